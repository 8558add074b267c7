use super::automaton::BuiltLocation;
use super::builder::{Builder, Shared};
use super::equations::Defined;
use super::matching::{Matched, match_constraints};
use super::statements::{assigned_by, assigned_names, defined_by, equation_names};
use crate::checks::{
    hs0101_unknown_name, hs0102_equation_for_undeclared_state, hs0103_reset_of_undeclared_state,
    hs0104_map_for_undeclared_output, hs0106_unit_for_unknown_name, hs0107_declared_twice,
    hs0108_defined_twice, hs0109_output_without_map, hs0110_state_without_equation,
    hs0112_location_declared_twice, hs0113_transition_declared_twice, hs0114_unknown_destination,
    hs0115_unknown_initial_location, hs0116_unreachable_location, hs0117_hidden_name, hs0118_unused,
    hs0119_no_location, hs0127_declaration_for_another_kind, hs0143_local_without_equation,
    hs0144_flag_without_event, hs0145_constrained, hs0146_assigned_by_two, hs0201_unknown_function,
    hs0206_natural_logarithm, hs0401_constant_guard, hs0402_taken_on_entry, hs0403_round_without_time,
};
use crate::declarations::{
    ComponentKind, Dialect, FunctionDeclaration, LocationDeclaration, ParameterDeclaration,
    VariableDeclaration, VariableRole,
};
use crate::lower::{Symbol, SymbolKind, SymbolValue};
use sophy_diagnostics::{Diagnostics, Span};
use sophy_ir::{
    Actions, Binary, Constraint, EventSection, Leaf, Node, NodeId, Rule, Special, VariableId, VariableKind,
};
use std::collections::{BTreeSet, HashMap, HashSet};

/// Something that is defined or assigned although it cannot be.
#[derive(Clone, Debug)]
pub(crate) struct Stray {
    pub(crate) name: String,
    pub(crate) span: Span,
    /// What the name stands for and where it is declared; `None` if it is not.
    pub(crate) found: Option<(SymbolKind, Span)>,
}

/// Equations and resets whose left-hand side names nothing that could have one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strays {
    pub(crate) rates: Vec<Stray>,
    pub(crate) values: Vec<Stray>,
    pub(crate) resets: Vec<Stray>,
}

/// Where a flag is zero: its quantity is at this level.
#[derive(Clone, Copy)]
struct Surface {
    quantity: NodeId,
    level: f64,
}

