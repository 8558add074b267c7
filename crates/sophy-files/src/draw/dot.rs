//! A diagram as Graphviz text.

use super::diagram::{BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line, Symbol};
use super::measure::is_led;
use crate::plot::text::FAMILY;
use std::fmt::Write;

/// The diagram in DOT, all texts in full.
pub(super) fn dot(diagram: &Diagram) -> String {
    let mut out = String::new();
    // Writing into a string does not fail.
    let _ = writeln!(out, "digraph {} {{", quoted(&diagram.title));
    let _ = writeln!(out, "  label={}; labelloc=t; rankdir=LR;", quoted(&diagram.title));
    for kind in ["graph", "node", "edge"] {
        let _ = writeln!(out, "  {kind} [fontname={}, fontsize=11];", quoted(FAMILY));
    }
    for (number, one) in diagram.boxes.iter().enumerate() {
        let shape = match (diagram.kind, one.kind) {
            (_, BoxKind::Note) => "shape=note",
            (_, BoxKind::Input | BoxKind::Output) => "shape=plaintext",
            (DiagramKind::Automaton, _) => "shape=box, style=rounded",
            (DiagramKind::Composition, _) => "shape=record",
        };
        let label = if shape == "shape=record" { record(one) } else { quoted(&lines(one).join("\n")) };
        let tip = if one.tip.is_empty() { String::new() } else { format!(", tooltip={}", quoted(&one.tip)) };
        let _ = writeln!(out, "  b{number} [{shape}, label={label}{tip}];");
        if one.kind == BoxKind::Initial {
            let _ = writeln!(out, "  start{number} [shape=point];\n  start{number} -> b{number};");
        }
    }
    for arrow in diagram.arrows.iter().filter(|arrow| is_led(arrow, diagram)) {
        let port = |side: &str, port: Option<usize>| port.map(|p| format!(":{side}{p}")).unwrap_or_default();
        let terminal = |of: usize| matches!(diagram.boxes[of].kind, BoxKind::Input | BoxKind::Output);
        let from = if terminal(arrow.from.of) { String::new() } else { port("o", arrow.from.port) };
        let to = if terminal(arrow.to.of) { String::new() } else { port("i", arrow.to.port) };
        let label: Vec<&str> = arrow.above.iter().chain(&arrow.below).map(String::as_str).collect();
        let mut attributes = Vec::new();
        if !label.is_empty() {
            attributes.push(format!("label={}", quoted(&label.join("\n"))));
        }
        if arrow.dashed {
            attributes.push("style=dashed".to_owned());
        }
        if !arrow.tip.is_empty() {
            attributes.push(format!("tooltip={}", quoted(&arrow.tip)));
        }
        let attributes =
            if attributes.is_empty() { String::new() } else { format!(" [{}]", attributes.join(", ")) };
        let _ = writeln!(out, "  b{}{from} -> b{}{to}{attributes};", arrow.from.of, arrow.to.of);
    }
    out.push_str("}\n");
    out
}

fn lines(one: &DiagramBox) -> Vec<String> {
    let head = [&one.name, &one.caption].into_iter().filter(|text| !text.is_empty()).cloned();
    head.chain(one.lines.iter().map(line)).collect()
}

fn line(line: &Line) -> String {
    match &line.derivative_of {
        Some(name) => format!("der({name}) {}", line.text),
        None => line.text.clone(),
    }
}

/// A box with its ports, as the label of a record.
fn record(one: &DiagramBox) -> String {
    let ports = |side: &str, ports: &[DiagramPort]| {
        let named = ports.iter().enumerate();
        let named =
            named.map(|(n, port)| format!("<{side}{n}> {} {}", letter(port.symbol), field(&port.name)));
        named.collect::<Vec<_>>().join("|")
    };
    let middle: Vec<String> = lines(one).iter().map(|line| field(line)).collect();
    let (inputs, outputs) = (ports("i", &one.inputs), ports("o", &one.outputs));
    let columns = [format!("{{{inputs}}}"), middle.join("\\n"), format!("{{{outputs}}}")];
    let columns: Vec<String> = columns.into_iter().filter(|column| column != "{}").collect();
    format!("\"{}\"", columns.join("|"))
}

fn letter(symbol: Symbol) -> char {
    match symbol {
        Symbol::Signal => '△',
        Symbol::Real => '●',
        Symbol::Integer => '□',
        Symbol::Boolean => '⊕',
        Symbol::Text => '◇',
        Symbol::Event => '▷',
    }
}

/// A text within a record, where more letters have a meaning.
fn field(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        if "{}|<>".contains(c) {
            out.push('\\');
        }
        escape(c, &mut out);
    }
    out
}

fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    text.chars().for_each(|c| escape(c, &mut out));
    out.push('"');
    out
}

fn escape(c: char, out: &mut String) {
    match c {
        '"' => out.push_str("\\\""),
        '\\' => out.push_str("\\\\"),
        '\n' => out.push_str("\\n"),
        c if c.is_control() => out.push(' '),
        c => out.push(c),
    }
}
