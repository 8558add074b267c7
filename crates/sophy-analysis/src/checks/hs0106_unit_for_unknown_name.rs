//! A unit is given for a name that is not declared, so that what was meant has none in tables and plots.

use super::hs0108_defined_twice;
use super::suggestion::suggest;
use crate::declarations::{ComponentDeclaration, Spanned};
use crate::lower::{SymbolKind, Symbols};
use sophy_diagnostics::{Code, Diagnostic, Span};
use std::collections::HashMap;

pub(crate) const CODE: Code = Code("HS0106");

/// Looks at the names of all units; one that is given twice is reported too.
pub(crate) fn find(declaration: &ComponentDeclaration, symbols: &Symbols<'_>) -> Vec<Diagnostic> {
    let mut first: HashMap<&str, Span> = HashMap::new();
    let mut found = Vec::new();
    for (name, _) in declaration.units.iter().filter(|(name, _)| !name.value.is_empty()) {
        if symbols.get(&name.value).is_none_or(|symbol| symbol.kind == SymbolKind::Function) {
            found.push(diagnostic(name, symbols));
        } else if let Some(&first) = first.get(name.value.as_str()) {
            let what = format!("the unit of `{}`", name.value);
            found.push(hs0108_defined_twice::diagnostic(&what, first, name.span));
        } else {
            first.insert(&name.value, name.span);
        }
    }
    found
}

fn diagnostic(name: &Spanned<String>, symbols: &Symbols<'_>) -> Diagnostic {
    let kinds = [SymbolKind::State, SymbolKind::Input, SymbolKind::Output, SymbolKind::Constant];
    let names = symbols.names();
    let of_kind = |kind| names.iter().filter(move |(_, s)| s.kind == kind).map(|(name, _)| *name);
    let candidates: Vec<&str> = kinds.into_iter().flat_map(of_kind).collect();
    let message = format!("`{}` has a unit, but is not declared", name.value);
    Diagnostic::error(CODE, name.span, message)
        .help(suggest(&name.value, &candidates, "names that exist").help)
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn a_unit_needs_a_quantity_and_a_quantity_one_unit() {
        check(
            "state Speed
             unit Sped = m/s
             unit Speed = m/s
             unit Speed = ft/s
             location A
               der Speed = 1",
            "error[HS0106] line 2 `Sped`: `Sped` has a unit, but is not declared
               help: did you mean `Speed`?
             error[HS0108] line 4 `Speed`: the unit of `Speed` is given twice
               line 3 `Speed`: first here
               help: delete one of the two",
        );
    }
}
