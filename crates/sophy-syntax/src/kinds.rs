use logos::{Lexer, Logos};

/// Kinds of tokens and of nodes.
///
/// The patterns include spellings that are understood but not accepted (`×` for `*`, `=<` for `<=`): the lexer
/// reports them, the grammar goes on as if they were right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Logos)]
#[repr(u16)]
#[allow(missing_docs)] // the names say it
pub enum SyntaxKind {
    // Tokens without meaning.
    #[regex(r"[ \t\r\n\f]+")]
    Whitespace,
    #[regex(r"%[^\n]*", allow_greedy = true)]
    Comment,
    /// A character of no token, or a `)` that closes nothing.
    Unknown,
    // Operands.
    #[regex(r"[0-9]", number)]
    #[regex(r"\.[0-9]", number)]
    Number,
    /// XID identifiers; the middle dots, which Unicode counts as letters, are misspelt `*`.
    #[regex(r"[\p{XID_Start}_][\p{XID_Continue}--\u{b7}\u{387}]*")]
    Name,
    #[regex(r"'[^'\n]*'?")]
    #[regex(r"[‘’][^'‘’\n]*['‘’]?")]
    QuotedName,
    #[regex("\"[^\"\n]*\"?")]
    #[regex("[“”„][^\"“”\n]*[\"“”]?")]
    String,
    #[token("true")]
    True,
    #[token("false")]
    False,
    // Operators.
    #[token("+")]
    Plus,
    #[token("-")]
    #[regex("[−–—‐‑]")]
    Minus,
    #[token("*")]
    #[regex(r"[×⋅∙∗\u{b7}\u{387}]")]
    Star,
    #[token("/")]
    #[regex("[÷∕]")]
    Slash,
    #[token("^")]
    #[token("**")]
    Caret,
    #[token("<")]
    Less,
    #[token("<=")]
    #[token("=<")]
    #[regex("[≤⩽]")]
    LessEqual,
    #[token(">")]
    Greater,
    #[token(">=")]
    #[token("=>")]
    #[regex("[≥⩾]")]
    GreaterEqual,
    #[token("=")]
    #[token("==")]
    Equal,
    #[token("<>")]
    #[token("!=")]
    #[token("~=")]
    #[token("≠")]
    NotEqual,
    #[token("not")]
    #[token("!")]
    #[token("~")]
    #[token("¬")]
    Not,
    #[token("and")]
    #[token("&&")]
    #[token("&")]
    #[token("∧")]
    And,
    #[token("or")]
    #[token("||")]
    #[token("|")]
    #[token("∨")]
    Or,
    #[token("if")]
    If,
    #[token("then")]
    Then,
    #[token("else")]
    Else,
    #[token("(")]
    #[token("\u{ff08}")]
    LeftParenthesis,
    #[token(")")]
    #[token("\u{ff09}")]
    RightParenthesis,
    #[token(",")]
    #[token("\u{ff0c}")]
    Comma,
    /// Past the last token; never in a tree.
    End,
    // Nodes.
    Root,
    Literal,
    Reference,
    Call,
    Arguments,
    Parentheses,
    Prefix,
    Power,
    /// Operands of operators of one precedence, flat, so that a long sum is not a deep tree.
    Chain,
    Comparison,
    Conditional,
    /// What did not fit.
    Error,
}

const ALL: [SyntaxKind; 42] = {
    use SyntaxKind::*;
    [
        Whitespace,
        Comment,
        Unknown,
        Number,
        Name,
        QuotedName,
        String,
        True,
        False,
        Plus,
        Minus,
        Star,
        Slash,
        Caret,
        Less,
        LessEqual,
        Greater,
        GreaterEqual,
        Equal,
        NotEqual,
        Not,
        And,
        Or,
        If,
        Then,
        Else,
        LeftParenthesis,
        RightParenthesis,
        Comma,
        End,
        Root,
        Literal,
        Reference,
        Call,
        Arguments,
        Parentheses,
        Prefix,
        Power,
        Chain,
        Comparison,
        Conditional,
        Error,
    ]
};

/// Takes the rest of a number: `12`, `1.5`, `1e-3`, and the mistakes `5.`, `.5`, `1e`. `1..5` is `1 .. 5`.
fn number(lexer: &mut Lexer<'_, SyntaxKind>) {
    let rest = lexer.remainder().as_bytes();
    let digits = |from: usize| rest[from..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let mut length = digits(0);
    let fraction_follows = rest.get(length) == Some(&b'.') && rest.get(length + 1) != Some(&b'.');
    if !lexer.slice().starts_with('.') && fraction_follows {
        length += 1 + digits(length + 1);
    }
    if matches!(rest.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(rest.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits(length + 1 + sign);
        let word_goes_on =
            lexer.remainder()[length + 1..].starts_with(|c: char| c.is_alphabetic() || c == '_');
        if exponent > 0 || !word_goes_on {
            length += 1 + sign + exponent;
        }
    }
    lexer.bump(length);
}

impl SyntaxKind {
    /// White space, comments and what the lexer could not read: the grammar does not see them.
    pub fn is_trivia(self) -> bool {
        matches!(self, SyntaxKind::Whitespace | SyntaxKind::Comment | SyntaxKind::Unknown)
    }
}

/// The language, for `rowan`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sophy {}

impl rowan::Language for Sophy {
    type Kind = SyntaxKind;

    fn kind_from_raw(raw: rowan::SyntaxKind) -> SyntaxKind {
        ALL.get(usize::from(raw.0)).copied().unwrap_or(SyntaxKind::Error)
    }

    fn kind_to_raw(kind: SyntaxKind) -> rowan::SyntaxKind {
        rowan::SyntaxKind(kind as u16)
    }
}

/// A node of the tree.
pub type SyntaxNode = rowan::SyntaxNode<Sophy>;
/// A token of the tree.
pub type SyntaxToken = rowan::SyntaxToken<Sophy>;
/// A node or a token.
pub type SyntaxElement = rowan::SyntaxElement<Sophy>;

#[cfg(test)]
mod tests {
    use super::*;
    use rowan::Language;

    #[test]
    fn every_kind_survives_the_way_through_rowan() {
        for kind in ALL {
            assert_eq!(Sophy::kind_from_raw(Sophy::kind_to_raw(kind)), kind);
        }
        assert_eq!(ALL.len(), SyntaxKind::Error as usize + 1);
    }
}
