use super::reader::Reader;
use crate::declarations::{Equations, LocationDeclaration, TransitionDeclaration, TriggerDeclaration};
use crate::hsml::codes::MISPLACED;
use sophy_syntax::ast::{self, Declaration, LocationItem, TriggerKind, View};

impl Reader<'_> {
    pub(super) fn location(&mut self, view: &ast::Location) -> LocationDeclaration {
        let mut location = LocationDeclaration {
            name: self.name(view.name(), view),
            documentation: view.documentation(),
            variables: Vec::new(),
            equations: Equations::default(),
            invariant: None,
            transitions: Vec::new(),
        };
        for item in view.items() {
            match item {
                LocationItem::Declarations(section) => {
                    for declaration in section.items() {
                        match declaration {
                            Declaration::Variable(variable) => {
                                self.variable(&variable, &mut location.variables);
                            }
                            Declaration::Clock(other) => self.of_the_body(&other),
                            Declaration::ComputationDelay(other) => self.of_the_body(&other),
                            Declaration::Priority(other) => self.of_the_body(&other),
                        }
                    }
                }
                LocationItem::EquationSection(section) => {
                    self.equation_section(&section, &mut location.equations);
                }
                LocationItem::Invariant(invariant) => {
                    let (condition, span) =
                        (self.required(invariant.condition(), &invariant), self.keyword(&invariant));
                    self.once(&mut location.invariant, condition, "an invariant", span);
                }
                LocationItem::Transition(transition) => {
                    let transition = self.transition(&transition);
                    location.transitions.push(transition);
                }
            }
        }
        location
    }

    /// Complains about a declaration that only a body has.
    fn of_the_body(&mut self, declaration: &impl View) {
        let span = self.keyword(declaration);
        let message = "this cannot be declared in a location";
        self.complain(MISPLACED, span, message, "put it into the declarations of the body");
    }

    fn transition(&mut self, view: &ast::Transition) -> TransitionDeclaration {
        TransitionDeclaration {
            name: self.name(view.name(), view),
            documentation: view.documentation(),
            trigger: view.trigger().map_or(TriggerDeclaration::When(None), |trigger| self.trigger(&trigger)),
            priority: self.optional(view.priority()),
            destination: self.name(view.target(), view),
            actions: self.statements(view.statements()),
        }
    }

    fn trigger(&mut self, trigger: &ast::Trigger) -> TriggerDeclaration {
        let guard = self.optional(trigger.guard());
        match trigger.kind() {
            Some(TriggerKind::Guard) | None => TriggerDeclaration::When(guard),
            Some(TriggerKind::Events(names)) => {
                TriggerDeclaration::On(names.into_iter().map(|name| self.spanned(name)).collect(), guard)
            }
            Some(TriggerKind::Invariant) => TriggerDeclaration::Invariant(self.span(trigger.range()), guard),
            Some(TriggerKind::Rate(rate)) => TriggerDeclaration::Rate(self.required(rate, trigger), guard),
            Some(TriggerKind::Sync(label)) => {
                TriggerDeclaration::Synchronised(self.name(label, trigger), guard)
            }
        }
    }
}