impl<'a> Shared<'a> {
    /// Names of constants and functions: each is declared once, and hides nothing.
    pub(crate) fn check_globals(
        &mut self,
        constants: &[&'a ParameterDeclaration],
        functions: &[&'a FunctionDeclaration],
    ) {
        let constants = constants.iter().map(|constant| (&constant.name, SymbolKind::Constant));
        let functions_named = functions.iter().map(|function| (&function.name, SymbolKind::Function));
        let mut first: HashMap<&str, (SymbolKind, Span)> = HashMap::new();
        for (name, kind) in constants.chain(functions_named).filter(|(name, _)| !name.value.is_empty()) {
            match first.get(name.value.as_str()) {
                Some(&first) => {
                    let again = (kind, name.span);
                    self.findings.report(hs0107_declared_twice::diagnostic(&name.value, first, again));
                }
                None => {
                    first.insert(&name.value, (kind, name.span));
                }
            }
            if hs0117_hidden_name::is_predefined(&name.value) {
                let what = kind.with_article();
                self.findings.report(hs0117_hidden_name::diagnostic(&name.value, name.span, what));
            }
        }
        for (parameter, _) in functions.iter().flat_map(|function| &function.parameters) {
            if let Some(&(kind, hidden)) = first.get(parameter.value.as_str()) {
                let (what, hides) = ("a parameter", kind.with_article());
                self.findings.report(hs0117_hidden_name::of_the_file(
                    &parameter.value,
                    parameter.span,
                    what,
                    hides,
                    hidden,
                ));
            }
            if hs0117_hidden_name::is_predefined(&parameter.value) {
                let found = hs0117_hidden_name::diagnostic(&parameter.value, parameter.span, "a parameter");
                self.findings.report(found);
            }
        }
        for (diagnostic, _) in hs0101_unknown_name::find(&self.findings.unknown_names) {
            self.findings.report(diagnostic);
        }
        let mut found = Diagnostics::default();
        for diagnostic in hs0201_unknown_function::find(&self.findings.unknown_names) {
            found.push(diagnostic);
        }
        if let Some(diagnostic) = hs0206_natural_logarithm::find(&self.findings.logarithms) {
            found.push(diagnostic);
        }
        self.findings.report_all(found);
        self.findings.unknown_names.clear();
        self.findings.logarithms.clear();
    }
}

impl Builder<'_, '_> {
    /// Complains about sections that this kind of component does not have.
    pub(crate) fn check_sections(&mut self) {
        use ComponentKind::{Cc, Ctc, Dtc, Lbc, System};
        let d = self.declaration;
        let place = d.name.span;
        let composite = matches!(d.kind, Cc | System);
        let first_location = d.locations.first().map(|location| location.name.span);
        let first_rule = d.rules.first().map(|rule| rule.span);
        let first_event = d.events.first().map(|event| event.flag.span);
        let member = (!d.members.is_empty()).then_some(place);
        let connection = (!d.connections.is_empty()).then_some(place);
        let equation = |items: &[crate::declarations::EquationItem]| match items.first() {
            Some(crate::declarations::EquationItem::Equation(e)) => Some(e.target.name.span),
            Some(_) => Some(place),
            None => None,
        };
        let dynamics = equation(&d.equations.dynamics);
        let output = equation(&d.equations.output);
        let constraint = d.equations.constraints.first().map(|c| c.left.span);
        let update = (!d.update.is_empty()).then_some(place);
        let wrong: [(&str, &str, bool, Option<Span>); 10] = [
            ("location", "a CTC", d.kind != Ctc, first_location),
            ("event", "a CTC", d.kind != Ctc, first_event),
            ("rules", "a CTC or LBC", !matches!(d.kind, Ctc | Lbc), first_rule),
            ("components", "a CC or SYSTEM", !composite, member),
            ("connections", "a CC or SYSTEM", !composite, connection),
            ("dynamics", "a CTC", d.kind != Ctc, dynamics),
            ("constraints", "a CTC or DTC", composite || d.kind == Lbc, constraint),
            ("output", "a CTC, DTC or LBC", composite, output),
            ("update", "a DTC", d.kind != Dtc, update),
            ("initial", "a CTC, DTC or LBC", composite, (!d.initial.is_empty()).then_some(place)),
        ];
        for (section, suits, is_wrong, span) in wrong {
            if let (true, Some(span)) = (is_wrong, span) {
                self.report(hs0127_declaration_for_another_kind::section(d.kind, section, suits, span));
            }
        }
        let equations = equation_names(d);
        for (name, at) in assigned_names(d) {
            // An equation of a state is a mistake of its own; what a location declares, another one may, too.
            let is_state = |v: &VariableDeclaration| v.name.value == name && v.role == VariableRole::State;
            let of_location = |l: &LocationDeclaration| l.variables.iter().any(|v| v.name.value == name);
            let is_own = d.variables.iter().any(is_state) || d.locations.iter().any(of_location);
            if let (Some(&first), false) = (equations.get(name), is_own || d.dialect == Dialect::Xml) {
                let what = format!("`{name}`, by an equation and by an assignment,");
                self.report(hs0108_defined_twice::diagnostic(&what, first, at));
            }
        }
        for location in &d.locations {
            let equations = defined_by(std::iter::once(&location.equations));
            let actions = location.transitions.iter().flat_map(|transition| &transition.actions);
            let assigned = assigned_by(actions.collect());
            for name in location.variables.iter().filter(|v| v.role == VariableRole::Local).map(|v| &v.name) {
                let twice = equations.get(name.value.as_str()).zip(assigned.get(name.value.as_str()));
                if let Some((&first, &at)) = twice {
                    let what = format!("`{}`, by an equation and by an assignment,", name.value);
                    self.report(hs0108_defined_twice::diagnostic(&what, first, at));
                }
            }
        }
        if let (Some(clock), true) = (&d.clock, d.kind != Dtc) {
            let span = match clock {
                crate::declarations::ClockDeclaration::Announced { name, .. } => name.span,
                crate::declarations::ClockDeclaration::Every { span, .. } => *span,
            };
            self.report(hs0127_declaration_for_another_kind::section(d.kind, "tsample", "a DTC", span));
        }
    }

    /// What only all locations together show.
    pub(crate) fn check_automaton(&mut self, locations: &[BuiltLocation<'_>], events: &[EventSection]) {
        let declaration = self.declaration;
        let mut meant: BTreeSet<String> =
            locations.iter().flat_map(|l| l.defined.meant.iter().cloned()).collect();
        meant.append(&mut self.constrained);
        self.check_strays(locations, &mut meant);
        let mut found = Diagnostics::default();
        for diagnostic in hs0106_unit_for_unknown_name::find(declaration, &self.symbols) {
            found.push(diagnostic);
        }
        hs0112_location_declared_twice::find(declaration, &mut found);
        hs0113_transition_declared_twice::find(declaration, &mut found);
        hs0114_unknown_destination::find(declaration, &mut found);
        hs0115_unknown_initial_location::find(declaration, &mut found);
        hs0116_unreachable_location::find(declaration, locations, &self.graph, &mut found);
        hs0401_constant_guard::find(locations, &self.graph, &mut found);
        hs0402_taken_on_entry::find(declaration, locations, &mut self.graph, &mut found);
        hs0403_round_without_time::find(locations, &self.graph, &mut found);
        self.shared.findings.report_all(found);
        if declaration.dialect == Dialect::Xml && declaration.locations.is_empty() {
            self.report(hs0119_no_location::diagnostic(&declaration.name.value, declaration.name.span));
            return;
        }
        self.check_states(locations, &meant);
        self.check_values(locations, &meant);
        let listened: HashSet<VariableId> = events.iter().map(|section| section.flag).collect();
        let flags: Vec<VariableId> = self.ids_of(|kind| kind == VariableKind::Flag);
        let written: HashSet<&str> =
            declaration.events.iter().map(|event| event.flag.value.as_str()).collect();
        for flag in flags {
            let variable = &self.variables[flag.0 as usize];
            let base = variable.name.split('[').next().unwrap_or("");
            if !listened.contains(&flag) && !written.contains(base) {
                let (name, span) = (variable.name.clone(), variable.span.unwrap_or(declaration.name.span));
                self.report(hs0144_flag_without_event::diagnostic(&name, span));
            }
        }
    }

    /// The level of a flag that is a quantity minus a number.
    fn surface(&self, locations: &[BuiltLocation<'_>], flag: VariableId) -> Option<Surface> {
        let node = locations.first()?.defined.values.get(&flag)?.right?;
        let (quantity, level) = match self.graph.node(node) {
            Node::Binary(Binary::Subtract, a, b) => match (self.known_value(a), self.known_value(b)) {
                (None, Some(level)) => (a, level),
                (Some(level), None) => (b, level),
                _ => return None,
            },
            Node::Binary(Binary::Add, a, b) => match (self.known_value(a), self.known_value(b)) {
                (None, Some(level)) => (a, -level),
                (Some(level), None) => (b, -level),
                _ => return None,
            },
            _ => (node, 0.0),
        };
        Some(Surface { quantity, level })
    }

    /// Complains about actions of equal priority that can meet at an instant and assign one variable.
    pub(crate) fn check_meetings(
        &mut self,
        locations: &[BuiltLocation<'_>],
        events: &[EventSection],
        rules: &[Rule],
    ) {
        /// What acts, with its priority; what has one number never acts together.
        type Actor<'n> = (usize, i32, &'n Actions, Span);
        let mut actors: Vec<Actor<'_>> = Vec::new();
        for transition in locations.iter().flat_map(|location| &location.transitions) {
            actors.push((0, transition.priority, &transition.actions, transition.declaration.name.span));
        }
        let mut group = 0;
        let surfaces: Vec<Option<Surface>> =
            events.iter().map(|section| self.surface(locations, section.flag)).collect();
        for section in events {
            group += 1;
            for actions in section.rising.iter().chain(&section.falling) {
                let span = section.span.unwrap_or(self.declaration.name.span);
                actors.push((group, section.priority, actions, span));
            }
        }
        let mut conditions: HashMap<usize, NodeId> = HashMap::new();
        for rule in rules.iter().filter(|rule| rule.delay.is_none()) {
            // Events are received one by one, after all conditions have been answered.
            let on_event = self.graph.dependencies([rule.condition]).into_iter().any(|leaf| match leaf {
                Leaf::Special(k) => matches!(self.specials.get(k as usize), Some(Special::Event(_))),
                _ => false,
            });
            if on_event {
                continue;
            }
            group += 1;
            conditions.insert(group, rule.condition);
            actors.push((
                group,
                rule.priority,
                &rule.actions,
                rule.span.unwrap_or(self.declaration.name.span),
            ));
        }
        let mut first: HashMap<(VariableId, i32), (usize, NodeId, Span)> = HashMap::new();
        let mut found = Vec::new();
        for (group, priority, actions, span) in actors {
            for assignment in &actions.assignments {
                let key = (assignment.variable, priority);
                match first.get(&key) {
                    Some(&(other, right, other_span)) if other != group => {
                        if let [Some(Some(a)), Some(Some(b))] = [other, group]
                            .map(|g| g.checked_sub(1).map(|g| surfaces.get(g).copied().flatten()))
                            && a.quantity == b.quantity
                            && a.level != b.level
                        {
                            continue; // two levels of one quantity are not reached together
                        }
                        if let [Some(&a), Some(&b)] = [other, group].map(|g| conditions.get(&g))
                            && self.never_meet(a, b)
                        {
                            continue;
                        }
                        let same_constant =
                            right == assignment.right && self.graph.as_number(right).is_some();
                        if !same_constant && other_span != span {
                            let name = self.variables[assignment.variable.0 as usize].name.clone();
                            found.push(hs0146_assigned_by_two::diagnostic(&name, other_span, span));
                        }
                    }
                    Some(_) => {}
                    None => {
                        first.insert(key, (group, assignment.right, span));
                    }
                }
            }
        }
        for diagnostic in found {
            self.report(diagnostic);
        }
    }

    fn ids_of(&self, kind: impl Fn(VariableKind) -> bool) -> Vec<VariableId> {
        let numbered = self.variables.iter().enumerate();
        numbered.filter(|(_, v)| kind(v.kind)).map(|(k, _)| VariableId(k as u32)).collect()
    }

    fn check_strays(&mut self, locations: &[BuiltLocation<'_>], meant: &mut BTreeSet<String>) {
        let strays = std::mem::take(&mut self.strays);
        let names: Vec<(String, SymbolKind)> =
            self.all_names().into_iter().map(|(name, symbol)| (name.to_owned(), symbol.kind)).collect();
        let states: Vec<&str> = names
            .iter()
            .filter(|(_, kind)| *kind == SymbolKind::State)
            .map(|(name, _)| name.as_str())
            .collect();
        let has_equation = |state: &&str| {
            let id = match self.symbols.get(state).map(|symbol| &symbol.value) {
                Some(SymbolValue::Variable(variable)) => variable.first,
                _ => return true,
            };
            locations.iter().all(|location| location.defined.rates.contains_key(&id))
        };
        let (with, without): (Vec<&str>, Vec<&str>) = states.iter().partition(|state| has_equation(state));
        let likely_states: Vec<&str> = without.into_iter().chain(with).collect();
        let xml = self.declaration.dialect == Dialect::Xml;
        let outputs: Vec<&str> = if xml {
            let all = self.declaration.ports.iter();
            all.filter(|port| port.direction == crate::declarations::Direction::Output)
                .map(|port| port.name.value.as_str())
                .collect()
        } else {
            let defined = |kind| matches!(kind, SymbolKind::Output | SymbolKind::Local | SymbolKind::Flag);
            names.iter().filter(|(_, kind)| defined(*kind)).map(|(name, _)| name.as_str()).collect()
        };
        let has_value = |output: &&str| match self.symbols.get(output).map(|symbol| &symbol.value) {
            Some(SymbolValue::Variable(variable)) => {
                locations.iter().all(|location| location.defined.values.contains_key(&variable.first))
            }
            _ => true,
        };
        let (with, without): (Vec<&str>, Vec<&str>) = outputs.iter().partition(|output| has_value(output));
        let likely_outputs: Vec<&str> = without.into_iter().chain(with).collect();
        let mut reports = hs0102_equation_for_undeclared_state::find(&strays.rates, &likely_states);
        let what = if xml { "output" } else { "local or output" };
        let resets = hs0103_reset_of_undeclared_state::find(&strays.resets, &likely_states);
        reports.extend(resets.into_iter().map(|diagnostic| (diagnostic, None)));
        reports.extend(hs0104_map_for_undeclared_output::find(&strays.values, &likely_outputs, what));
        for (diagnostic, name) in reports {
            self.report(diagnostic);
            self.suggested.extend(name.iter().cloned());
            meant.extend(name);
        }
    }

    /// Whether a variable exists in a location.
    fn lives_in(&self, id: VariableId, location: usize) -> bool {
        self.homes.get(&id).is_none_or(|&home| home == location)
    }

    /// The name that a variable is declared by, without indices.
    fn base(&self, id: VariableId) -> &str {
        let name = &self.variables[id.0 as usize].name;
        self.symbols.declared_as(id).unwrap_or_else(|| name.split('[').next().unwrap_or(name))
    }

    fn check_states(&mut self, locations: &[BuiltLocation<'_>], meant: &BTreeSet<String>) {
        let has_locations = !self.declaration.locations.is_empty();
        let mut found = Vec::new();
        let mut seen: BTreeSet<String> = BTreeSet::new();
        for state in self.ids_of(|kind| matches!(kind, VariableKind::State(_))) {
            let variable = &self.variables[state.0 as usize];
            let base = self.base(state).to_owned();
            let span = variable.span.unwrap_or(self.declaration.name.span);
            if meant.contains(&base) || seen.contains(&base) {
                continue;
            }
            let constrained = |l: &BuiltLocation<'_>| {
                let nodes = l.constraints.iter().flat_map(|c| [c.left, c.right]);
                self.graph.dependencies(nodes).contains(&sophy_ir::Leaf::Variable(state))
            };
            let defines = |l: &&BuiltLocation<'_>| l.defined.rates.contains_key(&state) || constrained(l);
            let living = locations.iter().enumerate().filter(|(k, _)| self.lives_in(state, *k));
            let lacking: Vec<&BuiltLocation<'_>> =
                living.map(|(_, location)| location).filter(|l| !defines(l)).collect();
            if lacking.is_empty() {
                continue;
            }
            if !locations.iter().any(|l| defines(&l)) {
                if has_locations || !locations.is_empty() {
                    found.push(hs0110_state_without_equation::nowhere(&variable.name, span, has_locations));
                    seen.insert(base);
                }
                continue;
            }
            for location in lacking {
                let Some(written) = location.declaration else { continue };
                found.push(hs0110_state_without_equation::diagnostic(
                    &variable.name,
                    span,
                    &written.name.value,
                    written.name.span,
                ));
            }
            seen.insert(base);
        }
        for diagnostic in found {
            self.report(diagnostic);
        }
    }

    /// Outputs, locals and flags have an equation in every location, or a constraint determines them.
    fn check_values(&mut self, locations: &[BuiltLocation<'_>], meant: &BTreeSet<String>) {
        let assigned: BTreeSet<String> =
            assigned_names(self.declaration).into_keys().map(str::to_owned).collect();
        let xml = self.declaration.dialect == Dialect::Xml;
        let mut lacking_maps: Vec<(VariableId, Vec<(String, Span)>)> = Vec::new();
        let mut found = Vec::new();
        let mut seen: BTreeSet<String> = BTreeSet::new();
        let with_value =
            |kind| matches!(kind, VariableKind::Local | VariableKind::Flag | VariableKind::Output);
        let ids = self.ids_of(with_value);
        for (position, location) in locations.iter().enumerate() {
            let read = self.graph.dependencies(location.nodes());
            let lacking: Vec<VariableId> = ids
                .iter()
                .copied()
                .filter(|&id| {
                    let base = self.base(id);
                    let is_local = self.variables[id.0 as usize].kind == VariableKind::Local;
                    let only_assigned =
                        is_local && assigned.contains(base) && !read.contains(&sophy_ir::Leaf::Variable(id));
                    let defined = location.defined.values.contains_key(&id) || meant.contains(base);
                    self.lives_in(id, position) && !defined && !only_assigned
                })
                .collect();
            let matched = self.matched(&location.defined, &location.constraints, &lacking, true);
            let place =
                location.declaration.map_or_else(String::new, |l| format!(" in location `{}`", l.name.value));
            let span = |k: usize| location.constraints[k].span.unwrap_or(self.declaration.name.span);
            for &constraint in &matched.superfluous {
                found.push(hs0145_constrained::too_many(span(constraint), &place));
            }
            let directly = self.matched(&location.defined, &location.constraints, &lacking, false);
            if let (Some(&constraint), true) = (directly.superfluous.first(), matched.superfluous.is_empty())
            {
                found.push(hs0145_constrained::higher_index(span(constraint), &place));
            }
            for id in matched.undetermined {
                let place = location.declaration.map(|l| (l.name.value.clone(), l.name.span));
                match lacking_maps.iter_mut().find(|(known, _)| *known == id) {
                    Some((_, places)) => places.extend(place),
                    None => lacking_maps.push((id, place.into_iter().collect())),
                }
            }
        }
        for (id, places) in lacking_maps {
            let variable = &self.variables[id.0 as usize];
            let base = self.base(id).to_owned();
            let span = variable.span.unwrap_or(self.declaration.name.span);
            if !seen.insert(base) {
                continue;
            }
            if xml {
                let places: Vec<(&str, Span)> =
                    places.iter().map(|(name, span)| (name.as_str(), *span)).collect();
                if !places.is_empty() {
                    found.push(hs0109_output_without_map::diagnostic(&variable.name, span, &places));
                }
                continue;
            }
            let kind = match variable.kind {
                VariableKind::Flag => SymbolKind::Flag,
                VariableKind::Output => SymbolKind::Output,
                _ => SymbolKind::Local,
            };
            let place = match places.as_slice() {
                [] => String::new(),
                all if all.len() == locations.len() => " in any location".to_owned(),
                [(name, _), ..] => format!(" in location `{name}`"),
            };
            let used = places.first().filter(|_| places.len() < locations.len()).map(|(_, span)| *span);
            found.push(hs0143_local_without_equation::diagnostic(&variable.name, kind, span, &place, used));
        }
        for diagnostic in found {
            self.report(diagnostic);
        }
    }

    fn matched(
        &self,
        defined: &Defined,
        constraints: &[Constraint],
        unknowns: &[VariableId],
        differentiated: bool,
    ) -> Matched {
        let is_state = |id: VariableId| matches!(self.variables[id.0 as usize].kind, VariableKind::State(_));
        match_constraints(&self.graph, defined, constraints, unknowns, is_state, differentiated)
    }

    /// Outputs and locals of a discrete-time component have an equation or are assigned, or a constraint determines
    /// them.
    pub(crate) fn check_discrete(&mut self, constraints: &[Constraint]) {
        let mut meant = std::mem::take(&mut self.constrained);
        self.check_strays(&[], &mut meant);
        let assigned: BTreeSet<String> =
            assigned_names(self.declaration).into_keys().map(str::to_owned).collect();
        let defined: BTreeSet<VariableId> = self.defined_values.clone();
        let mut seen = BTreeSet::new();
        let mut lacking = self.ids_of(|kind| matches!(kind, VariableKind::Local | VariableKind::Output));
        lacking.retain(|&id| {
            let base = self.base(id);
            !(defined.contains(&id) || meant.contains(base) || assigned.contains(base))
        });
        let matched = self.matched(&Defined::default(), constraints, &lacking, true);
        for constraint in matched.superfluous {
            let span = constraints[constraint].span.unwrap_or(self.declaration.name.span);
            self.report(hs0145_constrained::too_many(span, ""));
        }
        for id in matched.undetermined {
            let variable = &self.variables[id.0 as usize];
            if !seen.insert(self.base(id).to_owned()) {
                continue;
            }
            let kind =
                if variable.kind == VariableKind::Local { SymbolKind::Local } else { SymbolKind::Output };
            let span = variable.span.unwrap_or(self.declaration.name.span);
            let name = variable.name.clone();
            self.report(hs0143_local_without_equation::diagnostic(&name, kind, span, "", None));
        }
    }

    /// What the component declares, also in its locations.
    fn all_names(&self) -> Vec<(&str, &Symbol<'_>)> {
        let names = self.symbols.names().into_iter();
        let own = names.filter(|(name, s)| self.symbols.declared(name).is_some_and(|own| own.span == s.span));
        own.chain(self.symbols.of_locations().into_iter().map(|(_, name, symbol)| (name, symbol))).collect()
    }

    /// Unknown names, and names that are of no use.
    pub(crate) fn check_uses(&mut self) {
        let unknown = std::mem::take(&mut self.shared.findings.unknown_names);
        for (diagnostic, suggested) in hs0101_unknown_name::find(&unknown) {
            self.report(diagnostic);
            self.suggested.extend(suggested);
        }
        let mut found = Diagnostics::default();
        for diagnostic in hs0201_unknown_function::find(&unknown) {
            found.push(diagnostic);
        }
        let logarithms = std::mem::take(&mut self.shared.findings.logarithms);
        if let Some(diagnostic) = hs0206_natural_logarithm::find(&logarithms) {
            found.push(diagnostic);
        }
        self.shared.findings.report_all(found);
        let xml = self.declaration.dialect == Dialect::Xml;
        let composite = matches!(self.declaration.kind, ComponentKind::Cc | ComponentKind::System);
        let mut found = Vec::new();
        for (name, symbol) in self.all_names() {
            if hs0117_hidden_name::is_predefined(name) {
                found.push(hs0117_hidden_name::diagnostic(name, symbol.span, symbol.kind.with_article()));
            }
            if let Some(hidden) = self.shared.globals.get(name).filter(|_| !xml) {
                let [what, hides] = [symbol.kind, hidden.kind].map(SymbolKind::with_article);
                found.push(hs0117_hidden_name::of_the_file(name, symbol.span, what, hides, hidden.span));
            }
            let what = match symbol.kind {
                SymbolKind::Constant => "constant",
                SymbolKind::Input => "input",
                SymbolKind::Parameter => "parameter",
                SymbolKind::Knob => "knob",
                SymbolKind::Local if !self.is_seen(symbol) => "local",
                _ => continue,
            };
            let used = self.symbols.used().contains(name) || self.suggested.contains(name);
            let passed_on = composite && symbol.kind == SymbolKind::Input;
            let visible = !xml && self.is_seen(symbol);
            if !(used || passed_on || visible) {
                found.push(hs0118_unused::diagnostic(what, name, symbol.span));
            }
        }
        for diagnostic in found {
            self.report(diagnostic);
        }
    }

    /// Whether a variable can be seen from outside.
    fn is_seen(&self, symbol: &Symbol<'_>) -> bool {
        let SymbolValue::Variable(symbol) = &symbol.value else { return true };
        let variable = &self.variables[symbol.first.0 as usize];
        variable.viewed || variable.kind == VariableKind::Output
    }
}
