//! `log` is the natural logarithm, as in most languages. In JEP, which evaluated SOPHY models before, it was the
//! logarithm to base 10: an old model would change its meaning silently.

use super::places::further_places;
use sophy_diagnostics::{Code, Diagnostic, Span};

pub(crate) const CODE: Code = Code("HS0206");

/// One message for all uses.
pub(crate) fn find(uses: &[Span]) -> Option<Diagnostic> {
    (!uses.is_empty()).then(|| diagnostic(uses))
}

fn diagnostic(uses: &[Span]) -> Diagnostic {
    let warning = Diagnostic::warning(CODE, uses[0], "`log` is the natural logarithm");
    further_places(warning, &uses[1..])
        .note("in JEP, the expression parser of earlier SOPHY tools, it was the logarithm to base 10")
        .help("write `ln` or `log10`")
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    #[test]
    fn log_says_its_base() {
        check(
            "state x
             location A
               der x = log(x) + ln(x) + log10(x) + log(2)",
            "warning[HS0206] line 3 `log`: `log` is the natural logarithm
               line 3 `log`: also here
               note: in JEP, the expression parser of earlier SOPHY tools, it was the logarithm to base 10
               help: write `ln` or `log10`",
        );
    }
}
