//! Expressions over one set of names, and what becomes of them.

mod arrays;
mod files;
mod functions;
mod meaning;
mod promises;
mod units;

use super::*;
use crate::declarations::{Declarations, Dialect};
use crate::findings::Findings;
use crate::units::{Measured, parse};
use sophy_diagnostics::{Diagnostic, MemoryWorld, SourceId, Sources, Span};
use sophy_ir::{Graph, Leaf, NodeId, Quantity, Special, VariableId};
use std::collections::BTreeSet;
use std::rc::Rc;

/// What an expression became, with all it refers to.
struct Lowered {
    value: Option<Typed>,
    graph: Graph,
    specials: Vec<Special>,
    names: Vec<String>,
    structural: BTreeSet<String>,
    findings: Findings,
    sources: Sources,
}

/// The component that the expressions of these tests stand in, one variable a line: name, kind, type, unit, values.
const NAMES: &str = "
    x state real m
    y state real ft
    v state real m/s
    z state real -
    w state real -
    p state real[3] m
    q state real[3] -
    A state real[3,3] -
    B state real[2,3] -
    J parameter real[2,2] - 2 0 0 4
    big parameter real[5,5] -
    n parameter integer - 3
    k parameter real - 0
    a parameter real -
    on mode boolean -
    off mode boolean -
    i mode integer -
    phase mode string -
    u input real -
    wet mode boolean[2] -
    theta state real deg
    period parameter real ms
";

/// Lowers `expression` where `declarations`, of HSML, hold beside [`NAMES`].
fn lower_at(place: Place, declarations: &str, expression: &str, world: &MemoryWorld) -> Lowered {
    let mut sources = Sources::default();
    let file = format!("{declarations}\nconstant expression = {expression};\n");
    let reading = crate::read_hsml(&mut sources, "models/test.hsml", file.as_bytes());
    let mistakes: Vec<&Diagnostic> = reading.diagnostics.iter().collect();
    assert!(mistakes.is_empty(), "{expression}: {mistakes:?}");
    let declarations: Declarations = reading.declarations;
    let (it, constants) = declarations.constants.split_last().unwrap();

    let (mut findings, mut texts) = (Findings::default(), Vec::new());
    let mut files = Files::new(world);
    files.set_folder(reading.source, "models".into());
    let constants: Vec<_> = constants.iter().collect();
    let functions: Vec<_> = declarations.functions.iter().collect();
    let globals = lower_globals(&constants, &functions, Dialect::Hsml, &mut files, &mut texts, &mut findings);
    let mut symbols = Symbols::new(Rc::new(globals));
    symbols.locations = vec!["Flight".to_owned(), "Ground".to_owned()];
    let names = declare(&mut symbols, &mut texts, reading.source);
    let (mut graph, mut specials, mut structural) = (Graph::default(), Vec::new(), BTreeSet::new());
    let mut lowering = Lowering {
        graph: &mut graph,
        specials: &mut specials,
        symbols: &mut symbols,
        place,
        findings: &mut findings,
        texts: &mut texts,
        files: &mut files,
        dialect: Dialect::Hsml,
        structural: &mut structural,
    };
    let value = lowering.value(&it.value);
    assert!(
        value.is_some() || findings.error_count() > 0,
        "{expression}: there is no value, and no mistake either"
    );
    Lowered { value, graph, specials, names, structural, findings, sources }
}

fn declare(symbols: &mut Symbols<'_>, texts: &mut Vec<String>, source: SourceId) -> Vec<String> {
    let mut names = Vec::new();
    let span = Span::new(source, 0..0);
    for line in NAMES.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let mut words = line.split(' ');
        let mut word = || words.next().unwrap_or_default();
        let (name, kind, kind_of_value, unit) = (word(), word(), word(), word());
        let known: Vec<f64> = words.map(|number| number.parse().unwrap()).collect();
        let (kind, varies) = match kind {
            "state" => (SymbolKind::State, Varies::Continuously),
            "parameter" => (SymbolKind::Parameter, Varies::Parameters),
            "mode" => (SymbolKind::Mode, Varies::Instants),
            "input" => (SymbolKind::Input, Varies::Continuously),
            other => panic!("{other}"),
        };
        let (quantity, extents) = kind_of_value.split_once('[').unwrap_or((kind_of_value, ""));
        let extents = extents.trim_end_matches(']').split(',').filter(|extent| !extent.is_empty());
        let extents: Vec<usize> = extents.map(|extent| extent.parse().unwrap()).collect();
        let quantity = match quantity {
            "real" => Quantity::Real,
            "integer" => Quantity::Integer,
            "boolean" => Quantity::Boolean,
            "string" => Quantity::Text,
            other => panic!("{other}"),
        };
        let shape = Shape::of(&extents).unwrap();
        let choices = if quantity == Quantity::Text { vec!["idle", "tracking"] } else { Vec::new() };
        let choices = choices.into_iter().map(|text| sophy_ir::Model::text_number(texts, text)).collect();
        let variable = VariableSymbol {
            first: VariableId(names.len() as u32),
            shape,
            quantity,
            measured: if unit == "-" {
                Measured::Unchecked
            } else {
                Measured::Known(parse(unit).unwrap().unit)
            },
            varies,
            choices,
            known: (!known.is_empty()).then(|| Rc::from(known)),
        };
        names.extend((0..shape.len()).map(|element| format!("{name}{}", shape.suffix(element))));
        symbols.declare(name, Symbol { kind, span, value: SymbolValue::Variable(variable) });
    }
    for event in ["hit", "miss"] {
        symbols.declare(event, Symbol { kind: SymbolKind::Event, span, value: SymbolValue::Event });
    }
    symbols.declare("motor", Symbol { kind: SymbolKind::Member, span, value: SymbolValue::None });
    names
}

