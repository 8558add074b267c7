//! What is written is read again; mistakes have places and ways out.

use super::plain::Plain;
use super::{read_hsml, write_hsml};
use crate::declarations::*;
use proptest::prelude::*;
use sophy_diagnostics::{SourceId, Sources, Span, Style, TextMap, render};
use sophy_syntax::ast::FileItem;
use sophy_syntax::parse_file;

fn source() -> SourceId {
    Sources::default().add("", "")
}

fn spanned(text: impl Into<String>) -> Spanned<String> {
    Spanned::new(text.into(), Span::new(source(), 0..0))
}

/// Identifiers, words that mean something in some places, reserved words, and what needs quotes.
fn name() -> impl Strategy<Value = Spanned<String>> {
    let words = [
        "rate",
        "delay",
        "on",
        "priority",
        "from",
        "every",
        "hold",
        "emit",
        "compose",
        "with",
        "state",
        "knob",
        "transition",
        "where",
        "tsample",
        "initially",
        "end",
        "if",
        "not",
        "true",
        "in",
        "output",
        "initial",
        "location",
        "event",
        "is",
        "negative-to-positive",
        "CTC",
        "constant",
        "τ_1",
        "Ground Impact",
        "2nd",
        "a;b",
        "%",
        "x = 1",
        "der",
        " a",
    ];
    prop_oneof![
        2 => "[a-z_][a-z0-9_]{0,3}".prop_map(spanned),
        1 => prop::sample::select(words.to_vec()).prop_map(spanned),
    ]
}

/// Strings without quotes: paths and units.
fn string() -> impl Strategy<Value = Spanned<String>> {
    "[a-z0-9/ .^'%;]{0,6}".prop_map(spanned)
}

/// The expression in a file, as the reader would find it; or one that is a text of its own, as in SOPHY XML.
fn expression_of(text: &str, own: bool) -> ExpressionText {
    if own && !text.contains('"') {
        return ExpressionText::parse(text, TextMap::empty(source(), 0)).0;
    }
    let file = format!("constant c = {text};");
    let parse = parse_file(&file);
    assert!(parse.errors().is_empty(), "{file}: {:?}", parse.errors());
    let item = parse.file().and_then(|file| file.items().next());
    let Some(FileItem::Constant(constant)) = item else { panic!("{file}") };
    let expression = constant.value().expect("a value");
    ExpressionText {
        span: Span::new(source(), expression.range()),
        expression: Some(expression),
        well_formed: true,
        map: TextMap::plain(source(), 0, u32::try_from(file.len()).expect("short")),
        text: file.into(),
    }
}

