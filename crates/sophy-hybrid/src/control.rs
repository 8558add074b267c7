use crate::error::HybridError;
use crate::livelock::Livelock;
use crate::worklist::Worklist;
use crate::zeno::{Accumulation, Zeno};
use sophy_field::{
    Changes, Engine, Equations, EventIndex, Journal, Logic, Record, TransitionIndex, TriggerCode, WatchIndex,
};
use std::collections::VecDeque;

/// One transition taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken {
    /// The instant, s.
    pub time: f64,
    /// The micro-step, from 0.
    pub step: u32,
    /// The transition.
    pub transition: TransitionIndex,
}

/// Counts since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Transitions taken.
    pub transitions: u64,
    /// Instants with at least one micro-step.
    pub instants: u64,
    /// Events that no transition was waiting for.
    pub unused_events: u64,
}

/// Hybrid location control (thesis §8.3.2): the discrete half of a run.
///
/// **Micro-steps.** At an instant, micro-steps n = 0, 1, 2 … are taken until nothing is enabled. Each takes
/// the most urgent group that has something: (0) changes scheduled for the instant (inputs), (1) transitions
/// whose guard holds, of each automaton at most one, only those of the smallest priority number; (2) events,
/// one per receiver. All right-hand sides of a micro-step read the values before it. Guards are level-triggered:
/// they count while they hold, also on entry and at the start.
#[derive(Clone, Debug)]
pub struct Control {
    /// Events waiting, per automaton, and the automata for which some wait.
    queues: Vec<VecDeque<EventIndex>>,
    waiting: Worklist,
    /// Automata whose guards must be looked at.
    stale: Worklist,
    zeno: Vec<Zeno>,
    /// Memory for resets.
    memory: Vec<f64>,
    /// Watches that changed, transitions of a micro-step, and what they change; kept for their memory.
    changed: Vec<WatchIndex>,
    chosen: Vec<TransitionIndex>,
    changes: Changes,
    counts: Counts,
    most_steps: u32,
}

impl Control {
    /// The control of a system at its start: every guard will be looked at.
    pub fn new(equations: &Equations, logic: &Logic) -> Self {
        let automata = logic.outgoing.len();
        Control {
            queues: vec![VecDeque::new(); automata],
            waiting: Worklist::empty(automata),
            stale: Worklist::full(automata),
            zeno: vec![Zeno::default(); automata],
            memory: equations.image.clone(),
            changed: Vec::new(),
            chosen: Vec::new(),
            changes: Changes::default(),
            counts: Counts::default(),
            most_steps: 10_000,
        }
    }

    /// An event from outside, delivered by the next [`Control::react`].
    pub fn post(&mut self, logic: &Logic, event: EventIndex) {
        let receiver = logic.receivers[event.position()];
        self.queues[receiver.position()].push_back(event);
        self.waiting.insert(receiver);
    }

    /// Counts since the start.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Takes the micro-steps of the instant `t` (s), beginning with `scheduled` changes, and appends the
    /// transitions taken to `taken`. Says if transitions accumulate.
    ///
    /// # Errors
    /// [`HybridError`] when the engine cannot go on or micro-steps do not end.
    #[allow(clippy::too_many_arguments)] // each is a different party of the instant
    pub fn react(
        &mut self,
        engine: &mut dyn Engine,
        e: &Equations,
        logic: &Logic,
        t: f64,
        scheduled: &Changes,
        journal: &mut Journal,
        taken: &mut Vec<Taken>,
    ) -> Result<Option<Accumulation>, HybridError> {
        let mut step = 0;
        let mut accumulation = None;
        let mut livelock = Livelock::default();
        livelock.begin();
        let before = taken.len();
        if !scheduled.is_empty() {
            journal.push(Record::Jump { time: t, step });
            engine.change(e, t, scheduled, journal)?;
            step += 1;
        }
        loop {
            self.mark_stale(engine, logic);
            self.choose_enabled(engine, logic);
            if self.chosen.is_empty() && !self.choose_by_event(engine, logic) {
                break;
            }
            journal.push(Record::Jump { time: t, step });
            self.changes.clear();
            if !self.chosen.is_empty() {
                self.collect_changes(engine, e, logic, t);
                engine.change(e, t, &self.changes, journal)?;
            }
            for k in 0..self.chosen.len() {
                let transition = self.chosen[k];
                let code = &logic.transitions[transition.position()];
                taken.push(Taken { time: t, step, transition });
                self.stale.insert(code.automaton);
                self.counts.transitions += 1;
                for &event in &code.emits {
                    self.post(logic, event);
                }
                let zeno = self.zeno[code.automaton.position()].taken(t, transition);
                accumulation = accumulation.or(zeno);
            }
            step += 1;
            if let Some(cycle) =
                livelock.after(step, engine, e, t, &self.queues, &self.changes, &taken[before..])
            {
                return Err(HybridError::Livelock { time: t, steps: step, cycle, exact: true });
            }
            if step >= self.most_steps {
                let last = taken.len().saturating_sub(8).max(before);
                let cycle = taken[last..].iter().map(|taken| taken.transition).collect();
                return Err(HybridError::Livelock { time: t, steps: step, cycle, exact: false });
            }
        }
        self.counts.instants += u64::from(step > 0);
        Ok(accumulation)
    }

