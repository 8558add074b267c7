use sophy_diagnostics::{Diagnostic, Diagnostics, TextMap};
use sophy_syntax::Parse;

/// The syntax errors of an expression as messages, with places in the file that `map` leads to.
///
/// Whoever reads an expression from a file reports them, once; [`read`](crate::read) does.
pub fn syntax_errors(parse: &Parse, map: &TextMap) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    for error in parse.errors() {
        let mut diagnostic = Diagnostic::error(error.code, map.span(error.range.clone()), &error.message);
        for (range, message) in &error.related {
            diagnostic = diagnostic.label(map.span(range.clone()), message);
        }
        for help in &error.helps {
            diagnostic = diagnostic.help(help);
        }
        diagnostics.push(diagnostic);
    }
    diagnostics
}
