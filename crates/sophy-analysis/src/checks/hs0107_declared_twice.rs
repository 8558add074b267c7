//! A name is declared twice, so that it is not clear what is meant where it is used. States, inputs, outputs,
//! constants and functions share their names; only an output may have the name of a state, and is that state.

use crate::lower::SymbolKind;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0107");

/// `first` and `again` are what the name was declared as, and where.
pub(crate) fn diagnostic(name: &str, first: (SymbolKind, Span), again: (SymbolKind, Span)) -> Diagnostic {
    let message = if first.0 == again.0 {
        format!("`{name}` is declared twice")
    } else {
        format!("`{name}` is declared twice: as {} and as {}", first.0.with_article(), again.0.with_article())
    };
    Diagnostic::error(CODE, again.1, message)
        .label(first.1, format!("first declared here, as {}", first.0.with_article()))
        .help(format!("delete or rename one `{name}`"))
}

/// Two parameters of a function have one name.
pub(crate) fn parameter(name: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("two parameters are called `{name}`"))
        .label(first, "the first")
        .help("rename one of them")
}

/// Two components have one name.
pub(crate) fn component(name: &str, first: Span, again: Span) -> Diagnostic {
    Diagnostic::error(CODE, again, format!("two components are called `{name}`"))
        .label(first, "the first")
        .help("rename one of them")
}

#[cfg(test)]
mod tests {
    use crate::testing::{check, check_model};

    #[test]
    fn all_kinds_share_their_names() {
        check(
            "constant a = 1
             state a
             state b
             state b
             output c
             output c
             function b(x, x) = x
             location A
               der b = a
               out c = b",
            "error[HS0107] line 2 `a`: `a` is declared twice: as a constant and as a state
               line 1 `a`: first declared here, as a constant
               help: delete or rename one `a`
             error[HS0107] line 4 `b`: `b` is declared twice
               line 3 `b`: first declared here, as a state
               help: delete or rename one `b`
             error[HS0107] line 6 `c`: `c` is declared twice
               line 5 `c`: first declared here, as an output
               help: delete or rename one `c`
             error[HS0107] line 7 `b`: `b` is declared twice: as a state and as a function
               line 3 `b`: first declared here, as a state
               help: delete or rename one `b`
             error[HS0107] line 7 `x`: two parameters are called `x`
               line 7 `x`: the first
               help: rename one of them",
        );
    }

    #[test]
    fn an_output_may_be_a_state() {
        let model = check_model("state x\noutput x\nlocation A\n der x = 1\n out x = x", "");
        assert_eq!(model.root().variables.len(), 2);
        let map = &crate::testing::automaton(&model).locations[0].values[0];
        assert_eq!(
            model.root().graph.node(map.right),
            sophy_ir::Node::Leaf(sophy_ir::Leaf::Variable(sophy_ir::VariableId(0)))
        );
    }
}