fn expression_text() -> impl Strategy<Value = String> {
    let leaves = [
        "1",
        "0.5e-3",
        "x",
        "rate",
        "'end'",
        "'Ground Impact'",
        "true",
        "f()",
        "x[1]",
        "auv.mass",
        "[1, 2]",
        "time",
        "\"idle\"",
        "'delay'",
        "'priority'",
    ];
    let leaf = prop::sample::select(leaves.to_vec()).prop_map(str::to_owned);
    leaf.prop_recursive(3, 12, 3, |inner| {
        let operators = ["+", "-", "*", "/", "^", "<", ">=", "<>", "and", "or"].to_vec();
        let pair = (inner.clone(), prop::sample::select(operators), inner.clone());
        prop_oneof![
            pair.prop_map(|(a, operator, b)| format!("({a}) {operator} ({b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a})=({b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("max({a}, {b})")),
            inner.clone().prop_map(|a| format!("not ({a})")),
            inner.clone().prop_map(|a| format!("-({a})\n  + 1")),
            inner.clone().prop_map(|a| format!("(% a comment\n {a})")),
            inner.clone().prop_map(|a| format!("sum(i in 1..3 where i > 1 : {a})")),
            (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| format!("if {a} then {b} else {c}")),
        ]
    })
}

fn expression() -> impl Strategy<Value = ExpressionText> {
    (expression_text(), any::<bool>()).prop_map(|(text, own)| expression_of(&text, own))
}

fn list<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Vec<T>> {
    prop::collection::vec(of, 0..3)
}

fn some<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Vec<T>> {
    prop::collection::vec(of, 1..3)
}

fn maybe<T: std::fmt::Debug>(of: impl Strategy<Value = T>) -> impl Strategy<Value = Option<T>> {
    prop::option::of(of)
}

fn documentation() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[A-Z<&%][a-z \"&<>%]{0,9}[.>](\n{1,2}[a-z][a-z <&]{0,9}[.>]){0,3}"]
}

fn kind() -> impl Strategy<Value = TypeText> {
    let names = prop::sample::select(vec!["signal", "real", "integer", "boolean", "string", "event"]);
    (names, list(expression())).prop_map(|(name, shape)| TypeText { name: spanned(name), shape })
}

fn range() -> impl Strategy<Value = RangeText> {
    prop_oneof![
        (expression(), expression()).prop_map(|(low, high)| RangeText::Bounds(low, high)),
        some(expression()).prop_map(RangeText::Set),
    ]
}

fn port() -> impl Strategy<Value = PortDeclaration> {
    use Direction::{Input, Output, Synchronised};
    let direction = prop::sample::select(vec![Input, Output, Synchronised]);
    (name(), documentation(), direction, kind(), maybe(range()), maybe(string())).prop_map(
        |(name, documentation, direction, kind, range, unit)| match direction {
            Synchronised => {
                PortDeclaration { name, documentation, direction, kind: None, range: None, unit: None }
            }
            _ => PortDeclaration { name, documentation, direction, kind: Some(kind), range, unit },
        },
    )
}

fn knob() -> impl Strategy<Value = KnobDeclaration> {
    (name(), documentation(), maybe(range()), maybe(string()))
        .prop_map(|(name, documentation, range, unit)| KnobDeclaration { name, documentation, range, unit })
}

fn parameter() -> impl Strategy<Value = ParameterDeclaration> {
    (name(), documentation(), expression(), maybe(string())).prop_map(|(name, documentation, value, unit)| {
        ParameterDeclaration { name, documentation, kind: None, value, unit }
    })
}

fn function() -> impl Strategy<Value = FunctionDeclaration> {
    (name(), documentation(), list((name(), maybe(kind()))), maybe(kind()), expression()).prop_map(
        |(name, documentation, parameters, result, body)| FunctionDeclaration {
            name,
            documentation,
            parameters,
            result,
            body,
        },
    )
}

fn variable() -> impl Strategy<Value = VariableDeclaration> {
    use VariableRole::{Flag, Local, Mode, State};
    let role = prop::sample::select(vec![State, Local, Mode, Flag]);
    let parts =
        (role, name(), documentation(), maybe(kind()), maybe(range()), maybe(expression()), maybe(string()));
    parts.prop_map(|(role, name, documentation, kind, range, initial, unit)| VariableDeclaration {
        role,
        name,
        documentation,
        kind,
        range,
        initial,
        unit,
    })
}

fn target() -> impl Strategy<Value = Target> {
    (name(), list(expression())).prop_map(|(name, indices)| Target { name, indices })
}

fn repeated<T: std::fmt::Debug>(items: impl Strategy<Value = T>) -> impl Strategy<Value = Loop<T>> {
    // Bounds end where a comparison starts.
    let bound = || {
        prop::sample::select(vec!["1", "n", "n - 1", "2*(a + b)"]).prop_map(|text| expression_of(text, false))
    };
    (name(), bound(), bound(), list(items)).prop_map(|(variable, from, to, items)| Loop {
        variable,
        from,
        to,
        items,
    })
}

fn statement() -> impl Strategy<Value = Statement> {
    let leaf = prop_oneof![
        (target(), expression()).prop_map(|(target, right)| Statement::Assign { target, right }),
        name().prop_map(Statement::Emit),
        name().prop_map(Statement::Hold),
    ];
    leaf.prop_recursive(2, 6, 3, |inner| {
        prop_oneof![
            (some((expression(), list(inner.clone()))), list(inner.clone()))
                .prop_map(|(branches, otherwise)| Statement::If { branches, otherwise }),
            repeated(inner).prop_map(Statement::For),
        ]
    })
}

fn equation() -> impl Strategy<Value = EquationItem> {
    let leaf = (any::<bool>(), target(), expression()).prop_map(|(derivative, target, right)| {
        EquationItem::Equation(EquationDeclaration { derivative, target, right })
    });
    leaf.prop_recursive(2, 6, 3, |inner| {
        prop_oneof![
            (some((expression(), list(inner.clone()))), maybe(list(inner.clone()))).prop_map(
                |(branches, otherwise)| EquationItem::If {
                    branches,
                    otherwise,
                    span: Span::new(source(), 0..0)
                }
            ),
            repeated(inner).prop_map(EquationItem::For),
        ]
    })
}

fn equations() -> impl Strategy<Value = Equations> {
    let constraint =
        (expression(), expression()).prop_map(|(left, right)| ConstraintDeclaration { left, right });
    (list(equation()), list(constraint), list(equation()))
        .prop_map(|(dynamics, constraints, output)| Equations { dynamics, constraints, output })
}

fn trigger() -> impl Strategy<Value = TriggerDeclaration> {
    let nowhere = Span::new(source(), 0..0);
    prop_oneof![
        expression().prop_map(|guard| TriggerDeclaration::When(Some(guard))),
        (some(name()), maybe(expression())).prop_map(|(labels, guard)| TriggerDeclaration::On(labels, guard)),
        (expression(), maybe(expression())).prop_map(|(rate, guard)| TriggerDeclaration::Rate(rate, guard)),
        maybe(expression()).prop_map(move |guard| TriggerDeclaration::Invariant(nowhere, guard)),
        (name(), maybe(expression()))
            .prop_map(|(label, guard)| TriggerDeclaration::Synchronised(label, guard)),
    ]
}

fn transition() -> impl Strategy<Value = TransitionDeclaration> {
    let parts = (name(), documentation(), trigger(), maybe(expression()), name(), list(statement()));
    parts.prop_map(|(name, documentation, trigger, priority, destination, actions)| TransitionDeclaration {
        name,
        documentation,
        trigger,
        priority,
        destination,
        actions,
    })
}

fn location() -> impl Strategy<Value = LocationDeclaration> {
    let parts =
        (name(), documentation(), list(variable()), equations(), maybe(expression()), list(transition()));
    parts.prop_map(|(name, documentation, variables, equations, invariant, transitions)| {
        LocationDeclaration { name, documentation, variables, equations, invariant, transitions }
    })
}

fn event() -> impl Strategy<Value = EventDeclaration> {
    let direction = || maybe(list(statement()));
    (target(), documentation(), maybe(expression()), direction(), direction()).prop_map(
        |(target, documentation, priority, rising, falling)| EventDeclaration {
            flag: target.name,
            indices: target.indices,
            documentation,
            priority,
            rising,
            falling,
        },
    )
}

fn rule() -> impl Strategy<Value = RuleDeclaration> {
    let marks = (any::<bool>(), any::<bool>(), any::<bool>());
    let parts =
        (documentation(), expression(), maybe(expression()), marks, maybe(expression()), list(statement()));
    parts.prop_map(|(documentation, condition, delay, marks, priority, actions)| RuleDeclaration {
        span: Span::new(source(), 0..0),
        documentation,
        condition,
        delay,
        latched: marks.0,
        cancellable: marks.1,
        initially: marks.2,
        priority,
        actions,
    })
}

fn member() -> impl Strategy<Value = MemberItem> {
    let parts = (name(), list(expression()), documentation(), name(), list(parameter()), list(expression()));
    let leaf = parts.prop_map(|(name, indices, documentation, component, mut parameters, extents)| {
        parameters.iter_mut().for_each(|parameter| parameter.documentation.clear());
        MemberItem::Member(MemberDeclaration { name, indices, documentation, component, parameters, extents })
    });
    leaf.prop_recursive(2, 4, 2, |inner| repeated(inner).prop_map(MemberItem::For))
}

fn connection() -> impl Strategy<Value = ConnectionItem> {
    let port = || {
        prop::collection::vec((name(), list(expression())), 1..3)
            .prop_map(|parts| PortText { parts, span: Span::new(source(), 0..0) })
    };
    let leaf = prop_oneof![
        (port(), port()).prop_map(|(from, to)| ConnectionItem::Connect { from, to }),
        (some(port()), expression()).prop_map(|(members, matrix)| ConnectionItem::Compose {
            span: Span::new(source(), 0..0),
            members,
            matrix,
        }),
    ];
    leaf.prop_recursive(2, 4, 2, |inner| repeated(inner).prop_map(ConnectionItem::For))
}

fn clock() -> impl Strategy<Value = ClockDeclaration> {
    prop_oneof![
        (name(), maybe(expression()))
            .prop_map(|(name, initial)| ClockDeclaration::Announced { name, initial }),
        // A variable may be called `every`, and have a unit.
        (expression().prop_filter("a number", |e| !e.written().starts_with('"')), maybe(expression()))
            .prop_map(|(period, offset)| ClockDeclaration::Every {
                span: Span::new(source(), 0..0),
                period,
                offset,
            }),
    ]
}

fn component() -> impl Strategy<Value = ComponentDeclaration> {
    use ComponentKind::{Cc, Ctc, Dtc, Lbc, System};
    let kind = prop::sample::select(vec![Ctc, Dtc, Lbc, Cc, System]);
    let interface = (list(port()), list(knob()), list(name()));
    let head = (kind, name(), documentation(), interface, list(parameter()), list(variable()));
    let timing = (maybe(clock()), maybe(expression()), maybe(expression()));
    let sections = (list(statement()), list(statement()), equations(), maybe(name()), list(location()));
    let tail = (list(event()), list(rule()), list(member()), list(connection()));
    (head, timing, sections, tail).prop_map(|(head, timing, sections, tail)| {
        let (kind, name, documentation, (ports, knobs, views), parameters, variables) = head;
        let (clock, delay, priority) = timing;
        let (initial, update, equations, initial_location, locations) = sections;
        let (events, rules, members, connections) = tail;
        ComponentDeclaration {
            documentation,
            ports,
            knobs,
            views,
            parameters,
            variables,
            clock,
            delay,
            priority,
            initial,
            update,
            equations,
            initial_location,
            locations,
            events,
            rules,
            members,
            connections,
            ..ComponentDeclaration::new(kind, name, Dialect::Hsml)
        }
    })
}

/// Declarations that are shown by their content.
struct Shown(Declarations);

impl std::fmt::Debug for Shown {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.plain())
    }
}

