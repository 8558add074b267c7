//! The expression language: structure, mistakes and their messages, properties.

use proptest::prelude::*;
use sophy_syntax::ast::{ChainOperator, ComparisonOperator, Expression, LiteralValue, Part, PrefixOperator};
use sophy_syntax::parse_expression;

/// The structure as fully parenthesised prefix notation; `?` where something is missing.
fn structure(expression: Option<Expression>) -> String {
    let Some(expression) = expression else { return "?".to_owned() };
    match expression {
        Expression::Literal(literal) => match literal.value() {
            Some(LiteralValue::Number(x)) => x.to_string(),
            Some(LiteralValue::Boolean(b)) => b.to_string(),
            None => "?".to_owned(),
        },
        Expression::Reference(reference) => reference.name().unwrap_or_default(),
        Expression::Call(call) => {
            let arguments: Vec<String> = call.arguments().into_iter().map(|a| structure(Some(a))).collect();
            format!("{}[{}]", call.name().unwrap_or_default(), arguments.join(" "))
        }
        Expression::Parentheses(parentheses) => structure(parentheses.inner()),
        Expression::Prefix(prefix) => {
            let operator = match prefix.operator() {
                Some(PrefixOperator::Plus) => "pos",
                Some(PrefixOperator::Minus) => "neg",
                Some(PrefixOperator::Not) => "not",
                None => "?",
            };
            format!("({operator} {})", structure(prefix.operand()))
        }
        Expression::Power(power) => {
            format!("(^ {} {})", structure(power.base()), structure(power.exponent()))
        }
        Expression::Chain(chain) => chain.steps().into_iter().fold(structure(chain.first()), |left, step| {
            let operator = match step.operator {
                Some(ChainOperator::Add) => "+",
                Some(ChainOperator::Subtract) => "-",
                Some(ChainOperator::Multiply) => "*",
                Some(ChainOperator::Divide) => "/",
                Some(ChainOperator::And) => "and",
                Some(ChainOperator::Or) => "or",
                None => "?",
            };
            format!("({operator} {left} {})", structure(step.operand))
        }),
        Expression::Comparison(comparison) => {
            let operator = match comparison.operator() {
                Some(ComparisonOperator::Less) => "<",
                Some(ComparisonOperator::LessEqual) => "<=",
                Some(ComparisonOperator::Greater) => ">",
                Some(ComparisonOperator::GreaterEqual) => ">=",
                Some(ComparisonOperator::Equal) => "=",
                Some(ComparisonOperator::NotEqual) => "<>",
                None => "?",
            };
            format!("({operator} {} {})", structure(comparison.left()), structure(comparison.right()))
        }
        Expression::Conditional(conditional) => format!(
            "(if {} {} {})",
            structure(conditional.condition()),
            structure(conditional.then_value()),
            structure(conditional.else_value())
        ),
        Expression::StringLiteral(string) => format!("{:?}", string.value().unwrap_or_default()),
        Expression::Vector(vector) => format!("[{}]", structures(vector.elements())),
        Expression::Index(index) => format!("(at {}{})", structure(index.base()), selected(index.parts())),
        Expression::Path(path) => format!("(path {}{})", structure(path.base()), selected(path.parts())),
        Expression::Reduction(reduction) => {
            let binders: String = reduction
                .binders()
                .into_iter()
                .map(|b| format!(" ({} {} {})", b.name, structure(b.from), structure(b.to)))
                .collect();
            let condition = reduction.condition().map(|c| format!(" where {}", structure(Some(c))));
            let name = reduction.name().unwrap_or_default();
            format!("({name}{binders}{} : {})", condition.unwrap_or_default(), structure(reduction.body()))
        }
    }
}

fn structures(expressions: Vec<Expression>) -> String {
    let all: Vec<String> = expressions.into_iter().map(|e| structure(Some(e))).collect();
    all.join(" ")
}

fn selected(parts: Vec<Part>) -> String {
    let part = |part| match part {
        Part::Member(name, _) => format!(" .{name}"),
        Part::Indices(indices, _) => format!(" [{}]", structures(indices)),
    };
    parts.into_iter().map(part).collect()
}

