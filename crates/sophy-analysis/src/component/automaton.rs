use super::builder::Builder;
use super::equations::{Defined, Definition};
use super::statements::Setting;
use super::variables::Interface;
use crate::checks::{
    hs0105_unknown_initial_value, hs0108_defined_twice, hs0132_unknown_event, hs0136_event_section,
    hs0209_units, hs0220_wrong_argument, hs0303_algebraic_loop,
};
use crate::declarations::{
    ComponentKind, Dialect, EventDeclaration, ExpressionText, LocationDeclaration, RuleDeclaration, Spanned,
    Statement, TransitionDeclaration, TriggerDeclaration,
};
use crate::dependency_order::dependency_order;
use crate::lower::{Place, SymbolKind, SymbolValue, names_in};
use crate::units::{Measured, Unit};
use sophy_diagnostics::Span;
use sophy_ir::{
    Actions, Assignment, Constraint, Equation, EventSection, HybridAutomaton, Leaf, Location, Node, NodeId,
    Rule, Transition, Trigger, VariableId, VariableKind,
};
use std::collections::{BTreeMap, HashMap};

/// A location with what the checks want to know of it.
pub(crate) struct BuiltLocation<'a> {
    /// `None` for the one location of a component without locations.
    pub(crate) declaration: Option<&'a LocationDeclaration>,
    pub(crate) defined: Defined,
    pub(crate) values: Vec<Equation>,
    pub(crate) constraints: Vec<Constraint>,
    pub(crate) invariant: Option<NodeId>,
    pub(crate) transitions: Vec<BuiltTransition<'a>>,
}

impl BuiltLocation<'_> {
    /// All that is read while the location holds.
    pub(crate) fn nodes(&self) -> Vec<NodeId> {
        let defined = self.defined.rates.values().chain(self.defined.values.values());
        let constraints = self.constraints.iter().flat_map(|c| [c.left, c.right]);
        let guards = self.transitions.iter().filter_map(|transition| transition.guard);
        let equations = defined.filter_map(|definition| definition.right);
        equations.chain(constraints).chain(guards).chain(self.invariant).collect()
    }
}

/// A transition as far as it is free of mistakes.
pub(crate) struct BuiltTransition<'a> {
    pub(crate) declaration: &'a TransitionDeclaration,
    pub(crate) guard: Option<NodeId>,
    pub(crate) trigger: Vec<Trigger>,
    pub(crate) destination: Option<usize>,
    pub(crate) actions: Actions,
    pub(crate) priority: i32,
    /// Whether all of it is free of mistakes.
    pub(crate) sound: bool,
}

