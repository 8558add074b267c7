//! Large systems, as many states as one likes: for tests and measurements of scale.

use sophy_field::{AutomatonIndex, LocationIndex, ParameterIndex, StateIndex, TransitionIndex};
use sophy_ir::{
    Automaton, AutomatonKind, ClassIndex, Comparison, ComponentIndex, Composite, Declared, FlatLocation,
    FlatReset, FlatTransition, FlatTrigger, Graph, Leaf, Member, Members, NodeId, Origin, Parameter,
    Quantity, Role, Row, Shared, State, System, Unary, VariableId,
};

/// Nothing was written.
const ORIGIN: Origin = Origin { class: ClassIndex(0), variable: VariableId(0) };

fn declared(name: &str) -> Shared<Declared> {
    Shared::new(Declared {
        name: name.to_owned(),
        unit: None,
        quantity: Quantity::Real,
        choices: Vec::new(),
        origin: ORIGIN,
        span: None,
    })
}

fn state(component: u32, declared: &Shared<Declared>, initial: NodeId, rate: Row) -> State {
    State {
        component: ComponentIndex(component),
        declared: declared.clone(),
        discrete: false,
        initial: Some(initial),
        sign_of: None,
        rate,
    }
}

/// A ring of cells of three states each in HSML, as an array of components.
pub fn ring_text(cells: usize) -> String {
    format!(
        "\
%% One of many: an oscillator that its neighbour pulls at, and a mean of it.
CTC Cell is
interface
  input(pull, signal);
  output(x, signal);
  knob(k);
end interface;
body
  declarations
    state x := 1;
    state v := 0;
    state mean := 0;
  end declarations;
  dynamics
    der(x) = v;
    der(v) = k*(pull - x) - 0.1*v - x;
    der(mean) = (x - mean)/T;
  end dynamics;
  assignments
    k : 0.2;
    T : 5;
  end assignments;
end body;

SYSTEM Ring is
body
  components
    cell : Cell[{cells}];
  end components;
  connections
    for i in 1..{last} loop
      cell[i].x -> cell[i + 1].pull;
    end loop;
    cell[{cells}].x -> cell[1].pull;
  end connections;
end body;
",
        last = cells - 1
    )
}

/// A ring of `count` equal cells with three states each, every one a component of its own.
///
/// v′ = v − v³/3 − w + I + g (s₋ − v), w′ = ε (v + a − b w), s′ = (v − s)/τ; s₋ is that of the cell before, I
/// and the initial values differ from cell to cell. With `events` a cell has the locations rest and busy: it is busy
/// from v > 1 (w is raised then) until v < −½, and s follows faster meanwhile. Kinks are not lifted yet.
pub fn ring(count: usize, events: bool) -> System {
    let mut system = System { name: "ring".to_owned(), ..System::default() };
    let cells = Member {
        name: "cell".to_owned(),
        class: ClassIndex(0),
        extents: vec![count as u32],
        element: Vec::new(),
        parameters: Vec::new(),
        documentation: String::new(),
        span: None,
    };
    let cells = Composite { members: vec![cells], ..Composite::default() };
    system.components.hold(1, ComponentIndex(0), Members::of(&cells));
    let states = ["v", "w", "s"].map(declared);
    let names = &["rest", "busy"][..if events { 2 } else { 1 }];
    let outgoing = |l: u32| if events { vec![l] } else { Vec::new() };
    let locations = (0..).zip(names);
    let kind = Shared::new(AutomatonKind {
        role: Role::Component,
        locations: locations
            .map(|(l, name)| FlatLocation { name: (*name).to_owned(), transitions: outgoing(l) })
            .collect(),
        initial: LocationIndex(0),
    });
    for cell in 0..count {
        let before = if cell == 0 { count - 1 } else { cell - 1 };
        let owner = AutomatonIndex::new(cell);
        let current = ParameterIndex::new(cell);
        let value = system.graph.number(0.3 + 0.2 * scatter(cell, 3));
        let name = format!("cell[{}].I", cell + 1);
        system.parameters.push(Parameter {
            name,
            value,
            unit: None,
            knob: false,
            structural: false,
            origin: ORIGIN,
            span: None,
        });
        let index = |cell: usize, k: usize| StateIndex::new(3 * cell + k);
        let g = &mut system.graph;
        let [v, w, s] = [0, 1, 2].map(|k| g.leaf(Leaf::State(index(cell, k))));
        let neighbour = g.leaf(Leaf::State(index(before, 2)));
        let current = g.leaf(Leaf::Parameter(current));
        let numbers = [3.0, 0.5, 0.08, 0.7, 0.8, 2.0, 0.25].map(|n| g.number(n));
        let [three, coupling, epsilon, a, b, slow, fast] = numbers;
        let cube = g.integer_power(v, 3);
        let cube = g.divide(cube, three);
        let own = g.subtract(v, cube);
        let own = g.subtract(own, w);
        let own = g.add(own, current);
        let gap = g.subtract(neighbour, v);
        let pull = g.multiply(coupling, gap);
        let v_rate = g.add(own, pull);
        let sum = g.add(v, a);
        let back = g.multiply(b, w);
        let rest = g.subtract(sum, back);
        let w_rate = g.multiply(epsilon, rest);
        let lag = g.subtract(v, s);
        let (s_rest, s_busy) = (g.divide(lag, slow), g.divide(lag, fast));
        let rows = [[v_rate; 2], [w_rate; 2], [s_rest, s_busy]];
        let locations = names.len();
        for (k, (name, row)) in states.iter().zip(rows).enumerate() {
            let initial = system.graph.number(4.0 * scatter(cell, k) - 2.0);
            let rate = system.row(owner, &row[..locations], Row::NOWHERE);
            system.states.push(state(cell as u32 + 1, name, initial, rate));
        }
        system.automata.push(Automaton {
            component: ComponentIndex(cell as u32 + 1),
            kind: kind.clone(),
            first: TransitionIndex::new(system.transitions.len()),
        });
        if events {
            transitions(&mut system, owner, v, w, index(cell, 1));
        }
    }
    system
}