fn check(text: &str, expected: &str) {
    let parse = parse_expression(text);
    assert_eq!(parse.syntax().to_string(), text, "the tree keeps every byte");
    assert!(parse.errors().is_empty(), "{text}: {:?}", parse.errors());
    assert_eq!(structure(parse.expression()), expected, "{text}");
}

/// `expected`: one line for each mistake, `code under: message | help`.
fn check_errors(text: &str, expected_structure: &str, expected: &[&str]) {
    let parse = parse_expression(text);
    assert_eq!(parse.syntax().to_string(), text, "the tree keeps every byte");
    let found: Vec<String> = parse
        .errors()
        .iter()
        .map(|e| {
            let helps: String = e.helps.iter().map(|help| format!(" | {help}")).collect();
            format!("{} {}: {}{helps}", e.code, &text[e.range.clone()], e.message)
        })
        .collect();
    assert_eq!(found, expected, "{text}");
    assert_eq!(structure(parse.expression()), expected_structure, "{text}");
}

#[test]
fn precedence_and_associativity() {
    check("1 + 2*x", "(+ 1 (* 2 x))");
    check("a - b - c", "(- (- a b) c)");
    check("a / b * c", "(* (/ a b) c)");
    check("a * b + c * d - e", "(- (+ (* a b) (* c d)) e)");
    check("-x^2", "(neg (^ x 2))");
    check("(-x)^2", "(^ (neg x) 2)");
    check("2^-x", "(^ 2 (neg x))");
    check("2^-x^2", "(^ 2 (neg (^ x 2)))");
    check("a^b^c", "(^ a (^ b c))");
    check("-a*b", "(* (neg a) b)");
    check("a * -b", "(* a (neg b))");
    check("a - -b", "(- a (neg b))");
    check("--a", "(neg (neg a))");
    check("+a + b", "(+ (pos a) b)");
    check("a + b < c * d", "(< (+ a b) (* c d))");
    check("not a < b", "(not (< a b))");
    check("not a and b", "(and (not a) b)");
    check("! (a) || b && c", "(or (not a) (and b c))");
    check("a or b and c or d", "(or (or a (and b c)) d)");
    check("not not a", "(not (not a))");
    check("if a < b then c + 1 else d + 2", "(if (< a b) (+ c 1) (+ d 2))");
    check("if a then b else if c then d else e", "(if a b (if c d e))");
    check("1 + (if a then b else c)", "(+ 1 (if a b c))");
    check("f(if a then b else c, 2)", "f[(if a b c) 2]");
}

#[test]
fn spellings() {
    check("a == b", "(= a b)");
    check("a = b", "(= a b)");
    check("a != b", "(<> a b)");
    check("a <> b", "(<> a b)");
    check("true and false", "(and true false)");
    check("  x % a comment\n + 1 % another", "(+ x 1)");
    check("'Ground Impact' + 1", "(+ Ground Impact 1)");
    check("τ*Δx_2", "(* τ Δx_2)");
    check("1e-3 + 2.5E+2 + 7e1", "(+ (+ 0.001 250) 70)");
    check("f()", "f[]");
    check("atan2 (y, x)", "atan2[y x]");
    check("iff + orbit + not_a", "(+ (+ iff orbit) not_a)");
}

#[test]
fn a_parenthesis_without_partner_costs_one_message() {
    check_errors(
        "C > HFull)",
        "(> C HFull)",
        &["HS0004 ): unmatched `)` | delete it, or add a `(` before `C`"],
    );
    check_errors(
        "a * b) + c",
        "(+ (* a b) c)",
        &["HS0004 ): unmatched `)` | delete it, or add a `(` before `a`"],
    );
    check_errors(
        "f(a)) < 1",
        "(< f[a] 1)",
        &["HS0004 ): unmatched `)` | delete it, or add a `(` before `f`"],
    );
    check_errors(
        "(a + b",
        "(+ a b)",
        &["HS0005 (: `(` is never closed | add a `)` where the part ends, or delete the `(`"],
    );
    check_errors(
        "sin(x + (y * 2)",
        "sin[(+ x (* y 2))]",
        &["HS0005 (: `(` is never closed | add a `)` where the part ends, or delete the `(`"],
    );
    check_errors(")", "?", &["HS0004 ): unmatched `)` | delete it"]);
}