impl<'a> Builder<'_, 'a> {
    /// All locations; a component without any has one that holds what is written in its body.
    pub(crate) fn locations(&mut self, interface: &Interface) -> Vec<BuiltLocation<'a>> {
        let declaration = self.declaration;
        let has_locations = !declaration.locations.is_empty();
        let everywhere_place = if has_locations { " in all locations" } else { "" };
        let everywhere = self.define(&declaration.equations, everywhere_place);
        let common_constraints = self.constraints(&declaration.equations.constraints);
        let written: Vec<Option<&'a LocationDeclaration>> =
            if has_locations { declaration.locations.iter().map(Some).collect() } else { vec![None] };
        let mut built = Vec::with_capacity(written.len());
        let mut unheld = BTreeMap::new();
        for (position, location) in written.into_iter().enumerate() {
            self.symbols.enter_location(location.map(|_| position));
            let place = location.map_or_else(String::new, |l| format!(" in location `{}`", l.name.value));
            let mut defined = everywhere.clone();
            let mut constraints = common_constraints.clone();
            if let Some(location) = location {
                let own = self.define(&location.equations, &place);
                self.merge(&mut defined, own, &place);
                constraints.extend(self.constraints(&location.equations.constraints));
            }
            for &(output, own) in &interface.exported {
                let right = Some(self.graph.leaf(Leaf::Variable(own)));
                let span = self.variables[output.0 as usize].span.unwrap_or(declaration.name.span);
                defined.values.insert(output, Definition { right, span, target: span });
            }
            self.find_unheld(&defined, &mut unheld);
            let values = self.sorted(&defined, &constraints, &place);
            let invariant = location
                .and_then(|location| location.invariant.as_ref())
                .and_then(|invariant| self.at(Place::EQUATION).condition(invariant));
            let transitions = location.map_or(&[][..], |location| &location.transitions);
            let transitions = transitions.iter().map(|t| self.transition(t)).collect();
            built.push(BuiltLocation {
                declaration: location,
                defined,
                values,
                constraints,
                invariant,
                transitions,
            });
        }
        self.symbols.enter_location(None);
        self.report_unheld(unheld);
        built
    }

    pub(crate) fn constraints(
        &mut self,
        written: &'a [crate::declarations::ConstraintDeclaration],
    ) -> Vec<Constraint> {
        let mut constraints = Vec::new();
        for constraint in written {
            let left = self.at(Place::EQUATION).value(&constraint.left);
            let Some(left) = left else {
                self.at(Place::EQUATION).value(&constraint.right);
                self.misread(constraint);
                continue;
            };
            let expected = crate::lower::Expected {
                shape: left.shape,
                quantity: left.quantity,
                measured: left.measured,
                choices: Vec::new(),
                what: "the left-hand side".to_owned(),
                span: Some(constraint.left.span),
            };
            let Some(right) = self.at(Place::EQUATION).value_for(&constraint.right, &expected) else {
                self.misread(constraint);
                continue;
            };
            let pairs = left.elements.as_slice().iter().zip(right.elements.as_slice());
            let span = Some(constraint.left.span.to(constraint.right.span));
            constraints.extend(pairs.map(|(&left, &right)| Constraint { left, right, span }));
        }
        constraints
    }

    fn misread(&mut self, constraint: &crate::declarations::ConstraintDeclaration) {
        self.constrained.extend(names_in(&constraint.left));
        self.constrained.extend(names_in(&constraint.right));
    }

    /// Equations of outputs, locals and flags, each after those it reads; a circle is an algebraic loop.
    pub(crate) fn sorted(
        &mut self,
        defined: &Defined,
        constraints: &[Constraint],
        place: &str,
    ) -> Vec<Equation> {
        let ids: Vec<VariableId> = defined.values.keys().copied().collect();
        let position: HashMap<VariableId, usize> =
            ids.iter().enumerate().map(|(position, &id)| (id, position)).collect();
        let reads = |node: Option<NodeId>| -> Vec<usize> {
            let leaves = node.map(|node| self.graph.dependencies([node])).unwrap_or_default();
            let variable = |leaf: Leaf| match leaf {
                Leaf::Variable(id) => position.get(&id).copied(),
                _ => None,
            };
            leaves.into_iter().filter_map(variable).collect()
        };
        let needs: Vec<Vec<usize>> = defined.values.values().map(|d| reads(d.right)).collect();
        let sorted = dependency_order(&needs);
        // A loop that a constraint is part of is solved with it.
        let constrained: Vec<usize> =
            constraints.iter().flat_map(|c| [reads(Some(c.left)), reads(Some(c.right))].concat()).collect();
        let mut in_order = sorted.order;
        for cycle in &sorted.cycles {
            if cycle.iter().any(|member| constrained.contains(member)) {
                in_order.extend(cycle);
                continue;
            }
            let members: Vec<(String, Definition)> = cycle
                .iter()
                .map(|&member| {
                    (self.variables[ids[member].0 as usize].name.clone(), defined.values[&ids[member]])
                })
                .collect();
            let texts: Vec<String> =
                members.iter().map(|(_, d)| self.shared.sources.excerpt(d.span).trim().to_owned()).collect();
            self.report(hs0303_algebraic_loop::diagnostic(place, &members, &texts));
        }
        let mut equations: Vec<(usize, Equation)> = Vec::new();
        for (order, member) in in_order.into_iter().enumerate() {
            let (variable, definition) = (ids[member], defined.values[&ids[member]]);
            if let Some(right) = definition.right {
                equations.push((order, Equation { variable, right, span: Some(definition.span) }));
            }
        }
        equations.into_iter().map(|(_, equation)| equation).collect()
    }

    fn transition(&mut self, written: &'a TransitionDeclaration) -> BuiltTransition<'a> {
        let mistakes = |b: &Self| b.shared.findings.error_count() + b.strays.resets.len();
        let before = mistakes(self);
        let guard_text = match &written.trigger {
            TriggerDeclaration::When(guard)
            | TriggerDeclaration::On(_, guard)
            | TriggerDeclaration::WhenOrOn(guard, _)
            | TriggerDeclaration::Rate(_, guard)
            | TriggerDeclaration::Invariant(_, guard)
            | TriggerDeclaration::Synchronised(_, guard) => guard.as_ref(),
        };
        let on_event = matches!(
            written.trigger,
            TriggerDeclaration::On(..)
                | TriggerDeclaration::Invariant(..)
                | TriggerDeclaration::Synchronised(..)
        );
        let reads = if on_event { Place::INSTANT } else { Place::EQUATION };
        let guard = guard_text.and_then(|guard| self.at(reads).condition(guard));
        let usable = |guard: Option<NodeId>| guard_text.is_none() || guard.is_some();
        let trigger = match &written.trigger {
            TriggerDeclaration::When(_) => guard.map(Trigger::When).into_iter().collect(),
            TriggerDeclaration::On(events, _) => {
                let events = self.input_events(events);
                usable(guard).then_some(Trigger::On { events, guard }).into_iter().collect()
            }
            TriggerDeclaration::WhenOrOn(written_guard, events) => {
                self.when_or_on(written_guard.is_some(), guard, events)
            }
            TriggerDeclaration::Rate(rate, _) => {
                let rate = self.per_second(rate);
                rate.filter(|_| usable(guard)).map(|rate| Trigger::Rate { rate, guard }).into_iter().collect()
            }
            TriggerDeclaration::Invariant(..) => vec![Trigger::Invariant { guard }],
            TriggerDeclaration::Synchronised(label, _) => {
                if hs0132_unknown_event::is_synchronised(self.declaration, &label.value) {
                    self.symbols.look_up(&label.value);
                    vec![Trigger::Synchronised { label: label.value.clone(), guard }]
                } else {
                    self.report(hs0132_unknown_event::synchronised(label, self.declaration));
                    Vec::new()
                }
            }
        };
        let is_destination = |l: &LocationDeclaration| l.name.value == written.destination.value;
        let destination = self.declaration.locations.iter().position(is_destination);
        let place = format!(" in transition `{}`", written.name.value);
        let setting = Setting {
            place: &place,
            reads: Place::INSTANT,
            emits: true,
            holds: self.declaration.dialect == Dialect::Hsml,
            enters: destination,
        };
        let mut actions = self.actions(&written.actions, setting);
        if let Some(destination) = destination {
            self.start_anew(destination, &mut actions);
        }
        let fallback = self.component_priority();
        BuiltTransition {
            declaration: written,
            guard,
            trigger,
            destination,
            actions,
            priority: self.whole_number(written.priority.as_ref(), "a priority", fallback),
            sound: mistakes(self) == before,
        }
    }

    /// What exists in a location only has its declared value on entry, unless the transition assigns it.
    fn start_anew(&mut self, entered: usize, actions: &mut Actions) {
        let Some(location) = self.declaration.locations.get(entered) else { return };
        for variable in &location.variables {
            let declared =
                self.symbols.of_location(entered, &variable.name.value).map(|symbol| &symbol.value);
            let Some(SymbolValue::Variable(symbol)) = declared else { continue };
            for k in 0..symbol.shape.len() as u32 {
                let id = VariableId(symbol.first.0 + k);
                let start = match self.variables[id.0 as usize].kind {
                    VariableKind::State(start) | VariableKind::Mode(start) => start,
                    _ => None,
                };
                let is_assigned = actions.assignments.iter().any(|assignment| assignment.variable == id);
                if let (Some(right), false) = (start, is_assigned) {
                    let span = Some(variable.name.span);
                    actions.assignments.push(Assignment { variable: id, right, span });
                }
            }
        }
    }

    /// SOPHY XML: one transition with a guard and events is two, one taken while the guard is true, the other when
    /// an event arrives. A guard that is `false` leaves only the other.
    fn when_or_on(
        &mut self,
        has_guard: bool,
        guard: Option<NodeId>,
        events: &'a [Spanned<String>],
    ) -> Vec<Trigger> {
        let labels: Vec<String> = events.iter().map(|label| label.value.clone()).collect();
        let mut triggers = Vec::new();
        match guard {
            Some(guard) if self.graph.node(guard) == Node::Boolean(false) && !labels.is_empty() => {}
            Some(guard) => triggers.push(Trigger::When(guard)),
            None if has_guard || labels.is_empty() => return Vec::new(),
            None => {}
        }
        if !labels.is_empty() {
            triggers.push(Trigger::On { events: labels, guard: None });
        }
        triggers
    }

    fn input_events(&mut self, events: &'a [Spanned<String>]) -> Vec<String> {
        let mut labels = Vec::new();
        for label in events {
            if hs0132_unknown_event::is_input_event(self.declaration, &label.value) {
                self.symbols.look_up(&label.value);
                labels.push(label.value.clone());
            } else {
                self.report(hs0132_unknown_event::received(label, self.declaration));
            }
        }
        labels
    }

    /// `priority N;` of the component, else 0.
    pub(crate) fn component_priority(&mut self) -> i32 {
        let declaration = self.declaration;
        self.silently(|b| b.whole_number(declaration.priority.as_ref(), "a priority", 0))
    }

    /// Event sections.
    pub(crate) fn event_sections(&mut self) -> Vec<EventSection> {
        let declaration = self.declaration;
        let mut first: BTreeMap<VariableId, Span> = BTreeMap::new();
        let mut sections = Vec::new();
        for written in &declaration.events {
            if let Some(section) = self.event_section(written, &mut first) {
                sections.push(section);
            }
        }
        sections
    }

    fn event_section(
        &mut self,
        written: &'a EventDeclaration,
        first: &mut BTreeMap<VariableId, Span>,
    ) -> Option<EventSection> {
        let fallback = self.component_priority();
        let priority = self.whole_number(written.priority.as_ref(), "a priority", fallback);
        let place = format!(" in the event section of `{}`", written.flag.value);
        let setting =
            Setting { place: &place, reads: Place::INSTANT, emits: true, holds: true, enters: None };
        let rising = written.rising.as_ref().map(|statements| self.actions(statements, setting));
        let falling = written.falling.as_ref().map(|statements| self.actions(statements, setting));
        if written.flag.value.is_empty() {
            return None; // has been complained about
        }
        let found = self.symbols.look_up(&written.flag.value);
        let symbol = match found {
            Some(symbol) if symbol.kind == SymbolKind::Flag => match symbol.value {
                SymbolValue::Variable(variable) => variable,
                _ => return None,
            },
            found => {
                let kind = found.map(|symbol| (symbol.kind, symbol.span));
                let diagnostic = hs0136_event_section::no_flag(&written.flag, kind, &self.symbols);
                self.report(diagnostic);
                return None;
            }
        };
        let positions = self.positions(&written.flag, &written.indices, symbol.shape)?;
        let &[position] = positions.as_slice() else {
            self.report(hs0136_event_section::vector(&written.flag));
            return None;
        };
        if rising.is_none() && falling.is_none() {
            self.report(hs0136_event_section::nothing(&written.flag));
        }
        let flag = VariableId(symbol.first.0 + position as u32);
        if let Some(&earlier) = first.get(&flag) {
            let what = format!("the event section of `{}`", written.flag.value);
            self.report(hs0108_defined_twice::diagnostic(&what, earlier, written.flag.span));
            return None;
        }
        first.insert(flag, written.flag.span);
        Some(EventSection { flag, priority, rising, falling, span: Some(written.flag.span) })
    }

    /// Rules.
    pub(crate) fn rules(&mut self) -> Vec<Rule> {
        let declaration = self.declaration;
        declaration.rules.iter().filter_map(|rule| self.rule(rule)).collect()
    }

    fn rule(&mut self, written: &'a RuleDeclaration) -> Option<Rule> {
        let condition = self.at(Place::INSTANT).condition(&written.condition);
        let delay = written.delay.as_ref().map(|delay| self.seconds(delay, "the delay of a rule"));
        let fallback = self.component_priority();
        let priority = self.whole_number(written.priority.as_ref(), "a priority", fallback);
        let setting = Setting {
            place: " in this rule",
            reads: Place::INSTANT,
            emits: true,
            holds: false,
            enters: None,
        };
        let actions = self.actions(&written.actions, setting);
        Some(Rule {
            condition: condition?,
            actions,
            delay: match delay {
                Some(delay) => Some(delay?),
                None => None,
            },
            latched: written.latched,
            cancellable: written.cancellable,
            initially: written.initially,
            priority,
            span: Some(written.span),
        })
    }

    /// A number of seconds.
    pub(crate) fn seconds(&mut self, text: &'a ExpressionText, what: &str) -> Option<NodeId> {
        let expected = crate::lower::Expected {
            shape: crate::lower::Shape::Scalar,
            quantity: sophy_ir::Quantity::Real,
            measured: crate::units::Measured::Known(crate::units::Unit::SECOND),
            choices: Vec::new(),
            what: what.to_owned(),
            span: None,
        };
        let node = self.at(Place::EQUATION).value_for(text, &expected)?.node()?;
        self.check_not_negative(node, what, text);
        Some(node)
    }

    fn check_not_negative(&mut self, node: NodeId, what: &str, text: &ExpressionText) {
        if let Some(number) = self.known_value(node).filter(|&number| number < 0.0) {
            self.report(hs0220_wrong_argument::out_of_range(text.span, what, number));
        }
    }

    /// The rate of a Poisson transition, 1/s.
    fn per_second(&mut self, text: &'a ExpressionText) -> Option<NodeId> {
        let value = self.at(Place::EQUATION).scalar(text)?;
        if let Err(mismatch) = value.measured.agree(Measured::Known(Unit::SECOND).rate().rate()) {
            self.report(hs0209_units::required(text.span, "a rate", mismatch));
        }
        let node = value.node()?;
        self.check_not_negative(node, "a rate", text);
        Some(node)
    }

    /// The `initial` section. What depends on parameters only becomes a declared value; the rest is sorted.
    pub(crate) fn initial_section(&mut self) -> Vec<Assignment> {
        let declaration = self.declaration;
        if declaration.dialect == Dialect::Xml {
            self.initial_hints(&declaration.initial);
            return Vec::new();
        }
        let reads = Place { what: "the `initial` section", ..Place::EQUATION };
        let first = self.first_location();
        let place = " in the `initial` section";
        let setting = Setting { place, reads, emits: false, holds: false, enters: first };
        self.symbols.enter_location(first);
        let actions = self.actions(&declaration.initial, setting);
        self.symbols.enter_location(None);
        let position: HashMap<VariableId, usize> =
            actions.assignments.iter().enumerate().map(|(position, a)| (a.variable, position)).collect();
        let needs: Vec<Vec<usize>> = actions
            .assignments
            .iter()
            .map(|assignment| {
                let leaves = self.graph.dependencies([assignment.right]);
                let place = |leaf: Leaf| match leaf {
                    Leaf::Variable(id) => position.get(&id).copied(),
                    _ => None,
                };
                // What keeps its own declared value in a branch needs nothing else.
                let own = position.get(&assignment.variable).copied();
                leaves.into_iter().filter_map(place).filter(|&other| Some(other) != own).collect()
            })
            .collect();
        let sorted = dependency_order(&needs);
        for cycle in &sorted.cycles {
            let members: Vec<(String, Option<Span>)> = cycle
                .iter()
                .map(|&member| {
                    let assignment = &actions.assignments[member];
                    (self.variables[assignment.variable.0 as usize].name.clone(), assignment.span)
                })
                .collect();
            self.report(hs0303_algebraic_loop::initial(&members, declaration.name.span));
        }
        let mut rest = Vec::new();
        for index in sorted.order {
            let assignment = actions.assignments[index].clone();
            let parametric = self.graph.dependencies([assignment.right]).into_iter().all(|leaf| match leaf {
                Leaf::Variable(id) => {
                    matches!(self.variables[id.0 as usize].kind, VariableKind::Parameter { .. })
                }
                _ => false,
            });
            let kind = &mut self.variables[assignment.variable.0 as usize].kind;
            match kind {
                VariableKind::State(start) | VariableKind::Mode(start) if parametric => {
                    *start = Some(assignment.right);
                }
                _ => rest.push(assignment),
            }
        }
        rest
    }

    /// SOPHY XML: hints `initial NAME`.
    fn initial_hints(&mut self, hints: &'a [Statement]) {
        let mut first: BTreeMap<&str, Span> = BTreeMap::new();
        for hint in hints {
            let Statement::Assign { target, right } = hint else { continue };
            let value = self
                .at(Place {
                    what: "an initial value",
                    most: crate::lower::Varies::Parameters,
                    ..Place::INITIAL
                })
                .scalar(right);
            let name = target.name.value.as_str();
            if name.is_empty() {
                continue;
            }
            let state = match self.symbols.get(name) {
                Some(symbol) if symbol.kind == SymbolKind::State => match &symbol.value {
                    SymbolValue::Variable(variable) => Some(variable.first),
                    _ => None,
                },
                _ => {
                    let d = hs0105_unknown_initial_value::diagnostic(&target.name, &self.symbols);
                    self.report(d);
                    continue;
                }
            };
            if let Some(&first) = first.get(name) {
                let what = format!("the initial value of `{name}`");
                self.report(hs0108_defined_twice::diagnostic(&what, first, target.name.span));
                continue;
            }
            first.insert(name, target.name.span);
            if let (Some(state), Some(node)) = (state, value.and_then(|value| value.node())) {
                self.variables[state.0 as usize].kind = VariableKind::State(Some(node));
            }
        }
    }

    /// The automaton, once all checks are done; `None` if something is missing.
    pub(crate) fn automaton(
        &mut self,
        locations: Vec<BuiltLocation<'a>>,
        initial: Vec<Assignment>,
        events: Vec<EventSection>,
        rules: Vec<Rule>,
    ) -> Option<HybridAutomaton> {
        let declaration = self.declaration;
        let initial_location = match &declaration.initial_location {
            Some(name) => declaration.locations.iter().position(|l| l.name.value == name.value)?,
            None => 0,
        };
        let delay = declaration.delay.as_ref().and_then(|delay| self.seconds(delay, "`tdelay`"));
        let mut finished = Vec::with_capacity(locations.len());
        for built in locations {
            finished.push(finished_location(built)?);
        }
        Some(HybridAutomaton {
            locations: finished,
            initial_location,
            initial,
            events,
            rules,
            logic: declaration.kind == ComponentKind::Lbc,
            delay,
        })
    }
}

fn finished_location(built: BuiltLocation<'_>) -> Option<Location> {
    let mut dynamics = Vec::with_capacity(built.defined.rates.len());
    for (&variable, definition) in &built.defined.rates {
        dynamics.push(Equation { variable, right: definition.right?, span: Some(definition.span) });
    }
    let mut transitions = Vec::new();
    for built in built.transitions {
        let written = built.declaration;
        if built.trigger.is_empty() {
            return None;
        }
        for trigger in built.trigger {
            transitions.push(Transition {
                name: written.name.value.as_str().into(),
                documentation: written.documentation.clone(),
                span: Some(written.name.span),
                trigger,
                destination: built.destination?,
                actions: built.actions.clone(),
                priority: built.priority,
            });
        }
    }
    let name = built.declaration.map(|declaration| &declaration.name);
    Some(Location {
        name: name.map_or_else(String::new, |name| name.value.clone()),
        documentation: built.declaration.map(|d| d.documentation.clone()).unwrap_or_default(),
        span: name.map(|name| name.span),
        dynamics,
        values: built.values,
        constraints: built.constraints,
        invariant: built.invariant,
        transitions,
    })
}
