use crate::error::HybridError;
use crate::livelock::Livelock;
use crate::queues::Queues;
use crate::worklist::Worklist;
use crate::zeno::{Accumulation, Zeno};
use sophy_field::{
    AutomatonIndex, Changes, Engine, Equations, EventIndex, Guard, Journal, LocationIndex, Logic, Record,
    StateIndex, TransitionCode, TransitionIndex, TriggerCode, WatchIndex,
};

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
/// one per receiver, again only those of the smallest priority number. All right-hand sides of a micro-step
/// read the values before it. Guards are level-triggered: they count while they hold, also on entry and at the
/// start.
///
/// **Flags.** An event section is an automaton whose locations are the sides of its flag. It begins on the side
/// the flag has at the start. A flag that a reset puts back on the side it came from has not crossed again: its
/// automaton goes back without an event.
#[derive(Clone, Debug)]
pub struct Control {
    /// Events waiting, per automaton (of none where nobody receives events), and the automata for which some wait.
    queues: Queues,
    waiting: Worklist,
    /// Automata whose guards must be looked at.
    stale: Worklist,
    /// Of all automata; of none where there are no transitions.
    zeno: Zeno,
    /// Watches that changed, transitions of a micro-step, and what they change; kept for their memory.
    changed: Vec<WatchIndex>,
    chosen: Vec<TransitionIndex>,
    emitted: Vec<EventIndex>,
    /// Automata whose next event nothing listens to, and those that answer theirs, unless its condition keeps them.
    unheard: Vec<AutomatonIndex>,
    answers: Vec<(AutomatonIndex, Option<TransitionIndex>)>,
    changes: Changes,
    assigned: Vec<(StateIndex, usize)>,
    /// Event sections that change sides without an event.
    sides: Changes,
    counts: Counts,
    most_steps: u32,
}

impl Control {
    /// The control of a system at its start: every guard will be looked at.
    pub fn new(logic: &Logic) -> Self {
        let automata = logic.automata.len();
        let of_all = |needed: bool| if needed { automata } else { 0 };
        Control {
            queues: Queues::new(of_all(!logic.receivers.is_empty())),
            waiting: Worklist::empty(automata),
            stale: Worklist::full(automata),
            zeno: Zeno::new(of_all(!logic.transitions.is_empty())),
            changed: Vec::new(),
            chosen: Vec::new(),
            emitted: Vec::new(),
            unheard: Vec::new(),
            answers: Vec::new(),
            changes: Changes::default(),
            assigned: Vec::new(),
            sides: Changes::default(),
            counts: Counts::default(),
            most_steps: 10_000,
        }
    }

    /// An event from outside, delivered by the next [`Control::react`].
    pub fn post(&mut self, logic: &Logic, event: EventIndex) {
        let receiver = logic.receivers[event.position()];
        self.queues.push(receiver, event);
        self.waiting.insert(receiver);
    }

