use crate::declarations::{ExpressionText, Spanned};
use crate::hsml::codes::TWICE;
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, SourceId, Span, TextMap, closest};
use sophy_syntax::SyntaxError;
use sophy_syntax::ast::{Expression, Name, View};
use std::ops::Range;
use std::rc::Rc;

/// Makes declarations of views, and complains about what the grammar allows and a declaration has no place for.
pub(super) struct Reader<'d> {
    source: SourceId,
    text: Rc<str>,
    map: TextMap,
    mistakes: Mistakes,
    diagnostics: &'d mut Diagnostics,
}

impl<'d> Reader<'d> {
    pub(super) fn new(
        source: SourceId,
        text: &str,
        errors: &[SyntaxError],
        diagnostics: &'d mut Diagnostics,
    ) -> Self {
        let length = u32::try_from(text.len()).unwrap_or(u32::MAX);
        let map = TextMap::plain(source, 0, length);
        Reader { source, text: Rc::from(text), map, mistakes: Mistakes::new(errors), diagnostics }
    }

    pub(super) fn span(&self, range: Range<usize>) -> Span {
        Span::new(self.source, range)
    }

    /// Where the word stands that a view starts with.
    pub(super) fn keyword(&self, view: &impl View) -> Span {
        self.span(view.keyword_range())
    }

    /// What a view is by its first word, which may be misspelt.
    pub(super) fn meant<T: Copy>(&self, kind: Option<T>, view: &impl View, known: &[(&str, T)]) -> Option<T> {
        kind.or_else(|| {
            let word = self.text.get(view.keyword_range())?;
            let meant = closest(word, known.iter().map(|&(word, _)| word))?;
            known.iter().find(|(word, _)| *word == meant).map(|&(_, kind)| kind)
        })
    }

    /// A name; empty if it is missing in `view`, which the parser has said.
    pub(super) fn name(&self, name: Option<Name>, view: &impl View) -> Spanned<String> {
        match name {
            Some(name) => self.spanned(name),
            None => Spanned::new(String::new(), self.keyword(view)),
        }
    }

    pub(super) fn spanned(&self, name: Name) -> Spanned<String> {
        Spanned::new(name.text, self.span(name.range))
    }

    pub(super) fn expression(&self, expression: Expression) -> ExpressionText {
        let range = expression.range();
        ExpressionText {
            text: self.text.clone(),
            well_formed: !self.mistakes.touch(&range),
            expression: Some(expression),
            map: self.map.clone(),
            span: self.span(range),
        }
    }

    /// An expression that `view` should have; that it is missing has been said.
    pub(super) fn required(&self, expression: Option<Expression>, view: &impl View) -> ExpressionText {
        match expression {
            Some(expression) => self.expression(expression),
            None => ExpressionText {
                text: self.text.clone(),
                expression: None,
                well_formed: false,
                map: self.map.clone(),
                span: self.keyword(view),
            },
        }
    }

    pub(super) fn optional(&self, expression: Option<Expression>) -> Option<ExpressionText> {
        expression.map(|expression| self.expression(expression))
    }

    pub(super) fn expressions(&self, expressions: Vec<Expression>) -> Vec<ExpressionText> {
        expressions.into_iter().map(|expression| self.expression(expression)).collect()
    }

    /// Whether the parser has complained about an expression in `range`.
    pub(super) fn is_damaged(&self, range: &Range<usize>) -> bool {
        self.mistakes.touch(range)
    }

    pub(super) fn complain(
        &mut self,
        code: Code,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        self.diagnostics.push(Diagnostic::error(code, span, message).help(help));
    }

    /// Puts a part into its place; complains if there is one already.
    pub(super) fn once<T>(&mut self, place: &mut Option<T>, part: T, what: &str, span: Span) {
        if place.is_none() {
            *place = Some(part);
        } else {
            self.complain(TWICE, span, format!("{what} stands here a second time"), "delete one of the two");
        }
    }
}

/// Where expressions have mistakes of grammar.
struct Mistakes {
    /// Start, and the last end so far; in the order of starts.
    starts: Vec<(usize, usize)>,
}

impl Mistakes {
    fn new(errors: &[SyntaxError]) -> Self {
        let inside = errors.iter().filter(|error| is_about_expression(error.code));
        let mut starts: Vec<(usize, usize)> =
            inside.map(|error| (error.range.start, error.range.end)).collect();
        starts.sort_unstable();
        let mut last = 0;
        for (_, end) in &mut starts {
            last = last.max(*end);
            *end = last;
        }
        Mistakes { starts }
    }

    /// Whether there is a mistake inside of `range` or at its ends.
    fn touch(&self, range: &Range<usize>) -> bool {
        let before = self.starts.partition_point(|&(start, _)| start <= range.end);
        before
            .checked_sub(1)
            .and_then(|last| self.starts.get(last))
            .is_some_and(|&(_, end)| end >= range.start)
    }
}

/// Whether a mistake makes the structure of an expression doubtful, rather than that of what it stands in.
fn is_about_expression(code: Code) -> bool {
    code.0 <= "HS0014" || code.0 == "HS0022"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mistakes_touch_what_they_stand_in() {
        let mistakes = Mistakes { starts: vec![(2, 4), (3, 9), (20, 20)] };
        let touched = |range: Range<usize>| mistakes.touch(&range);
        assert!(!touched(0..1) && touched(0..2) && touched(5..8) && touched(9..12));
        assert!(!touched(10..19) && touched(10..20) && touched(20..30) && !touched(21..30));
    }
}
