use super::builder::Builder;
use super::checks::Stray;
use crate::checks::{
    hs0108_defined_twice, hs0111_output_differs_from_state, hs0117_hidden_name,
    hs0129_not_defined_by_equations, hs0130_branches_differ, hs0131_loop_bounds,
};
use crate::declarations::{
    ComponentKind, Dialect, Direction, EquationDeclaration, EquationItem, Equations, ExpressionText, Loop,
    Target,
};
use crate::lower::{Expected, Place, Shape, Symbol, SymbolKind, SymbolValue, Typed, VariableSymbol};
use sophy_diagnostics::Span;
use sophy_ir::{Graph, Leaf, Node, NodeId, VariableId};
use std::collections::BTreeMap;

/// What defines an element of a variable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Definition {
    /// `None` if it has mistakes.
    pub(crate) right: Option<NodeId>,
    /// Where the right-hand side stands.
    pub(crate) span: Span,
    /// Where the left-hand side stands.
    pub(crate) target: Span,
}

/// Equations, element by element.
#[derive(Clone, Debug, Default)]
pub(crate) struct Defined {
    /// `der(x) = …`.
    pub(crate) rates: BTreeMap<VariableId, Definition>,
    /// `y = …`.
    pub(crate) values: BTreeMap<VariableId, Definition>,
    /// States of equations that were not understood, by name: nothing is said of their lack of an equation.
    pub(crate) meant: Vec<String>,
}

/// The section an equation stands in.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Section {
    Dynamics,
    Output,
}

/// How many times a loop may run.
const MOST_TURNS: i64 = 10_000_000;