fn declarations() -> impl Strategy<Value = Shown> {
    (list(string()), list(parameter()), list(function()), list(component())).prop_map(
        |(imports, constants, functions, components)| {
            Shown(Declarations { imports, constants, functions, components })
        },
    )
}

/// What is read of a text that must have no mistakes.
fn read(text: &str) -> Declarations {
    let mut sources = Sources::default();
    let reading = read_hsml(&mut sources, "m.hsml", text.as_bytes());
    let messages = reading.diagnostics.sorted(&sources);
    let drawn: Vec<_> = messages.iter().map(|message| render(message, &sources, Style::Plain)).collect();
    assert!(drawn.is_empty(), "{}", drawn.join("\n"));
    reading.declarations
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(written in declarations()) {
        let text = write_hsml(&written.0);
        prop_assert_eq!(read(&text).plain(), written.0.plain(), "{}", text);
        prop_assert_eq!(write_hsml(&read(&text)), text);
    }
}

/// `line:column code message` of each message about a text.
fn said(text: &str) -> Vec<String> {
    let mut sources = Sources::default();
    let reading = read_hsml(&mut sources, "m.hsml", text.as_bytes());
    let messages = reading.diagnostics.sorted(&sources);
    assert!(messages.iter().all(|message| !message.helps.is_empty()), "{messages:?}");
    let line = |d: &sophy_diagnostics::Diagnostic| {
        let span = d.span().expect("a place");
        format!("{} {} {}", sources.line_column(span.source, span.start), d.code, d.message)
    };
    messages.iter().map(line).collect()
}

