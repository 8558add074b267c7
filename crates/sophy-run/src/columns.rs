//! The columns that a run could record, and those that an experiment asks for.

use crate::configure::{names, unknown};
use crate::experiment::{ExperimentError, matches};
use rustc_hash::FxHashSet;
use sophy_field::SourceIndex;
use sophy_ir::{Quantity, System};
use sophy_record::ColumnKind;

/// What a real column shows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Real {
    Source(SourceIndex),
    Output(usize),
}

/// What a label column shows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Label {
    /// The location of an automaton.
    Location(usize),
    /// A truth value or the number of a text, at most `last`.
    Value { value: Real, last: u32 },
}

/// A column that could be recorded.
pub(crate) struct Available {
    pub(crate) name: String,
    pub(crate) unit: Option<String>,
    pub(crate) kind: ColumnKind,
    pub(crate) shown: Shown,
    by_default: bool,
    is_state: bool,
}

/// What a column shows.
pub(crate) enum Shown {
    Real(Real),
    Label(Label),
}

/// The columns asked for, in the order in which the patterns ask for them; by default outputs and locations.
pub(crate) fn chosen<'a>(
    available: &'a [Available],
    patterns: Option<&[String]>,
) -> Result<Vec<&'a Available>, Vec<ExperimentError>> {
    let Some(patterns) = patterns else {
        // A model without outputs shows its states.
        let no_outputs = !available.iter().any(Available::is_output);
        let wanted = |column: &&Available| column.by_default || (no_outputs && column.is_state);
        return Ok(available.iter().filter(wanted).collect());
    };
    let (mut columns, mut errors) = (Vec::new(), Vec::new());
    let mut taken = vec![false; available.len()];
    for pattern in patterns {
        let mut any = false;
        for (column, taken) in available.iter().zip(&mut taken) {
            if matches(pattern, &column.name) {
                any = true;
                if !std::mem::replace(taken, true) {
                    columns.push(column);
                }
            }
        }
        if !any {
            errors.push(unknown("record", "variable", pattern, &names(available, |c| c.name.clone())));
        }
    }
    if errors.is_empty() { Ok(columns) } else { Err(errors) }
}

impl Available {
    fn is_output(&self) -> bool {
        let value = match self.shown {
            Shown::Real(value) | Shown::Label(Label::Value { value, .. }) => Some(value),
            Shown::Label(Label::Location(_)) => None,
        };
        matches!(value, Some(Real::Output(_)))
    }
}

/// Outputs, then states and inputs that are not outputs of the same name, then locations.
pub(crate) fn available(system: &System, states: u32) -> Vec<Available> {
    let mut columns: Vec<Available> = Vec::new();
    let mut taken: FxHashSet<String> = FxHashSet::default();
    let mut add = |name: String, unit: &Option<String>, (kind, shown), by_default: bool, is_state: bool| {
        if taken.insert(name.clone()) {
            columns.push(Available { name, unit: unit.clone(), kind, shown, by_default, is_state });
        }
    };
    let shown = |quantity: Quantity, value: Real| shown(quantity, value, &system.texts);
    for (index, y) in system.outputs.iter().enumerate() {
        add(y.name(system), &y.declared.unit, shown(y.declared.quantity, Real::Output(index)), true, false);
    }
    for (index, x) in system.states.iter().enumerate() {
        let source = Real::Source(SourceIndex(index as u32));
        add(x.name(system), &x.declared.unit, shown(x.declared.quantity, source), false, true);
    }
    for (index, u) in system.inputs.iter().enumerate() {
        let source = Real::Source(SourceIndex(states + index as u32));
        add(u.name(system), &u.declared.unit, shown(u.declared.quantity, source), false, false);
    }
    for (index, automaton) in system.automata.iter().enumerate() {
        // A component that was written without locations has one without a name.
        let kind = &automaton.kind;
        let written = kind.locations.iter().any(|location| !location.name.is_empty());
        if kind.role != sophy_ir::Role::Component || !written {
            continue;
        }
        let name = match automaton.name(system).as_str() {
            "" => "location".to_owned(),
            component => format!("{component}.location"),
        };
        columns.push(Available {
            name,
            unit: None,
            kind: ColumnKind::Label(kind.locations.iter().map(|l| l.name.clone()).collect()),
            shown: Shown::Label(Label::Location(index)),
            by_default: kind.locations.len() > 1,
            is_state: false,
        });
    }
    columns
}

/// A value as people read it: truth values and texts by their names.
fn shown(quantity: Quantity, value: Real, texts: &[String]) -> (ColumnKind, Shown) {
    let names = match quantity {
        Quantity::Boolean => vec!["false".to_owned(), "true".to_owned()],
        Quantity::Text => texts.to_vec(),
        Quantity::Real | Quantity::Integer => Vec::new(),
    };
    match names.len().checked_sub(1) {
        Some(last) => {
            let label = Label::Value { value, last: u32::try_from(last).unwrap_or(u32::MAX) };
            (ColumnKind::Label(names), Shown::Label(label))
        }
        None => (ColumnKind::Real, Shown::Real(value)),
    }
}
