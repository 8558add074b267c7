//! Compiled programs against the reference interpreter, their Taylor coefficients against symbolic
//! derivatives and difference quotients, their enclosures against points, on random expression graphs.

use proptest::prelude::*;
use sophy_codegen::{Compiled, Parameters, Sharing, compile_sharing};
use sophy_field::{Ball, Enclosing, Formula, Jet, LocationIndex, NOW, SourceIndex, StateIndex, WatchIndex};
use sophy_ir::{Binary, Comparison, Graph, Leaf, Model, Node, NodeId, System, Unary, Value, evaluate};
use sophy_segment::Interval;
use sophy_testkit::Build;

/// One operation: which, and three operands.
type Step = (u8, u8, u8, u8);

const UNARY: [Unary; 20] = [
    Unary::Negate,
    Unary::Sin,
    Unary::Cos,
    Unary::Tan,
    Unary::Asin,
    Unary::Acos,
    Unary::Atan,
    Unary::Sinh,
    Unary::Cosh,
    Unary::Tanh,
    Unary::Asinh,
    Unary::Acosh,
    Unary::Atanh,
    Unary::Exp,
    Unary::Ln,
    Unary::Log10,
    Unary::Sqrt,
    Unary::Abs,
    Unary::Sign,
    Unary::Floor,
];
const BINARY: [Binary; 8] = [
    Binary::Add,
    Binary::Subtract,
    Binary::Multiply,
    Binary::Divide,
    Binary::Power,
    Binary::Min,
    Binary::Max,
    Binary::Atan2,
];
const COMPARISONS: [Comparison; 6] = [
    Comparison::Less,
    Comparison::LessEqual,
    Comparison::Greater,
    Comparison::GreaterEqual,
    Comparison::Equal,
    Comparison::NotEqual,
];

/// The point x₁, x₂, u, t at which a case is looked at, and the values of p and q.
#[derive(Clone, Copy, Debug)]
struct Point {
    sources: [f64; 4],
    parameters: [f64; 2],
}

/// A model whose output `z` and whose two rates are the same random expression.
struct Case {
    system: System,
    compiled: Compiled,
    point: Point,
}

/// Builds the expression of `steps`; what `accept` refuses is left out.
fn expression(
    b: &mut Build,
    leaves: &[NodeId],
    steps: &[Step],
    accept: &dyn Fn(&Graph, NodeId) -> bool,
) -> NodeId {
    let mut reals = leaves.to_vec();
    reals.extend([0.5, 2.0, -1.25, 3.0].map(|n| b.number(n)));
    let graph = b.graph();
    let mut booleans = vec![];
    let pick = |from: &[NodeId], k: u8| {
        let (n, k) = (from.len(), usize::from(k));
        if k < 128 { from[n - 1 - k % n.min(4)] } else { from[k % n] }
    };
    for &(operation, i, j, k) in steps {
        let (x, y) = (pick(&reals, i), pick(&reals, j));
        let real = match operation % 40 {
            n @ 0..=19 => graph.unary(UNARY[usize::from(n)], x),
            n @ 20..=27 => graph.binary(BINARY[usize::from(n - 20)], x, y),
            28 | 29 => graph.integer_power(x, i32::from(k % 10) - 3),
            n @ 30..=35 if booleans.is_empty() || n < 33 => {
                let truth = graph.compare(COMPARISONS[usize::from(k % 6)], x, y);
                if accept(graph, truth) {
                    booleans.push(truth);
                }
                continue;
            }
            n @ 33..=35 => {
                let (a, c) = (pick(&booleans, i), pick(&booleans, j));
                let combined = match n {
                    33 => graph.and(a, c),
                    34 => graph.or(a, c),
                    _ => graph.not(a),
                };
                booleans.push(combined);
                continue;
            }
            n @ 36..=38 => {
                if booleans.is_empty() {
                    graph.multiply(x, y)
                } else if n == 38 {
                    let (a, c) = (pick(&booleans, i), pick(&booleans, j));
                    let condition = graph.select(pick_one(&booleans, k), a, c);
                    graph.select(condition, x, y)
                } else {
                    graph.select(pick_one(&booleans, k), x, y)
                }
            }
            _ => graph.multiply(x, y),
        };
        if accept(graph, real) {
            reals.push(real);
        }
    }
    // What came last, and something of all that came before.
    let root = *reals.last().unwrap();
    let before = reals[reals.len() / 2];
    graph.add(root, before)
}