impl Lowered {
    /// Elements in the notation of the language; numbers without `.0`.
    fn text(&self) -> String {
        let Some(value) = self.value.as_ref().filter(|_| self.findings.error_count() == 0) else {
            return self.messages();
        };
        let elements: Vec<String> = value.elements.as_slice().iter().map(|&node| self.node(node)).collect();
        elements.join("; ")
    }

    fn node(&self, node: NodeId) -> String {
        let text = self.graph.display(node, &|leaf| match leaf {
            Leaf::Variable(id) => self.names[id.0 as usize].clone(),
            Leaf::Special(position) => self.special(&self.specials[position as usize]),
            Leaf::Time => "time".to_owned(),
            other => format!("{other:?}"),
        });
        text.replace(".0", "")
    }

    fn special(&self, special: &Special) -> String {
        match special {
            Special::Delayed { value, delay, before } => {
                let before = before.map_or(String::new(), |before| format!(", {}", self.node(before)));
                format!("delayed({}, {}{before})", self.node(*value), self.node(*delay))
            }
            Special::Noise { name, deviation, period } => {
                format!("noise({name}, {}, {})", self.node(*deviation), self.node(*period))
            }
            Special::Chance(p) => format!("chance({})", self.node(*p)),
            Special::Event(name) => format!("event {name}"),
            Special::Rises(condition) => format!("rises({})", self.node(*condition)),
            Special::Falls(condition) => format!("falls({})", self.node(*condition)),
            Special::Changes(value) => format!("changes({})", self.node(*value)),
            Special::Location => "location".to_owned(),
            Special::Never => "never".to_owned(),
            Special::Table { table, at } => format!("table{table}({})", self.node(*at)),
            Special::Smooth(value) => format!("smooth({})", self.node(*value)),
        }
    }

    /// One line for each mistake: code, place, message, then labels, notes and helps.
    fn messages(&self) -> String {
        let mut lines: Vec<String> = Vec::new();
        for unknown in &self.findings.unknown_names {
            lines.push(format!("unknown {}", unknown.name));
        }
        for diagnostic in self.findings.diagnostics.clone().sorted(&self.sources) {
            let mut line = String::new();
            for (position, label) in diagnostic.labels.iter().enumerate() {
                let excerpt = self.sources.excerpt(label.span);
                line += &match (position, label.message.as_str()) {
                    (0, "") => format!("{} {excerpt}: {}", diagnostic.code, diagnostic.message),
                    (0, said) => format!("{} {excerpt}: {} ({said})", diagnostic.code, diagnostic.message),
                    (_, said) => format!(" | {excerpt}: {said}"),
                };
            }
            let notes = diagnostic.notes.iter().map(|note| format!(" | note: {note}"));
            let helps = diagnostic.helps.iter().map(|help| format!(" | help: {help}"));
            line.extend(notes.chain(helps));
            lines.push(line);
        }
        lines.join("\n")
    }
}

fn lower(expression: &str) -> Lowered {
    lower_at(Place::INSTANT, "", expression, &MemoryWorld::default())
}

/// Expressions and what they become, or the messages about them.
fn check(table: &[(&str, &str)]) {
    for (expression, expected) in table {
        assert_eq!(lower(expression).text(), *expected, "{expression}");
    }
}

/// Messages, also of what has a value beside.
fn check_messages(table: &[(&str, &str)]) {
    for (expression, expected) in table {
        assert_eq!(lower(expression).messages(), *expected, "{expression}");
    }
}
