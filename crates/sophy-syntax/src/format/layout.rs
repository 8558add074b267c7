use super::lines::{self, Comment, Piece};
use super::spacing::{break_before, depth_of, space_between};
use crate::kinds::{SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};

/// The tree of `text`, which has no mistakes, laid out.
pub(super) fn laid_out(root: &SyntaxNode, text: &str) -> String {
    let mut layout = Layout { text, ..Layout::default() };
    layout.node(root, 0);
    layout.end();
    layout.out
}

/// How a new line starts.
#[derive(Clone, Copy)]
struct Start {
    level: usize,
    /// The level of comments before it.
    comments: usize,
    /// Whether it ends a block or a part of one.
    ends: bool,
}

#[derive(Default)]
struct Layout<'t> {
    text: &'t str,
    out: String,
    /// The tokens of the item that is being read, and its level.
    pieces: Vec<Piece<'t>>,
    /// The comments inside of it, behind each token that has some.
    inside: Vec<Vec<Comment<'t>>>,
    level: usize,
    /// Comments since the last token.
    comments: Vec<Comment<'t>>,
    newlines: usize,
    before: Option<SyntaxToken>,
    /// The next token starts a line.
    start: Option<Start>,
    /// Level of the line written last.
    written: usize,
}

impl<'t> Layout<'t> {
    /// Lays out `node`, whose first line has `level`.
    fn node(&mut self, node: &SyntaxNode, level: usize) {
        let inner = level + usize::from(indents(node.kind()));
        for child in node.children_with_tokens() {
            match child {
                SyntaxElement::Node(child) if child.kind() == SyntaxKind::BlockEnd => {
                    let comments = if node.kind() == SyntaxKind::IfStatement { level + 1 } else { inner };
                    self.start = Some(Start { level, comments, ends: true });
                    self.node(&child, level);
                }
                SyntaxElement::Node(child) if child.kind() == SyntaxKind::Branch => {
                    let ends = child.first_token().is_some_and(|token| token.kind() != SyntaxKind::If);
                    if ends {
                        self.start = Some(Start { level, comments: level + 1, ends });
                    }
                    self.node(&child, level);
                }
                SyntaxElement::Node(child) => {
                    if is_item(child.kind()) {
                        self.start = Some(Start { level: inner, comments: inner, ends: false });
                    }
                    self.node(&child, inner);
                }
                SyntaxElement::Token(token) => self.token(&token),
            }
        }
    }

    fn token(&mut self, token: &SyntaxToken) {
        match token.kind() {
            SyntaxKind::Whitespace => self.newlines = token.text().matches('\n').count(),
            kind if kind.is_trivia() => {
                let own_line = self.newlines > 0 || (self.before.is_none() && self.comments.is_empty());
                let text = self.text_of(token).trim_end();
                self.comments.push(Comment { text, own_line, after_blank: self.newlines > 1 });
                self.newlines = 0;
            }
            _ => {
                match self.start.take() {
                    Some(start) => self.new_line(start),
                    None => {
                        let comments = std::mem::take(&mut self.comments);
                        if let Some(last) = self.pieces.last_mut()
                            && !comments.is_empty()
                        {
                            last.commented = true;
                            self.inside.push(comments);
                        }
                    }
                }
                self.piece(token);
                self.newlines = 0;
                self.before = Some(token.clone());
            }
        }
    }

    fn piece(&mut self, token: &SyntaxToken) {
        let (mut space, mut break_here) = (false, None);
        if let Some(before) = &self.before
            && !self.pieces.is_empty()
        {
            space = space_between(before, token);
            let depth = token.parent().map_or(0, |parent| depth_of(&parent));
            break_here = break_before(before, token, depth);
        }
        self.pieces.push(Piece {
            text: self.text_of(token),
            space,
            depth: break_here.map(|(depth, _)| u16::try_from(depth).unwrap_or(u16::MAX)),
            all: break_here.is_some_and(|(_, all)| all),
            commented: false,
        });
    }

    /// Writes the item that ends here and the comments after it.
    fn new_line(&mut self, start: Start) {
        let mut comments = std::mem::take(&mut self.comments).into_iter().peekable();
        self.item();
        if let Some(trailing) = comments.next_if(|comment| !comment.own_line) {
            self.out.push_str("  ");
            self.out.push_str(trailing.text);
        }
        for comment in comments {
            self.break_line(comment.after_blank && self.written >= start.comments);
            lines::spaces(&mut self.out, 2 * start.comments);
            self.out.push_str(comment.text);
            self.written = start.comments;
        }
        self.break_line(self.newlines > 1 && self.written >= start.level && !start.ends);
        self.level = start.level;
    }

    fn item(&mut self) {
        if !self.pieces.is_empty() {
            lines::write(&mut self.out, &self.pieces, &self.inside, 2 * self.level);
            self.written = self.level;
            self.pieces.clear();
            self.inside.clear();
        }
    }

    fn text_of(&self, token: &SyntaxToken) -> &'t str {
        let range = token.text_range();
        self.text.get(range.start().into()..range.end().into()).unwrap_or("")
    }

    fn break_line(&mut self, blank: bool) {
        if !self.out.is_empty() {
            self.out.push_str(if blank { "\n\n" } else { "\n" });
        }
    }

    /// The last item and the comments after it.
    fn end(&mut self) {
        self.newlines = 0;
        self.new_line(Start { level: 0, comments: 0, ends: false });
    }
}

/// Whether what stands in a node of `kind` is indented.
fn indents(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Interface
            | K::Body
            | K::Declarations
            | K::StatementSection
            | K::EquationSection
            | K::EventSection
            | K::Direction
            | K::Rules
            | K::Rule
            | K::Location
            | K::Transition
            | K::ComponentsSection
            | K::ConnectionsSection
            | K::AssignmentsSection
            | K::Branch
            | K::ForLoop
    )
}

/// Whether a node of `kind` starts on a line of its own.
fn is_item(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Import
            | K::Constant
            | K::Function
            | K::Component
            | K::InterfaceItem
            | K::Variable
            | K::Clock
            | K::ComputationDelay
            | K::Priority
            | K::InitialLocation
            | K::Invariant
            | K::Instance
            | K::Connection
            | K::Compose
            | K::Assignment
            | K::AssignmentStatement
            | K::Emit
            | K::Hold
            | K::IfStatement
            | K::Equation
    ) || (indents(kind) && kind != K::Branch)
}
