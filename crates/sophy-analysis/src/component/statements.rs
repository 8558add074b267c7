use super::builder::Builder;
use super::checks::Stray;
use super::equations::shape_of_part;
use crate::checks::{
    hs0108_defined_twice, hs0126_out_of_range, hs0132_unknown_event, hs0133_not_assignable,
    hs0134_hold_without_flag, hs0147_read_before_assigned, hs0148_of_another_location,
};
use crate::declarations::{
    ComponentDeclaration, Dialect, EquationItem, Equations, ExpressionText, Spanned, Statement, Target,
};
use crate::lower::{Elements, Place, Symbol, SymbolKind, SymbolValue, Typed};
use sophy_diagnostics::Span;
use sophy_ir::{
    Actions, Allowed, Assignment, Emission, Leaf, Node, NodeId, Variable, VariableId, VariableKind,
};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Where statements stand, and what they may do there.
#[derive(Clone, Copy)]
pub(crate) struct Setting<'s> {
    /// For messages: `in transition `t``.
    pub(crate) place: &'s str,
    /// What right-hand sides may read.
    pub(crate) reads: Place,
    /// Whether events can be emitted.
    pub(crate) emits: bool,
    /// Whether `hold` has a meaning.
    pub(crate) holds: bool,
    /// The location that is entered then, if one is: what exists only there can be assigned.
    pub(crate) enters: Option<usize>,
}

/// New values so far, element by element.
#[derive(Clone, Default)]
struct New {
    values: BTreeMap<VariableId, (Option<NodeId>, Span, Span)>,
    /// Locals with their new elements.
    locals: HashMap<String, Typed>,
}

struct Doing<'s> {
    setting: Setting<'s>,
    emissions: Vec<Emission>,
    holds: Vec<VariableId>,
    /// Under which condition the present statement is done.
    when: Option<NodeId>,
}