#[test]
fn what_the_grammar_allows_and_declarations_do_not() {
    let cases = [
        ("tsample every 1; tsample t := 0;", "1:45 HS0084 `tsample` stands here a second time"),
        ("tdelay 1; tdelay 2;", "1:38 HS0084 `tdelay` stands here a second time"),
        ("priority 1; priority 2;", "1:40 HS0084 `priority` stands here a second time"),
        ("mode m in (1, 2, 3);", "1:38 HS0085 a range in parentheses has two bounds, and this one 3"),
    ];
    for (declaration, expected) in cases {
        assert_eq!(
            said(&format!("DTC D is body declarations {declaration} end declarations; end body;")),
            [expected]
        );
    }
    let cases = [
        (
            "initial location A; initial location B;",
            "1:35 HS0084 the first location stands here a second time",
        ),
        (
            "constraints for i in 1..2 loop x[i] = 1; end loop; end constraints;",
            "1:27 HS0086 constraints stand neither under conditions nor in loops",
        ),
        ("event(S + 1) end event;", "1:21 HS0087 an event section names a flag, and this is an expression"),
        (
            "initial der(x) := 1; end initial;",
            "1:23 HS0088 the left side of this assignment is not `x` or `x[i]`",
        ),
        (
            "dynamics if a > 1 then x = 1; else x = 2; elsif a > 0 then x = 3; end if; end dynamics;",
            "1:57 HS0089 this stands after the `else`, which is the last part of an `if`",
        ),
        (
            "location A declarations priority 1; end declarations; end location;",
            "1:39 HS0090 this cannot be declared in a location",
        ),
        (
            "location A invariant x < 1; invariant x < 2; end location;",
            "1:43 HS0084 an invariant stands here a second time",
        ),
        (
            "event(S) positive-to-negative end positive-to-negative; positive-to-negative end positive-to-negative; end event;",
            "1:71 HS0084 `positive-to-negative` stands here a second time",
        ),
        ("end body; body", "1:25 HS0020 a component has one body"),
    ];
    for (section, expected) in cases {
        assert_eq!(said(&format!("CTC C is body {section} end body;")), [expected], "{section}");
    }
}

