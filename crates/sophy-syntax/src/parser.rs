use crate::brackets::match_brackets;
use crate::error::{Errors, SyntaxError, codes};
use crate::grammar::blocks::Block;
use crate::kinds::{Sophy, SyntaxKind};
use crate::lexer::{Mode, Token, lex};
use crate::parse::Parse;
use rowan::{Checkpoint, GreenNodeBuilder, Language};
use sophy_diagnostics::closest;
use std::ops::Range;

/// How deep expressions may be nested; keeps every later walk over the tree off the end of the stack.
const DEEPEST: usize = 128;
/// How many tokens ahead a missing word is looked for.
const FAR: usize = 1000;

/// Drives the grammar over the tokens and builds the tree.
///
/// Brackets are matched before the grammar runs: a `)` that closes nothing has become trivia, and a `(` that
/// is never closed has been reported, so the grammar is silent about both.
///
/// In a file, an expression cannot reach beyond the end of its statement: [`Parser::fenced`] lets the grammar of
/// expressions see [`SyntaxKind::End`] there.
pub(crate) struct Parser<'t> {
    text: &'t str,
    mode: Mode,
    tokens: Vec<Token>,
    /// The tokens that end a statement, in order.
    statement_ends: Vec<usize>,
    /// The grammar does not see this token and those after it.
    fence: usize,
    /// The first token not yet in the tree; trivia before [`Parser::current`] stay behind it.
    position: usize,
    builder: GreenNodeBuilder<'static>,
    errors: Errors,
    /// Where the lexer and the matching of brackets found mistakes, in order.
    lexical: Vec<usize>,
    /// The start of the item being read, and how many mistakes were known then.
    item: (usize, usize),
    /// Names that end an expression, because a clause starts with them.
    stops: &'static [&'static str],
    depth: usize,
    muted: bool,
    /// The blocks of a file that are open.
    pub(crate) blocks: Vec<Block<'t>>,
    /// How many blocks stay open once those that lack an `end` are left.
    pub(crate) unwinding: Option<usize>,
}

impl<'t> Parser<'t> {
    pub(crate) fn new(text: &'t str, mode: Mode) -> Self {
        let (mut tokens, mut errors) = lex(text, mode);
        tokens.shrink_to_fit();
        let statement_ends = match_brackets(text, mode, &mut tokens, &mut errors);
        let mut lexical: Vec<usize> = errors.iter().map(|error| error.range.start).collect();
        lexical.sort_unstable();
        Parser {
            text,
            mode,
            fence: tokens.len(),
            tokens,
            statement_ends,
            position: 0,
            builder: GreenNodeBuilder::new(),
            errors,
            lexical,
            item: (0, 0),
            stops: &[],
            depth: 0,
            muted: false,
            blocks: Vec::new(),
            unwinding: None,
        }
    }

    pub(crate) fn finish(self) -> Parse {
        Parse::new(self.builder.finish(), self.errors.sorted())
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
            Some(token) => token.range(),
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
        while self.position < self.fence {
            self.take();
        }
    }

    /// Runs `grammar`, to which the text ends where the statement does.
    pub(crate) fn fenced(&mut self, grammar: impl FnOnce(&mut Self)) {
        let here = self.significant(self.position);
        let end = self.statement_end(here).unwrap_or(self.fence);
        let (fence, muted) = (self.fence, self.muted);
        self.fence = end.min(fence);
        grammar(self);
        self.muted = muted;
        self.fence = fence;
    }

