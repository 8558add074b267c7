/// Times `start + k·step`, each the correctly rounded double of the decimal that was meant: with a step of
/// 0.1 the third is 0.3, not 0.30000000000000004.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    start: f64,
    step: f64,
    /// `step` as `numerator / 10^digits`, where that is exact.
    decimal: Option<(u64, i32)>,
    next: u64,
}

impl Grid {
    pub(crate) fn new(start: f64, step: f64) -> Self {
        Grid { start, step, decimal: decimal(step), next: 0 }
    }

    /// The next time.
    pub(crate) fn peek(&self) -> f64 {
        if let Some((numerator, digits)) = self.decimal
            && let Some(product) = self.next.checked_mul(numerator)
            && product < 1 << 53
        {
            return self.start + product as f64 / sophy_ir::arithmetic::integer_power(10.0, digits);
        }
        self.start + self.next as f64 * self.step
    }

    pub(crate) fn advance(&mut self) {
        self.next += 1;
    }
}

/// The shortest decimal that prints `x`, as a whole number and a count of decimals (up to 22, where powers
/// of ten are exact).
fn decimal(x: f64) -> Option<(u64, i32)> {
    let text = format!("{x}");
    let (whole, fraction) = text.split_once('.').unwrap_or((&text, ""));
    let digits = i32::try_from(fraction.len()).ok().filter(|&d| d <= 22)?;
    Some((format!("{whole}{fraction}").parse().ok()?, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_times_are_the_decimals_meant() {
        let mut grid = Grid::new(0.0, 0.1);
        for expected in [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7] {
            assert_eq!(grid.peek(), expected);
            grid.advance();
        }
        let mut grid = Grid::new(0.0, 0.1);
        for _ in 0..1_000_000 {
            grid.advance();
        }
        assert_eq!(grid.peek(), 100_000.0);
    }
}