fn pick_one(from: &[NodeId], k: u8) -> NodeId {
    from[usize::from(k) % from.len()]
}

fn case(steps: &[Step], point: Point, tame: bool) -> Case {
    let mut b = Build::default();
    b.component("");
    let (x1, x2) = (b.state("x1", 0.0), b.state("x2", 0.0));
    let u = b.input("u");
    let (p, q) = (b.parameter("p", point.parameters[0]), b.parameter("q", point.parameters[1]));
    let z = b.output("z");
    let here = b.location("all");
    let leaves = [b.read(x1), b.read(x2), b.read(u), b.time(), p, q];
    let names = leaves.map(|node| match b.graph().node(node) {
        Node::Leaf(leaf) => leaf,
        other => panic!("{other:?}"),
    });
    let [s1, s2, su, st] = point.sources;
    let values = [s1, s2, su, st, point.parameters[0], point.parameters[1]];
    let value = move |leaf: Leaf| values[names.iter().position(|&name| name == leaf).unwrap()];
    let accept = move |graph: &Graph, node: NodeId| !tame || is_tame(graph, node, &value);
    let root = expression(&mut b, &leaves, steps, &accept);
    b.value(here, z, root);
    b.rate(here, x1, root);
    let opposite = b.sub(root, leaves[1]);
    b.rate(here, x2, opposite);
    // Integrated trajectories are read by guards.
    let guard = b.less(root, leaves[1]);
    b.when(here, "turn", guard, here, &[]);
    lowered(&b.model(), point)
}

fn lowered(model: &Model, point: Point) -> Case {
    let system = sophy_passes::lower(model).expect("lowers");
    // Programs of their own and shared ones must not differ in a bit.
    let sharing = if system.graph.len().is_multiple_of(2) { Sharing::Always } else { Sharing::Usual };
    let compiled = compile_sharing(&system, &Parameters::new(), 3, sharing).expect("compiles");
    Case { system, compiled, point }
}

/// Whether the value of a node is moderate at the point and no kink or pole is near.
fn is_tame(graph: &Graph, node: NodeId, leaf: &dyn Fn(Leaf) -> f64) -> bool {
    let at = |node| evaluate(graph, node, &mut |l| Value::Real(leaf(l)));
    let number = |node| at(node).real();
    let moderate = match at(node) {
        Value::Real(x) => x.abs() < 50.0,
        Value::Boolean(_) => true,
    };
    let apart = |a, b| (number(a) - number(b)).abs() > 0.02;
    moderate
        && match graph.node(node) {
            Node::Unary(Unary::Abs | Unary::Sign, a) => number(a).abs() > 0.02,
            Node::Unary(Unary::Floor, a) => {
                let rest = number(a) - number(a).floor();
                rest > 0.02 && rest < 0.98
            }
            Node::Unary(Unary::Sqrt | Unary::Ln | Unary::Log10, a) => number(a) > 0.1,
            Node::Unary(Unary::Asin | Unary::Acos | Unary::Atanh, a) => number(a).abs() < 0.9,
            Node::Unary(Unary::Acosh, a) => number(a) > 1.1,
            Node::Unary(Unary::Tan, _) => number(node).abs() < 5.0,
            Node::IntegerPower(a, n) => n >= 0 && number(a).abs() < 10.0 || number(a).abs() > 0.1,
            Node::Binary(Binary::Divide, _, b) => number(b).abs() > 0.1,
            Node::Binary(Binary::Power, a, _) => number(a) > 0.1,
            Node::Binary(Binary::Atan2, a, b) => number(a).abs() + number(b).abs() > 0.2 && apart(a, b),
            Node::Binary(Binary::Min | Binary::Max, a, b) => apart(a, b),
            // Equality of continuous quantities is an error in conditions.
            Node::Compare(Comparison::Equal | Comparison::NotEqual, ..) => false,
            Node::Compare(_, a, b) => apart(a, b),
            _ => true,
        }
}

