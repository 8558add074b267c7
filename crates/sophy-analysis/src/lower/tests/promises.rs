use super::*;
use proptest::prelude::*;
use sophy_ir::{Value, evaluate};

/// An expression as text, and its value where q = (1, 2, 3), z = 0.5, by plain arithmetic.
fn expression() -> impl Strategy<Value = (String, f64)> {
    let leaf = prop_oneof![
        (1..9_u32).prop_map(|n| (n.to_string(), f64::from(n))),
        (1..4_usize).prop_map(|i| (format!("q[{i}]"), i as f64)),
        Just(("z".to_owned(), 0.5)),
        (1..4_usize).prop_map(|i| (format!("[q[3], q[2], q[1]][{i}]"), (4 - i) as f64)),
        (0..4_usize).prop_map(|n| (format!("sum(j in 1..{n} : q[j])"), (n * (n + 1) / 2) as f64)),
        (1..4_usize).prop_map(|n| (format!("max(j in 1..{n} : q[j])"), n as f64)),
        Just(("dot(q, q)".to_owned(), 14.0)),
        Just(("(identity(3)*q)[2]".to_owned(), 2.0)),
    ];
    leaf.prop_recursive(4, 40, 2, |inner| {
        (inner.clone(), inner, 0..6_u32).prop_map(|((a, x), (b, y), operation)| match operation {
            0 => (format!("({a} + {b})"), x + y),
            1 => (format!("({a} - {b})"), x - y),
            2 => (format!("({a}*{b})"), x * y),
            3 => (format!("min({a}, {b})"), if x < y { x } else { y }),
            4 => (format!("(if {a} < {b} then {a} else {b} + 1)"), if x < y { x } else { y + 1.0 }),
            _ => (format!("f({a}, {b})"), x - 2.0 * y),
        })
    })
}

proptest! {
    #[test]
    fn lowering_keeps_the_meaning((text, expected) in expression()) {
        let lowered = lower_at(Place::EQUATION, "function f(a, b) = a - 2*b;", &text, &MemoryWorld::default());
        let node = lowered.value.as_ref().and_then(Typed::node);
        let node = node.ok_or_else(|| TestCaseError::fail(lowered.messages()))?;
        let value = evaluate(&lowered.graph, node, &mut |leaf| match leaf {
            Leaf::Variable(id) => Value::Real(match lowered.names[id.0 as usize].as_str() {
                "q[1]" => 1.0,
                "q[2]" => 2.0,
                "q[3]" => 3.0,
                _ => 0.5,
            }),
            _ => Value::Real(f64::NAN),
        });
        prop_assert_eq!(value.real(), expected);
    }

    /// What the words of the language make together is a value or a message, and never a panic.
    #[test]
    fn any_words_are_a_value_or_a_message(words in prop::collection::vec(prop::sample::select(vec![
        "x", "q", "A", "on", "phase", "1", "0", "\"idle\"", "+", "*", "/", "^", "=", "<", "and", "not", "(", ")",
        "[", "]", ",", "sum(j in 1..3 :", "q[", "inv(", "cross(", "if", "then", "else", "-", ".", "min(", "hit",
        "delayed(", "f(", "table(", "1..2", "size(", "noise(", "location", "zeros(",
    ]), 1..12)) {
        let mut sources = Sources::default();
        let file = format!("function f(a, b) = a - 2*b;\nconstant expression = {};\n", words.join(" "));
        let reading = crate::read_hsml(&mut sources, "t.hsml", file.as_bytes());
        let (mut findings, mut texts) = (Findings::default(), Vec::new());
        let world = MemoryWorld::default();
        let mut files = Files::new(&world);
        let functions: Vec<_> = reading.declarations.functions.iter().collect();
        let globals = lower_globals(&[], &functions, Dialect::Hsml, &mut files, &mut texts, &mut findings);
        let mut symbols = Symbols::new(Rc::new(globals));
        declare(&mut symbols, &mut texts, reading.source);
        let (mut graph, mut specials, mut structural) = (Graph::default(), Vec::new(), BTreeSet::new());
        let mut lowering = Lowering {
            graph: &mut graph,
            specials: &mut specials,
            symbols: &mut symbols,
            place: Place::INSTANT,
            findings: &mut findings,
            texts: &mut texts,
            files: &mut files,
            dialect: Dialect::Hsml,
            structural: &mut structural,
        };
        for constant in &reading.declarations.constants {
            let value = lowering.value(&constant.value);
            if let Some(value) = &value {
                prop_assert_eq!(value.elements.as_slice().len(), value.shape.len());
            }
            let errors = lowering.findings.error_count();
            let said = errors > 0 || reading.diagnostics.has_errors();
            prop_assert!(value.is_some() || said, "{}", file);
            prop_assert!(value.is_none() || constant.value.well_formed);
        }
    }
}