    /// Like [`Parser::fenced`], for an expression after which a clause may start with one of `stops`.
    pub(crate) fn fenced_before(&mut self, stops: &'static [&'static str], grammar: impl FnOnce(&mut Self)) {
        let before = std::mem::replace(&mut self.stops, stops);
        self.fenced(grammar);
        self.stops = before;
    }

    /// An expression inside of another, which one of `stops` ends.
    pub(crate) fn stopped_by(&mut self, stops: &'static [&'static str], grammar: impl FnOnce(&mut Self)) {
        let before = std::mem::replace(&mut self.stops, stops);
        grammar(self);
        self.stops = before;
    }

    /// Whether an operand that stands here after another one begins something new rather than lacks an operator.
    pub(crate) fn begins_anew(&self) -> bool {
        if self.mode == Mode::Expression {
            return false;
        }
        match self.current() {
            SyntaxKind::String => true,
            SyntaxKind::LeftBracket => false,
            SyntaxKind::Name if self.is_stop(self.word()) => true,
            SyntaxKind::Name if matches!(self.next(), SyntaxKind::Colon | SyntaxKind::Assign) => true,
            _ => self.on_new_line(),
        }
    }

    /// Whether the text is an expression and nothing else: then no word is taken for a misspelt keyword.
    pub(crate) fn is_expression_alone(&self) -> bool {
        self.mode == Mode::Expression
    }

    /// Whether `word` ends the expression, be it misspelt.
    fn is_stop(&self, word: &str) -> bool {
        self.stops.contains(&word) || (word.len() > 2 && closest(word, self.stops.iter().copied()).is_some())
    }

    /// Whether the current token is the first of its line.
    pub(crate) fn on_new_line(&self) -> bool {
        let here = self.significant(self.position).min(self.tokens.len());
        self.tokens[..here]
            .iter()
            .rev()
            .take_while(|token| token.kind.is_trivia())
            .any(|token| self.text_of(token.range()).contains('\n'))
    }

    /// Whether a line ends between the current token and the next.
    pub(crate) fn breaks_line_after(&self) -> bool {
        let here = self.significant(self.position) + 1;
        let next = self.significant(here);
        self.tokens
            .get(here..next)
            .is_some_and(|trivia| trivia.iter().any(|t| self.text_of(t.range()).contains('\n')))
    }

    /// The text of the current token.
    pub(crate) fn word(&self) -> &'t str {
        self.text_of(self.range())
    }

    /// The text of the significant token after the current one.
    pub(crate) fn word_behind(&self) -> &'t str {
        let behind = self.significant(self.significant(self.position) + 1);
        self.tokens.get(behind).map_or("", |token| self.text_of(token.range()))
    }

    /// The kind of the second significant token after the current one.
    pub(crate) fn after_next(&self) -> SyntaxKind {
        let next = self.significant(self.significant(self.position) + 1);
        self.kind_at(self.significant(next + 1))
    }

    /// Whether the current token is the name `word`; only its place makes it a keyword.
    pub(crate) fn at_word(&self, word: &str) -> bool {
        self.current() == SyntaxKind::Name && self.word() == word
    }

    /// The kind and text of the token that stands `ahead` significant tokens further on.
    pub(crate) fn ahead(&self, ahead: usize) -> (SyntaxKind, &'t str) {
        let mut index = self.significant(self.position);
        for _ in 0..ahead {
            index = self.significant(index + 1);
        }
        let text = self.tokens.get(index).map_or("", |token| self.text_of(token.range()));
        (self.kind_at(index), text)
    }

    /// The kind of the token after the brackets that open after the current token.
    pub(crate) fn after_brackets(&self) -> SyntaxKind {
        use SyntaxKind as K;
        let mut depth = 0;
        let mut index = self.significant(self.significant(self.position) + 1);
        loop {
            match self.kind_at(index) {
                K::LeftParenthesis | K::LeftBracket | K::LeftBrace => depth += 1,
                K::RightParenthesis | K::RightBracket | K::RightBrace => depth -= 1,
                K::End => return K::End,
                _ => {}
            }
            index = self.significant(index + 1);
            if depth == 0 {
                return self.kind_at(index);
            }
        }
    }

    /// The first `=` between the token `start` and the current one that is in no brackets, nor between `if` and
    /// `then`.
    pub(crate) fn open_equality(&self, start: usize) -> Option<Range<usize>> {
        use SyntaxKind as K;
        let mut depth = 0;
        let tokens = self.tokens.get(start..self.significant(self.position)).unwrap_or(&[]);
        let found = tokens.iter().find(|token| {
            match token.kind {
                K::LeftParenthesis | K::LeftBracket | K::LeftBrace | K::If => depth += 1,
                K::RightParenthesis | K::RightBracket | K::RightBrace | K::Then => depth -= 1,
                _ => {}
            }
            depth == 0 && token.kind == K::Equal
        });
        found.map(Token::range)
    }

    /// Whether a token of `kind` comes before the statement ends, or ends it; in a long one not far from here.
    pub(crate) fn comes(&self, kind: SyntaxKind) -> bool {
        let here = self.significant(self.position);
        let end = self.statement_end(here).unwrap_or(here).min(here + FAR);
        self.tokens.get(here..=end).is_some_and(|tokens| tokens.iter().any(|token| token.kind == kind))
    }

    /// How far the grammar has come.
    pub(crate) fn position(&self) -> usize {
        self.significant(self.position)
    }

    /// The end of what was read.
    pub(crate) fn end_of_previous(&self) -> usize {
        self.previous().map_or(0, |token| token.range().end)
    }

    /// Begins an item, in which [`Parser::error`] reports one mistake.
    pub(crate) fn begin_item(&mut self) {
        self.item = (self.range().start, self.errors.len());
    }

    /// Reports a mistake; in a file only if none of the same item is known: the first is the cause of the others.
    pub(crate) fn error(&mut self, error: SyntaxError) {
        if !self.muted && (self.mode == Mode::Expression || !self.item_has_errors()) {
            self.errors.push(error);
        }
    }

    /// Reports a mistake that is none of the current item.
    pub(crate) fn error_outside(&mut self, error: SyntaxError) {
        if !self.muted {
            self.errors.push(error);
        }
    }

    fn item_has_errors(&self) -> bool {
        let (start, known) = self.item;
        let here = self.significant(self.position);
        let statement_end = self.statement_end(here).and_then(|end| self.tokens.get(end));
        let end = statement_end.map_or(self.text.len(), |token| token.range().end);
        let at = self.lexical.partition_point(|&place| place < start);
        self.errors.len() != known || self.lexical.get(at).is_some_and(|&place| place < end)
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

    /// Reads an expression one level deeper; too deep, it takes the rest of the text as it is instead.
    pub(crate) fn nested(&mut self, grammar: impl FnOnce(&mut Self)) {
        let help = "split it: define a part of it as an output or a function, and use its name here";
        self.deeper("the expression is", help, grammar);
    }

    /// Reads a statement one level deeper.
    pub(crate) fn nested_statement(&mut self, grammar: impl FnOnce(&mut Self)) {
        self.deeper("the statements are", "split them, or use `elsif`", grammar);
    }

    fn deeper(&mut self, what: &str, help: &str, grammar: impl FnOnce(&mut Self)) {
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
                format!("{what} nested more than {DEEPEST} levels deep"),
            )
            .help(help),
        );
        self.start(SyntaxKind::Error);
        self.take_rest();
        self.finish_node();
        self.muted = true;
    }

    /// The first token from `here` on that ends a statement, or the end of the text.
    fn statement_end(&self, here: usize) -> Option<usize> {
        let next = self.statement_ends.partition_point(|&end| end < here);
        let end = self.statement_ends.get(next).copied().unwrap_or(self.tokens.len());
        (here < self.tokens.len()).then_some(end)
    }

    fn kind_at(&self, index: usize) -> SyntaxKind {
        match self.tokens.get(index) {
            Some(token) if index < self.fence => token.kind,
            _ => SyntaxKind::End,
        }
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
            self.builder.token(Sophy::kind_to_raw(token.kind), &self.text[token.range()]);
            self.position += 1;
        }
    }
}
