//! A diagram as SVG, in the look of the plots.

use super::diagram::{Arrow, BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line, Symbol};
use super::layers::{Flow, Item, Pin};
use super::measure::{
    Content, LABEL_GAP, LEADING, Label, Measured, NAME, PAD, PORT_PAD, SMALL, STACK, START, TEXT,
    derivative_width, is_led, measure,
};
use super::routes::{Layout, layout};
use crate::plot::palette::{location, location_shade};
use crate::plot::svg::{Anchor, INK, Svg};
use crate::plot::text::width;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Room around the drawing, px.
const MARGIN: f64 = 18.0;
/// Room for the heading.
const HEADING: f64 = 26.0;
/// Room between the border of a composite and what is in it.
const BORDER: f64 = 16.0;
/// Radius of the bends of arrows.
const BEND: f64 = 7.0;
const GREY: &str = "#6b6b6b";

/// The diagram as SVG.
pub(super) fn svg(diagram: &Diagram) -> String {
    let measured = measure(diagram);
    let flow = match diagram.kind {
        DiagramKind::Automaton => Flow::Around,
        DiagramKind::Composition => Flow::Onward,
    };
    let layout = layout(&measured.items, &measured.links, flow, &measured.lead_in);
    let bordered = diagram.kind == DiagramKind::Composition;
    let around = if bordered { BORDER } else { 0.0 };
    let (dx, dy) = (MARGIN + around, MARGIN + HEADING + around);
    let heading = width(&diagram.title, NAME);
    let size = ((layout.size.0 + 2.0 * dx).max(heading + 2.0 * MARGIN), layout.size.1 + dy + around + MARGIN);
    let mut sheet = Sheet { svg: Svg::new(size.0, size.1, &diagram.title), dx, dy };
    sheet.svg.text((MARGIN, MARGIN + NAME), Anchor::Start, NAME, &diagram.title);
    if bordered {
        sheet.border(&measured.items, &layout);
    }
    let led = diagram.arrows.iter().filter(|arrow| is_led(arrow, diagram));
    for (number, arrow) in led.enumerate() {
        sheet.arrow(arrow, &measured.labels[number], &layout.routes[number], layout.labels[number]);
    }
    sheet.branches(&layout.routes);
    for number in 0..diagram.boxes.len() {
        sheet.framed(number, diagram, &measured, layout.corners[number]);
    }
    sheet.svg.finish()
}

struct Sheet {
    svg: Svg,
    dx: f64,
    dy: f64,
}