impl Case {
    /// The reference: expressions of the system, comparisons as written.
    fn value(&self, node: NodeId, sources: &[f64; 4]) -> f64 {
        evaluate(&self.system.graph, node, &mut |leaf| self.leaf(leaf, sources)).real()
    }

    fn leaf(&self, leaf: Leaf, sources: &[f64; 4]) -> Value {
        match leaf {
            Leaf::State(i) => Value::Real(sources[i.position()]),
            Leaf::Input(_) => Value::Real(sources[2]),
            Leaf::Time => Value::Real(sources[3]),
            Leaf::Parameter(i) => Value::Real(self.point.parameters[i.position()]),
            Leaf::Truth(i) => {
                let truth = self.system.truths.at(i.position());
                let watch = self.system.watches.at(truth.watch.position());
                let (left, right) = (self.value(watch.left, sources), self.value(watch.right, sources));
                Value::Boolean(truth.comparison.holds(left, right))
            }
            Leaf::Stair(i) => {
                Value::Real(self.value(self.system.stairs[i.position()].argument, sources).floor())
            }
            other => panic!("{other:?}"),
        }
    }

    /// Memory with jets of all sources on both sides, switches as at the point.
    fn memory(&self, jets: &[Jet; 4]) -> Vec<f64> {
        let e = &self.compiled.equations;
        let mut memory = e.memory().to_vec();
        memory[NOW] = TIME;
        for (source, jet) in jets.iter().enumerate() {
            let source = SourceIndex(source as u32);
            e.layout.set_integrated(&mut memory, source, jet, TIME);
            e.layout.set_quantised(&mut memory, source, jet, TIME);
        }
        let sources = &self.point.sources;
        for i in 0..self.system.truths.len() {
            let truth = self.leaf(Leaf::Truth(sophy_field::TruthIndex::new(i)), sources);
            memory[e.layout.truths as usize + i] = truth.real();
        }
        for i in 0..self.system.stairs.len() {
            let stair = self.leaf(Leaf::Stair(sophy_field::StairIndex::new(i)), sources);
            memory[e.layout.stairs as usize + i] = stair.real();
        }
        memory
    }

    /// All formulas read by guards and outputs whose reference is a node of the system.
    fn formulas(&self) -> Vec<((&Formula, u32), NodeId)> {
        let e = &self.compiled.equations;
        let watches = (0..).map(WatchIndex).zip(self.system.watches.iter());
        watches
            .map(|(index, watch)| {
                let (code, copy) = e.watch(index);
                ((&code.formula, copy), watch.difference)
            })
            .chain([(e.output(0, &HERE), self.system.nodes(self.system.outputs.at(0).value)[0])])
            .collect()
    }

    /// Coefficients of a rate by its block, from quantised jets.
    fn rate(&self, state: usize, memory: &mut [f64], orders: usize) -> Jet {
        let e = &self.compiled.equations;
        for (block, copy) in e.own_blocks(state, &HERE) {
            e.execute(&block.call, copy, memory, orders);
            if let Some(row) = block.rows.iter().find(|row| row.state.of(copy) as usize == state) {
                let mut rate = e.rate(row, copy, memory);
                rate.iter_mut().skip(orders).for_each(|c| *c = 0.0);
                return rate;
            }
        }
        panic!("no block has the rate of state {state}");
    }
}

const HERE: [LocationIndex; 1] = [LocationIndex(0)];

/// The instant at which equations are evaluated, s; trajectories begin there.
const TIME: f64 = 0.75;

/// Coefficients of a jet, for order 3.
const WIDTH: usize = 4;

fn same_bits(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn steps(most: usize) -> impl Strategy<Value = Vec<Step>> {
    prop::collection::vec(any::<Step>(), 1..most)
}

fn wild() -> impl Strategy<Value = f64> {
    let special =
        prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 2.0, 0.5, 1e-300, -1e300, f64::INFINITY, f64::NAN]);
    prop_oneof![3 => -4.0f64..4.0, 1 => special]
}