    /// Automata whose guards read a watch that changed.
    fn mark_stale(&mut self, engine: &mut dyn Engine, logic: &Logic) {
        self.changed.clear();
        engine.take_changed(&mut self.changed);
        for watch in &self.changed {
            for &automaton in logic.automata_of_watch.row(watch.position()) {
                self.stale.insert(automaton);
            }
        }
    }

    /// Group 1: of each automaton the first transition whose guard holds; of these, those of the smallest
    /// priority number. Automata that wait for a more urgent one stay marked.
    fn choose_enabled(&mut self, engine: &dyn Engine, logic: &Logic) {
        let chosen = &mut self.chosen;
        chosen.clear();
        let mut least = i32::MAX;
        self.stale.retain(|automaton| {
            let location = engine.locations()[automaton.position()].position();
            let outgoing = &logic.outgoing[automaton.position()][location];
            let first = outgoing.iter().copied().find(|transition| {
                match &logic.transitions[transition.position()].trigger {
                    TriggerCode::When(guard) => guard.holds(|watch| engine.sign(watch)),
                    TriggerCode::On(..) => false,
                }
            });
            let Some(transition) = first else { return false };
            let priority = logic.transitions[transition.position()].priority;
            if priority < least {
                chosen.clear();
                least = priority;
            }
            if priority == least {
                chosen.push(transition);
            }
            true
        });
    }

    /// Group 2: every automaton takes one waiting event; `false` if none waits.
    fn choose_by_event(&mut self, engine: &dyn Engine, logic: &Logic) -> bool {
        let (queues, chosen, counts) = (&mut self.queues, &mut self.chosen, &mut self.counts);
        let mut any = false;
        self.waiting.retain(|automaton| {
            let queue = &mut queues[automaton.position()];
            let Some(event) = queue.pop_front() else { return false };
            any = true;
            let location = engine.locations()[automaton.position()].position();
            let waiting =
                logic.outgoing[automaton.position()][location].iter().copied().find(
                    |transition| match &logic.transitions[transition.position()].trigger {
                        TriggerCode::On(events, guard) => {
                            events.contains(&event) && guard.holds(|watch| engine.sign(watch))
                        }
                        TriggerCode::When(_) => false,
                    },
                );
            match waiting {
                Some(transition) => chosen.push(transition),
                None => counts.unused_events += 1,
            }
            !queue.is_empty()
        });
        any
    }

    /// The changes of one micro-step, all right-hand sides read before it.
    fn collect_changes(&mut self, engine: &dyn Engine, e: &Equations, logic: &Logic, t: f64) {
        for transition in &self.chosen {
            let code = &logic.transitions[transition.position()];
            for (state, formula) in &code.resets {
                for &source in e.sources(&formula.sources) {
                    self.memory[e.layout.series_of(source)] = engine.value(source, t);
                }
                let [value, ..] = e.formula(formula, engine.locations(), &mut self.memory, 1);
                self.changes.states.push((*state, value));
            }
            self.changes.locations.push((code.automaton, code.destination));
        }
    }
}
