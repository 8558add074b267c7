use logos::{Lexer, Logos};

macro_rules! kinds {
    ($($(#[$attribute:meta])* $name:ident,)*) => {
        /// Kinds of tokens and of nodes.
        ///
        /// The patterns include spellings that are understood but not accepted (`×` for `*`, `=<` for `<=`): the
        /// lexer reports them, the grammar goes on as if they were right.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Logos)]
        #[repr(u16)]
        #[allow(missing_docs)] // the names say it
        pub enum SyntaxKind {
            $($(#[$attribute])* $name,)*
        }

        const ALL: &[SyntaxKind] = &[$(SyntaxKind::$name,)*];
    };
}

kinds! {
    // Tokens without meaning.
    #[regex(r"[ \t\r\n\f\u{feff}]+")]
    Whitespace,
    #[regex(r"%[^\n]*", allow_greedy = true)]
    Comment,
    /// `%% …`: a comment on the declaration that follows.
    #[regex(r"%%[^\n]*", allow_greedy = true, priority = 10)]
    DocComment,
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
    #[regex("\"[^\"\n]*\"")]
    #[regex("\"[^\"\n;]*")]
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
    #[token("[")]
    LeftBracket,
    #[token("]")]
    RightBracket,
    #[token("{")]
    LeftBrace,
    #[token("}")]
    RightBrace,
    #[token(";")]
    Semicolon,
    #[token(":")]
    Colon,
    #[token(":=")]
    Assign,
    #[token(".")]
    Dot,
    #[token("..")]
    DotDot,
    #[token("->")]
    Arrow,
    // Words that a file reserves; the lexer makes them of names.
    IsKeyword,
    InterfaceKeyword,
    BodyKeyword,
    DeclarationsKeyword,
    EndKeyword,
    EndifKeyword,
    ElsifKeyword,
    ForKeyword,
    LoopKeyword,
    WhenKeyword,
    DoKeyword,
    GotoKeyword,
    InKeyword,
    InitialKeyword,
    UpdateKeyword,
    DynamicsKeyword,
    ConstraintsKeyword,
    OutputKeyword,
    EventKeyword,
    EventsKeyword,
    RulesKeyword,
    LocationKeyword,
    ComponentsKeyword,
    ConnectionsKeyword,
    AssignmentsKeyword,
    NegativeToPositiveKeyword,
    PositiveToNegativeKeyword,
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
    /// `x[i, j]`.
    Index,
    /// The brackets of an index.
    Indices,
    /// `[1, 2, 3]`.
    Vector,
    /// `sum(i in 1..n where c : e)`.
    Reduction,
    /// `i in 1..n`.
    Binder,
    /// `1..5`.
    Range,
    /// `auv.drag.x`.
    Path,
    /// `"idle"`.
    StringLiteral,
    // Nodes of a file.
    /// `import "x.hsml";`.
    Import,
    /// `constant g = 9.82 "m/s2";`.
    Constant,
    /// `function f(a, b : real[3]) : real = …;`.
    Function,
    FunctionParameters,
    FunctionParameter,
    /// `CTC Name is …`.
    Component,
    Interface,
    /// `input(u, signal, "N");` and the like.
    InterfaceItem,
    Body,
    /// `: real[3]`, or the `real[3]` of an interface item.
    Type,
    /// `[3, 3]` of a type or of an array of components.
    Shape,
    /// `(0, 5)`, `{"high", "low"}`.
    ValueRange,
    /// `"m/s"`.
    Unit,
    /// `declarations … end declarations;`.
    Declarations,
    /// `state x := 1;`.
    Variable,
    /// `:= 1`.
    InitialValue,
    /// `tsample every Ts;`.
    Clock,
    /// `tdelay 2e-4;`.
    ComputationDelay,
    /// `priority 1;`.
    Priority,
    /// `initial … end initial;`, `update … end update;`.
    StatementSection,
    /// `dynamics … end dynamics;`, `constraints …`, `output …`.
    EquationSection,
    /// `event(S) … end event;`.
    EventSection,
    /// `negative-to-positive … end negative-to-positive;`.
    Direction,
    Rules,
    /// `when … do … end when;`.
    Rule,
    /// `delay 0.5`, `latched`, `priority 2`, `from t0`, `every Ts`, `when G`.
    Clause,
    /// `initial location Flight;`.
    InitialLocation,
    Location,
    /// `invariant x < 1;`.
    Invariant,
    Transition,
    /// `when G`, `on E`, `rate r`, `on invariant`, `sync L` of a transition.
    Trigger,
    ComponentsSection,
    /// `name : Type(p : 1)[3];`.
    Instance,
    InstanceArguments,
    /// `p : 1`.
    InstanceArgument,
    ConnectionsSection,
    /// `a.b -> c.d;`.
    Connection,
    /// `a.b[1]`.
    Port,
    /// `compose a, b with [[1]];`.
    Compose,
    AssignmentsSection,
    /// `g : 9.82 "m/s2";`.
    Assignment,
    /// `x := e;`.
    AssignmentStatement,
    /// `emit l;`.
    Emit,
    /// `hold S;`.
    Hold,
    /// `if c then … end if;`.
    IfStatement,
    /// One `if`, `elsif` or `else` part.
    Branch,
    /// `for i in 1..n loop … end loop;`.
    ForLoop,
    /// `l = r;`.
    Equation,
    /// `end dynamics;`.
    BlockEnd,
    /// What did not fit.
    Error,
}

/// The words that a file reserves beside those of expressions.
const KEYWORDS: &[(&str, SyntaxKind)] = &[
    ("is", SyntaxKind::IsKeyword),
    ("interface", SyntaxKind::InterfaceKeyword),
    ("body", SyntaxKind::BodyKeyword),
    ("declarations", SyntaxKind::DeclarationsKeyword),
    ("end", SyntaxKind::EndKeyword),
    ("endif", SyntaxKind::EndifKeyword),
    ("elsif", SyntaxKind::ElsifKeyword),
    ("for", SyntaxKind::ForKeyword),
    ("loop", SyntaxKind::LoopKeyword),
    ("when", SyntaxKind::WhenKeyword),
    ("do", SyntaxKind::DoKeyword),
    ("goto", SyntaxKind::GotoKeyword),
    ("in", SyntaxKind::InKeyword),
    ("initial", SyntaxKind::InitialKeyword),
    ("update", SyntaxKind::UpdateKeyword),
    ("dynamics", SyntaxKind::DynamicsKeyword),
    ("constraints", SyntaxKind::ConstraintsKeyword),
    ("output", SyntaxKind::OutputKeyword),
    ("event", SyntaxKind::EventKeyword),
    ("events", SyntaxKind::EventsKeyword),
    ("rules", SyntaxKind::RulesKeyword),
    ("location", SyntaxKind::LocationKeyword),
    ("components", SyntaxKind::ComponentsKeyword),
    ("connections", SyntaxKind::ConnectionsKeyword),
    ("assignments", SyntaxKind::AssignmentsKeyword),
    ("negative-to-positive", SyntaxKind::NegativeToPositiveKeyword),
    ("positive-to-negative", SyntaxKind::PositiveToNegativeKeyword),
];

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
    /// The kind of a word that a file reserves.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        KEYWORDS.iter().find(|(text, _)| *text == word).map(|&(_, kind)| kind)
    }

    /// The text of a reserved word.
    pub(crate) fn word(self) -> Option<&'static str> {
        KEYWORDS.iter().find(|&&(_, kind)| kind == self).map(|&(text, _)| text)
    }

    /// White space, comments and what the lexer could not read: the grammar does not see them.
    pub fn is_trivia(self) -> bool {
        matches!(
            self,
            SyntaxKind::Whitespace | SyntaxKind::Comment | SyntaxKind::DocComment | SyntaxKind::Unknown
        )
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
        for &kind in ALL {
            assert_eq!(Sophy::kind_from_raw(Sophy::kind_to_raw(kind)), kind);
        }
    }
}
