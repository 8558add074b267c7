use crate::kinds::{SyntaxKind, SyntaxNode, SyntaxToken};

/// Whether a space stands between two tokens of a line.
pub(super) fn space_between(before: &SyntaxToken, token: &SyntaxToken) -> bool {
    use SyntaxKind as K;
    let (left, right) = (before.kind(), token.kind());
    let (left_in, right_in) = (parent(before), parent(token));
    match right {
        K::RightParenthesis
        | K::RightBracket
        | K::RightBrace
        | K::Comma
        | K::Semicolon
        | K::Dot
        | K::DotDot => {
            return false;
        }
        K::LeftParenthesis if !matches!(right_in, K::Parentheses | K::ValueRange) => return false,
        K::LeftBracket if right_in != K::Vector => return false,
        K::Star | K::Slash | K::Caret => return false,
        _ => {}
    }
    match left {
        K::LeftParenthesis | K::LeftBracket | K::LeftBrace | K::Dot | K::DotDot => false,
        K::Star | K::Slash | K::Caret => false,
        K::Comma => left_in != K::Shape,
        K::Plus | K::Minus => left_in != K::Prefix,
        K::Not => before.text().starts_with(char::is_alphabetic),
        _ => true,
    }
}

/// Where a long line may go on at a token: the depth of the node it belongs to, and whether all of its kind
/// break together.
pub(super) fn break_before(before: &SyntaxToken, token: &SyntaxToken, depth: usize) -> Option<(usize, bool)> {
    use SyntaxKind as K;
    match token.kind() {
        K::Plus | K::Minus | K::Star | K::Slash | K::And | K::Or if parent(token) == K::Chain => {
            return Some((depth, false));
        }
        K::Then | K::Else if parent(token) == K::Conditional => return Some((depth, false)),
        _ => {}
    }
    if before.kind() != K::Comma {
        return starts_part(token).then_some((0, false));
    }
    let list = before.parent()?;
    let outside = matches!(
        list.kind(),
        K::InterfaceItem
            | K::FunctionParameters
            | K::InstanceArguments
            | K::Variable
            | K::Compose
            | K::Trigger
    );
    let rows = list.kind() == K::Vector && is_matrix(&list);
    let list_depth = if outside { 0 } else { depth_of(&list) };
    Some((list_depth, rows))
}

/// Whether a clause, or a matrix that is all of a value, starts with `token`.
fn starts_part(token: &SyntaxToken) -> bool {
    let Some(node) = token.parent() else { return false };
    match node.kind() {
        SyntaxKind::Clause => node.first_token().as_ref() == Some(token),
        SyntaxKind::Vector => {
            let of_item = node.parent().is_some_and(|parent| depth_of(&parent) == 0);
            of_item && is_matrix(&node) && node.first_token().as_ref() == Some(token)
        }
        _ => false,
    }
}

fn is_matrix(vector: &SyntaxNode) -> bool {
    vector.children().any(|child| child.kind() == SyntaxKind::Vector)
}

/// How many expressions `node` stands in, itself included.
pub(super) fn depth_of(node: &SyntaxNode) -> usize {
    node.ancestors().take_while(|ancestor| is_expression(ancestor.kind())).count()
}

pub(super) fn is_expression(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Literal
            | K::Reference
            | K::Call
            | K::Arguments
            | K::Parentheses
            | K::Prefix
            | K::Power
            | K::Chain
            | K::Comparison
            | K::Conditional
            | K::Index
            | K::Indices
            | K::Vector
            | K::Reduction
            | K::Binder
            | K::Range
            | K::Path
            | K::StringLiteral
    )
}

fn parent(token: &SyntaxToken) -> SyntaxKind {
    token.parent().map_or(SyntaxKind::Root, |node| node.kind())
}