impl Sheet {
    fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        (x + self.dx, y + self.dy)
    }

    /// The border of a composite, through its own ports.
    fn border(&mut self, items: &[Item], layout: &Layout) {
        let ends = |pin: Pin| {
            let pinned = items.iter().zip(&layout.corners).filter(move |(item, _)| item.at == pin);
            pinned.map(move |(item, corner)| corner.0 + if pin == Pin::First { item.width } else { 0.0 })
        };
        let left = ends(Pin::First).next().unwrap_or(-BORDER);
        let right = ends(Pin::Last).next().unwrap_or(layout.size.0 + BORDER);
        let corner = self.at((left, -BORDER));
        let size = (right - left, layout.size.1 + 2.0 * BORDER);
        self.svg.rect(corner, size, &format!("rx=\"4\" fill=\"none\" stroke=\"{GREY}\" stroke-width=\"1\""));
    }

    fn arrow(&mut self, arrow: &Arrow, label: &Label, route: &[(f64, f64)], place: Option<(f64, f64)>) {
        let points: Vec<(f64, f64)> = route.iter().map(|&point| self.at(point)).collect();
        self.svg.begin_group(&arrow.tip);
        let dash = if arrow.dashed { " stroke-dasharray=\"5 3\"" } else { "" };
        let attributes = format!("stroke=\"{INK}\" stroke-width=\"1.2\"{dash}");
        self.svg.path(&rounded(&points), &attributes);
        self.head(&points);
        match (place, points.first()) {
            (Some(place), _) => {
                let (x, y) = self.at(place);
                self.label(label, (x, y), Anchor::Middle);
            }
            (None, Some(&(x, y))) => self.label(label, (x + PORT_PAD, y), Anchor::Start),
            _ => {}
        }
        self.svg.end_group();
    }

    /// A dot where arrows that begin at one port part.
    fn branches(&mut self, routes: &[Vec<(f64, f64)>]) {
        let mut bends: BTreeMap<(u64, u64), Vec<(f64, f64)>> = BTreeMap::new();
        for route in routes {
            if let [begin, bend, .., _] = route.as_slice() {
                bends.entry((begin.0.to_bits(), begin.1.to_bits())).or_default().push(*bend);
            } else if let [begin, end] = route.as_slice() {
                bends.entry((begin.0.to_bits(), begin.1.to_bits())).or_default().push(*end);
            }
        }
        for (_, mut bends) in bends {
            bends.sort_by(|a, b| a.0.total_cmp(&b.0));
            bends.dedup();
            bends.pop();
            for bend in bends {
                let at = self.at(bend);
                self.svg.circle(at, 2.4, &format!("fill=\"{INK}\""));
            }
        }
    }

    fn label(&mut self, label: &Label, (x, y): (f64, f64), anchor: Anchor) {
        for (number, line) in label.above.iter().rev().enumerate() {
            self.svg.text((x, y - LABEL_GAP - LEADING * number as f64), anchor, TEXT, line);
        }
        for (number, line) in label.below.iter().enumerate() {
            self.svg.text((x, y + TEXT + LABEL_GAP - 2.0 + LEADING * number as f64), anchor, TEXT, line);
        }
    }

    /// The head of an arrow that comes along its last piece.
    fn head(&mut self, points: &[(f64, f64)]) {
        let [.., (x0, y0), (x, y)] = *points else { return };
        let data = if (y - y0).abs() > (x - x0).abs() {
            let back = if y > y0 { -8.0 } else { 8.0 };
            format!("M{x} {y}L{} {}L{} {}Z", x - 3.5, y + back, x + 3.5, y + back)
        } else {
            let back = if x >= x0 { -8.0 } else { 8.0 };
            format!("M{x} {y}L{} {}L{} {}Z", x + back, y - 3.5, x + back, y + 3.5)
        };
        self.svg.shape(&data, &format!("fill=\"{INK}\""));
    }

    fn framed(&mut self, number: usize, diagram: &Diagram, measured: &Measured, corner: (f64, f64)) {
        let (one, item, content) =
            (&diagram.boxes[number], &measured.items[number], &measured.contents[number]);
        let corner = self.at(corner);
        self.svg.begin_group(&one.tip);
        match one.kind {
            BoxKind::Input | BoxKind::Output => self.terminal(one, item, content, corner),
            _ => self.boxed(number, diagram.kind, one, item, content, corner),
        }
        self.svg.end_group();
    }

    /// An own port of a composite: the name outside, the symbol on the border.
    fn terminal(&mut self, one: &DiagramBox, item: &Item, content: &Content, (x, y): (f64, f64)) {
        let middle = y + 0.5 * item.height;
        let port = one.inputs.first().or(one.outputs.first());
        let symbol = port.map(|port| port.symbol).unwrap_or_default();
        let base = middle + 0.35 * TEXT;
        if one.kind == BoxKind::Input {
            self.symbol(symbol, (x + item.width, middle));
            self.svg.text((x + item.width - PORT_PAD, base), Anchor::End, TEXT, &content.name);
        } else {
            self.symbol(symbol, (x, middle));
            self.svg.text((x + PORT_PAD, base), Anchor::Start, TEXT, &content.name);
        }
    }

    fn boxed(
        &mut self,
        number: usize,
        kind: DiagramKind,
        one: &DiagramBox,
        item: &Item,
        content: &Content,
        (x, y): (f64, f64),
    ) {
        let (fill, stroke) = match (kind, one.kind) {
            (_, BoxKind::Note) => ("#fff".to_owned(), format!("{GREY}\" stroke-dasharray=\"4 3")),
            (DiagramKind::Automaton, _) => (location_shade(number as u32), location(number as u32)),
            (DiagramKind::Composition, _) => ("#f6f8fa".to_owned(), INK.to_owned()),
        };
        let radius = if kind == DiagramKind::Automaton { 9 } else { 2 };
        let frame = format!("rx=\"{radius}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.3\"");
        let size = (item.width, item.height);
        if one.kind == BoxKind::Stack {
            for behind in [2.0 * STACK, STACK] {
                self.svg.rect((x + behind, y - behind), size, &frame);
            }
        }
        self.svg.rect((x, y), size, &frame);
        if one.kind == BoxKind::Initial {
            let (from, to) = ((x + 14.0, y - START + 6.0), (x + 14.0, y));
            self.svg.circle(from, 4.0, &format!("fill=\"{INK}\""));
            self.svg.line(from, to, &format!("stroke=\"{INK}\" stroke-width=\"1.2\""));
            self.head(&[from, to]);
        }
        let middle = x + 0.5 * item.width;
        let used = content.header + LEADING * content.lines.len() as f64;
        // A box that is higher for its arrows has its text in the middle.
        let free = if one.inputs.is_empty() && one.outputs.is_empty() {
            item.height - used - 1.2 * PAD
        } else {
            0.0
        };
        let mut base = y + 0.5 * free + 0.6 * PAD + NAME - 1.0;
        self.svg.text((middle, base), Anchor::Middle, NAME, &content.name);
        if !content.caption.is_empty() {
            self.svg.grey_text((middle, base + LEADING - 1.0), Anchor::Middle, SMALL, &content.caption);
        }
        base += content.header;
        for line in &content.lines {
            self.line(line, (x + PAD, base));
            base += LEADING;
        }
        for (port, height) in one.inputs.iter().zip(&item.left) {
            self.port(port, (x, y + 0.5 * item.height + height), Anchor::Start);
        }
        for (port, height) in one.outputs.iter().zip(&item.right) {
            self.port(port, (x + item.width, y + 0.5 * item.height + height), Anchor::End);
        }
    }

    /// A line of a box; a dot over the name of a quantity makes it the derivative.
    fn line(&mut self, line: &Line, (x, y): (f64, f64)) {
        if let Some(name) = &line.derivative_of {
            self.svg.text((x, y), Anchor::Start, TEXT, name);
            // Of an element the letter has the dot, not the index.
            let letters = name.split('[').next().unwrap_or(name);
            let middle = x + 0.5 * width(letters, TEXT);
            self.svg.circle((middle, y - 10.6), 1.2, &format!("fill=\"{INK}\""));
        }
        self.svg.text((x + derivative_width(line), y), Anchor::Start, TEXT, &line.text);
    }

    fn port(&mut self, port: &DiagramPort, (x, y): (f64, f64), anchor: Anchor) {
        self.svg.begin_group(&port.tip);
        self.symbol(port.symbol, (x, y));
        let towards = if matches!(anchor, Anchor::End) { -PORT_PAD } else { PORT_PAD };
        self.svg.text((x + towards, y + 0.35 * SMALL), anchor, SMALL, &port.name);
        self.svg.end_group();
    }

    fn symbol(&mut self, symbol: Symbol, (x, y): (f64, f64)) {
        let open = format!("fill=\"#fff\" stroke=\"{INK}\" stroke-width=\"1.1\"");
        let r = 4.0;
        let polygon = |points: &[(f64, f64)]| {
            let mut data = String::new();
            for (number, (dx, dy)) in points.iter().enumerate() {
                let _ = write!(data, "{}{} {}", if number == 0 { 'M' } else { 'L' }, x + dx, y + dy);
            }
            data + "Z"
        };
        match symbol {
            Symbol::Signal => self.svg.shape(&polygon(&[(-4.5, 3.5), (4.5, 3.5), (0.0, -4.5)]), &open),
            Symbol::Event => self.svg.shape(&polygon(&[(-3.5, -4.5), (-3.5, 4.5), (4.5, 0.0)]), &open),
            Symbol::Text => {
                self.svg.shape(&polygon(&[(-5.0, 0.0), (0.0, -5.0), (5.0, 0.0), (0.0, 5.0)]), &open);
            }
            Symbol::Integer => self.svg.shape(&polygon(&[(-r, -r), (r, -r), (r, r), (-r, r)]), &open),
            Symbol::Real => self.svg.circle((x, y), 3.5, &format!("fill=\"{INK}\"")),
            Symbol::Boolean => {
                self.svg.circle((x, y), 4.5, &open);
                let stroke = format!("stroke=\"{INK}\" stroke-width=\"1.1\"");
                self.svg.line((x - 4.5, y), (x + 4.5, y), &stroke);
                self.svg.line((x, y - 4.5), (x, y + 4.5), &stroke);
            }
        }
    }
}

/// A path along right-angled pieces with rounded bends.
fn rounded(points: &[(f64, f64)]) -> String {
    let mut data = String::new();
    for (number, &(x, y)) in points.iter().enumerate() {
        // Writing into a string does not fail.
        let _ = match (number, points.get(number + 1)) {
            (0, _) => write!(data, "M{x:.1} {y:.1}"),
            (_, None) => write!(data, "L{x:.1} {y:.1}"),
            (_, Some(&next)) => {
                let before = points[number - 1];
                let (to, from) = (towards((x, y), before), towards((x, y), next));
                write!(data, "L{:.1} {:.1}Q{x:.1} {y:.1} {:.1} {:.1}", to.0, to.1, from.0, from.1)
            }
        };
    }
    data
}

/// The point where the bend at `corner` begins on the way to `other`.
fn towards(corner: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    let (dx, dy) = (other.0 - corner.0, other.1 - corner.1);
    let length = dx.abs().max(dy.abs());
    let share = if length > 0.0 { (BEND / length).min(0.5) } else { 0.0 };
    (corner.0 + share * dx, corner.1 + share * dy)
}