fn transitions(system: &mut System, automaton: AutomatonIndex, v: NodeId, w: NodeId, raised: StateIndex) {
    let g = &mut system.graph;
    let [high, low, kick] = [1.0, -0.5, 0.05].map(|n| g.number(n));
    let (above, below) = (g.compare(Comparison::Greater, v, high), g.compare(Comparison::Less, v, low));
    let value = g.add(w, kick);
    let reset = FlatReset { state: raised, value, span: None };
    let ways = [("fire", 0, above, vec![reset]), ("calm", 1, below, Vec::new())];
    for (name, source, guard, resets) in ways {
        system.transitions.push(FlatTransition {
            name: name.into(),
            automaton,
            source: LocationIndex(source),
            destination: LocationIndex(1 - source),
            trigger: FlatTrigger::When(guard),
            resets,
            emits: Vec::new(),
            priority: 0,
            silent: false,
            span: None,
        });
    }
}

/// `count` states in one component, no two of whose equations are equal: each is a chain of operations of its
/// own on the state and its two neighbours. Bounded, and contracting for every state by itself.
pub fn distinct(count: usize) -> System {
    let mut system = System { name: "distinct".to_owned(), ..System::default() };
    for position in 0..count {
        let g = &mut system.graph;
        let near = [count - 1, 0, 1].map(|k| g.leaf(Leaf::State(StateIndex::new((position + k) % count))));
        let chain = chain(g, near, position);
        let rate = g.subtract(chain, near[1]);
        let initial = g.number(scatter(position, 0));
        let rate = system.row(AutomatonIndex(0), &[rate], Row::NOWHERE);
        system.states.push(state(0, &declared(&format!("x{position}")), initial, rate));
    }
    let location = FlatLocation { name: "all".to_owned(), transitions: Vec::new() };
    let (locations, initial, role) = (vec![location], LocationIndex(0), Role::Component);
    let kind = Shared::new(AutomatonKind { role, locations, initial });
    system.automata.push(Automaton { component: ComponentIndex(0), kind, first: TransitionIndex(0) });
    system
}

/// The digits of `position` choose the operations.
fn chain(g: &mut Graph, near: [NodeId; 3], position: usize) -> NodeId {
    let mut value = g.unary(Unary::Sin, near[0]);
    let mut digits = position;
    for _ in 0..9 {
        let digit = digits % 4;
        digits /= 4;
        value = match digit {
            0 => g.unary(Unary::Sin, value),
            1 => g.unary(Unary::Tanh, value),
            2 => g.add(value, near[2]),
            _ => g.subtract(near[0], value),
        };
    }
    g.unary(Unary::Tanh, value)
}

/// A number in [0, 1) that looks like chance.
fn scatter(position: usize, k: usize) -> f64 {
    let mixed = (position as u64 * 4 + k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (mixed >> 11) as f64 / (1u64 << 53) as f64
}