fn wild_point() -> impl Strategy<Value = Point> {
    let finite = || wild().prop_filter("finite", |x| x.is_finite());
    ([wild(), wild(), wild(), wild()], [finite(), finite()])
        .prop_map(|(sources, parameters)| Point { sources, parameters })
}

fn tame_point() -> impl Strategy<Value = Point> {
    let near = || prop_oneof![0.1f64..2.5, -2.0f64..-0.1];
    ([near(), near(), near(), near()], [near(), near()])
        .prop_map(|(sources, parameters)| Point { sources, parameters })
}

/// Two coefficients per source besides its value; time has slope 1.
fn motion() -> impl Strategy<Value = [[f64; 2]; 4]> {
    let c = || -1.5f64..1.5;
    ([c(), c()], [c(), c()], c()).prop_map(|(a, b, u)| [a, b, [u, 0.0], [1.0, 0.0]])
}

fn jets(point: &Point, motion: &[[f64; 2]; 4], s: f64) -> [Jet; 4] {
    std::array::from_fn(|k| {
        let [c1, c2] = motion[k];
        [point.sources[k] + s * (c1 + s * c2), c1 + 2.0 * c2 * s, c2, 0.0]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Every operation, every number of coefficients: the bits of the reference interpreter.
    #[test]
    fn outputs_and_rates_have_the_bits_of_the_interpreter(
        steps in steps(24),
        point in wild_point(),
        motion in motion(),
    ) {
        // A trajectory that is −0 may be followed to 0.
        let point = Point { sources: point.sources.map(|x| x + 0.0), ..point };
        let case = case(&steps, point, false);
        let jets = std::array::from_fn(|k| [point.sources[k], motion[k][0], motion[k][1], 0.0]);
        for (formula, node) in case.formulas() {
            let expected = case.value(node, &point.sources);
            for orders in 1..=WIDTH {
                let mut memory = case.memory(&jets);
                let [value, ..] = case.compiled.equations.formula(formula, &HERE, &mut memory, orders);
                prop_assert!(same_bits(value, expected), "{value:e} for {expected:e} at {:?}, {orders} orders: {}", point.sources, case.system.text(node));
            }
        }
        for state in 0..2 {
            let node = case.system.nodes(case.system.states.at(state).rate)[0];
            let expected = case.value(node, &point.sources);
            for orders in 1..=WIDTH {
                let [value, ..] = case.rate(state, &mut case.memory(&jets), orders);
                prop_assert!(same_bits(value, expected), "{value:e} for {expected:e} at {:?}, {orders} orders: {}", point.sources, case.system.text(node));
            }
        }
    }

    /// Lifting the kinks changes nothing, away from ties.
    #[test]
    fn lifted_rates_have_the_value_as_written(steps in steps(24), point in tame_point()) {
        let case = case(&steps, point, true);
        let written = case.value(case.system.nodes(case.system.outputs.at(0).value)[0], &point.sources);
        let lifted = case.value(case.system.nodes(case.system.states.at(0).rate)[0], &point.sources);
        prop_assert!(written == lifted, "{written} {lifted}");
    }

    /// First, second and third coefficients: symbolic derivatives along the motion, and difference quotients.
    #[test]
    fn coefficients_are_the_derivatives_along_the_motion(
        steps in steps(16),
        point in tame_point(),
        motion in motion(),
    ) {
        let case = case(&steps, point, true);
        let jets = jets(&point, &motion, 0.0);
        // The motion written into the expression: z(t₀ + s) as a function of s.
        let root = case.system.nodes(case.system.outputs.at(0).value)[0];
        let mut graph = Graph::default();
        let s = graph.leaf(Leaf::Time);
        let moved = graph.import(&case.system.graph, root, &mut |graph, leaf| {
            let k = match leaf {
                Leaf::State(i) => i.position(),
                Leaf::Input(_) => 2,
                Leaf::Time => 3,
                Leaf::Parameter(i) => return graph.number(point.parameters[i.position()]),
                other => panic!("{other:?}"),
            };
            let [c0, c1, c2, _] = jets[k].map(|c| graph.number(c));
            let inner = graph.multiply(c2, s);
            let inner = graph.add(c1, inner);
            let term = graph.multiply(inner, s);
            graph.add(c0, term)
        });
        let at = |graph: &Graph, node: NodeId, s: f64| evaluate(graph, node, &mut |_| Value::Real(s)).real();
        let first = graph.derivative(moved, Leaf::Time);
        let second = first.and_then(|d| graph.derivative(d, Leaf::Time));
        let third = second.and_then(|d| graph.derivative(d, Leaf::Time));
        let [d1, d2, d3] = [first, second, third].map(|d| d.map_or(0.0, |d| at(&graph, d, 0.0)));
        prop_assume!(d1.abs() < 1e4 && d2.abs() < 1e6 && d3.abs() < 1e8);
        // The same first derivative along a direction, in the system's own graph.
        let mut own = case.system.graph.clone();
        let along = own.directional(root, &mut |graph, leaf| match leaf {
            Leaf::State(i) => Some(graph.number(jets[i.position()][1])),
            Leaf::Input(_) => Some(graph.number(jets[2][1])),
            Leaf::Time => Some(graph.number(1.0)),
            _ => None,
        });
        let along = along.map_or(0.0, |d| evaluate(&own, d, &mut |leaf| case.leaf(leaf, &point.sources)).real());
        let scale = 1.0 + d1.abs() + d2.abs();
        prop_assert!((along - d1).abs() < 1e-9 * scale, "{along} {d1}");

        let formula = case.compiled.equations.output(0, &HERE);
        let plain = case.compiled.equations.formula(formula, &HERE, &mut case.memory(&jets), WIDTH);
        let lifted = case.rate(0, &mut case.memory(&jets), WIDTH);
        for c in [plain, lifted] {
            prop_assert!((c[1] - d1).abs() < 1e-9 * scale, "{c:?} for {d1} {d2}");
            prop_assert!((2.0 * c[2] - d2).abs() < 1e-8 * scale, "{c:?} for {d1} {d2}");
            prop_assert!((6.0 * c[3] - d3).abs() < 1e-7 * (scale + d3.abs()), "{c:?} for {d1} {d2} {d3}");
        }

        // Difference quotients with two steps; their difference estimates their error.
        let quotients = |h: f64| {
            let z = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(&graph, moved, k * h));
            let first = (z[0] - 8.0 * z[1] + 8.0 * z[3] - z[4]) / (12.0 * h);
            let second = (16.0 * (z[1] + z[3]) - z[0] - z[4] - 30.0 * z[2]) / (12.0 * h * h);
            (first, second)
        };
        let ((a1, a2), (b1, b2)) = (quotients(2e-4), quotients(1e-4));
        prop_assert!((b1 - d1).abs() <= 2.0 * (a1 - b1).abs() + 1e-8 * scale, "{b1} for {d1}");
        prop_assert!((b2 - d2).abs() <= 2.0 * (a2 - b2).abs() + 1e-4 * scale, "{b2} for {d2}");
    }

    /// Over a random interval of time, enclosures contain value and coefficients at every point of it.
    #[test]
    fn enclosures_contain_all_coefficients(
        steps in steps(16),
        point in tame_point(),
        motion in motion(),
        width in prop_oneof![1e-7f64..1e-3, 1e-3f64..0.5],
        inside in prop::collection::vec(0.0f64..=1.0, 8),
    ) {
        let case = case(&steps, point, true);
        let e = &case.compiled.equations;
        let numbers = case.memory(&jets(&point, &motion, 0.0));
        let rest = e.layout.rest;
        let mut enclosed: Vec<Interval> =
            numbers[rest as usize..].iter().copied().map(Interval::point).collect();
        let now = Interval::new(TIME, TIME + width);
        let mut bounded: Vec<Ball> = numbers[rest as usize..].iter().map(|&number| [number, 0.0]).collect();
        let around = [TIME + 0.5 * width, 0.5 * width + 1e-15];
        for (formula, _) in case.formulas().into_iter().take(e.watches.len()) {
            let mut memory = Enclosing { numbers: &numbers, enclosed: &mut enclosed, rest, now };
            let enclosure = e.formula_enclosed(formula, &HERE, &mut memory);
            let mut memory = Enclosing { numbers: &numbers, enclosed: &mut bounded, rest, now: around };
            let [middle, radius] = e.formula_bounded(formula, &HERE, &mut memory);
            for &part in &inside {
                let mut memory = case.memory(&jets(&point, &motion, part * width));
                let c = e.formula(formula, &HERE, &mut memory, 3);
                let outside = (c[0] - middle).abs() > radius + 1e-12 * (1.0 + c[0].abs());
                prop_assert!(!outside, "{} is not within {radius} of {middle} at {part} of {width}", c[0]);
                for (x, range) in c.into_iter().zip(enclosure) {
                    let slack = 1e-12 * (1.0 + x.abs());
                    let holds = x.is_nan() || range.contains(x) || range.contains(x - slack) || range.contains(x + slack);
                    prop_assert!(holds, "{x} is not in {range:?} at {part} of {width}");
                }
            }
        }
    }

    /// An affine form has the value of the expression everywhere, and what is built affine is recognised.
    #[test]
    fn affine_forms_have_the_value_of_the_expression(
        build in prop::collection::vec((0u8..9, any::<u8>(), any::<u8>()), 1..20),
        parameters in [0.3f64..3.0, -3.0f64..-0.3],
        points in prop::collection::vec([-5.0f64..5.0, -5.0f64..5.0, -5.0f64..5.0, 0.0f64..5.0], 3),
        spoil in prop::bool::ANY,
    ) {
        let mut graph = Graph::default();
        let leaves = [
            Leaf::State(StateIndex(0)),
            Leaf::State(StateIndex(1)),
            Leaf::Input(sophy_field::InputIndex(0)),
            Leaf::Time,
        ];
        let mut forms: Vec<NodeId> = leaves.iter().map(|&leaf| graph.leaf(leaf)).collect();
        let mut constants: Vec<NodeId> =
            (0..2).map(|i| graph.leaf(Leaf::Parameter(sophy_field::ParameterIndex(i)))).collect();
        constants.push(graph.number(2.5));
        for (operation, i, j) in build {
            let (a, c) = (pick_one(&forms, i), pick_one(&constants, j));
            let b = pick_one(&forms, j);
            let made = match operation {
                0 => graph.add(a, b),
                1 => graph.subtract(a, b),
                2 => graph.multiply(a, c),
                3 => graph.multiply(c, a),
                4 => graph.divide(a, c),
                5 => graph.unary(Unary::Negate, a),
                6 => {
                    let other = pick_one(&constants, i);
                    let condition = graph.compare(Comparison::Less, c, other);
                    graph.select(condition, a, b)
                }
                7 => {
                    let sine = graph.unary(Unary::Sin, c);
                    constants.push(sine);
                    graph.add(sine, a)
                }
                _ => graph.subtract(c, a),
            };
            forms.push(made);
        }
        let mut root = *forms.last().unwrap();
        if spoil {
            // Still affine if the product is with what happens not to depend on a variable.
            let square = graph.multiply(root, forms[forms.len() / 2]);
            root = graph.add(square, root);
        }
        let variable = |leaf: Leaf| !matches!(leaf, Leaf::Parameter(_));
        let form = graph.affine(root, &variable);
        prop_assert!(spoil || form.is_some());
        let Some(form) = form else { return Ok(()) };
        for point in points {
            let mut leaf = |leaf: Leaf| Value::Real(match leaf {
                Leaf::Parameter(i) => parameters[i.position()],
                other => point[leaves.iter().position(|&l| l == other).unwrap()],
            });
            let expected = evaluate(&graph, root, &mut leaf).real();
            let mut sum = form.constant.map_or(0.0, |c| evaluate(&graph, c, &mut leaf).real());
            let mut scale = 1.0 + expected.abs() + sum.abs();
            for (&name, &coefficient) in &form.terms {
                let term = evaluate(&graph, coefficient, &mut leaf).real() * leaf(name).real();
                sum += term;
                scale += term.abs();
            }
            prop_assert!((sum - expected).abs() < 1e-11 * scale, "{sum} for {expected}");
        }
    }
}
