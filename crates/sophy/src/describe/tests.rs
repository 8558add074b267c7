use super::*;
use crate::load_model;
use sophy_diagnostics::MemoryWorld;
use std::path::Path;

fn described(text: &str) -> Description {
    let loaded = load_model(&MemoryWorld::default().with("m.hsml", text), Path::new("m.hsml"));
    let messages: Vec<String> = loaded.messages().iter().map(|message| message.message.clone()).collect();
    let model = loaded.model.unwrap_or_else(|| panic!("{messages:?}"));
    describe(&model).expect("a system")
}

fn chain(cells: usize) -> String {
    format!(
        "
CTC Cell is
interface
  input(inp, signal); output(out, signal); knob(k, (0, 10), \"1/s\");
end interface;
body
  declarations state x := 0.5 \"m\"; end declarations;
  dynamics der(x) = k*(inp - x); end dynamics;
  output out = x; end output;
  assignments k : 2; end assignments;
end body;

SYSTEM Ring is
body
  components cell : Cell[{cells}]; end components;
  connections
    cell[{cells}].out -> cell[1].inp;
    for i in 1..{} loop cell[i].out -> cell[i+1].inp; end loop;
  end connections;
end body;
",
        cells - 1
    )
}

#[test]
fn copies_are_counted_and_coupling_is_measured() {
    let d = described(&chain(50));
    let tree: Vec<_> = d.components.iter().map(|c| (c.name.as_str(), c.kind, c.depth, c.copies)).collect();
    assert_eq!(tree, [("Ring", "SYSTEM", 0, 1), ("cell", "CTC", 1, 50)]);
    assert_eq!((d.states.len(), d.sizes.components), (50, 50));
    // Row i of a ring reads i and its predecessor; the first row reads the last column.
    let sparsity = d.sparsity.expect("counted");
    assert_eq!((sparsity.rows, sparsity.nonzeros, sparsity.least, sparsity.most), (50, 100, 2, 2));
    assert_eq!(sparsity.bandwidth, 49);
    assert_eq!(d.index, 0);
    let [knot] = d.knots.as_slice() else { panic!("{:?}", d.knots) };
    assert!(knot.size >= 50 && knot.members.len() == 12, "{knot:?}");
    let knob = d.constants.iter().find(|c| c.knob).expect("a knob");
    assert_eq!((knob.value, knob.unit.as_deref()), (Some(2.0), Some("1/s")));
    assert!(knob.range.is_some());
    assert_eq!((d.states[0].value, d.states[0].unit.as_deref()), (Some(0.5), Some("m")));
}

#[test]
fn one_hundred_thousand_copies_are_described_at_once() {
    let d = described(&chain(100_000));
    assert_eq!((d.components.len(), d.states.len()), (2, 100_000));
    assert_eq!(d.sparsity.map(|s| s.nonzeros), Some(200_000));
}

#[test]
fn clocks_and_reactions_are_described() {
    let d = described(
        "
DTC Sampler is
interface
  input(u, real); output(y, real);
end interface;
body
  declarations
    state held;
    tsample every Ts;
    tdelay 2e-4;
    priority 3;
  end declarations;
  initial held := 0; end initial;
  update held := u; end update;
  output y = held; end output;
  assignments Ts : 0.01; end assignments;
end body;

CTC Roll is
interface
  input(e, real); output(F, signal);
end interface;
body
  declarations flag S; mode m in {-1, 1} := 1; state x := 0; end declarations;
  dynamics der(x) = m - x; S = x + h*m; end dynamics;
  output F = x; end output;
  event(S)
    negative-to-positive m := 1; end negative-to-positive;
    positive-to-negative m := -1; end positive-to-negative;
  end event;
  assignments h : 5; end assignments;
end body;

SYSTEM Loop is
body
  components
    sampler : Sampler(Ts : 0.02);
    roll : Roll;
  end components;
  connections
    roll.F -> sampler.u;
    sampler.y -> roll.e;
  end connections;
end body;
",
    );
    let [clock] = d.clocks.as_slice() else { panic!("{:?}", d.clocks) };
    assert_eq!((clock.period, clock.delay, clock.priority), (Some(0.02), Some(2e-4), 3));
    let [roll] = d.automata.as_slice() else { panic!("{:?}", d.automata) };
    let when: Vec<&str> = roll.reactions.iter().map(|r| r.when.as_str()).collect();
    assert_eq!(when, ["S from negative to positive", "S from positive to negative"]);
    assert!(d.awaits.iter().any(|sentence| sentence.contains("discrete-time")), "{:?}", d.awaits);
}

/// The pendulum in Cartesian coordinates has index 3; with its constraint on the accelerations it has index 1.
#[test]
fn the_index_is_that_of_the_textbook() {
    let pendulum = |constraint: &str| {
        format!(
            "
CTC Pendulum is
interface output(x, signal); end interface;
body
  declarations
    state x := 1; state y := 0; state vx := 0; state vy := 0;
    local lambda;
  end declarations;
  dynamics
    der(x) = vx; der(y) = vy; der(vx) = -lambda*x; der(vy) = -lambda*y - 9.81;
  end dynamics;
  constraints
    {constraint}
  end constraints;
end body;
"
        )
    };
    assert_eq!(described(&pendulum("x^2 + y^2 = 1;")).index, 2);
    assert_eq!(described(&pendulum("vx^2 + vy^2 - lambda*(x^2 + y^2) = 9.81*y;")).index, 1);
}
