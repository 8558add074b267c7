//! Two locations have one name, so that a transition to it could mean either.

use crate::declarations::ComponentDeclaration;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use std::collections::HashMap;

pub(crate) const CODE: Code = Code("HS0112");

pub(crate) fn find(declarations: &ComponentDeclaration, diagnostics: &mut Diagnostics) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for location in declarations.locations.iter().filter(|location| !location.name.value.is_empty()) {
        let (name, span) = (location.name.value.as_str(), location.name.span);
        match first.get(name) {
            Some(&first) => diagnostics.push(diagnostic(name, first, span)),
            None => {
                first.insert(name, span);
            }
        }
    }
}

fn diagnostic(name: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("two locations are called `{name}`"))
        .label(first, "the first")
        .help("rename one of them, and the destinations that mean it")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn locations_have_names_of_their_own() {
        check(
            "state x
             location A
               der x = 1
               transition t when x > 1 goto A
                 reset x = 0
             location A
               der x = 2",
            "error[HS0112] line 6 `A`: two locations are called `A`
               line 2 `A`: the first
               help: rename one of them, and the destinations that mean it",
        );
    }
}