#[test]
fn something_is_missing() {
    let write = "write a number, a name or an expression there";
    check_errors("", "?", &[&format!("HS0006 : an expression is missing | {write}")]);
    check_errors("  ", "?", &[&format!("HS0006 : an expression is missing | {write}")]);
    check_errors("a +", "(+ a ?)", &[&format!("HS0006 +: `+` has nothing on its right | {write}")]);
    check_errors("* a", "(* ? a)", &[&format!("HS0006 *: `*` has nothing on its left | {write}")]);
    check_errors("a + * b", "(+ a (* ? b))", &[&format!("HS0006 +: `+` has nothing on its right | {write}")]);
    check_errors(
        "(a +) < b",
        "(< (+ a ?) b)",
        &[&format!("HS0006 +: `+` has nothing on its right | {write}")],
    );
    check_errors("()", "?", &[&format!("HS0006 (): an expression is missing here | {write}")]);
    check_errors("max(a, )", "max[a]", &[&format!("HS0006 , ): an expression is missing here | {write}")]);
    check_errors("not", "(not ?)", &[&format!("HS0006 not: `not` has nothing on its right | {write}")]);
    check_errors(
        "a b",
        "(? a b)",
        &["HS0007 b: an operator is missing between `a` and `b` | for a product write `a * b`"],
    );
    check_errors(
        "2(x+1) < 3",
        "(< (? 2 (+ x 1)) 3)",
        &["HS0007 (: an operator is missing between `2` and `(` | for a product write `2 * (`"],
    );
    check_errors(
        "when the tank is full",
        "(? (? (? (? when the) tank) is) full)",
        &["HS0007 the: an operator is missing between `when` and `the` | for a product write `when * the`"],
    );
}

#[test]
fn comparisons_do_not_chain() {
    check_errors(
        "0 < x < 1",
        "(< 0 x)",
        &["HS0008 <: comparisons cannot be chained | write `0 < x and x < 1`"],
    );
    check_errors(
        "0 < x + 1 <= y < 1",
        "(< 0 (+ x 1))",
        &["HS0008 <=: comparisons cannot be chained | write `0 < x + 1 and x + 1 <= y and y < 1`"],
    );
}

#[test]
fn conditionals() {
    let write = "write `if condition then value else other`";
    check_errors("if a then b", "(if a b ?)", &[&format!("HS0009 if: this `if` has no `else` | {write}")]);
    check_errors("if a else b", "(if a ? b)", &[&format!("HS0009 if: this `if` has no `then` | {write}")]);
    check_errors("if a", "(if a ? ?)", &[&format!("HS0009 if: this `if` has no `then` | {write}")]);
    check_errors(
        "1 + if a then b else c",
        "(+ 1 (if a b c))",
        &["HS0010 if: `if` needs parentheses here | put it in parentheses: `(if …)`"],
    );
    check_errors(
        "a = not b",
        "(= a (not b))",
        &["HS0010 not: `not` needs parentheses here | put it in parentheses: `(not …)`"],
    );
    check_errors("a then b", "a", &["HS0012 then: `then` is not expected here"]);
}

#[test]
fn numbers() {
    check_errors("5.", "5", &["HS0002 5.: a number needs a digit after the point | write `5.0`"]);
    check_errors(".5*x", "(* 0.5 x)", &["HS0002 .5: a number needs a digit before the point | write `0.5`"]);
    check_errors("5.e3", "5000", &["HS0002 5.e3: a number needs a digit after the point | write `5.0e3`"]);
    check_errors(
        "1e + x",
        "(+ ? x)",
        &["HS0002 1e: the exponent of `1e` has no digits | write for example `1e-3`"],
    );
    check_errors(
        "1e999",
        "inf",
        &["HS0002 1e999: `1e999` is too large for a number | the largest is about 1.8e308"],
    );
    check_errors("1,5", "1", &["HS0012 ,: `,` is not expected here | a decimal number has a point: `1.…`"]);
    check_errors(
        "(1, x) + 2",
        "(+ 1 2)",
        &["HS0012 ,: `,` is not expected here | a comma stands only between the arguments of a function"],
    );
}

