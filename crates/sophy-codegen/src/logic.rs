//! Transitions: guards become postfix combinations of signs, resets become formulas.

use crate::blocks::Gather;
use crate::compile::signs_of;
use sophy_field::{AutomatonIndex, Guard, GuardStep, Logic, TransitionCode, TriggerCode};
use sophy_ir::{FlatTrigger, Leaf, Node, NodeId, System, Value, evaluate};

/// A guard nests too many conditions.
pub(crate) struct LogicError {
    pub(crate) transition: String,
}

pub(crate) fn compile(gather: &mut Gather<'_>, parameters: &[f64]) -> Result<Logic, LogicError> {
    let system = gather.system;
    let mut logic = Logic {
        receivers: system.events.iter().map(|e| e.receiver.automaton).collect(),
        outgoing: system
            .automata
            .iter()
            .map(|a| a.locations.iter().map(|l| l.transitions.clone()).collect())
            .collect(),
        ..Logic::default()
    };
    let mut readers: Vec<Vec<AutomatonIndex>> = vec![Vec::new(); system.watches.len()];
    for transition in &system.transitions {
        let mut guard = Guard::default();
        match transition.trigger.guard() {
            Some(node) => guard_steps(system, node, parameters, &mut guard.steps),
            None => guard.steps.push(GuardStep::Constant(true)),
        }
        if guard.depth() > 64 {
            return Err(LogicError { transition: transition.name.clone() });
        }
        for watch in guard.watches() {
            let automata = &mut readers[watch.position()];
            if !automata.contains(&transition.automaton) {
                automata.push(transition.automaton);
            }
        }
        let trigger = match &transition.trigger {
            FlatTrigger::When(_) => TriggerCode::When(guard),
            FlatTrigger::On { events, .. } => TriggerCode::On(events.clone(), guard),
        };
        let resets =
            transition.resets.iter().map(|reset| (reset.state, gather.formula(reset.value, true))).collect();
        logic.transitions.push(TransitionCode {
            automaton: transition.automaton,
            source: transition.source,
            destination: transition.destination,
            trigger,
            resets,
            emits: transition.emits.iter().flat_map(|(_, receivers)| receivers.iter().copied()).collect(),
            priority: transition.priority,
        });
    }
    logic.automata_of_watch = readers;
    Ok(logic)
}

fn guard_steps(system: &System, node: NodeId, parameters: &[f64], steps: &mut Vec<GuardStep>) {
    if system.is_parametric(node) {
        let mut leaf = |leaf: Leaf| match leaf {
            Leaf::Parameter(i) => Value::Real(parameters.get(i.position()).copied().unwrap_or(f64::NAN)),
            _ => Value::Real(f64::NAN),
        };
        steps.push(GuardStep::Constant(evaluate(&system.graph, node, &mut leaf).boolean()));
        return;
    }
    match system.graph.node(node) {
        Node::Leaf(Leaf::Truth(i)) => {
            let truth = system.truths[i.position()];
            steps.push(GuardStep::Sign(truth.watch, signs_of(truth.comparison)));
        }
        Node::Not(a) => {
            guard_steps(system, a, parameters, steps);
            steps.push(GuardStep::Not);
        }
        Node::And(a, b) => pair(system, [a, b], parameters, steps, GuardStep::And),
        Node::Or(a, b) => pair(system, [a, b], parameters, steps, GuardStep::Or),
        // if c then a else b = (c and a) or (not c and b)
        Node::Select(c, a, b) => {
            pair(system, [c, a], parameters, steps, GuardStep::And);
            guard_steps(system, c, parameters, steps);
            steps.push(GuardStep::Not);
            guard_steps(system, b, parameters, steps);
            steps.push(GuardStep::And);
            steps.push(GuardStep::Or);
        }
        // A number used as a condition does not pass the checks.
        _ => steps.push(GuardStep::Constant(false)),
    }
}

fn pair(
    system: &System,
    [a, b]: [NodeId; 2],
    parameters: &[f64],
    steps: &mut Vec<GuardStep>,
    join: GuardStep,
) {
    guard_steps(system, a, parameters, steps);
    guard_steps(system, b, parameters, steps);
    steps.push(join);
}
