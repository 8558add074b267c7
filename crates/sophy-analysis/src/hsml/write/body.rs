use super::Writer;
use super::file::unit;
use crate::declarations::{
    ClockDeclaration, ComponentDeclaration, ConnectionItem, Equations, EventDeclaration, MemberDeclaration,
    MemberItem, PortText, RuleDeclaration, VariableDeclaration, VariableRole,
};

impl Writer {
    pub(super) fn body(&mut self, component: &ComponentDeclaration) {
        self.declarations(component);
        self.section("initial", &component.initial, Self::statement);
        self.section("update", &component.update, Self::statement);
        self.equations(&component.equations);
        component.events.iter().for_each(|event| self.event(event));
        self.section("rules", &component.rules, Self::rule);
        self.gap();
        if let Some(location) = &component.initial_location {
            let name = self.name(location);
            self.line(&format!("initial location {name};"));
        }
        component.locations.iter().for_each(|location| self.location(location));
        self.gap();
        self.section("components", &component.members, Self::member);
        self.section("connections", &component.connections, Self::connection);
        self.section("assignments", &component.parameters, |writer, parameter| {
            writer.documentation(&parameter.documentation);
            let (name, value) = (writer.name(&parameter.name), writer.expression(&parameter.value));
            writer.line(&format!("{name} : {value}{};", unit(parameter.unit.as_ref())));
        });
    }

    fn declarations(&mut self, component: &ComponentDeclaration) {
        let nothing = component.variables.is_empty()
            && component.clock.is_none()
            && component.delay.is_none()
            && component.priority.is_none();
        if nothing {
            return;
        }
        self.block("declarations", "declarations", |writer| {
            component.variables.iter().for_each(|variable| writer.variable(variable));
            if let Some(clock) = &component.clock {
                writer.clock(clock);
            }
            if let Some(delay) = &component.delay {
                let delay = writer.expression(delay);
                writer.line(&format!("tdelay {delay};"));
            }
            if let Some(priority) = &component.priority {
                let priority = writer.expression(priority);
                writer.line(&format!("priority {priority};"));
            }
        });
    }

    pub(super) fn variable(&mut self, variable: &VariableDeclaration) {
        self.documentation(&variable.documentation);
        let word = match variable.role {
            VariableRole::State => "state",
            VariableRole::Local => "local",
            VariableRole::Mode => "mode",
            VariableRole::Flag => "flag",
        };
        let (name, kind) = (self.name(&variable.name), self.typed(variable.kind.as_ref()));
        let range =
            variable.range.as_ref().map_or_else(String::new, |range| format!(" in {}", self.range(range)));
        let initial = variable
            .initial
            .as_ref()
            .map_or_else(String::new, |initial| format!(" := {}", self.expression(initial)));
        self.line(&format!("{word} {name}{kind}{range}{initial}{};", unit(variable.unit.as_ref())));
    }

    fn clock(&mut self, clock: &ClockDeclaration) {
        let text = match clock {
            ClockDeclaration::Announced { name, initial } => {
                let initial =
                    initial.as_ref().map_or_else(String::new, |i| format!(" := {}", self.expression(i)));
                self.name(name) + &initial
            }
            ClockDeclaration::Every { period, offset, .. } => {
                let offset =
                    offset.as_ref().map_or_else(String::new, |o| format!(" from {}", self.expression(o)));
                format!("every {}{offset}", self.operand(period))
            }
        };
        self.line(&format!("tsample {text};"));
    }

    pub(super) fn equations(&mut self, equations: &Equations) {
        self.section("dynamics", &equations.dynamics, Self::equation);
        self.section("constraints", &equations.constraints, |writer, constraint| {
            let (left, right) = (writer.left_side(&constraint.left), writer.right_side(&constraint.right));
            writer.line(&format!("{left} = {right};"));
        });
        self.section("output", &equations.output, Self::equation);
    }

    fn event(&mut self, event: &EventDeclaration) {
        self.documentation(&event.documentation);
        let flag = self.name(&event.flag) + &self.brackets(&event.indices);
        let priority =
            event.priority.as_ref().map_or_else(String::new, |p| format!(" priority {}", self.operand(p)));
        self.block(&format!("event({flag}){priority}"), "event", |writer| {
            for (word, statements) in
                [("negative-to-positive", &event.rising), ("positive-to-negative", &event.falling)]
            {
                if let Some(statements) = statements {
                    writer.block(word, word, |writer| {
                        statements.iter().for_each(|each| writer.statement(each));
                    });
                }
            }
        });
    }

    fn rule(&mut self, rule: &RuleDeclaration) {
        self.documentation(&rule.documentation);
        let mut opening = format!("when {}", self.condition(&rule.condition));
        if let Some(delay) = &rule.delay {
            opening += &format!(" delay {}", self.condition(delay));
        }
        for (said, word) in
            [(rule.initially, " initially"), (rule.latched, " latched"), (rule.cancellable, " cancellable")]
        {
            opening += if said { word } else { "" };
        }
        if let Some(priority) = &rule.priority {
            opening += &format!(" priority {}", self.condition(priority));
        }
        self.block(&(opening + " do"), "when", |writer| {
            rule.actions.iter().for_each(|each| writer.statement(each));
        });
    }

    fn member(&mut self, item: &MemberItem) {
        match item {
            MemberItem::Member(member) => self.one_member(member),
            MemberItem::For(repeated) => self.repeated(repeated, Self::member),
        }
    }

    fn one_member(&mut self, member: &MemberDeclaration) {
        self.documentation(&member.documentation);
        let name = self.name(&member.name) + &self.brackets(&member.indices);
        let component = self.name(&member.component);
        let mut parameters = Vec::new();
        for parameter in &member.parameters {
            let (name, value) = (self.name(&parameter.name), self.expression(&parameter.value));
            parameters.push(format!("{name} : {value}{}", unit(parameter.unit.as_ref())));
        }
        let parameters =
            if parameters.is_empty() { String::new() } else { format!("({})", parameters.join(", ")) };
        let extents = self.brackets(&member.extents);
        self.line(&format!("{name} : {component}{parameters}{extents};"));
    }

    fn connection(&mut self, item: &ConnectionItem) {
        match item {
            ConnectionItem::Connect { from, to } => {
                let (from, to) = (self.port_text(from), self.port_text(to));
                self.line(&format!("{from} -> {to};"));
            }
            ConnectionItem::Compose { members, matrix, .. } => {
                let members =
                    members.iter().map(|member| self.port_text(member)).collect::<Vec<_>>().join(", ");
                let matrix = self.expression(matrix);
                self.line(&format!("compose {members} with {matrix};"));
            }
            ConnectionItem::For(repeated) => self.repeated(repeated, Self::connection),
        }
    }

    fn port_text(&mut self, port: &PortText) -> String {
        let parts = port.parts.iter().map(|(name, indices)| self.name(name) + &self.brackets(indices));
        parts.collect::<Vec<_>>().join(".")
    }
}