#[test]
fn typographic_characters_say_what_to_type() {
    check_errors("a × b", "(* a b)", &["HS0001 ×: `×` is a typographic character | type `*`"]);
    check_errors("a·b", "(* a b)", &["HS0001 ·: `·` is a typographic character | type `*`"]);
    check_errors("a − b", "(- a b)", &["HS0001 −: `−` is a typographic character | type `-`"]);
    check_errors("a ≤ b", "(<= a b)", &["HS0001 ≤: `≤` is a typographic character | type `<=`"]);
    check_errors("a ≠ b", "(<> a b)", &["HS0001 ≠: `≠` is a typographic character | type `<>` or `!=`"]);
    check_errors(
        "‘Ground Impact’",
        "Ground Impact",
        &["HS0001 ‘Ground Impact’: typographic quotes do not quote a name | type `'Ground Impact'`"],
    );
    check_errors("x² + 1", "(+ x 1)", &["HS0001 ²: `²` is not a character of an expression | type `^2`"]);
    check_errors("a\u{a0}+ b", "(+ a b)", &["HS0001 \u{a0}: this is a no-break space | type a plain space"]);
    check_errors(
        "a + “b”",
        "(+ a \"b\")",
        &[
            "HS0014 “b”: a string cannot be part of this expression | a name that is not an identifier stands \
           in single quotes: `'Ground Impact'`",
        ],
    );
    check_errors(
        "\u{ff08}a + b\u{ff09}",
        "(+ a b)",
        &[
            "HS0001 \u{ff08}: `\u{ff08}` is a typographic character | type `(`",
            "HS0001 \u{ff09}: `\u{ff09}` is a typographic character | type `)`",
        ],
    );
}

#[test]
fn misspelt_operators() {
    check_errors("a =< b", "(<= a b)", &["HS0013 =<: `=<` is not an operator | type `<=`"]);
    check_errors("a & b", "(and a b)", &["HS0013 &: `&` is not an operator | type `and` or `&&`"]);
    check_errors("a ** 2", "(^ a 2)", &["HS0013 **: `**` is not an operator | type `^`"]);
    check_errors(
        "a $$ b",
        "(? a b)",
        &["HS0001 $$: `$$` are not characters of an expression | delete it, or put a name that needs it in \
           single quotes: `'Ground Impact'`"],
    );
    check_errors(
        "'Ground Impact",
        "Ground Impact",
        &["HS0003 'Ground Impact: the quote that starts here is never closed | a quoted name ends with `'` \
           on the same line"],
    );
    check_errors("''", "", &["HS0003 '': there is no name between the quotes"]);
}

#[test]
fn vectors_and_what_is_selected_of_them() {
    check("[1, x + 2, -3]", "[1 (+ x 2) (neg 3)]");
    check("[[1, 2], [3, 4]]", "[[1 2] [3 4]]");
    check("2*x[i + 1]^2", "(* 2 (^ (at x [(+ i 1)]) 2))");
    check("J[i, 3] - J[1][2]", "(- (at J [i 3]) (at J [1] [2]))");
    check("(A*B)[1] + f(x)[2] + [1, 2][k]", "(+ (+ (at (* A B) [1]) (at f[x] [2])) (at [1 2] [k]))");
    check("auv.drag.x[3] + 1", "(+ (path auv .drag .x [3]) 1)");
    check("cell[2].out < 1", "(< (path cell [2] .out) 1)");
}

#[test]
fn reductions() {
    check("sum(i in 1..3 : x[i])", "(sum (i 1 3) : (at x [i]))");
    check(
        "min(j in 1..5 where j <> id : norm(p[j] - p[id])) < 2",
        "(< (min (j 1 5) where (<> j id) : norm[(- (at p [j]) (at p [id]))]) 2)",
    );
    check("sum(i in 1..n, j in i + 1..m : a[i, j]*2)", "(sum (i 1 n) (j (+ i 1) m) : (* (at a [i j]) 2))");
    check("all(i in 1..3 : x[i] > 0 and a)", "(all (i 1 3) : (and (> (at x [i]) 0) a))");
    check("sum(x)", "sum[x]");
}

