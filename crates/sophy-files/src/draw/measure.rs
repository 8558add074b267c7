//! How much room boxes and labels need, and what of long texts is shown.

use super::diagram::{Arrow, BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line};
use super::layers::{Item, Link, Pin};
use crate::plot::text::{fitted, width};
use std::collections::HashMap;

/// Sizes of letters, px.
pub(super) const NAME: f64 = 13.0;
pub(super) const TEXT: f64 = 11.0;
pub(super) const SMALL: f64 = 10.0;
/// Distance of lines, px.
pub(super) const LEADING: f64 = 15.0;
/// Distance of ports, px.
pub(super) const PORT: f64 = 18.0;
/// Room inside a box, px.
pub(super) const PAD: f64 = 10.0;
/// Room between a port and its name.
pub(super) const PORT_PAD: f64 = 10.0;
/// Room for the arrow of the initial location.
pub(super) const START: f64 = 26.0;
/// How far the copies of a stack show.
pub(super) const STACK: f64 = 4.0;
/// Distance of an arrow and its label.
pub(super) const LABEL_GAP: f64 = 5.0;

const WIDEST_LINE: f64 = 280.0;
const WIDEST_LABEL: f64 = 190.0;
const MOST_LINES: usize = 14;
const MOST_LABEL_LINES: usize = 4;

/// A diagram with its sizes.
#[derive(Debug, Default)]
pub(super) struct Measured {
    /// One per box.
    pub(super) items: Vec<Item>,
    pub(super) contents: Vec<Content>,
    /// One per arrow.
    pub(super) links: Vec<Link>,
    pub(super) labels: Vec<Label>,
    /// Room that an arrow needs where it begins, for a label without room of its own.
    pub(super) lead_in: Vec<f64>,
}

/// What is shown of a box.
#[derive(Debug, Default)]
pub(super) struct Content {
    pub(super) name: String,
    pub(super) caption: String,
    pub(super) lines: Vec<Line>,
    /// Height of the name and the caption.
    pub(super) header: f64,
}

/// What is shown of a label.
#[derive(Debug, Default)]
pub(super) struct Label {
    pub(super) above: Vec<String>,
    pub(super) below: Vec<String>,
}

pub(super) fn measure(diagram: &Diagram) -> Measured {
    let mut measured = Measured::default();
    for one in &diagram.boxes {
        let content = content(one);
        measured.items.push(item(one, &content));
        measured.contents.push(content);
    }
    // The border stands where all ports of its side are.
    for pin in [Pin::First, Pin::Last] {
        let pinned = |item: &&mut Item| item.at == pin;
        let widest = measured.items.iter_mut().filter(pinned).map(|item| item.width).fold(0.0, f64::max);
        measured.items.iter_mut().filter(pinned).for_each(|item| item.width = widest);
    }
    let mut carrier: HashMap<(usize, Option<usize>), usize> = HashMap::new();
    let mut degree = vec![[0_usize; 2]; diagram.boxes.len()];
    for arrow in diagram.arrows.iter().filter(|arrow| is_led(arrow, diagram)) {
        let mut label = Label { above: shown(&arrow.above), below: shown(&arrow.below) };
        if diagram.kind == DiagramKind::Composition && !label.above.is_empty() {
            // Arrows that begin at one port have one label there.
            let begin = (arrow.from.of, arrow.from.port);
            let first = *carrier.entry(begin).or_insert(measured.labels.len());
            if let Some(known) = measured.labels.get_mut(first) {
                let text = label.above.join(" ");
                let line = known.above.join(" ");
                if line.split(' ').all(|word| word != text) {
                    known.above = vec![fitted(&format!("{line} {text}"), TEXT, WIDEST_LABEL)];
                }
                measured.lead_in[first] = widest(known.above.iter(), TEXT) + 2.0 * LABEL_GAP;
                label = Label::default();
            }
        }
        let widest = widest(label.above.iter().chain(&label.below), TEXT);
        let height =
            |lines: &[String]| LEADING * lines.len() as f64 + if lines.is_empty() { 0.0 } else { LABEL_GAP };
        let (above, below) = (height(&label.above), height(&label.below));
        let room = if widest > 0.0 { widest + 2.0 * LABEL_GAP } else { 0.0 };
        let of_its_own = diagram.kind == DiagramKind::Automaton;
        measured.links.push(Link {
            from: arrow.from.of,
            to: arrow.to.of,
            from_port: arrow.from.port,
            to_port: arrow.to.port,
            width: if of_its_own { room } else { 0.0 },
            above: if of_its_own { above } else { 0.0 },
            below: if of_its_own { below } else { 0.0 },
        });
        measured.labels.push(label);
        measured.lead_in.push(if of_its_own { 0.0 } else { room });
        degree[arrow.from.of][1] += 1;
        degree[arrow.to.of][0] += 1;
    }
    if diagram.kind == DiagramKind::Automaton {
        // Room for all arrows at one side: nothing is known yet about where they come from.
        for (item, [incoming, outgoing]) in measured.items.iter_mut().zip(degree) {
            item.height = item.height.max(TEXT * (incoming + outgoing + 1) as f64);
        }
    }
    measured
}

