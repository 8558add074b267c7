//! A connection names a port or a component that does not exist.

use super::suggestion::suggest;
use crate::component::Interface;
use crate::declarations::Spanned;
use sophy_diagnostics::{Code, Diagnostic, Span};
use std::collections::BTreeSet;

pub(crate) const CODE: Code = Code("HS0410");

/// `component` is the member, or nothing for the composite itself.
pub(crate) fn port(name: &Spanned<String>, component: Option<&str>, interface: &Interface) -> Diagnostic {
    let events = interface.input_events.iter().chain(&interface.output_events).chain(&interface.synchronised);
    let ports: Vec<&str> = interface
        .ports
        .iter()
        .map(|port| port.name.as_str())
        .chain(events.map(|event| &*event.name))
        .collect();
    let help = suggest(&name.value, &ports, "ports").help;
    let message = match component {
        Some(component) => format!("`{component}` has no port `{}`", name.value),
        None => format!("`{}` is no port of this component", name.value),
    };
    let error = Diagnostic::error(CODE, name.span, message).help(help);
    match component {
        Some(_) => error,
        None => error.help("a port of a member is written with its name: `member.port`"),
    }
}

pub(crate) fn member(name: &Spanned<String>, members: &BTreeSet<&str>) -> Diagnostic {
    let members: Vec<&str> = members.iter().copied().collect();
    Diagnostic::error(CODE, name.span, format!("there is no member `{}`", name.value))
        .help(suggest(&name.value, &members, "members").help)
}

pub(crate) fn too_deep(span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, "a connection reaches only the ports of members")
        .help("give the member a port of its own and connect that one inside it")
}

pub(crate) fn number_of_indices(name: &Spanned<String>, extents: &[u32], indices: usize) -> Diagnostic {
    let message = match (extents, indices) {
        ([], _) => format!("`{}` is a single component and takes no index", name.value),
        (_, 0) => format!("`{}` is an array: which copy is meant?", name.value),
        _ => format!("`{}` takes {} indices, not {indices}", name.value, extents.len()),
    };
    let example: Vec<&str> = extents.iter().map(|_| "1").collect();
    let help = if extents.is_empty() {
        "delete the index".to_owned()
    } else {
        format!("write for example `{}[{}]`, or connect in a loop", name.value, example.join(","))
    };
    Diagnostic::error(CODE, name.span, message).help(help)
}

pub(crate) fn outside(name: &Spanned<String>, index: i64, extent: u32, span: Span) -> Diagnostic {
    Diagnostic::error(CODE, span, format!("`{}` has no copy {index}", name.value))
        .help(format!("copies are counted from 1 to {extent}"))
}

/// `cell[50] : Cell` declares one cell.
pub(crate) fn one_element(name: &Spanned<String>, indices: &[u32], declared: Span) -> Diagnostic {
    let indices: Vec<String> = indices.iter().map(u32::to_string).collect();
    let (name, indices, at) = (&name.value, indices.join(","), name.span);
    Diagnostic::error(CODE, at, format!("of `{name}` there is only `{name}[{indices}]`"))
        .label(declared, "declares this one member")
        .help(format!("for an array write its extent behind the component: `{name} : Component[{indices}]`"))
}

pub(crate) fn no_element(name: &Spanned<String>, indices: &[i64]) -> Diagnostic {
    let indices: Vec<String> = indices.iter().map(i64::to_string).collect();
    let written = if indices.is_empty() { String::new() } else { format!("[{}]", indices.join(",")) };
    Diagnostic::error(CODE, name.span, format!("there is no member `{}{written}`", name.value))
        .help("the elements of this array are declared one by one: this one is not among them")
}
