use crate::error::{SyntaxError, codes};
use crate::kinds::{Sophy, SyntaxKind};
use crate::lexer::{Token, lex};
use crate::parse::Parse;
use rowan::{Checkpoint, GreenNodeBuilder, Language};
use std::ops::Range;

/// How deep expressions may be nested; keeps every later walk over the tree off the end of the stack.
const DEEPEST: usize = 128;

/// Drives the grammar over the tokens and builds the tree.
///
/// Parentheses are matched before the grammar runs: a `)` that closes nothing has become trivia, and a `(` that
/// is never closed has been reported, so the grammar is silent about both.
pub(crate) struct Parser<'t> {
    text: &'t str,
    tokens: Vec<Token>,
    /// The first token not yet in the tree; trivia before [`Parser::current`] stay behind it.
    position: usize,
    builder: GreenNodeBuilder<'static>,
    errors: Vec<SyntaxError>,
    depth: usize,
    muted: bool,
}

impl<'t> Parser<'t> {
    pub(crate) fn new(text: &'t str) -> Self {
        let (mut tokens, mut errors) = lex(text);
        match_parentheses(text, &mut tokens, &mut errors);
        Parser { text, tokens, position: 0, builder: GreenNodeBuilder::new(), errors, depth: 0, muted: false }
    }

    pub(crate) fn finish(mut self) -> Parse {
        self.errors.sort_by_key(|error| (error.range.start, error.range.end));
        Parse::new(self.builder.finish(), self.errors)
    }

    /// The token the grammar is at.
    pub(crate) fn current(&self) -> SyntaxKind {
        self.kind_at(self.significant(self.position))
    }

    /// The token after the one the grammar is at.
    pub(crate) fn next(&self) -> SyntaxKind {
        self.kind_at(self.significant(self.significant(self.position) + 1))
    }

    /// Bytes of the current token; empty at the end.
    pub(crate) fn range(&self) -> Range<usize> {
        match self.tokens.get(self.significant(self.position)) {
            Some(token) => token.range.clone(),
            None => self.text.len()..self.text.len(),
        }
    }

    /// The significant token before the current one.
    pub(crate) fn previous(&self) -> Option<Token> {
        self.tokens[..self.position.min(self.tokens.len())]
            .iter()
            .rev()
            .find(|token| !token.kind.is_trivia())
            .cloned()
    }

    pub(crate) fn text_of(&self, range: Range<usize>) -> &'t str {
        self.text.get(range).unwrap_or("")
    }

    /// Whether something already reported stands just before the current token, or at it.
    pub(crate) fn after_reported(&self) -> bool {
        let here = self.significant(self.position).min(self.tokens.len());
        self.tokens[..here]
            .iter()
            .rev()
            .take_while(|token| token.kind.is_trivia())
            .any(|token| token.kind == SyntaxKind::Unknown)
    }

    /// Takes the current token into the tree.
    pub(crate) fn bump(&mut self) {
        self.take_trivia();
        self.take();
    }

    /// A place where a node can later be started.
    pub(crate) fn checkpoint(&mut self) -> Checkpoint {
        self.take_trivia();
        self.builder.checkpoint()
    }

    pub(crate) fn start(&mut self, kind: SyntaxKind) {
        if kind != SyntaxKind::Root {
            self.take_trivia();
        }
        self.builder.start_node(Sophy::kind_to_raw(kind));
    }

    pub(crate) fn start_at(&mut self, checkpoint: Checkpoint, kind: SyntaxKind) {
        self.builder.start_node_at(checkpoint, Sophy::kind_to_raw(kind));
    }

    pub(crate) fn finish_node(&mut self) {
        self.builder.finish_node();
    }

    /// Takes everything that is left into the tree.
    pub(crate) fn take_rest(&mut self) {
        while self.position < self.tokens.len() {
            self.take();
        }
    }

    pub(crate) fn error(&mut self, error: SyntaxError) {
        if !self.muted {
            self.errors.push(error);
        }
    }

    /// How many mistakes are known by now.
    pub(crate) fn error_count(&self) -> usize {
        self.errors.len()
    }

    /// Runs `grammar` without reporting: what it reads is known to be wrong.
    pub(crate) fn quietly(&mut self, grammar: impl FnOnce(&mut Self)) {
        let muted = std::mem::replace(&mut self.muted, true);
        grammar(self);
        self.muted = muted;
    }

    /// Runs `grammar` one level deeper; too deep, it takes the rest of the text as it is instead.
    pub(crate) fn nested(&mut self, grammar: impl FnOnce(&mut Self)) {
        if self.depth < DEEPEST {
            self.depth += 1;
            grammar(self);
            self.depth -= 1;
            return;
        }
        let range = self.range();
        self.error(
            SyntaxError::new(
                codes::TOO_DEEP,
                range,
                format!("the expression is nested more than {DEEPEST} levels deep"),
            )
            .help("split it: define a part of it as an output or a function, and use its name here"),
        );
        self.start(SyntaxKind::Error);
        self.take_rest();
        self.finish_node();
        self.muted = true;
    }

    fn kind_at(&self, index: usize) -> SyntaxKind {
        self.tokens.get(index).map_or(SyntaxKind::End, |token| token.kind)
    }

    /// The first token from `index` on that is not trivia.
    fn significant(&self, mut index: usize) -> usize {
        while self.tokens.get(index).is_some_and(|token| token.kind.is_trivia()) {
            index += 1;
        }
        index
    }

    fn take_trivia(&mut self) {
        while self.tokens.get(self.position).is_some_and(|token| token.kind.is_trivia()) {
            self.take();
        }
    }

    fn take(&mut self) {
        if let Some(token) = self.tokens.get(self.position) {
            self.builder.token(Sophy::kind_to_raw(token.kind), &self.text[token.range.clone()]);
            self.position += 1;
        }
    }
}

/// Reports parentheses without partner; a `)` that closes nothing becomes trivia.
fn match_parentheses(text: &str, tokens: &mut [Token], errors: &mut Vec<SyntaxError>) {
    let first = tokens.iter().find(|token| !token.kind.is_trivia()).map(|token| token.range.clone());
    let mut open: Vec<Range<usize>> = Vec::new();
    for token in tokens.iter_mut() {
        match token.kind {
            SyntaxKind::LeftParenthesis => open.push(token.range.clone()),
            SyntaxKind::RightParenthesis if open.pop().is_none() => {
                token.kind = SyntaxKind::Unknown;
                let before = match &first {
                    Some(first) if first.start < token.range.start => {
                        format!(", or add a `(` before `{}`", &text[first.clone()])
                    }
                    _ => String::new(),
                };
                errors.push(
                    SyntaxError::new(codes::UNMATCHED, token.range.clone(), "unmatched `)`")
                        .help(format!("delete it{before}")),
                );
            }
            _ => {}
        }
    }
    let mut unclosed = open.into_iter();
    if let Some(first) = unclosed.next() {
        let mut error = SyntaxError::new(codes::UNCLOSED, first, "`(` is never closed")
            .help("add a `)` where the part ends, or delete the `(`");
        for further in unclosed.take(3) {
            error = error.related(further, "nor is this one");
        }
        errors.push(error);
    }
}
