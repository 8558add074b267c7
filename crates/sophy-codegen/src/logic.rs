//! Transitions: guards become postfix combinations of signs, resets become formulas.

use crate::blocks::Gather;
use crate::blocks::Wanted;
use crate::compile::{CompileError, parameter_leaf};
use crate::repeats::{Draft, Reading};
use crate::watches::signs_of;
use rustc_hash::FxHashMap;
use sophy_field::{
    Affine, AutomatonIndex, AutomatonLogic, EmissionCode, EventIndex, Formula, Guard, GuardStep,
    LocationIndex, Logic, StateIndex, Table, TransitionCode, TriggerCode,
};
use sophy_ir::{Evaluator, FlatTrigger, Leaf, Node, NodeId, Role};

/// The most steps of a guard: what several of its parts share is written several times.
const MOST_STEPS: usize = 1 << 16;

/// What a transition emits: who receives it, and on what condition.
type Emits = (Box<[EventIndex]>, Option<Wanted>);

/// A transition, as [`TransitionCode`] has it.
#[derive(Clone, Debug)]
pub(crate) struct Leads {
    automaton: AutomatonIndex,
    source: LocationIndex,
    destination: LocationIndex,
    /// The events that trigger it, if it is triggered by events.
    events: Option<Box<[EventIndex]>>,
    guard: Guard,
    resets: Box<[(StateIndex, Wanted)]>,
    emits: Box<[Emits]>,
    priority: i32,
    silent: bool,
}

impl Leads {
    /// Writes it down; `formula` does so with its formulas.
    pub(crate) fn write(&self, draft: &mut Draft, mut formula: impl FnMut(&Wanted, &mut Draft)) {
        draft.number(self.automaton.0);
        draft.forms([self.source, self.destination].map(|location| location.0));
        draft.form(self.priority.cast_unsigned());
        draft.form(u32::from(self.silent));
        draft.count(usize::from(self.events.is_some()));
        if let Some(events) = &self.events {
            draft.numbers(events.iter().map(|event| event.0));
        }
        draft.count(self.guard.steps.len());
        for step in &self.guard.steps {
            write_step(*step, draft);
        }
        draft.count(self.resets.len());
        for (state, value) in &self.resets {
            draft.number(state.0);
            formula(value, draft);
        }
        draft.count(self.emits.len());
        for (receivers, when) in &self.emits {
            draft.numbers(receivers.iter().map(|event| event.0));
            draft.count(usize::from(when.is_some()));
            if let Some(when) = when {
                formula(when, draft);
            }
        }
    }
}

/// What [`Leads::write`] wrote.
pub(crate) fn read_transition(
    reading: &mut Reading<'_>,
    mut formula: impl FnMut(&mut Reading<'_>) -> Formula,
) -> TransitionCode {
    let automaton = reading.number();
    let [source, destination] = reading.forms().map(LocationIndex);
    let (priority, silent) = (reading.form().cast_signed(), reading.form() != 0);
    let events = reading.several(|reading| reading.numbers().collect()).pop();
    let guard = Guard { steps: reading.several(read_step) };
    TransitionCode {
        automaton,
        source,
        destination,
        priority,
        silent,
        trigger: match events {
            Some(events) => TriggerCode::On(events, guard),
            None => TriggerCode::When(guard),
        },
        resets: reading.several(|reading| (reading.number(), formula(reading))),
        emits: reading.several(|reading| EmissionCode {
            receivers: reading.numbers().collect(),
            when: reading.several(&mut formula).pop(),
        }),
    }
}

fn write_step(step: GuardStep, draft: &mut Draft) {
    let code = match step {
        GuardStep::Constant(value) => u32::from(value),
        GuardStep::Not => 2,
        GuardStep::And => 3,
        GuardStep::Or => 4,
        GuardStep::Sign(watch, signs) => {
            draft.number(watch.first);
            SIGNS + u32::from(signs)
        }
    };
    draft.form(code);
}

/// What [`write_step`] wrote.
fn read_step(reading: &mut Reading<'_>) -> GuardStep {
    match reading.form() {
        0 => GuardStep::Constant(false),
        1 => GuardStep::Constant(true),
        2 => GuardStep::Not,
        3 => GuardStep::And,
        4 => GuardStep::Or,
        signs => GuardStep::Sign(reading.number(), (signs - SIGNS) as u8),
    }
}

/// Behind the codes of the other steps.
const SIGNS: u32 = 8;

/// What the hybrid logic knows of automata and events, and all transitions.
pub(crate) fn compile(
    gather: &mut Gather<'_>,
    evaluator: &mut Evaluator,
    parameters: &[f64],
) -> Result<(Logic, Vec<Leads>), CompileError> {
    let system = gather.system;
    let mut logic =
        Logic { receivers: system.events.iter().map(|e| e.receiver.automaton).collect(), ..Logic::default() };
    let mut known = FxHashMap::default();
    for automaton in system.automata.iter() {
        let code = *known.entry(automaton.kind.address()).or_insert_with(|| {
            let locations = automaton.kind.locations.iter();
            logic.automaton_codes.push(AutomatonLogic {
                outgoing: locations.map(|location| location.transitions.as_slice().into()).collect(),
                follows_flag: automaton.kind.role == Role::Flag,
            });
            logic.automaton_codes.len() as u32 - 1
        });
        logic.automata.push((code, automaton.first));
    }
    logic.automata.shrink_to_fit();
    let mut readers: Vec<(u32, AutomatonIndex)> = Vec::new();
    let mut transitions = Vec::with_capacity(system.transitions.len());
    for transition in system.transitions.iter() {
        let mut guard = Guard::default();
        match transition.trigger.guard() {
            Some(node) => guard_steps(gather, evaluator, node, parameters, &mut guard.steps),
            None => guard.steps.push(GuardStep::Constant(true)),
        }
        if guard.steps.len() >= MOST_STEPS {
            return Err(CompileError::GuardTooLong { transition: transition.name.to_string() });
        }
        if guard.depth() > 64 {
            return Err(CompileError::GuardTooDeep { transition: transition.name.to_string() });
        }
        readers.extend(guard.steps.iter().filter_map(|step| match step {
            GuardStep::Sign(watch, _) => Some((watch.first, transition.automaton)),
            _ => None,
        }));
        let events = match &transition.trigger {
            FlatTrigger::When(_) => None,
            FlatTrigger::On { events, .. } => Some(events.as_slice().into()),
        };
        let resets =
            transition.resets.iter().map(|reset| (reset.state, gather.formula(reset.value, true))).collect();
        let emits = transition
            .emits
            .iter()
            .map(|emission| {
                let when = emission.when.map(|when| gather.formula(when, true));
                (emission.receivers.as_slice().into(), when)
            })
            .collect();
        transitions.push(Leads {
            automaton: transition.automaton,
            source: transition.source,
            destination: transition.destination,
            events,
            guard,
            resets,
            emits,
            priority: transition.priority,
            silent: transition.silent,
        });
    }
    readers.sort_unstable();
    readers.dedup();
    logic.automata_of_watch = Table::from_pairs(system.watches.len(), &readers);
    Ok((logic, transitions))
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
                let truth = system.truths.at(i.position());
                steps.push(GuardStep::Sign(Affine::fixed(truth.watch.0), signs_of(truth.comparison)));
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