impl<'a> Builder<'_, 'a> {
    /// What statements do at an instant. Right-hand sides read the values before; a local is assigned above its use
    /// and has its new value there.
    pub(crate) fn actions(&mut self, statements: &'a [Statement], setting: Setting<'_>) -> Actions {
        let mark = self.symbols.enter();
        let mut doing = Doing { setting, emissions: Vec::new(), holds: Vec::new(), when: None };
        let mut new = New::default();
        self.statements(statements, &mut new, &mut doing);
        self.symbols.leave(mark);
        let assignment = |(variable, (right, span, _)): (VariableId, (Option<NodeId>, Span, Span))| {
            Some(Assignment { variable, right: right?, span: Some(span) })
        };
        Actions {
            assignments: new.values.into_iter().filter_map(assignment).collect(),
            emissions: doing.emissions,
            holds: doing.holds,
        }
    }

    fn statements(&mut self, statements: &'a [Statement], new: &mut New, doing: &mut Doing<'_>) {
        for statement in statements {
            match statement {
                Statement::Assign { target, right } => self.assign(target, right, new, doing),
                Statement::Emit(label) => self.emit(label, doing),
                Statement::Hold(flag) => self.hold(flag, doing),
                Statement::If { branches, otherwise } => self.choose(branches, otherwise, new, doing),
                Statement::For(turns) => {
                    // What a turn assigns to a local, the next one reads, and so does what follows the loop.
                    self.each_turn(turns, |b| {
                        b.bind_locals(new);
                        b.statements(&turns.items, new, doing);
                    });
                    self.bind_locals(new);
                }
            }
        }
    }

    fn assign(
        &mut self,
        target: &'a Target,
        right: &'a ExpressionText,
        new: &mut New,
        doing: &mut Doing<'_>,
    ) {
        let name = &target.name;
        let reads = doing.setting.reads;
        let found = self.assigned_symbol(name, doing);
        let assignable = match &found {
            _ if name.value.is_empty() => false,
            Some(Symbol { value: SymbolValue::Broken, .. }) => false,
            Some(symbol) if self.is_left(symbol, name, doing) => false,
            Some(Symbol { kind: SymbolKind::State | SymbolKind::Mode | SymbolKind::Local, .. }) => true,
            found if self.declaration.dialect == Dialect::Xml => {
                let found = found.as_ref().map(|symbol| (symbol.kind, symbol.span));
                self.strays.resets.push(Stray { name: name.value.clone(), span: name.span, found });
                false
            }
            Some(symbol) => {
                self.report(hs0133_not_assignable::diagnostic(name, symbol.kind, symbol.span));
                false
            }
            None => {
                let enters_nothing = self.symbols.is_in_location() && doing.setting.enters.is_none();
                let is_guess = enters_nothing && !self.symbols.elsewhere(&name.value).is_empty();
                if !is_guess && !self.is_of_another_location(name) {
                    let diagnostic = hs0133_not_assignable::unknown(name, &self.symbols);
                    self.report(diagnostic);
                }
                false
            }
        };
        let symbol = found.as_ref().filter(|_| assignable);
        let Some((symbol, mut expected)) = symbol.and_then(|s| Builder::expected_of(s, &name.value, ""))
        else {
            self.at(reads).value(right);
            return;
        };
        let Some(ids) = self.target_elements(target, &symbol) else {
            self.at(reads).value(right);
            return;
        };
        expected.shape = shape_of_part(symbol.shape, target.indices.len());
        let value = self.at(reads).value_for(right, &expected);
        let nodes = value.as_ref().map(|value| value.elements.as_slice().to_vec());
        if let Some(nodes) = &nodes
            && !matches!(found, Some(Symbol { kind: SymbolKind::Local, .. }))
        {
            self.check_assigned_before(nodes, right.span);
            self.check_assigned_range(&ids, nodes, right.span);
        }
        let is_local = matches!(found, Some(Symbol { kind: SymbolKind::Local, .. }));
        if is_local {
            self.assign_local(target, &ids, symbol.first, value, new);
            if self.is_held_local(&name.value) {
                for (k, id) in ids.into_iter().enumerate() {
                    let node = nodes.as_ref().and_then(|nodes| nodes.get(k).copied());
                    new.values.insert(id, (node, right.span, name_span(target)));
                }
            }
            return;
        }
        for (k, id) in ids.into_iter().enumerate() {
            let node = nodes.as_ref().and_then(|nodes| nodes.get(k).copied());
            // A loop that does one statement several times ends with what the last turn assigns.
            if let Some(&(_, _, first)) = new.values.get(&id)
                && first != name_span(target)
            {
                let name = &self.variables[id.0 as usize].name;
                let what = match self.declaration.dialect {
                    Dialect::Xml => format!("the reset of `{name}`{}", doing.setting.place),
                    Dialect::Hsml => format!("`{name} :=`{}", doing.setting.place),
                };
                self.report(hs0108_defined_twice::diagnostic(&what, first, name_span(target)));
                continue;
            }
            new.values.insert(id, (node, right.span, name_span(target)));
        }
    }

    /// What an assignment to a name is about: that of the location that is entered before all others.
    fn assigned_symbol(&self, name: &Spanned<String>, doing: &Doing<'_>) -> Option<Symbol<'a>> {
        let entered = doing.setting.enters.and_then(|entered| self.symbols.of_location(entered, &name.value));
        let entered = entered.filter(|symbol| symbol.kind != SymbolKind::Local);
        entered.or_else(|| self.symbols.declared(&name.value)).cloned()
    }

    /// Whether something is assigned that ends with the location that is left; says so.
    fn is_left(&mut self, symbol: &Symbol<'a>, name: &Spanned<String>, doing: &Doing<'_>) -> bool {
        let SymbolValue::Variable(variable) = &symbol.value else { return false };
        let home = self.homes.get(&variable.first).copied();
        let Some(home) = home.filter(|_| home != doing.setting.enters) else { return false };
        if symbol.kind == SymbolKind::Local || doing.setting.enters.is_none() {
            return false; // holds until the last statement; enters nobody knows what
        }
        let place = self.symbols.locations.get(home).cloned().unwrap_or_default();
        let found =
            hs0148_of_another_location::left(&name.value, name.span, symbol.kind, &place, symbol.span);
        self.report(found);
        true
    }

    /// Whether a name that is not known here is declared by other locations for themselves; says so.
    pub(crate) fn is_of_another_location(&mut self, name: &Spanned<String>) -> bool {
        let Some(&(location, symbol)) = self.symbols.elsewhere(&name.value).first() else { return false };
        let place = self.symbols.locations.get(location).map_or("", String::as_str);
        let found =
            hs0148_of_another_location::diagnostic(&name.value, name.span, symbol.kind, place, symbol.span);
        self.report(found);
        true
    }

    /// Complains about a number outside the range of the variable that it is assigned to.
    pub(crate) fn check_assigned_range(&mut self, ids: &[VariableId], nodes: &[NodeId], at: Span) {
        for (&id, &node) in ids.iter().zip(nodes) {
            let Variable { name, range, span, .. } = &self.variables[id.0 as usize];
            let declared = span.unwrap_or(at);
            let found = match range {
                Some(Allowed::OneOf(set)) => {
                    let strange = self.outcomes(node).iter().any(|outcome| !set.contains(outcome));
                    strange.then(|| hs0126_out_of_range::not_in_set(name, at, declared))
                }
                Some(Allowed::Between(bounds)) => self.known_value(node).and_then(|value| {
                    let [low, high] = self.known_bounds(*bounds)?;
                    let outside = !(low..=high).contains(&value);
                    outside.then(|| hs0126_out_of_range::diagnostic(name, value, low, high, at, declared))
                }),
                None => None,
            };
            if let Some(found) = found {
                self.report(found);
            }
        }
    }

    /// Numbers that a value can be, as far as they are known.
    fn outcomes(&self, node: NodeId) -> Vec<f64> {
        let mut found = Vec::new();
        let mut seen = BTreeSet::new();
        let mut pending = vec![node];
        while let Some(node) = pending.pop() {
            if !seen.insert(node) {
                continue;
            }
            match self.graph.node(node) {
                Node::Select(_, a, b) => pending.extend([b, a]),
                _ => found.extend(self.known_value(node)),
            }
        }
        found
    }

    fn assign_local(
        &mut self,
        target: &'a Target,
        ids: &[VariableId],
        first: VariableId,
        value: Option<Typed>,
        new: &mut New,
    ) {
        let Some(value) = value else { return };
        let name = &target.name.value;
        let whole = if target.indices.is_empty() {
            Some(value)
        } else {
            // The other elements keep what they have.
            self.at(Place::INSTANT).variable(name).map(|old| {
                let mut elements = old.elements.as_slice().to_vec();
                for (id, node) in ids.iter().zip(value.elements.as_slice()) {
                    if let Some(element) = elements.get_mut((id.0 - first.0) as usize) {
                        *element = *node;
                    }
                }
                Typed { elements: Elements::from(elements), ..old }
            })
        };
        if let Some(whole) = whole {
            new.locals.insert(name.clone(), whole.clone());
            self.symbols.bind(name, SymbolKind::Local, target.name.span, whole);
        }
    }

    fn emit(&mut self, label: &'a Spanned<String>, doing: &mut Doing<'_>) {
        let known = self.declaration.ports.iter().any(|port| port.name.value == label.value);
        let xml = self.declaration.dialect == Dialect::Xml;
        if !xml && (!known || !doing.setting.emits) {
            let diagnostic = hs0132_unknown_event::emitted(label, self.declaration, doing.setting.emits);
            self.report(diagnostic);
            return;
        }
        if !xml && !hs0132_unknown_event::is_output_event(self.declaration, &label.value) {
            self.report(hs0132_unknown_event::emitted(label, self.declaration, true));
            return;
        }
        doing.emissions.push(Emission { label: label.value.as_str().into(), when: doing.when });
    }

    fn hold(&mut self, flag: &'a Spanned<String>, doing: &mut Doing<'_>) {
        match self.symbols.look_up(&flag.value) {
            Some(symbol) if symbol.kind == SymbolKind::Flag && doing.setting.holds => {
                if let SymbolValue::Variable(variable) = symbol.value {
                    doing.holds.push(variable.first);
                }
            }
            found => {
                let kind = found.map(|symbol| (symbol.kind, symbol.span));
                self.report(hs0134_hold_without_flag::diagnostic(flag, kind, doing.setting.place));
            }
        }
    }

    /// `if … then … elsif … else … end if`: what a branch leaves alone keeps its value.
    fn choose(
        &mut self,
        branches: &'a [(ExpressionText, Vec<Statement>)],
        otherwise: &'a [Statement],
        new: &mut New,
        doing: &mut Doing<'_>,
    ) {
        let outer = doing.when;
        let before = new.clone();
        let mut results: Vec<(Option<NodeId>, New)> = Vec::new();
        let mut remaining = outer;
        for (condition, statements) in branches {
            let at = condition.span;
            let condition = self.at(doing.setting.reads).condition(condition);
            if let Some(condition) = condition {
                self.check_assigned_before(&[condition], at);
            }
            doing.when = self.both(remaining, condition);
            let result = self.branch(statements, &before, doing);
            results.push((condition, result));
            let negated = condition.map(|condition| self.graph.not(condition));
            remaining = self.both(remaining, negated);
        }
        doing.when = remaining;
        let last = self.branch(otherwise, &before, doing);
        doing.when = outer;
        let mut merged = last;
        for (condition, result) in results.into_iter().rev() {
            merged = self.merge_branches(condition, result, merged);
        }
        self.bind_locals(&merged);
        *new = merged;
    }

    fn bind_locals(&mut self, new: &New) {
        for (name, value) in &new.locals {
            if let Some(span) = self.symbols.declared(name).map(|symbol| symbol.span) {
                self.symbols.bind(name, SymbolKind::Local, span, value.clone());
            }
        }
    }

    /// Complains about a local that has no equation and is read before the section assigns it.
    fn check_assigned_before(&mut self, nodes: &[NodeId], at: Span) {
        for leaf in self.graph.dependencies(nodes.iter().copied()) {
            let Leaf::Variable(id) = leaf else { continue };
            let Some(variable) = self.variables.get(id.0 as usize) else { continue };
            let base = self.symbols.declared_as(id).unwrap_or(&variable.name);
            // What an update assigns to a local lasts to the next one, for the output equations only.
            let held = matches!(variable.kind, VariableKind::Mode(_)) && self.is_held_local(base) && {
                let declared = self.declaration.variables.iter().find(|v| v.name.value == base);
                declared.is_some_and(|v| v.role == crate::declarations::VariableRole::Local)
            };
            let nothing = variable.kind == VariableKind::Local && !self.with_equation.contains(base);
            if nothing || held {
                let (name, declared) = (variable.name.clone(), variable.span);
                self.report(hs0147_read_before_assigned::diagnostic(&name, at, declared));
            }
        }
    }

    fn both(&mut self, a: Option<NodeId>, b: Option<NodeId>) -> Option<NodeId> {
        match (a, b) {
            (Some(a), Some(b)) => Some(self.graph.and(a, b)),
            (only, None) | (None, only) => only,
        }
    }

    fn branch(&mut self, statements: &'a [Statement], before: &New, doing: &mut Doing<'_>) -> New {
        let mark = self.symbols.enter();
        let mut new = before.clone();
        self.statements(statements, &mut new, doing);
        self.symbols.leave(mark);
        new
    }

    fn merge_branches(&mut self, condition: Option<NodeId>, a: New, b: New) -> New {
        let mut merged = New::default();
        let ids: BTreeSet<VariableId> = a.values.keys().chain(b.values.keys()).copied().collect();
        for id in ids {
            let (of_a, of_b) = (a.values.get(&id), b.values.get(&id));
            let Some(&(_, span, target)) = of_a.or(of_b) else { continue };
            let old = self.graph.leaf(Leaf::Variable(id));
            let node = |of: Option<&(Option<NodeId>, Span, Span)>| of.map_or(Some(old), |(node, ..)| *node);
            let value = match (condition, node(of_a), node(of_b)) {
                (Some(c), Some(a), Some(b)) => Some(self.graph.select(c, a, b)),
                _ => None,
            };
            merged.values.insert(id, (value, span, target));
        }
        for (name, of_a) in &a.locals {
            // A local that only one branch assigns has no value behind.
            let (Some(of_b), Some(c)) = (b.locals.get(name), condition) else { continue };
            let pairs = of_a.elements.as_slice().iter().zip(of_b.elements.as_slice());
            let elements: Vec<NodeId> = pairs.map(|(&a, &b)| self.graph.select(c, a, b)).collect();
            let value = Typed { elements: Elements::from(elements), ..of_a.clone() };
            merged.locals.insert(name.clone(), value);
        }
        merged
    }
}

