//! Transitions: guards become postfix combinations of signs, resets become formulas.

use crate::blocks::Gather;
use crate::compile::{CompileError, parameter_leaf};
use crate::watches::signs_of;
use sophy_field::{
    AutomatonIndex, EmissionCode, Guard, GuardStep, LocationIndex, Logic, Table, TransitionCode, TriggerCode,
};
use sophy_ir::{Evaluator, FlatTrigger, Leaf, Node, NodeId, Role};

/// The most steps of a guard: what several of its parts share is written several times.
const MOST_STEPS: usize = 1 << 16;

pub(crate) fn compile(
    gather: &mut Gather<'_>,
    evaluator: &mut Evaluator,
    parameters: &[f64],
) -> Result<Logic, CompileError> {
    let system = gather.system;
    let mut logic = Logic {
        receivers: system.events.iter().map(|e| e.receiver.automaton).collect(),
        follows_flag: system.automata.iter().map(|a| a.kind.role == Role::Flag).collect(),
        ..Logic::default()
    };
    let mut locations = 0;
    for automaton in &system.automata {
        logic.first_location.push(locations);
        let count = automaton.kind.locations.len();
        locations += count as u32;
        (0..count).for_each(|l| logic.outgoing.push(automaton.outgoing(LocationIndex::new(l))));
    }
    logic.outgoing.shrink_to_fit();
    logic.first_location.shrink_to_fit();
    let mut readers: Vec<(u32, AutomatonIndex)> = Vec::new();
    for transition in &system.transitions {
        let mut guard = Guard::default();
        match transition.trigger.guard() {
            Some(node) => guard_steps(gather, evaluator, node, parameters, &mut guard.steps),
            None => guard.steps.push(GuardStep::Constant(true)),
        }
        if guard.steps.len() >= MOST_STEPS {
            return Err(CompileError::GuardTooLong { transition: transition.name.clone() });
        }
        if guard.depth() > 64 {
            return Err(CompileError::GuardTooDeep { transition: transition.name.clone() });
        }
        readers.extend(guard.watches().map(|watch| (watch.0, transition.automaton)));
        let trigger = match &transition.trigger {
            FlatTrigger::When(_) => TriggerCode::When(guard),
            FlatTrigger::On { events, .. } => TriggerCode::On(events.clone(), guard),
        };
        let resets =
            transition.resets.iter().map(|reset| (reset.state, gather.formula(reset.value, true))).collect();
        let emits = transition
            .emits
            .iter()
            .map(|emission| EmissionCode {
                receivers: emission.receivers.clone(),
                when: emission.when.map(|when| gather.formula(when, true)),
            })
            .collect();
        logic.transitions.push(TransitionCode {
            automaton: transition.automaton,
            source: transition.source,
            destination: transition.destination,
            trigger,
            resets,
            emits,
            priority: transition.priority,
            silent: transition.silent,
        });
    }
    readers.sort_unstable();
    readers.dedup();
    logic.automata_of_watch = Table::from_pairs(system.watches.len(), &readers);
    Ok(logic)
}

/// What is still to be written of a guard.
enum Task {
    Visit(NodeId),
    Write(GuardStep),
}

/// A guard in postfix form, by a stack of its own: conditions may be chained up to [`MOST_STEPS`].
fn guard_steps(
    gather: &Gather<'_>,
    evaluator: &mut Evaluator,
    root: NodeId,
    parameters: &[f64],
    steps: &mut Vec<GuardStep>,
) {
    let system = gather.system;
    let mut tasks = vec![Task::Visit(root)];
    while let Some(task) = tasks.pop() {
        if steps.len() >= MOST_STEPS {
            return;
        }
        let node = match task {
            Task::Write(step) => {
                steps.push(step);
                continue;
            }
            Task::Visit(node) => node,
        };
        // Tasks are taken from the end.
        match system.graph.node(node) {
            Node::Leaf(Leaf::Truth(i)) => {
                let truth = system.truths[i.position()];
                steps.push(GuardStep::Sign(truth.watch, signs_of(truth.comparison)));
            }
            Node::Not(a) => tasks.extend([Task::Write(GuardStep::Not), Task::Visit(a)]),
            Node::And(a, b) => {
                tasks.extend([Task::Write(GuardStep::And), Task::Visit(b), Task::Visit(a)]);
            }
            Node::Or(a, b) => tasks.extend([Task::Write(GuardStep::Or), Task::Visit(b), Task::Visit(a)]),
            // if c then a else b = (c and a) or (not c and b)
            Node::Select(c, a, b) => tasks.extend([
                Task::Write(GuardStep::Or),
                Task::Write(GuardStep::And),
                Task::Visit(b),
                Task::Write(GuardStep::Not),
                Task::Visit(c),
                Task::Write(GuardStep::And),
                Task::Visit(a),
                Task::Visit(c),
            ]),
            _ if gather.memory.is_parametric(node) => {
                let mut leaf = |leaf| parameter_leaf(leaf, parameters);
                let value = evaluator.value(&system.graph, node, &mut leaf).boolean();
                steps.push(GuardStep::Constant(value));
            }
            // A number used as a condition does not pass the checks.
            _ => steps.push(GuardStep::Constant(false)),
        }
    }
}
