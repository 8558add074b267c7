use super::reader::Reader;
use crate::declarations::{
    ClockDeclaration, ComponentDeclaration, Equations, EventDeclaration, ParameterDeclaration,
    RuleDeclaration, Spanned, VariableDeclaration, VariableRole,
};
use crate::hsml::codes::NO_FLAG;
use sophy_syntax::ast::{
    self, Clock, ClockKind, Declaration, DirectionKind, EquationSection, EquationSectionKind, EventSection,
    Expression, Section, StatementSection, StatementSectionKind, Target, VariableKind, View,
};

impl Reader<'_> {
    pub(super) fn body(&mut self, body: &ast::Body, component: &mut ComponentDeclaration) {
        for section in body.sections() {
            self.section(&section, component);
        }
    }

    fn section(&mut self, section: &Section, component: &mut ComponentDeclaration) {
        match section {
            Section::Declarations(section) => {
                for declaration in section.items() {
                    self.declaration(&declaration, component);
                }
            }
            Section::StatementSection(section) => self.statement_section(section, component),
            Section::EquationSection(section) => self.equation_section(section, &mut component.equations),
            Section::EventSection(section) => {
                let event = self.event(section);
                component.events.push(event);
            }
            Section::Rules(section) => {
                for rule in section.rules() {
                    let rule = self.rule(&rule);
                    component.rules.push(rule);
                }
            }
            Section::InitialLocation(section) => {
                let name = self.name(section.name(), section);
                let span = self.keyword(section);
                self.once(&mut component.initial_location, name, "the first location", span);
            }
            Section::Location(section) => {
                let location = self.location(section);
                component.locations.push(location);
            }
            Section::ComponentsSection(section) => {
                let members = self.members(section.items());
                component.members.extend(members);
            }
            Section::ConnectionsSection(section) => {
                let connections = self.connections(section.items());
                component.connections.extend(connections);
            }
            Section::AssignmentsSection(section) => {
                for assignment in section.items() {
                    component.parameters.push(ParameterDeclaration {
                        name: self.name(assignment.name(), &assignment),
                        documentation: assignment.documentation(),
                        kind: None,
                        value: self.required(assignment.value(), &assignment),
                        unit: self.unit(assignment.unit()),
                    });
                }
            }
        }
    }

    fn declaration(&mut self, declaration: &Declaration, component: &mut ComponentDeclaration) {
        match declaration {
            Declaration::Variable(variable) => self.variable(variable, &mut component.variables),
            Declaration::Clock(clock) => {
                let span = self.keyword(clock);
                if let Some(read) = self.clock(clock) {
                    self.once(&mut component.clock, read, "`tsample`", span);
                }
            }
            Declaration::ComputationDelay(delay) => {
                let (value, span) = (self.required(delay.value(), delay), self.keyword(delay));
                self.once(&mut component.delay, value, "`tdelay`", span);
            }
            Declaration::Priority(priority) => {
                let (value, span) = (self.required(priority.value(), priority), self.keyword(priority));
                self.once(&mut component.priority, value, "`priority`", span);
            }
        }
    }

    /// One declaration for each of its names.
    pub(super) fn variable(&mut self, variable: &ast::Variable, variables: &mut Vec<VariableDeclaration>) {
        use VariableKind as K;
        let known = [("state", K::State), ("local", K::Local), ("mode", K::Mode), ("flag", K::Flag)];
        let role = match self.meant(variable.kind(), variable, &known) {
            Some(K::State) => VariableRole::State,
            Some(K::Local) => VariableRole::Local,
            Some(K::Mode) => VariableRole::Mode,
            Some(K::Flag) => VariableRole::Flag,
            None => return,
        };
        let first = VariableDeclaration {
            role,
            name: Spanned::new(String::new(), self.keyword(variable)),
            documentation: variable.documentation(),
            kind: self.type_text(variable.declared_type()),
            range: self.range(variable.value_range()),
            initial: self.optional(variable.initial_value()),
            unit: self.unit(variable.unit()),
        };
        variables.extend(
            variable.names().map(|name| VariableDeclaration { name: self.spanned(name), ..first.clone() }),
        );
    }

    fn clock(&mut self, clock: &Clock) -> Option<ClockDeclaration> {
        Some(match clock.kind()? {
            ClockKind::Variable { name, initial_value } => ClockDeclaration::Announced {
                name: self.spanned(name),
                initial: self.optional(initial_value),
            },
            ClockKind::Every { period, start } => ClockDeclaration::Every {
                span: self.keyword(clock),
                period: self.required(period, clock),
                offset: self.optional(start),
            },
        })
    }

    fn statement_section(&mut self, section: &StatementSection, component: &mut ComponentDeclaration) {
        use StatementSectionKind as K;
        let statements = self.statements(section.statements());
        match self.meant(section.kind(), section, &[("initial", K::Initial), ("update", K::Update)]) {
            Some(K::Update) => component.update.extend(statements),
            Some(K::Initial) | None => component.initial.extend(statements),
        }
    }

    pub(super) fn equation_section(&mut self, section: &EquationSection, equations: &mut Equations) {
        use EquationSectionKind as K;
        let known = [("dynamics", K::Dynamics), ("constraints", K::Constraints), ("output", K::Output)];
        match self.meant(section.kind(), section, &known) {
            Some(K::Constraints) => {
                let constraints = self.constraints(section.equations());
                equations.constraints.extend(constraints);
            }
            Some(K::Output) => equations.output.extend(self.equations(section.equations())),
            Some(K::Dynamics) | None => equations.dynamics.extend(self.equations(section.equations())),
        }
    }

    fn event(&mut self, section: &EventSection) -> EventDeclaration {
        let flag = section.flag();
        let target = flag.as_ref().and_then(Target::of).filter(|target| !target.derivative);
        let mut event = EventDeclaration {
            flag: Spanned::new(String::new(), self.keyword(section)),
            indices: Vec::new(),
            documentation: section.documentation(),
            priority: self.optional(section.priority()),
            rising: None,
            falling: None,
        };
        match (target, flag) {
            (Some(target), _) => {
                event.flag = self.spanned(target.name);
                event.indices = self.expressions(target.indices);
            }
            (None, Some(other)) if !self.is_damaged(&other.range()) => self.no_flag(&other),
            (None, _) => {}
        }
        for direction in section.directions() {
            let statements = self.statements(direction.statements());
            let span = self.keyword(&direction);
            match direction.kind() {
                Some(DirectionKind::NegativeToPositive) => {
                    self.once(&mut event.rising, statements, "`negative-to-positive`", span);
                }
                Some(DirectionKind::PositiveToNegative) => {
                    self.once(&mut event.falling, statements, "`positive-to-negative`", span);
                }
                None => {}
            }
        }
        event
    }

    fn no_flag(&mut self, expression: &Expression) {
        let span = self.span(expression.range());
        self.complain(
            NO_FLAG,
            span,
            "an event section names a flag, and this is an expression",
            "declare a `flag S`, define it in `dynamics` as `S = …`, and write `event(S)`",
        );
    }

    fn rule(&mut self, rule: &ast::Rule) -> RuleDeclaration {
        RuleDeclaration {
            span: self.keyword(rule),
            documentation: rule.documentation(),
            condition: self.required(rule.condition(), rule),
            delay: self.optional(rule.delay()),
            latched: rule.latched().is_some(),
            cancellable: rule.cancellable().is_some(),
            initially: rule.initially().is_some(),
            priority: self.optional(rule.priority()),
            actions: self.statements(rule.statements()),
        }
    }
}
