use sophy_ir::Model;
use sophy_testkit::Build;

/// u′ᵢ = 1000(uᵢ₋₁ − uᵢ) − 1000 uᵢ(uᵢ − ½)(uᵢ − 1), u₀ = 1: some fronts that travel through cells at rest, of which half
/// are 1 and half are 0. One front is as fast and as steep as another, however many cells there are: with u, 1 − u is a
/// solution, too.
#[derive(Clone, Copy, Debug)]
pub struct Fronts {
    pub cells: usize,
    pub fronts: usize,
}

impl Fronts {
    pub fn model(self) -> Model {
        let mut b = Build::default();
        b.component("");
        let cells: Vec<_> = (0..self.cells).map(|i| b.state(&format!("x{}", i + 1), self.start(i))).collect();
        let here = b.location("all");
        let [one, half, speed] = [1.0, 0.5, 1000.0].map(|n| b.number(n));
        let mut before = one;
        for cell in cells {
            let u = b.read(cell);
            let step = b.sub(before, u);
            let (flow, middle, end) = (b.mul(step, speed), b.sub(u, half), b.sub(u, one));
            let product = b.mul(u, middle);
            let product = b.mul(product, end);
            let source = b.mul(product, speed);
            let rate = b.sub(flow, source);
            b.rate(here, cell, rate);
            before = u;
        }
        b.model()
    }

    /// The first front stands behind three tenths of its share of the cells.
    fn start(self, cell: usize) -> f64 {
        let passed = (10 * cell * self.fronts + 7 * self.cells) / (10 * self.cells);
        if passed.is_multiple_of(2) { 1.0 } else { 0.0 }
    }
}