#[test]
fn a_mistake_leaves_the_rest_as_it_is() {
    let text = "CTC C is body declarations stat x; state y; end declarations;
        dynamics der(x) = 1 +; der(y) = 2*x end dynamics; end body;";
    let reading = read_hsml(&mut Sources::default(), "m.hsml", text.as_bytes());
    assert_eq!(reading.diagnostics.iter().count(), 3, "{:?}", reading.diagnostics);
    let component = &reading.declarations.components[0];
    let names: Vec<_> = component.variables.iter().map(|v| (v.role, v.name.value.as_str())).collect();
    assert_eq!(names, [(VariableRole::State, "x"), (VariableRole::State, "y")]);
    let equations = component.equations.dynamics.iter().map(|item| match item {
        EquationItem::Equation(equation) => (equation.right.written(), equation.right.well_formed),
        other => panic!("{other:?}"),
    });
    assert_eq!(equations.collect::<Vec<_>>(), [("1 +", false), ("2*x", true)]);
}

#[test]
fn places_are_those_of_the_file() {
    let text = "\u{feff}%% A ball\nCTC Ball is\ninterface output(h, signal, \"m\"); end interface;\nbody\n\
        declarations state h, v : real := 1 + 1; end declarations;\nend body;\n";
    let mut sources = Sources::default();
    let reading = read_hsml(&mut sources, "ball.hsml", text.as_bytes());
    let component = &reading.declarations.components[0];
    assert_eq!(component.documentation, "A ball");
    let [h, v] = component.variables.as_slice() else { panic!("two states") };
    let initial = v.initial.as_ref().expect("a value");
    assert_eq!((sources.excerpt(h.name.span), sources.excerpt(v.name.span)), ("h", "v"));
    assert_eq!((sources.excerpt(initial.span), initial.written()), ("1 + 1", "1 + 1"));
    let place = |span: Span| sources.line_column(span.source, span.start).to_string();
    assert_eq!((place(component.name.span), place(initial.span)), ("2:5".to_owned(), "5:35".to_owned()));
    let unit = component.ports[0].unit.as_ref().expect("a unit");
    assert_eq!((unit.value.as_str(), sources.excerpt(unit.span)), ("m", "\"m\""));
}

