//! The whole path from a flat system to callable equations.

use crate::blocks::Gather;
use crate::interpreter::{enclose, run};
use crate::logic::{self, LogicError};
use crate::programs::{Memory, source_of};
use sophy_field::{
    AlgebraicIndex, AutomatonCode, Equations, Formula, Logic, ParameterIndex, Selected, SourceIndex,
    StairIndex, StateIndex, TruthIndex, WatchCode, WatchIndex, sign_bit,
};
use sophy_ir::{Affine, Comparison, Leaf, NodeId, Row, System, Value, evaluate};
use sophy_segment::Sign;
use std::collections::{BTreeMap, BTreeSet};

/// Callable equations and transitions of one system with one set of parameter values.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// Read by engines.
    pub equations: Equations,
    /// Read by the hybrid logic.
    pub logic: Logic,
    /// Value of every parameter.
    pub parameters: Vec<f64>,
}

/// Values of knobs that replace those of the model.
pub type Parameters = BTreeMap<ParameterIndex, f64>;

/// A system cannot be made callable.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// A parameter has no finite value.
    #[error("parameter `{name}` is {value}")]
    Parameter {
        /// Its name.
        name: String,
        /// What came out.
        value: f64,
    },
    /// Switches (`if`, `min`, `abs`, …) nest too deep.
    #[error("switches (`if`, `min`, `max`, `abs`, …) nest deeper than 256 somewhere in `{system}`")]
    TooDeep {
        /// The system.
        system: String,
    },
    /// A guard combines more comparisons than can be kept.
    #[error("the guard of transition `{transition}` nests more than 64 conditions")]
    GuardTooDeep {
        /// The transition.
        transition: String,
    },
}

impl From<LogicError> for CompileError {
    fn from(LogicError { transition }: LogicError) -> Self {
        CompileError::GuardTooDeep { transition }
    }
}

/// Makes `system` callable for an engine that needs `order` derivatives of the states (1 for QSS1, 2 for
/// QSS2); `knobs` replace parameter values.
///
/// # Errors
/// [`CompileError`] when a parameter is not finite, or a guard or switch nests too deep.
pub fn compile(system: &System, knobs: &Parameters, order: u32) -> Result<Compiled, CompileError> {
    let parameters = parameter_values(system, knobs)?;
    let mut system = system.clone();
    let bends = bends(&mut system, order);
    let system = &system;
    let mut gather = Gather::new(system, order + 1, bends);

    let source_leaves: Vec<Leaf> = (0..system.states.len())
        .map(|i| Leaf::State(StateIndex::new(i)))
        .chain((0..system.inputs.len()).map(|i| Leaf::Input(sophy_field::InputIndex::new(i))))
        .chain([Leaf::Time])
        .collect();
    let influence = source_leaves.iter().map(|&leaf| gather.influence(&[leaf])).collect();
    let own = (0..system.states.len()).map(|s| gather.all_of([StateIndex::new(s)])).collect();
    let on_location = (0..system.automata.len()).map(|a| location_entries(&mut gather, a)).collect();
    let deciders = Deciders::new(&gather);
    let on_watch = deciders.decided.iter().map(|decided| gather.influence(decided)).collect();
    let rates = system.states.iter().map(|s| gather.selected(&s.rate, false)).collect();
    let outputs = system.outputs.iter().map(|y| gather.selected(&y.value, true)).collect();
    let watches: Vec<WatchCode> =
        (0..system.watches.len()).map(|w| watch(&mut gather, &deciders, WatchIndex::new(w))).collect();
    let logic = logic::compile(&mut gather, &parameters)?;
    let automata = automata(&gather);
    let watches_of_source = watches_of_source(&gather);

    let Gather { mut memory, mut programs, blocks, sources, mut rows, entries, .. } = gather;
    if memory.too_deep {
        return Err(CompileError::TooDeep { system: system.name.clone() });
    }
    memory.finish(&mut programs);
    for row in &mut rows {
        row.result = memory.place(row.result);
    }
    let mut equations = Equations {
        layout: memory.layout,
        image: image(system, &memory, &parameters),
        run,
        enclose,
        programs,
        blocks,
        sources,
        rows,
        entries,
        influence,
        own,
        on_location,
        on_watch,
        automata,
        watches,
        watches_of_source,
        rates,
        outputs,
    };
    let mut logic = logic;
    place_formulas(&memory, &mut equations, &mut logic);
    Ok(Compiled { equations, logic, parameters })
}

/// Every parameter in order; those that a knob does not set are evaluated from earlier ones.
fn parameter_values(system: &System, knobs: &Parameters) -> Result<Vec<f64>, CompileError> {
    let mut values: Vec<f64> = Vec::with_capacity(system.parameters.len());
    for (position, parameter) in system.parameters.iter().enumerate() {
        let value = match knobs.get(&ParameterIndex::new(position)) {
            Some(&knob) => knob,
            None => {
                evaluate(&system.graph, parameter.value, &mut |leaf| parameter_leaf(leaf, &values)).real()
            }
        };
        if !value.is_finite() {
            return Err(CompileError::Parameter { name: parameter.name.clone(), value });
        }
        values.push(value);
    }
    Ok(values)
}

