use super::builder::Builder;
use super::statements::Setting;
use super::variables::Interface;
use crate::checks::hs0137_no_clock;
use crate::declarations::ClockDeclaration;
use crate::lower::{Place, SymbolValue};
use sophy_ir::{Assignment, Binary, Clock, Discrete, Leaf, Node, NodeId, VariableId, VariableKind};

impl<'a> Builder<'_, 'a> {
    /// What a discrete-time component does; `None` if something is missing.
    pub(crate) fn discrete(&mut self, interface: &Interface) -> Option<Discrete> {
        let declaration = self.declaration;
        let priority = self.whole_number(declaration.priority.as_ref(), "a priority", 0);
        let delay = declaration.delay.as_ref().map(|delay| self.seconds(delay, "`tdelay`"));
        let initial = self.initial_section();
        let reads = Place { what: "the `update` section", ..Place::INSTANT };
        let setting =
            Setting { place: " in the `update` section", reads, emits: true, holds: false, enters: None };
        let actions = self.actions(&declaration.update, setting);
        let mut defined = self.define(&declaration.equations, "");
        for &(output, own) in &interface.exported {
            let right = Some(self.graph.leaf(Leaf::Variable(own)));
            let span = self.variables[output.0 as usize].span.unwrap_or(declaration.name.span);
            let definition = super::equations::Definition { right, span, target: span };
            defined.values.insert(output, definition);
        }
        self.defined_values = defined.values.keys().copied().collect();
        for name in &defined.meant {
            if let Some(SymbolValue::Variable(symbol)) = self.symbols.declared(name).map(|s| &s.value) {
                self.defined_values.extend(Builder::elements(symbol.first, symbol.shape.len()));
            }
        }
        let constraints = self.constraints(&declaration.equations.constraints);
        let values = self.sorted(&defined, &constraints, "");
        self.check_discrete(&constraints);
        let clock = self.clock(&actions.assignments);
        if declaration.clock.is_none() {
            self.report(hs0137_no_clock::diagnostic(&declaration.name));
        }
        Some(Discrete {
            clock: clock?,
            delay: match delay {
                Some(delay) => Some(delay?),
                None => None,
            },
            priority,
            initial,
            update: actions.assignments,
            emissions: actions.emissions,
            values,
            constraints,
        })
    }

    /// When it executes. A variable to which every update adds a parameter is a periodic clock, whose ticks are
    /// exact; the variable itself stays.
    fn clock(&mut self, update: &[Assignment]) -> Option<Clock> {
        let declaration = self.declaration;
        match declaration.clock.as_ref()? {
            ClockDeclaration::Every { period, offset, .. } => {
                let period = self.seconds(period, "the period of `tsample`")?;
                let offset = match offset {
                    Some(offset) => Some(self.seconds(offset, "the first instant of `tsample`")?),
                    None => None,
                };
                if self.known_value(period).is_some_and(|period| period <= 0.0)
                    && let Some(ClockDeclaration::Every { span, .. }) = &declaration.clock
                {
                    self.report(hs0137_no_clock::not_positive(*span));
                }
                Some(Clock::Periodic { period, offset })
            }
            ClockDeclaration::Announced { name, .. } => {
                let SymbolValue::Variable(symbol) = &self.symbols.declared(&name.value)?.value else {
                    return None;
                };
                let next = symbol.first;
                let Some(moved) = update.iter().find(|assignment| assignment.variable == next) else {
                    self.report(hs0137_no_clock::never_moved(name));
                    return None;
                };
                match self.added(moved.right, next) {
                    Some(period) => {
                        let VariableKind::Mode(offset) = self.variables[next.0 as usize].kind else {
                            return None;
                        };
                        Some(Clock::Periodic { period, offset })
                    }
                    None => Some(Clock::Announced { next }),
                }
            }
        }
    }

    /// The parameter that `next + parameter` adds.
    fn added(&self, node: NodeId, next: VariableId) -> Option<NodeId> {
        let Node::Binary(Binary::Add, a, b) = self.graph.node(node) else { return None };
        let is_next = |node| self.graph.node(node) == Node::Leaf(Leaf::Variable(next));
        let other = match (is_next(a), is_next(b)) {
            (true, false) => b,
            (false, true) => a,
            _ => return None,
        };
        let is_parameter = |leaf: Leaf| match leaf {
            Leaf::Variable(id) => {
                matches!(self.variables[id.0 as usize].kind, VariableKind::Parameter { .. })
            }
            _ => false,
        };
        self.graph.dependencies([other]).into_iter().all(is_parameter).then_some(other)
    }
}