/// A text with everything, for mutations.
const BASE: &str = "import \"a.hsml\"; constant g = 9.82 \"m/s2\"; function f(a, b : real[3]) : real = a*b;
    %% documented\nCTC C is interface input(u, signal[2], (0, 1), \"N\"); output(e, event); knob(k, {1, 2}); view(x);
    end interface; body declarations state x : real in (0, 1) := 0 \"m\"; flag S; mode m := true; end declarations;
    initial x := 1; end initial; dynamics if u[1] > 0 then der(x) = -x; else der(x) = sum(i in 1..2 : u[i]); end if;
    S = x - 1; end dynamics; constraints x + m = 2; end constraints; output y = x = 1; end output;
    event(S) priority 1 negative-to-positive hold S; emit e; end negative-to-positive; end event;
    rules when x > 1 delay 0.5 latched do m := not m; for i in 1..2 loop z[i] := 1; end loop; end when; end rules;
    initial location A; location A invariant x < 2; transition t rate 2 when x > 0 priority 1 goto A; end location;
    components c[1] : Cell(p : 1)[3]; end components; connections a.b[1] -> c; compose a, b with [[1, 0], [0, 1]];
    end connections; assignments k : 2; end assignments; end body; end C;
    DTC D is body declarations tsample every k from 0; tdelay 1e-3; priority 2; end declarations; end body;";

proptest! {
    #[test]
    fn any_text_is_read(text in "\\PC{0,60}") {
        read_hsml(&mut Sources::default(), "m.hsml", text.as_bytes());
    }

    #[test]
    fn any_changed_text_is_read_and_written(cuts in prop::collection::vec((any::<prop::sample::Index>(), 0..30_usize, any::<prop::sample::Index>()), 1..4)) {
        let mut text: Vec<char> = BASE.chars().collect();
        for (at, length, from) in cuts {
            let at = at.index(text.len());
            let from = from.index(text.len());
            let moved: Vec<char> = text.iter().skip(from).take(length).copied().collect();
            text.splice(at..(at + length).min(text.len()), moved);
        }
        let text: String = text.into_iter().collect();
        let reading = read_hsml(&mut Sources::default(), "m.hsml", text.as_bytes());
        write_hsml(&reading.declarations);
    }
}

#[test]
fn ten_times_the_text_takes_about_ten_times_as_long() {
    let time = |count: usize| {
        let states: String = (0..count).map(|n| format!("state x{n} := {n};\n")).collect();
        let equations: String = (0..count).map(|n| format!("der(x{n}) = -x{n} + 2*x{};\n", n / 2)).collect();
        let text = format!(
            "CTC C is body declarations {states} end declarations; dynamics {equations} end dynamics; end body;"
        );
        let start = std::time::Instant::now();
        let declarations = read(&text);
        let read_time = start.elapsed();
        assert_eq!(declarations.components[0].equations.dynamics.len(), count);
        let written = write_hsml(&declarations);
        assert!(written.len() > text.len() / 2);
        (read_time, start.elapsed())
    };
    time(1000);
    let (small, large) = (time(2_000), time(20_000));
    assert!(large.0 < small.0 * 60 && large.1 < small.1 * 60, "{small:?} {large:?}");
}