#[test]
fn mistakes_in_brackets_and_reductions_cost_one_message() {
    let write = "write a number, a name or an expression there";
    check_errors("x[]", "(at x [])", &[&format!("HS0006 []: an expression is missing here | {write}")]);
    check_errors("[1, , 2]", "[1 2]", &[&format!("HS0006 , ,: an expression is missing here | {write}")]);
    check_errors(
        "2 [1, 2]",
        "(? 2 [1 2])",
        &["HS0007 [: an operator is missing between `2` and `[` | for a product write `2 * [`"],
    );
    check_errors(
        "x[1",
        "(at x [1])",
        &["HS0005 [: `[` is never closed | add a `]` where the part ends, or delete the `[`"],
    );
    check_errors("a. + 1", "(+ (path a) 1)", &[&format!("HS0006 .: `.` has nothing on its right | {write}")]);
    check_errors(
        "sum(i in 1 : x[i])",
        "(sum (i 1 ?) : (at x [i]))",
        &["HS0006 :: `..` is missing before `:` | a range has a first and a last value: `1..3`"],
    );
    check_errors(
        "sum(i in 1..3, x[i]) + 1",
        "(+ (sum (i 1 3) : ?) 1)",
        &["HS0006 x: a loop variable is missing before `x` | write for example `j in 1..3` after the comma"],
    );
    check_errors(
        "sum(i in 1..3 x[i])",
        "(sum (i 1 (? 3 (at x [i]))) : ?)",
        &["HS0007 x: an operator is missing between `3` and `x` | for a product write `3 * x`"],
    );
    check_errors(
        "sum(i in 1..3)",
        "(sum (i 1 3) : ?)",
        &["HS0006 ): `:` is missing before `)` | write the range, a colon and what is to be combined: \
           `sum(i in 1..3 : x[i])`"],
    );
}

#[test]
fn depth_is_bounded_and_length_is_not() {
    for deep in [
        "[".repeat(100_000),
        "x[".repeat(100_000),
        "sum(i in 1..2 : ".repeat(100_000),
        format!("{}x{}", "(".repeat(100_000), ")".repeat(100_000)),
        "-".repeat(100_000),
        "2^".repeat(100_000),
        "not ".repeat(100_000),
        "if a then b else ".repeat(100_000),
        "f(".repeat(100_000),
    ] {
        let parse = parse_expression(&deep);
        assert_eq!(parse.syntax().to_string(), deep);
        let too_deep = parse.errors().iter().filter(|e| e.code.0 == "HS0011").count();
        assert_eq!(too_deep, 1, "{deep:.20}…");
        assert!(parse.errors().len() <= 2, "{:?}", parse.errors());
    }
    let long = format!("x{}", " + x*y".repeat(20_000));
    assert!(
        parse_expression(&format!("x{}{}", ".y".repeat(20_000), "[1]".repeat(20_000))).errors().is_empty()
    );
    assert!(parse_expression(&long).errors().is_empty());
    check(&format!("{}x{}", "(".repeat(100), ")".repeat(100)), "x");
}

