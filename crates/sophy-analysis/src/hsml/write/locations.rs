use super::Writer;
use crate::declarations::{LocationDeclaration, TransitionDeclaration, TriggerDeclaration};

impl Writer {
    pub(super) fn location(&mut self, location: &LocationDeclaration) {
        self.gap();
        self.documentation(&location.documentation);
        let name = self.name(&location.name);
        self.block(&format!("location {name}"), "location", |writer| {
            writer.section("declarations", &location.variables, Self::variable);
            writer.equations(&location.equations);
            if let Some(invariant) = &location.invariant {
                let invariant = writer.expression(invariant);
                writer.line(&format!("invariant {invariant};"));
            }
            location.transitions.iter().for_each(|transition| writer.transition(transition));
        });
    }

    fn transition(&mut self, transition: &TransitionDeclaration) {
        self.documentation(&transition.documentation);
        let (name, trigger) = (self.name(&transition.name), self.trigger(&transition.trigger));
        let priority = transition
            .priority
            .as_ref()
            .map_or_else(String::new, |p| format!(" priority {}", self.operand(p)));
        let destination = self.name(&transition.destination);
        let opening = format!("transition {name} {trigger}{priority} goto {destination}");
        if transition.actions.is_empty() {
            return self.line(&format!("{opening};"));
        }
        self.block(&format!("{opening} do"), "transition", |writer| {
            transition.actions.iter().for_each(|each| writer.statement(each));
        });
    }

    fn trigger(&mut self, trigger: &TriggerDeclaration) -> String {
        let (waits, guard) = match trigger {
            TriggerDeclaration::When(guard) => (String::new(), guard),
            // One that waits for either has become two by now.
            TriggerDeclaration::On(labels, guard) | TriggerDeclaration::WhenOrOn(guard, labels) => {
                (format!("on {}", self.names(labels)), guard)
            }
            TriggerDeclaration::Rate(rate, guard) => (format!("rate {}", self.condition(rate)), guard),
            TriggerDeclaration::Invariant(_, guard) => ("on invariant".to_owned(), guard),
            TriggerDeclaration::Synchronised(label, guard) => (format!("sync {}", self.name(label)), guard),
        };
        let guard = guard.as_ref().map(|guard| format!("when {}", self.condition(guard)));
        [Some(waits).filter(|waits| !waits.is_empty()), guard]
            .into_iter()
            .flatten()
            .collect::<Vec<_>>()
            .join(" ")
    }
}
