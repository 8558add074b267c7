//! The whole path from a flat system to callable equations.

use crate::automata::Owned;
use crate::blocks::Gather;
use crate::interpreter::{bound, enclose, run};
use crate::logic;
use crate::memory::Memory;
use crate::patterns::Tables;
use crate::shapes::{Emitter, Programs, Sharing};
use crate::watches::Watching;
use sophy_field::{Equations, InputIndex, Logic, ParameterIndex, StairCode, StateIndex};
use sophy_ir::{Evaluator, Leaf, Stair, System, Value};
use std::collections::BTreeMap;

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
    /// A guard has too many conditions.
    #[error(
        "the guard of transition `{transition}` has more than 65536 conditions, those of `if` counted twice"
    )]
    GuardTooLong {
        /// The transition.
        transition: String,
    },
}

/// Makes `system` callable for an engine that needs `order` derivatives of the states (1 for QSS1, 2 for
/// QSS2); `knobs` replace parameter values.
///
/// # Errors
/// [`CompileError`] when a parameter is not finite, or a guard or switch nests too deep.
pub fn compile(system: &System, knobs: &Parameters, order: u32) -> Result<Compiled, CompileError> {
    compile_sharing(system, knobs, order, Sharing::Usual)
}

/// [`compile`] with a say in when equal equations share a program; the bits of a run do not depend on it.
///
/// # Errors
/// Those of [`compile`].
pub fn compile_sharing(
    system: &System,
    knobs: &Parameters,
    order: u32,
    sharing: Sharing,
) -> Result<Compiled, CompileError> {
    let (mut evaluator, parameters) = parameter_values(system, knobs)?;
    let mut gather = Gather::new(system, order);

    // What is to be evaluated when …
    let sources = (0..system.states.len())
        .map(|i| Leaf::State(StateIndex::new(i)))
        .chain((0..system.inputs.len()).map(|i| Leaf::Input(InputIndex::new(i))))
        .chain([Leaf::Time]);
    let influence: Vec<_> = sources.map(|leaf| gather.influence(&[leaf])).collect();
    let own: Vec<_> = (0..system.states.len()).map(|s| gather.all_of([StateIndex::new(s)])).collect();
    let owned = Owned::new(system);
    let on_location: Vec<_> = (0..system.automata.len()).map(|a| owned.entries(&mut gather, a)).collect();
    let watching = Watching::new(&mut gather);
    let on_watch: Vec<_> = watching.decided().map(|decided| gather.influence(decided)).collect();
    let outputs: Vec<_> = system.outputs.iter().map(|y| gather.selected(y.value, true)).collect();
    let watches = watching.watched(&mut gather);
    let (mut logic, transitions) = logic::compile(&mut gather, &mut evaluator, &parameters)?;
    let automata = owned.automata(&mut gather, &watching);

    // … and by which programs.
    let (mut memory, shapes, mut gathered) = gather.finish();
    let equations = Equations {
        layout: memory.layout,
        stairs: system.stairs.iter().map(|stair| stair_code(system, &memory, stair)).collect(),
        watches_of_source: watching.of_sources(),
        ..Equations::none(run, enclose, bound)
    };
    let emitter = Emitter::new(system, &mut memory, shapes, sharing);
    let mut tables = Tables::new(system, &mut gathered, emitter, equations);
    tables.influences(&influence, &own);
    tables.outputs(&outputs);
    tables.watches(&watches, &on_watch);
    tables.automata(&automata, &on_location);
    (logic.transition_codes, logic.transitions) = tables.transitions(&transitions);
    let (mut equations, Programs { programs, temporaries, too_deep }) = tables.finish();
    if too_deep {
        return Err(CompileError::TooDeep { system: system.name.clone() });
    }
    // Room for reading a jet of any width at the last temporary.
    equations.layout.length = memory.end() + temporaries + 4;
    equations.image = image(system, &memory, &mut evaluator, &parameters, equations.layout.length);
    equations.programs = programs;
    equations.shrink_to_fit();
    Ok(Compiled { equations, logic, parameters })
}

/// Every parameter in order; those that a knob does not set are evaluated from earlier ones.
fn parameter_values(system: &System, knobs: &Parameters) -> Result<(Evaluator, Vec<f64>), CompileError> {
    let mut evaluator = Evaluator::default();
    let mut values: Vec<f64> = Vec::with_capacity(system.parameters.len());
    for (position, parameter) in system.parameters.iter().enumerate() {
        let value = match knobs.get(&ParameterIndex::new(position)) {
            Some(&knob) => knob,
            None => {
                let mut leaf = |leaf| parameter_leaf(leaf, &values);
                evaluator.value(&system.graph, parameter.value, &mut leaf).real()
            }
        };
        if !value.is_finite() {
            return Err(CompileError::Parameter { name: parameter.name.clone(), value });
        }
        values.push(value);
    }
    Ok((evaluator, values))
}

pub(crate) fn parameter_leaf(leaf: Leaf, values: &[f64]) -> Value {
    match leaf {
        Leaf::Parameter(i) => Value::Real(values.get(i.position()).copied().unwrap_or(f64::NAN)),
        _ => Value::Real(f64::NAN),
    }
}

fn stair_code(system: &System, memory: &Memory, stair: &Stair) -> StairCode {
    let knots = stair.knots.map_or(0..0, |column| {
        let first = memory.column(column) + 1;
        first..first + system.graph.numbers(column).len() as u32
    });
    StairCode { watches: [stair.lower, stair.upper], knots }
}

/// Memory behind the records at the start: parameters, columns and the pool of numbers and parametric expressions.
fn image(
    system: &System,
    memory: &Memory,
    evaluator: &mut Evaluator,
    parameters: &[f64],
    length: u32,
) -> Vec<f64> {
    let rest = memory.layout.rest;
    let mut image = vec![0.0; (length - rest) as usize];
    let first = (memory.parameters - rest) as usize;
    image[first..first + parameters.len()].copy_from_slice(parameters);
    for (&at, column) in memory.columns.iter().zip(system.graph.columns()) {
        let numbers = &column.numbers;
        let at = (at - rest) as usize;
        image[at] = numbers.len() as f64;
        image[at + 1..][..numbers.len()].copy_from_slice(numbers);
    }
    for (position, &node) in memory.pooled.iter().enumerate() {
        let mut leaf = |leaf| parameter_leaf(leaf, parameters);
        image[(memory.pool - rest) as usize + position] =
            evaluator.value(&system.graph, node, &mut leaf).real();
    }
    image
}