fn parameter_leaf(leaf: Leaf, values: &[f64]) -> Value {
    match leaf {
        Leaf::Parameter(i) => Value::Real(values.get(i.position()).copied().unwrap_or(f64::NAN)),
        _ => Value::Real(f64::NAN),
    }
}

/// Where, between events, a rate is not the polynomial that an engine of this order takes it for: an
/// engine of order 1 holds it constant (so inputs and time bend it), one of order 2 linear.
fn bends(system: &mut System, order: u32) -> Vec<Vec<bool>> {
    let rows: Vec<Row> = system.states.iter().map(|s| s.rate.clone()).collect();
    rows.iter()
        .map(|row| {
            row.by_location
                .iter()
                .map(|&node| match order {
                    1 => system
                        .row_sources(&Row { owner: row.owner, by_location: vec![node], spans: vec![None] })
                        .iter()
                        .any(|leaf| matches!(leaf, Leaf::Input(_) | Leaf::Time)),
                    _ => !is_affine(system, node),
                })
                .collect()
        })
        .collect()
}

fn is_affine(system: &mut System, node: NodeId) -> bool {
    let form: Option<Affine> = system.graph.affine(node, &|leaf| {
        matches!(leaf, Leaf::State(_) | Leaf::Input(_) | Leaf::Time | Leaf::Algebraic(_))
    });
    let Some(form) = form else { return false };
    form.terms.keys().all(|leaf| match leaf {
        Leaf::Algebraic(z) => {
            let nodes = system.algebraics[z.position()].value.by_location.clone();
            nodes.into_iter().all(|node| is_affine(system, node))
        }
        _ => true,
    })
}

/// What to evaluate when an automaton changes its location: its own rates, and those of others that read its
/// algebraic variables.
fn location_entries(gather: &mut Gather<'_>, automaton: usize) -> std::ops::Range<u32> {
    let system = gather.system;
    let mut states: BTreeSet<StateIndex> = (0..system.states.len())
        .filter(|&s| system.states[s].rate.owner.position() == automaton)
        .map(StateIndex::new)
        .collect();
    for (z, algebraic) in system.algebraics.iter().enumerate() {
        if algebraic.value.owner.position() == automaton {
            let readers = gather.readers.get(&Leaf::Algebraic(AlgebraicIndex::new(z)));
            states.extend(readers.into_iter().flatten().map(|(state, _)| *state));
        }
    }
    gather.all_of(states)
}

/// Who decides what, and who reads it.
struct Deciders {
    /// Per watch: the truths and stairs it decides.
    decided: Vec<Vec<Leaf>>,
    /// Per watch: the watches that read what it decides.
    dependents: Vec<Vec<WatchIndex>>,
    /// Per watch: whether a guard reads what it decides.
    guards: Vec<bool>,
}

impl Deciders {
    fn new(gather: &Gather<'_>) -> Self {
        let system = gather.system;
        let count = system.watches.len();
        let mut decided = vec![Vec::new(); count];
        for (i, truth) in system.truths.iter().enumerate() {
            decided[truth.watch.position()].push(Leaf::Truth(TruthIndex::new(i)));
        }
        for (i, stair) in system.stairs.iter().enumerate() {
            for watch in [stair.lower, stair.upper] {
                decided[watch.position()].push(Leaf::Stair(StairIndex::new(i)));
            }
        }
        let deciders = |leaf: Leaf| match leaf {
            Leaf::Truth(i) => vec![system.truths[i.position()].watch],
            Leaf::Stair(i) => {
                vec![system.stairs[i.position()].lower, system.stairs[i.position()].upper]
            }
            _ => Vec::new(),
        };
        let mut dependents = vec![Vec::new(); count];
        for (position, watch) in system.watches.iter().enumerate() {
            let read: BTreeSet<WatchIndex> =
                gather.closure([watch.difference]).into_iter().flat_map(deciders).collect();
            for decider in read {
                dependents[decider.position()].push(WatchIndex::new(position));
            }
        }
        let mut guards = vec![false; count];
        for guard in system.transitions.iter().filter_map(|t| t.trigger.guard()) {
            for decider in system.graph.dependencies([guard]).into_iter().flat_map(deciders) {
                guards[decider.position()] = true;
            }
        }
        Deciders { decided, dependents, guards }
    }
}

/// The signs of `left − right` for which a comparison holds.
pub(crate) fn signs_of(comparison: Comparison) -> u8 {
    let (minus, zero, plus) = (sign_bit(Sign::Negative), sign_bit(Sign::Zero), sign_bit(Sign::Positive));
    match comparison {
        Comparison::Less => minus,
        Comparison::LessEqual => minus | zero,
        Comparison::Greater => plus,
        Comparison::GreaterEqual => plus | zero,
        Comparison::Equal => zero,
        Comparison::NotEqual => minus | plus,
    }
}

