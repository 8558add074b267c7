//! An event label is emitted or waited for that is no event of the interface in that direction.

use super::suggestion::suggest;
use crate::declarations::{ComponentDeclaration, Dialect, Direction, PortDeclaration, Spanned};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0132");

fn is_event(port: &PortDeclaration) -> bool {
    port.kind.as_ref().is_some_and(|kind| kind.name.value == "event")
}

fn labels(component: &ComponentDeclaration, direction: Direction) -> Vec<&str> {
    let suits = |port: &&PortDeclaration| {
        port.direction == direction && (is_event(port) || direction == Direction::Synchronised)
    };
    component.ports.iter().filter(suits).map(|port| port.name.value.as_str()).collect()
}

pub(crate) fn is_output_event(component: &ComponentDeclaration, label: &str) -> bool {
    component.dialect == Dialect::Xml || labels(component, Direction::Output).contains(&label)
}

pub(crate) fn is_input_event(component: &ComponentDeclaration, label: &str) -> bool {
    component.dialect == Dialect::Xml || labels(component, Direction::Input).contains(&label)
}

pub(crate) fn is_synchronised(component: &ComponentDeclaration, label: &str) -> bool {
    labels(component, Direction::Synchronised).contains(&label)
}

fn other_way(component: &ComponentDeclaration, label: &str) -> Option<&'static str> {
    let port = component.ports.iter().find(|port| port.name.value == label)?;
    Some(match (port.direction, is_event(port)) {
        (_, false) => "it is declared, but carries a value and is no event",
        (Direction::Input, true) => "it is an event that is received",
        (Direction::Output, true) => "it is an event that is emitted",
        (Direction::Synchronised, true) => "it is the label of synchronised transitions",
    })
}

fn unknown(
    label: &Spanned<String>,
    component: &ComponentDeclaration,
    direction: Direction,
    example: &str,
) -> Diagnostic {
    let what = match direction {
        Direction::Input => "input event",
        Direction::Output => "output event",
        Direction::Synchronised => "`sync` label",
    };
    let mut error = Diagnostic::error(
        CODE,
        label.span,
        format!("`{}` is no {what} of `{}`", label.value, component.name.value),
    );
    let candidates = labels(component, direction);
    match other_way(component, &label.value) {
        Some(why) => error = error.note(why),
        None if !candidates.is_empty() => {
            error = error.help(suggest(&label.value, &candidates, "labels").help);
        }
        None => {}
    }
    error.help(format!("declare it in the interface: `{example}`"))
}

/// `emits` is whether events can be emitted where the statement stands.
pub(crate) fn emitted(label: &Spanned<String>, component: &ComponentDeclaration, emits: bool) -> Diagnostic {
    if !emits {
        return Diagnostic::error(CODE, label.span, "no events can be emitted here")
            .help("emit it in a transition, an event section, a rule or an `update` section");
    }
    unknown(label, component, Direction::Output, &format!("output({}, event);", label.value))
}

pub(crate) fn received(label: &Spanned<String>, component: &ComponentDeclaration) -> Diagnostic {
    unknown(label, component, Direction::Input, &format!("input({}, event);", label.value))
}

pub(crate) fn synchronised(label: &Spanned<String>, component: &ComponentDeclaration) -> Diagnostic {
    unknown(label, component, Direction::Synchronised, &format!("sync({});", label.value))
}