fn name_span(target: &Target) -> Span {
    target.name.span
}

/// Names that some `:=` section of a component assigns, with a place where it does.
pub(crate) fn assigned_names(declaration: &ComponentDeclaration) -> BTreeMap<&str, Span> {
    let mut pending: Vec<&Statement> = Vec::new();
    let d = declaration;
    pending.extend(d.update.iter());
    pending.extend(d.initial.iter());
    pending.extend(d.locations.iter().flat_map(|l| &l.transitions).flat_map(|t| &t.actions));
    for event in &d.events {
        pending.extend(event.rising.iter().chain(&event.falling).flatten());
    }
    pending.extend(d.rules.iter().flat_map(|rule| &rule.actions));
    assigned_by(pending)
}

/// Names that statements assign, with a place where they do.
pub(crate) fn assigned_by(mut pending: Vec<&Statement>) -> BTreeMap<&str, Span> {
    let mut names = BTreeMap::new();
    while let Some(statement) = pending.pop() {
        match statement {
            Statement::Assign { target, .. } => {
                names.entry(target.name.value.as_str()).or_insert(target.name.span);
            }
            Statement::If { branches, otherwise } => {
                pending.extend(branches.iter().flat_map(|(_, statements)| statements));
                pending.extend(otherwise);
            }
            Statement::For(turns) => pending.extend(&turns.items),
            Statement::Emit(_) | Statement::Hold(_) => {}
        }
    }
    names
}

/// Names that some equation `name = …` of a component defines, with a place where it does.
pub(crate) fn equation_names(declaration: &ComponentDeclaration) -> BTreeMap<&str, Span> {
    let of_locations = declaration.locations.iter().map(|location| &location.equations);
    defined_by(std::iter::once(&declaration.equations).chain(of_locations))
}

/// Names that equations `name = …` define, with a place where they do.
pub(crate) fn defined_by<'d>(sections: impl Iterator<Item = &'d Equations>) -> BTreeMap<&'d str, Span> {
    let mut names = BTreeMap::new();
    let mut pending: Vec<&EquationItem> = sections.flat_map(|e| e.dynamics.iter().chain(&e.output)).collect();
    while let Some(item) = pending.pop() {
        match item {
            EquationItem::Equation(equation) if !equation.derivative => {
                names.entry(equation.target.name.value.as_str()).or_insert(equation.target.name.span);
            }
            EquationItem::Equation(_) => {}
            EquationItem::If { branches, otherwise, .. } => {
                pending.extend(branches.iter().flat_map(|(_, items)| items));
                pending.extend(otherwise.iter().flatten());
            }
            EquationItem::For(turns) => pending.extend(&turns.items),
        }
    }
    names
}