/// An expression by its meaning.
#[derive(Clone, Debug)]
enum Tree {
    Number(u32),
    Name(&'static str),
    Call(&'static str, Vec<Tree>),
    Prefix(&'static str, Box<Tree>),
    Binary(&'static str, Box<Tree>, Box<Tree>),
    If(Box<Tree>, Box<Tree>, Box<Tree>),
}

impl Tree {
    fn structure(&self) -> String {
        match self {
            Tree::Number(n) => n.to_string(),
            Tree::Name(name) => (*name).to_owned(),
            Tree::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(Tree::structure).collect();
                format!("{name}[{}]", arguments.join(" "))
            }
            Tree::Prefix("-", a) => format!("(neg {})", a.structure()),
            Tree::Prefix(operator, a) => format!("({operator} {})", a.structure()),
            Tree::Binary(operator, a, b) => format!("({operator} {} {})", a.structure(), b.structure()),
            Tree::If(c, a, b) => format!("(if {} {} {})", c.structure(), a.structure(), b.structure()),
        }
    }

    /// The table of the language reference: how tightly the outermost operator binds.
    fn level(&self) -> u32 {
        match self {
            Tree::If(..) => 0,
            Tree::Binary("or", ..) => 1,
            Tree::Binary("and", ..) => 2,
            Tree::Prefix("not", _) => 3,
            Tree::Binary("<" | "<=" | ">" | ">=" | "=" | "<>", ..) => 4,
            Tree::Binary("+" | "-", ..) => 5,
            Tree::Binary("*" | "/", ..) => 6,
            Tree::Prefix(..) => 7,
            Tree::Binary(..) => 8,
            Tree::Number(_) | Tree::Name(_) | Tree::Call(..) => 9,
        }
    }

    fn print(&self, all_parentheses: bool) -> String {
        let at = |tree: &Tree, least: u32| {
            let text = tree.print(all_parentheses);
            if all_parentheses || tree.level() < least { format!("({text})") } else { text }
        };
        match self {
            Tree::Number(n) => n.to_string(),
            Tree::Name(name) => (*name).to_owned(),
            Tree::Call(name, arguments) => {
                let arguments: Vec<String> = arguments.iter().map(|a| at(a, 0)).collect();
                format!("{name}({})", arguments.join(", "))
            }
            Tree::Prefix("not", a) => format!("not {}", at(a, 3)),
            Tree::Prefix(operator, a) => format!("{operator}{}", at(a, 7)),
            Tree::Binary("^", a, b) => format!("{}^{}", at(a, 9), at(b, 7)),
            Tree::Binary(operator, a, b) => {
                let level = self.level();
                let left = if level == 4 { 5 } else { level };
                format!("{} {operator} {}", at(a, left), at(b, level + 1))
            }
            Tree::If(c, a, b) => format!("if {} then {} else {}", at(c, 0), at(a, 0), at(b, 0)),
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (0u32..1000).prop_map(Tree::Number),
        prop::sample::select(vec!["x", "Position", "τ", "ETA2"]).prop_map(Tree::Name),
    ];
    leaf.prop_recursive(6, 60, 3, |inner| {
        let operators = vec!["+", "-", "*", "/", "^", "<", "<=", ">", ">=", "=", "<>", "and", "or"];
        let boxed = inner.clone().prop_map(Box::new);
        prop_oneof![
            6 => (prop::sample::select(operators), boxed.clone(), boxed.clone())
                .prop_map(|(operator, a, b)| Tree::Binary(operator, a, b)),
            2 => (prop::sample::select(vec!["-", "not"]), boxed.clone())
                .prop_map(|(operator, a)| Tree::Prefix(operator, a)),
            1 => prop::collection::vec(inner, 1..4).prop_map(|arguments| Tree::Call("f", arguments)),
            1 => (boxed.clone(), boxed.clone(), boxed).prop_map(|(c, a, b)| Tree::If(c, a, b)),
        ]
    })
}

proptest! {
    #[test]
    fn what_is_printed_is_read_back(tree in tree()) {
        for all_parentheses in [true, false] {
            let text = tree.print(all_parentheses);
            let parse = parse_expression(&text);
            prop_assert!(parse.errors().is_empty(), "{text}: {:?}", parse.errors());
            prop_assert_eq!(structure(parse.expression()), tree.structure(), "{}", text);
            prop_assert_eq!(parse.syntax().to_string(), text);
        }
    }

    #[test]
    fn any_text_has_a_tree(text in ".*") {
        let parse = parse_expression(&text);
        prop_assert_eq!(parse.syntax().to_string(), text);
        structure(parse.expression());
    }

    #[test]
    fn any_jumble_of_tokens_has_a_tree_and_whole_characters_in_its_errors(
        words in prop::collection::vec(
            prop::sample::select(vec![
                "a", "1", "5.", ".5", "1e", "'q'", "'", "\"", "+", "-", "*", "^", "<", "=", "<>", "not", "and",
                "or", "if", "then", "else", "(", ")", ",", "f(", "×", "≤", "²", "%", "\n", " ", "$", "[", "true",
            ]),
            0..40,
        ),
    ) {
        let text = words.concat();
        let parse = parse_expression(&text);
        prop_assert_eq!(parse.syntax().to_string(), text.clone());
        structure(parse.expression());
        for error in parse.errors() {
            prop_assert!(text.get(error.range.clone()).is_some(), "{:?}", error);
            for (range, _) in &error.related {
                prop_assert!(text.get(range.clone()).is_some(), "{:?}", error);
            }
        }
    }

    #[test]
    fn a_deleted_character_never_makes_a_wrong_tree_silently_longer(tree in tree(), place in 0usize..200) {
        let mut text: Vec<char> = tree.print(false).chars().collect();
        if place < text.len() {
            text.remove(place);
        }
        let text: String = text.into_iter().collect();
        let parse = parse_expression(&text);
        if parse.errors().is_empty() {
            prop_assert!(!structure(parse.expression()).contains('?'), "{text}");
        }
    }
}
