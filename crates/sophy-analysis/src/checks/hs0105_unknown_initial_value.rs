//! An initial value is given to something that is not a state: a run would start elsewhere than was meant.

use super::suggestion::suggest;
use crate::declarations::Spanned;
use crate::lower::{SymbolKind, Symbols};
use sophy_diagnostics::{Code, Diagnostic};

pub(crate) const CODE: Code = Code("HS0105");

pub(crate) fn diagnostic(target: &Spanned<String>, symbols: &Symbols<'_>) -> Diagnostic {
    let name = &target.value;
    if let Some(symbol) = symbols.get(name) {
        let what = symbol.kind.with_article();
        let message = format!("`{name}` is {what}, and only states have initial values");
        return Diagnostic::error(CODE, target.span, message)
            .label(symbol.span, "declared here")
            .help("delete the initial value");
    }
    let names = symbols.names();
    let states: Vec<&str> =
        names.iter().filter(|(_, s)| s.kind == SymbolKind::State).map(|(name, _)| *name).collect();
    let message = format!("`{name}` has an initial value, but is not declared as a state");
    Diagnostic::error(CODE, target.span, message).help(suggest(name, &states, "states").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn only_states_start_somewhere() {
        check(
            "state Position
             input u
             initial Positon = 1
             initial u = 1
             location A
               der Position = u",
            "error[HS0105] line 3 `Positon`: `Positon` has an initial value, but is not declared as a state
               help: did you mean `Position`?
             error[HS0105] line 4 `u`: `u` is an input, and only states have initial values
               line 2 `u`: declared here
               help: delete the initial value",
        );
    }
}