    /// Puts every event section on the side its flag has at the start `t` (s); nothing fires.
    ///
    /// # Errors
    /// [`HybridError`] when the engine cannot go on.
    pub fn begin(
        &mut self,
        engine: &mut dyn Engine,
        e: &Equations,
        logic: &Logic,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), HybridError> {
        self.follow_flags(engine, e, logic, t, journal, |_| true)
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
            let silent = |t: TransitionIndex| logic.transition(t).0.silent;
            self.follow_flags(engine, e, logic, t, journal, silent)?;
            self.choose_enabled(engine, logic);
            if self.chosen.is_empty() && !self.choose_by_event(engine, logic) {
                break;
            }
            journal.push(Record::Jump { time: t, step });
            self.changes.clear();
            if !self.chosen.is_empty() {
                self.collect_changes(engine, e, logic, t);
                if self.chosen.len() > 1 {
                    self.refuse_assigned_twice(logic, t)?;
                }
                engine.change(e, t, &self.changes, journal)?;
                self.put_back(engine, e, logic, t, journal)?;
            }
            for k in 0..self.emitted.len() {
                self.post(logic, self.emitted[k]);
            }
            self.emitted.clear();
            for &transition in &self.chosen {
                let (code, copy) = logic.transition(transition);
                let automaton = AutomatonIndex(code.automaton.of(copy));
                taken.push(Taken { time: t, step, transition });
                self.stale.insert(automaton);
                self.counts.transitions += 1;
                let zeno = self.zeno.taken(automaton, t, transition);
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

    /// Event sections whose flag is on the other side go there without an event, by transitions for which
    /// `quiet` holds.
    fn follow_flags(
        &mut self,
        engine: &mut dyn Engine,
        e: &Equations,
        logic: &Logic,
        t: f64,
        journal: &mut Journal,
        quiet: impl Fn(TransitionIndex) -> bool,
    ) -> Result<(), HybridError> {
        let sides = &mut self.sides;
        sides.clear();
        self.stale.retain(|automaton| {
            if logic.follows_flag(automaton) {
                let location = engine.locations()[automaton.position()];
                if let Some(transition) = enabled(engine, logic, automaton, location)
                    && quiet(transition)
                {
                    let destination = logic.transition(transition).0.destination;
                    sides.locations.push((automaton, destination));
                }
            }
            true
        });
        if !sides.is_empty() {
            engine.change(e, t, sides, journal)?;
        }
        Ok(())
    }

    /// Event sections that were taken and whose flag is back on the side it came from.
    fn put_back(
        &mut self,
        engine: &mut dyn Engine,
        e: &Equations,
        logic: &Logic,
        t: f64,
        journal: &mut Journal,
    ) -> Result<(), HybridError> {
        self.sides.clear();
        for transition in &self.chosen {
            let (code, copy) = logic.transition(*transition);
            let automaton = AutomatonIndex(code.automaton.of(copy));
            if logic.follows_flag(automaton) && enabled(engine, logic, automaton, code.destination).is_some()
            {
                self.sides.locations.push((automaton, code.source));
            }
        }
        if !self.sides.is_empty() {
            engine.change(e, t, &self.sides, journal)?;
        }
        Ok(())
    }

    /// Group 1: of each automaton the first transition whose guard holds; of these, those of the smallest
    /// priority number. Automata that wait for a more urgent one stay marked.
    fn choose_enabled(&mut self, engine: &dyn Engine, logic: &Logic) {
        self.chosen.clear();
        let mut least = i32::MAX;
        let chosen = &mut self.chosen;
        self.stale.retain(|automaton| {
            let location = engine.locations()[automaton.position()];
            let Some(transition) = enabled(engine, logic, automaton, location) else { return false };
            keep_urgent(chosen, &mut least, logic.transition(transition).0.priority, transition);
            true
        });
    }

    /// Group 2: every automaton takes one waiting event, those first whose answer has the smallest priority
    /// number; `false` if none waits. An event that nothing listens to is gone.
    fn choose_by_event(&mut self, engine: &dyn Engine, logic: &Logic) -> bool {
        let (queues, mut least) = (&self.queues, i32::MAX);
        let (unheard, answers) = (&mut self.unheard, &mut self.answers);
        unheard.clear();
        answers.clear();
        self.waiting.retain(|automaton| {
            let Some(event) = queues.front(automaton) else { return false };
            let location = engine.locations()[automaton.position()];
            let outgoing = logic.outgoing(automaton, location);
            let mut listening = outgoing.filter_map(|transition| match logic.transition(transition) {
                (TransitionCode { trigger: TriggerCode::On(events, guard), .. }, copy)
                    if events.iter().any(|waited| waited.of(copy) == event.0) =>
                {
                    Some((transition, (guard, copy)))
                }
                _ => None,
            });
            let holds = |(guard, copy): (&Guard, u32)| guard.holds(copy, |watch| engine.sign(watch));
            // One that only its condition keeps from answering has its turn, too.
            match listening.next() {
                None => unheard.push(automaton),
                Some((first, guard)) => {
                    let answer = if holds(guard) {
                        Some(first)
                    } else {
                        listening.find(|&(_, guard)| holds(guard)).map(|(transition, _)| transition)
                    };
                    let priority = logic.transition(answer.unwrap_or(first)).0.priority;
                    keep_urgent(answers, &mut least, priority, (automaton, answer));
                }
            }
            true
        });
        let any = !(unheard.is_empty() && answers.is_empty());
        let unheard = unheard.iter().map(|&automaton| (automaton, None));
        for (automaton, answer) in unheard.chain(answers.iter().copied()) {
            self.queues.pop(automaton);
            match answer {
                Some(transition) => self.chosen.push(transition),
                None => self.counts.unused_events += 1,
            }
        }
        any
    }

    /// The changes and events of one micro-step, all right-hand sides read before it.
    fn collect_changes(&mut self, engine: &mut dyn Engine, e: &Equations, logic: &Logic, t: f64) {
        for transition in &self.chosen {
            let (code, copy) = logic.transition(*transition);
            for (state, formula) in &code.resets {
                let value = engine.formula(e, (formula, copy), t);
                self.changes.states.push((StateIndex(state.of(copy)), value));
            }
            self.changes.locations.push((AutomatonIndex(code.automaton.of(copy)), code.destination));
            for emission in &code.emits {
                let mut value = |formula| engine.formula(e, (formula, copy), t);
                if emission.when.as_ref().is_none_or(|when| value(when) != 0.0) {
                    self.emitted.extend(emission.receivers.iter().map(|event| EventIndex(event.of(copy))));
                }
            }
        }
    }
}

impl Control {
    /// All right-hand sides of a micro-step read the values before it, so what a state becomes must not depend on
    /// which of two assignments is looked at first. Equal values are no contradiction.
    fn refuse_assigned_twice(&mut self, logic: &Logic, time: f64) -> Result<(), HybridError> {
        self.assigned.clear();
        self.assigned.extend(self.changes.states.iter().enumerate().map(|(k, (state, _))| (*state, k)));
        self.assigned.sort_unstable();
        for pair in self.assigned.windows(2) {
            let [(state, first), (again, second)] = [pair[0], pair[1]];
            let values = [self.changes.states[first].1, self.changes.states[second].1];
            if state == again && values[0].to_bits() != values[1].to_bits() {
                let assigns = |t: &TransitionIndex| {
                    let (code, copy) = logic.transition(*t);
                    code.resets.iter().any(|(reset, _)| reset.of(copy) == state.0)
                };
                let mut who = self.chosen.iter().copied().filter(assigns);
                if let (Some(first), Some(second)) = (who.next(), who.next()) {
                    return Err(HybridError::AssignedTwice {
                        time,
                        state,
                        transitions: [first, second],
                        values,
                    });
                }
            }
        }
        Ok(())
    }
}

/// The first transition out of a location whose guard holds.
fn enabled(
    engine: &dyn Engine,
    logic: &Logic,
    automaton: AutomatonIndex,
    location: LocationIndex,
) -> Option<TransitionIndex> {
    logic.outgoing(automaton, location).find(|&transition| {
        let (code, copy) = logic.transition(transition);
        match &code.trigger {
            TriggerCode::When(guard) => guard.holds(copy, |watch| engine.sign(watch)),
            TriggerCode::On(..) => false,
        }
    })
}

/// Keeps in `kept` what has the smallest priority number so far, which is `least`.
fn keep_urgent<T>(kept: &mut Vec<T>, least: &mut i32, priority: i32, item: T) {
    if priority < *least {
        kept.clear();
        *least = priority;
    }
    if priority == *least {
        kept.push(item);
    }
}