fn watch(gather: &mut Gather<'_>, deciders: &Deciders, index: WatchIndex) -> WatchCode {
    let system = gather.system;
    let watch = &system.watches[index.position()];
    let decided = &deciders.decided[index.position()];
    let truths = decided.iter().filter_map(|leaf| match leaf {
        Leaf::Truth(i) => Some((i.0, signs_of(system.truths[i.position()].comparison))),
        _ => None,
    });
    let stair = decided.iter().find_map(|leaf| match leaf {
        Leaf::Stair(i) => {
            let step = if system.stairs[i.position()].lower == index { -1.0 } else { 1.0 };
            Some((i.0, step))
        }
        _ => None,
    });
    WatchCode {
        truths: truths.collect(),
        stair,
        dependents: deciders.dependents[index.position()].clone(),
        guard: deciders.guards[index.position()],
        affine: watch.affine,
        formula: gather.formula(watch.difference, false),
        left: gather.formula(watch.left, false),
        right: gather.formula(watch.right, false),
    }
}

fn automata(gather: &Gather<'_>) -> Vec<AutomatonCode> {
    let system = gather.system;
    system
        .automata
        .iter()
        .enumerate()
        .map(|(a, automaton)| {
            let states: Vec<StateIndex> = (0..system.states.len())
                .filter(|&s| system.states[s].rate.owner.position() == a)
                .map(StateIndex::new)
                .collect();
            let locations = 0..automaton.locations.len();
            AutomatonCode {
                readers: readers_of(gather, a),
                armed: locations.clone().map(|l| armed_in(gather, a, l)).collect(),
                row_of: locations
                    .map(|l| {
                        let node = |s: &StateIndex| system.states[s.position()].rate.by_location[l];
                        states.iter().map(|s| node(s).position() as u32).collect()
                    })
                    .collect(),
                states,
            }
        })
        .collect()
}

/// Watches that read an algebraic variable of an automaton.
fn readers_of(gather: &Gather<'_>, automaton: usize) -> Vec<WatchIndex> {
    let system = gather.system;
    let owned = |leaf: &Leaf| match leaf {
        Leaf::Algebraic(z) => system.algebraics[z.position()].value.owner.position() == automaton,
        _ => false,
    };
    let watches = system.watches.iter().enumerate();
    watches
        .filter(|(_, watch)| gather.closure([watch.difference]).iter().any(owned))
        .map(|(position, _)| WatchIndex::new(position))
        .collect()
}

/// Watches that a location needs: those of its guards and of the switches in the rows it selects.
fn armed_in(gather: &Gather<'_>, automaton: usize, location: usize) -> Vec<WatchIndex> {
    let system = gather.system;
    let rows = system
        .states
        .iter()
        .map(|s| &s.rate)
        .chain(system.algebraics.iter().map(|z| &z.value))
        .filter(|row| row.owner.position() == automaton)
        .map(|row| row.by_location[location]);
    let outgoing = system.automata[automaton].locations[location].transitions.iter();
    let guards = outgoing.filter_map(|t| system.transitions[t.position()].trigger.guard());
    gather.watches_below(rows.chain(guards)).into_iter().collect()
}

fn watches_of_source(gather: &Gather<'_>) -> Vec<Vec<WatchIndex>> {
    let layout = gather.memory.layout;
    let mut by_source = vec![Vec::new(); layout.sources()];
    for (w, watch) in gather.system.watches.iter().enumerate() {
        let sources: BTreeSet<SourceIndex> = gather
            .closure([watch.difference])
            .into_iter()
            .filter_map(|leaf| source_of(leaf, layout))
            .collect();
        for source in sources {
            by_source[source.position()].push(WatchIndex::new(w));
        }
    }
    by_source
}

/// Memory at the start: parameters and the pool of numbers and parametric expressions.
fn image(system: &System, memory: &Memory, parameters: &[f64]) -> Vec<f64> {
    let mut image = vec![0.0; memory.layout.length as usize];
    let first = memory.parameters as usize;
    image[first..first + parameters.len()].copy_from_slice(parameters);
    for (position, &node) in memory.pooled.iter().enumerate() {
        image[memory.pool as usize + position] =
            evaluate(&system.graph, node, &mut |leaf| parameter_leaf(leaf, parameters)).real();
    }
    image
}

/// Results of formulas get their final places once memory is laid out.
fn place_formulas(memory: &Memory, equations: &mut Equations, logic: &mut Logic) {
    let place = |formula: &mut Formula| formula.result = memory.place(formula.result);
    let all = |selected: &mut Selected| selected.by_location.iter_mut().for_each(place);
    equations.rates.iter_mut().for_each(all);
    equations.outputs.iter_mut().for_each(all);
    for watch in &mut equations.watches {
        place(&mut watch.formula);
        place(&mut watch.left);
        place(&mut watch.right);
    }
    for transition in &mut logic.transitions {
        transition.resets.iter_mut().for_each(|(_, formula)| place(formula));
        transition.emits.iter_mut().filter_map(|emission| emission.when.as_mut()).for_each(place);
    }
}