/// Whether an arrow joins boxes that exist.
pub(super) fn is_led(arrow: &Arrow, diagram: &Diagram) -> bool {
    arrow.from.of.max(arrow.to.of) < diagram.boxes.len()
}

fn content(one: &DiagramBox) -> Content {
    let mut lines: Vec<Line> = one.lines.iter().take(MOST_LINES).map(shown_line).collect();
    if one.lines.len() > MOST_LINES {
        lines.truncate(MOST_LINES - 1);
        let more = one.lines.len() - lines.len();
        lines.push(Line { derivative_of: None, text: format!("… and {more} more") });
    }
    let name = fitted(&one.name, NAME, WIDEST_LINE);
    let caption = fitted(&one.caption, SMALL, WIDEST_LINE);
    let header = if caption.is_empty() { LEADING + 3.0 } else { 2.0 * LEADING };
    Content { name, caption, lines, header }
}

fn shown_line(line: &Line) -> Line {
    let before = derivative_width(line);
    Line { derivative_of: line.derivative_of.clone(), text: fitted(&line.text, TEXT, WIDEST_LINE - before) }
}

/// Width of the dotted name in front of a line.
pub(super) fn derivative_width(line: &Line) -> f64 {
    line.derivative_of.as_ref().map_or(0.0, |name| width(name, TEXT) + width(" ", TEXT))
}

fn item(one: &DiagramBox, content: &Content) -> Item {
    let port_width = |ports: &[DiagramPort]| widest(ports.iter().map(|port| &port.name), SMALL);
    if matches!(one.kind, BoxKind::Input | BoxKind::Output) {
        let at = if one.kind == BoxKind::Input { Pin::First } else { Pin::Last };
        let (width, height) = (width(&content.name, TEXT) + PORT_PAD, PORT - 2.0);
        return Item { width, height, at, left: vec![0.0], right: vec![0.0], ..Item::default() };
    }
    let (inputs, outputs) = (port_width(&one.inputs), port_width(&one.outputs));
    let lines = content.lines.iter().map(|line| derivative_width(line) + width(&line.text, TEXT));
    let inside = lines.fold(width(&content.name, NAME).max(width(&content.caption, SMALL)), f64::max);
    let ports = if inputs + outputs > 0.0 { inputs + outputs + 2.0 * PORT_PAD + 18.0 } else { 0.0 };
    let rows = one.inputs.len().max(one.outputs.len()) as f64;
    let height = 1.2 * PAD + content.header + LEADING * content.lines.len() as f64 + PORT * rows;
    let head = match one.kind {
        BoxKind::Initial => START,
        BoxKind::Stack => 2.0 * STACK,
        _ => 0.0,
    };
    let first = 0.5 * height - PORT * rows - 0.3 * PAD + 0.5 * PORT;
    let heights = |ports: &[DiagramPort]| (0..ports.len()).map(|n| first + PORT * n as f64).collect();
    Item {
        width: (inside + 2.0 * PAD).max(ports).max(64.0),
        height,
        head,
        at: Pin::Free,
        left: heights(&one.inputs),
        right: heights(&one.outputs),
    }
}

fn widest<'a>(texts: impl Iterator<Item = &'a String>, size: f64) -> f64 {
    texts.map(|text| width(text, size)).fold(0.0, f64::max)
}

/// The lines of a label, broken where they are too long, the rest left out.
fn shown(lines: &[String]) -> Vec<String> {
    let mut out: Vec<String> = lines.iter().flat_map(|line| wrapped(line)).collect();
    if out.len() > MOST_LABEL_LINES {
        out.truncate(MOST_LABEL_LINES);
        if let Some(last) = out.last_mut() {
            *last = fitted(&format!("{last} …"), TEXT, WIDEST_LABEL);
        }
    }
    out
}

fn wrapped(line: &str) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match out.last_mut() {
            Some(last) if width(last, TEXT) + width(" ", TEXT) + width(word, TEXT) <= WIDEST_LABEL => {
                last.push(' ');
                last.push_str(word);
            }
            _ => out.push(fitted(word, TEXT, WIDEST_LABEL)),
        }
    }
    out
}
