//! Two transitions of one location have one name, so that the event log cannot tell which was taken.

use crate::declarations::{ComponentDeclaration, TriggerDeclaration};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use std::collections::HashMap;

pub(crate) const CODE: Code = Code("HS0113");

pub(crate) fn find(declarations: &ComponentDeclaration, diagnostics: &mut Diagnostics) {
    for location in &declarations.locations {
        let mut first: HashMap<&str, (Span, bool)> = HashMap::new();
        for transition in location.transitions.iter().filter(|transition| !transition.name.value.is_empty()) {
            let (name, span) = (transition.name.value.as_str(), transition.name.span);
            // What is taken while a guard holds and what is taken on an event may be two forms of one.
            let guarded = matches!(transition.trigger, TriggerDeclaration::When(_));
            match first.get(name) {
                Some(&(_, other)) if other != guarded => {}
                Some(&(first, _)) => diagnostics.push(diagnostic(name, &location.name.value, first, span)),
                None => {
                    first.insert(name, (span, guarded));
                }
            }
        }
    }
}

fn diagnostic(name: &str, location: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("two transitions of location `{location}` are called `{name}`"))
        .label(first, "the first")
        .help("rename one of them")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn transitions_of_one_location_have_names_of_their_own() {
        check(
            "state x
             location A
               der x = 1
               transition t when x > 1 goto B
               transition t when x < 0 goto B
             location B
               der x = 1
               transition t when x^2 > 2 goto A",
            "error[HS0113] line 5 `t`: two transitions of location `A` are called `t`
               line 4 `t`: the first
               help: rename one of them",
        );
    }
}