impl<'a> Builder<'_, 'a> {
    /// The equations of the sections of a body or a location; `place` says which, in messages.
    pub(crate) fn define(&mut self, equations: &'a Equations, place: &str) -> Defined {
        let mut defined = Defined::default();
        self.define_items(&equations.dynamics, Section::Dynamics, place, &mut defined);
        self.define_items(&equations.output, Section::Output, place, &mut defined);
        defined
    }

    fn define_items(
        &mut self,
        items: &'a [EquationItem],
        section: Section,
        place: &str,
        defined: &mut Defined,
    ) {
        for item in items {
            match item {
                EquationItem::Equation(equation) => self.define_one(equation, section, place, defined),
                EquationItem::For(turns) => {
                    let errors = self.shared.findings.error_count();
                    self.each_turn(turns, |b| b.define_items(&turns.items, section, place, defined));
                    if self.shared.findings.error_count() > errors {
                        defined.meant.extend(targets(&turns.items)); // in turns that were not looked at
                    }
                }
                EquationItem::If { branches, otherwise, span } => {
                    let branches_defined =
                        self.define_if(branches, otherwise.as_deref(), *span, section, place);
                    self.merge(defined, branches_defined, place);
                }
            }
        }
    }

    /// Runs `turn` once for each value of the loop variable.
    pub(crate) fn each_turn<T>(&mut self, turns: &'a Loop<T>, mut turn: impl FnMut(&mut Self)) {
        let place = Place { what: "a bound of a loop", ..Place::PARAMETER };
        let from = self.at(place).constant_integer(&turns.from, "the first value of a loop");
        let to = self.at(place).constant_integer(&turns.to, "the last value of a loop");
        let (Some(from), Some(to)) = (from, to) else {
            // Other mistakes of the turn are looked for all the same.
            let mark = self.symbols.enter();
            let (kind, span) = (SymbolKind::LoopVariable, turns.variable.span);
            let unknown = Symbol { kind, span, value: SymbolValue::Broken };
            self.symbols.bind_symbol(&turns.variable.value, unknown);
            turn(self);
            self.symbols.leave(mark);
            return;
        };
        if to.saturating_sub(from) >= MOST_TURNS {
            self.report(hs0131_loop_bounds::too_many(from, to, turns.from.span, turns.to.span));
            return;
        }
        if to < from {
            self.report(hs0131_loop_bounds::empty(from, to, turns.from.span, turns.to.span));
        }
        let name = &turns.variable;
        if let Some(hidden) = self.symbols.get(&name.value) {
            let (kind, span) = (hidden.kind, hidden.span);
            self.report(hs0117_hidden_name::declared(&name.value, name.span, kind.with_article(), span));
        }
        let errors = self.shared.findings.error_count();
        for value in from..=to {
            let mark = self.symbols.enter();
            let bound = self.integer(value);
            self.symbols.bind(&turns.variable.value, SymbolKind::LoopVariable, turns.variable.span, bound);
            turn(self);
            self.symbols.leave(mark);
            // A mistake would be repeated with every turn.
            if self.shared.findings.error_count() > errors {
                break;
            }
        }
    }

    fn define_if(
        &mut self,
        branches: &'a [(ExpressionText, Vec<EquationItem>)],
        otherwise: Option<&'a [EquationItem]>,
        span: Span,
        section: Section,
        place: &str,
    ) -> Defined {
        let mut conditions = Vec::new();
        let mut all = Vec::new();
        for (condition, items) in branches {
            conditions.push(self.at(Place::EQUATION).condition(condition));
            let mut defined = Defined::default();
            self.define_items(items, section, place, &mut defined);
            all.push(defined);
        }
        let mut last = Defined::default();
        self.define_items(otherwise.unwrap_or(&[]), section, place, &mut last);
        all.push(last);
        let mut result = Defined::default();
        for defined in &all {
            result.meant.extend(defined.meant.iter().cloned());
        }
        for rates in [true, false] {
            let map = |defined: &'_ Defined| -> BTreeMap<VariableId, Definition> {
                if rates { defined.rates.clone() } else { defined.values.clone() }
            };
            let maps: Vec<_> = all.iter().map(map).collect();
            let mut ids: Vec<VariableId> = maps.iter().flat_map(|m| m.keys().copied()).collect();
            ids.sort_unstable();
            ids.dedup();
            for id in ids {
                let definitions: Vec<Option<Definition>> = maps.iter().map(|m| m.get(&id).copied()).collect();
                let Some(some) = definitions.iter().flatten().next().copied() else { continue };
                if definitions.iter().any(Option::is_none) {
                    let name = &self.variables[id.0 as usize].name;
                    let shown = if rates { format!("der({name})") } else { name.clone() };
                    self.report(hs0130_branches_differ::diagnostic(
                        &shown,
                        some.target,
                        span,
                        otherwise.is_none(),
                    ));
                }
                let mut right = definitions.last().copied().flatten().and_then(|d| d.right);
                for (definition, condition) in definitions.iter().zip(&conditions).rev() {
                    right = match (condition, definition.and_then(|d| d.right), right) {
                        (Some(c), Some(a), Some(b)) => Some(self.graph.select(*c, a, b)),
                        _ => None,
                    };
                }
                let definition = Definition { right, ..some };
                if rates { &mut result.rates } else { &mut result.values }.insert(id, definition);
            }
        }
        result
    }

    /// Adds equations; one variable has one.
    pub(crate) fn merge(&mut self, into: &mut Defined, other: Defined, place: &str) {
        for (id, definition) in other.rates {
            self.insert(&mut into.rates, id, definition, true, place);
        }
        for (id, definition) in other.values {
            self.insert(&mut into.values, id, definition, false, place);
        }
        into.meant.extend(other.meant);
    }

    fn insert(
        &mut self,
        map: &mut BTreeMap<VariableId, Definition>,
        id: VariableId,
        definition: Definition,
        rate: bool,
        place: &str,
    ) {
        let Some(first) = map.get(&id) else {
            map.insert(id, definition);
            return;
        };
        let name = &self.variables[id.0 as usize].name;
        let what = match (rate, self.declaration.dialect) {
            (true, _) => format!("`der({name})`{place}"),
            (false, Dialect::Xml) => format!("output `{name}`{place}"),
            (false, Dialect::Hsml) => format!("`{name}`{place}"),
        };
        let first = first.target;
        self.report(hs0108_defined_twice::diagnostic(&what, first, definition.target));
    }

    fn define_one(
        &mut self,
        equation: &'a EquationDeclaration,
        section: Section,
        place: &str,
        defined: &mut Defined,
    ) {
        let name = equation.target.name.value.as_str();
        if name.is_empty() {
            self.silently(|b| b.at(Place::EQUATION).value(&equation.right));
            return;
        }
        let Some((ids, expected)) = self.defined_variable(equation, section, defined) else {
            self.at(Place::EQUATION).value(&equation.right);
            return;
        };
        let value = self.at(Place::EQUATION).value_for(&equation.right, &expected);
        let nodes = value.map(|value: Typed| value.elements.as_slice().to_vec());
        if let (Some(nodes), false) = (&nodes, equation.derivative) {
            self.check_assigned_range(&ids, nodes, equation.right.span);
        }
        for (k, id) in ids.into_iter().enumerate() {
            let definition = Definition {
                right: nodes.as_ref().and_then(|nodes| nodes.get(k).copied()),
                span: equation.right.span,
                target: equation.target.name.span,
            };
            let map = if equation.derivative { &mut defined.rates } else { &mut defined.values };
            self.insert(map, id, definition, equation.derivative, place);
        }
    }

    /// The elements that an equation defines, and what its right-hand side must be.
    fn defined_variable(
        &mut self,
        equation: &'a EquationDeclaration,
        section: Section,
        defined: &mut Defined,
    ) -> Option<(Vec<VariableId>, Expected)> {
        let name = &equation.target.name;
        let found =
            self.symbols.get(&name.value).map(|symbol| (symbol.kind, symbol.span, symbol.value.clone()));
        let xml = self.declaration.dialect == Dialect::Xml;
        let is_rate = equation.derivative;
        match found {
            Some((_, _, SymbolValue::Broken)) => return None,
            Some((SymbolKind::State, ..)) if is_rate => {}
            Some((SymbolKind::Local | SymbolKind::Flag, ..)) if !is_rate => {}
            Some((SymbolKind::Output, ..)) if !is_rate => {}
            Some((SymbolKind::State, declared, SymbolValue::Variable(symbol)))
                if xml && section == Section::Output && self.is_output_port(&name.value) =>
            {
                self.check_state_output(equation, declared, &symbol);
                return None;
            }
            Some((kind, declared, _)) if !xml => {
                self.report(hs0129_not_defined_by_equations::diagnostic(name, kind, declared, is_rate));
                defined.meant.push(name.value.clone());
                return None;
            }
            None if self.is_of_another_location(name) => return None,
            found => {
                let found = found.map(|(kind, span, _)| (kind, span));
                let stray = Stray { name: name.value.clone(), span: name.span, found };
                if is_rate { &mut self.strays.rates } else { &mut self.strays.values }.push(stray);
                return None;
            }
        }
        if is_rate && self.declaration.kind != ComponentKind::Ctc {
            return None; // the section has been reported
        }
        let around = if is_rate { "der" } else { "" };
        let (symbol, mut expected) = self.expected(&name.value, around)?;
        if is_rate {
            expected.measured = expected.measured.rate();
        }
        let Some(ids) = self.target_elements(&equation.target, &symbol) else {
            defined.meant.push(name.value.clone());
            return None;
        };
        if !equation.target.indices.is_empty() {
            expected.shape = shape_of_part(symbol.shape, equation.target.indices.len());
        }
        Some((ids, expected))
    }

    fn is_output_port(&self, name: &str) -> bool {
        self.declaration
            .ports
            .iter()
            .any(|port| port.direction == Direction::Output && port.name.value == name)
    }

    /// The elements that a target names: all, a row, or one.
    pub(crate) fn target_elements(
        &mut self,
        target: &'a Target,
        symbol: &VariableSymbol,
    ) -> Option<Vec<VariableId>> {
        let positions = self.positions(&target.name, &target.indices, symbol.shape)?;
        Some(positions.into_iter().map(|k| VariableId(symbol.first.0 + k as u32)).collect())
    }

    /// SOPHY XML: an output with the name of a state can only be that state.
    fn check_state_output(&mut self, map: &'a EquationDeclaration, declared: Span, state: &VariableSymbol) {
        let value = self.at(Place::EQUATION).value(&map.right);
        let is_state = |graph: &Graph, node| graph.node(node) == Node::Leaf(Leaf::Variable(state.first));
        if value.and_then(|value| value.node()).is_some_and(|node| !is_state(&self.graph, node)) {
            self.report(hs0111_output_differs_from_state::diagnostic(map, declared));
        }
    }
}

/// The names that equations define.
fn targets(items: &[EquationItem]) -> Vec<String> {
    let mut names = Vec::new();
    let mut pending: Vec<&EquationItem> = items.iter().collect();
    while let Some(item) = pending.pop() {
        match item {
            EquationItem::Equation(equation) => names.push(equation.target.name.value.clone()),
            EquationItem::For(turns) => pending.extend(&turns.items),
            EquationItem::If { branches, otherwise, .. } => {
                pending.extend(branches.iter().flat_map(|(_, items)| items));
                pending.extend(otherwise.iter().flatten());
            }
        }
    }
    names
}

/// What is left of a shape after `indices` indices.
pub(crate) fn shape_of_part(shape: Shape, indices: usize) -> Shape {
    match (shape, indices) {
        (shape, 0) => shape,
        (Shape::Matrix(_, columns), 1) => Shape::Vector(columns),
        _ => Shape::Scalar,
    }
}
