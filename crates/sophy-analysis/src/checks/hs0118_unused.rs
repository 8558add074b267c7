//! A constant or an input is not used in any expression: it is left over, or something that should use it does
//! not.

use crate::analyse::expressions;
use crate::declarations::Declarations;
use crate::lower::names_in;
use crate::names::{Kind, Names};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Span};
use std::collections::HashSet;

pub(crate) const CODE: Code = Code("HS0118");

/// Names in `suggested` were proposed for misspelt ones and count as used.
pub(crate) fn find(
    declarations: &Declarations,
    names: &Names<'_>,
    suggested: &[String],
    diagnostics: &mut Diagnostics,
) {
    let mut used: HashSet<String> = expressions(declarations).flat_map(names_in).collect();
    used.extend(suggested.iter().cloned());
    for (kind, what) in [(Kind::Constant, "constant"), (Kind::Input, "input")] {
        for name in names.of_kind(kind).filter(|name| !used.contains(*name)) {
            if let Some(symbol) = names.symbol(name) {
                diagnostics.push(diagnostic(what, name, symbol.span));
            }
        }
    }
}

fn diagnostic(what: &str, name: &str, span: Span) -> Diagnostic {
    Diagnostic::note_at(CODE, span, format!("{what} `{name}` is not used"))
        .help("delete it, or use it where it was meant")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn what_is_not_used_is_noted() {
        check(
            "constant G = 9.82
             constant H = 2*G
             constant K = H
             input u
             input Pin
             state x
             location A
               der x = Pn",
            "note[HS0118] line 3 `K`: constant `K` is not used
               help: delete it, or use it where it was meant
             note[HS0118] line 4 `u`: input `u` is not used
               help: delete it, or use it where it was meant
             error[HS0101] line 8 `Pn`: `Pn` is not declared
               help: did you mean `Pin`?",
        );
    }
}
