//! The whole path from a flat system to callable equations.

use crate::automata::Owned;
use crate::blocks::Gather;
use crate::interpreter::{enclose, run};
use crate::logic;
use crate::memory::Memory;
use crate::patterns::Blocks;
use crate::shapes::{Answer, Emitter, Programs, RequestIndex, Sharing};
use crate::watches::Watching;
use sophy_field::{
    Affine, Call, Equations, Formula, InputIndex, Logic, ParameterIndex, StairCode, StateIndex,
};
use sophy_ir::{Evaluator, Leaf, Stair, System, Value};
use std::collections::BTreeMap;
use std::sync::OnceLock;

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
    let on_location = (0..system.automata.len()).map(|a| owned.entries(&mut gather, a)).collect();
    let watching = Watching::new(&mut gather);
    let on_watch = watching.decided().map(|decided| gather.influence(decided)).collect();
    let outputs = system.outputs.iter().map(|y| gather.selected(y.value, true)).collect();
    let watches = watching.codes(&mut gather);
    let mut logic = logic::compile(&mut gather, &mut evaluator, &parameters)?;
    let automata = owned.automata(&mut gather, &watching);

    // … and by which programs.
    let (mut memory, shapes, mut gathered) = gather.finish();
    let mut equations = Equations {
        layout: memory.layout,
        image: Vec::new(),
        run,
        enclose,
        programs: Vec::new(),
        kernels: OnceLock::new(),
        operands: Vec::new(),
        calls: std::mem::take(&mut gathered.calls),
        blocks: Vec::new(),
        reads: Vec::new(),
        rows: Vec::new(),
        evaluations: Vec::new(),
        influences: Vec::new(),
        sites: Vec::new(),
        turns: Vec::new(),
        on_location: Vec::new(),
        on_watch: Vec::new(),
        sources: Vec::new(),
        entries: Vec::new(),
        automata,
        watches,
        stairs: system.stairs.iter().map(|stair| stair_code(system, &memory, stair)).collect(),
        watches_of_source: watching.of_sources(),
        formulas: std::mem::take(&mut gathered.formulas),
        outputs,
    };
    let mut emitter = Emitter::new(system, &mut memory, shapes, sharing);
    let blocks = Blocks::new(system, &mut gathered, &mut emitter, &mut equations);
    equations.on_location = blocks.turns(&gathered.entries, on_location, &mut equations.turns);
    equations.on_watch = blocks.turns(&gathered.entries, on_watch, &mut equations.turns);
    blocks.influences(system, &gathered.entries, &influence, &own, &mut equations);
    equations.sources = gathered.sources;
    equations.entries = gathered.before;
    let (mut answer, operands) = (Answer::default(), &mut equations.operands);
    let mut place = |call: &mut Call| {
        emitter.answer(RequestIndex(call.program), &mut answer);
        let start = operands.len() as u32;
        operands.extend(answer.operands.iter().map(|&operand| Affine::fixed(operand)));
        *call = Call { program: answer.program, operands: start..operands.len() as u32 };
        answer.results.first().copied()
    };
    for call in &mut equations.calls {
        place(call);
    }
    let mut place = |formula: &mut Formula| {
        formula.result = place(&mut formula.call).unwrap_or(formula.result);
    };
    equations.formulas.iter_mut().for_each(&mut place);
    for watch in &mut equations.watches {
        [&mut watch.formula, &mut watch.left, &mut watch.right].into_iter().for_each(&mut place);
    }
    for transition in &mut logic.transitions {
        transition.resets.iter_mut().for_each(|(_, formula)| place(formula));
        transition.emits.iter_mut().filter_map(|emission| emission.when.as_mut()).for_each(&mut place);
    }
    let Programs { programs, temporaries, too_deep } = emitter.finish();
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
