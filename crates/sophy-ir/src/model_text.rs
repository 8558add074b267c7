//! The text form of a model (`--emit model`), in the notation of the language.

use crate::class::{
    Actions, Allowed, Assignment, Body, Class, Clock, Composite, Discrete, EventPort, HybridAutomaton,
    Location, Port, Rule, Sources, Special, Transition, Trigger, Variable, VariableKind,
};
use crate::model::{Model, Quantity};
use crate::{Leaf, NodeId};
use std::fmt;

impl Class {
    /// An expression in the notation of the language.
    pub fn text(&self, node: NodeId) -> String {
        self.text_within(node, NESTED)
    }

    /// What is written where an expression reads something that is no variable.
    pub fn special_text(&self, special: u32) -> String {
        self.special_within(special, NESTED)
    }

    fn text_within(&self, node: NodeId, nested: u32) -> String {
        self.graph.display(node, &|leaf| self.leaf_within(leaf, nested))
    }

    /// What a leaf is called.
    pub(crate) fn leaf_text(&self, leaf: Leaf) -> String {
        self.leaf_within(leaf, NESTED)
    }

    fn leaf_within(&self, leaf: Leaf, nested: u32) -> String {
        match leaf {
            Leaf::Variable(id) => self.variable_name(id).to_owned(),
            Leaf::Special(special) => self.special_within(special, nested),
            Leaf::Time => "time".to_owned(),
            other => format!("{other:?}"),
        }
    }

    fn special_within(&self, special: u32, nested: u32) -> String {
        let (Some(special), Some(nested)) = (self.specials.get(special as usize), nested.checked_sub(1))
        else {
            return "…".to_owned();
        };
        let text = |node: NodeId| self.text_within(node, nested);
        match special {
            Special::Delayed { value, delay, before: None } => {
                format!("delayed({}, {})", text(*value), text(*delay))
            }
            Special::Delayed { value, delay, before: Some(before) } => {
                format!("delayed({}, {}, {})", text(*value), text(*delay), text(*before))
            }
            Special::Noise { name, deviation, period } => {
                format!("noise({name:?}, {}, {})", text(*deviation), text(*period))
            }
            Special::Chance(p) => format!("chance({})", text(*p)),
            Special::Event(label) => label.clone(),
            Special::Rises(b) => format!("rises({})", text(*b)),
            Special::Falls(b) => format!("falls({})", text(*b)),
            Special::Changes(x) => format!("changes({})", text(*x)),
            Special::Location => "location_index".to_owned(),
            Special::Never => "never".to_owned(),
            Special::Table { table, at } => format!("table({table}, {})", text(*at)),
            Special::Smooth(e) => format!("smooth({})", text(*e)),
        }
    }

    fn variable_name(&self, id: crate::VariableId) -> &str {
        self.variables.get(id.0 as usize).map_or("?", |variable| variable.name.as_str())
    }
}

/// How deep `delayed(delayed(…))` and the like are shown.
const NESTED: u32 = 16;

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "model {}", self.name())?;
        for (number, text) in self.texts.iter().enumerate() {
            writeln!(f, "text {number} {text:?}")?;
        }
        for (number, table) in self.tables.iter().enumerate() {
            let (name, rows, between) = (&table.name, table.knots.len(), table.between);
            writeln!(f, "table {number} {name} ({rows} rows, {between:?})")?;
        }
        for class in &self.classes {
            Text { model: self, class }.class(f)?;
        }
        Ok(())
    }
}

struct Text<'a> {
    model: &'a Model,
    class: &'a Class,
}

impl Text<'_> {
    fn class(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match &self.class.body {
            Body::Automaton(automaton) if automaton.logic => "logic component",
            Body::Automaton(_) => "component",
            Body::Discrete(_) => "discrete component",
            Body::Composite(_) => "composite",
        };
        let name = &self.class.name;
        if name.is_empty() {
            writeln!(f, "{kind}")?;
        } else {
            writeln!(f, "{kind} {name}")?;
        }
        for variable in &self.class.variables {
            self.variable(f, variable)?;
        }
        self.ports(f, "input", &self.class.input_events)?;
        self.ports(f, "output", &self.class.output_events)?;
        self.ports(f, "sync", &self.class.synchronised)?;
        match &self.class.body {
            Body::Automaton(automaton) => self.automaton(f, automaton),
            Body::Discrete(discrete) => self.discrete(f, discrete),
            Body::Composite(composite) => self.composite(f, composite),
        }
    }

    fn expression(&self, node: NodeId) -> String {
        self.class.text(node)
    }

    fn optional(&self, before: &str, node: Option<NodeId>) -> String {
        node.map(|node| format!("{before}{}", self.expression(node))).unwrap_or_default()
    }

    fn name(&self, id: crate::VariableId) -> &str {
        self.class.variable_name(id)
    }

    fn variable(&self, f: &mut fmt::Formatter<'_>, variable: &Variable) -> fmt::Result {
        let (kind, value) = match variable.kind {
            VariableKind::Parameter { value, knob } => {
                (if knob { "knob" } else { "constant" }, self.optional(" = ", Some(value)))
            }
            VariableKind::State(initial) => ("state", self.optional(" := ", initial)),
            VariableKind::Mode(initial) => ("mode", self.optional(" := ", initial)),
            VariableKind::Input { continuous: true } => ("input", String::new()),
            VariableKind::Input { continuous: false } => ("discrete input", String::new()),
            VariableKind::Output => ("output", String::new()),
            VariableKind::Local => ("local", String::new()),
            VariableKind::Flag => ("flag", String::new()),
        };
        let quantity = match variable.quantity {
            Quantity::Real => "",
            Quantity::Integer => " : integer",
            Quantity::Boolean => " : boolean",
            Quantity::Text => " : string",
        };
        let mut within = String::new();
        if let Some(Allowed::Between([low, high])) = variable.range {
            within = format!(" in ({}, {})", self.expression(low), self.expression(high));
        } else if let Some(Allowed::OneOf(numbers)) = &variable.range {
            let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
            within = format!(" in {{{}}}", numbers.join(", "));
        } else if !variable.choices.is_empty() {
            let text = |n: &usize| self.model.texts.get(*n).map_or("?".to_owned(), |t| format!("{t:?}"));
            let texts: Vec<String> = variable.choices.iter().map(text).collect();
            within = format!(" in {{{}}}", texts.join(", "));
        }
        let unit = variable.unit.as_ref().map(|u| format!(" \"{u}\"")).unwrap_or_default();
        let viewed = if variable.viewed { " (viewed)" } else { "" };
        writeln!(f, "  {kind} {}{quantity}{within}{value}{unit}{viewed}", variable.name)
    }

    fn ports(&self, f: &mut fmt::Formatter<'_>, kind: &str, ports: &[EventPort]) -> fmt::Result {
        ports.iter().try_for_each(|port| writeln!(f, "  {kind} event {}", port.name))
    }

    fn automaton(&self, f: &mut fmt::Formatter<'_>, automaton: &HybridAutomaton) -> fmt::Result {
        if let Some(delay) = automaton.delay {
            writeln!(f, "  tdelay {}", self.expression(delay))?;
        }
        self.assignments(f, "  initial ", &automaton.initial)?;
        for (position, location) in automaton.locations.iter().enumerate() {
            let initial = if position == automaton.initial_location { " (initial)" } else { "" };
            writeln!(f, "  location {}{initial}", location.name)?;
            self.location(f, automaton, location)?;
        }
        for section in &automaton.events {
            writeln!(f, "  event({}){}", self.name(section.flag), priority(section.priority))?;
            let directions =
                [("negative-to-positive", &section.rising), ("positive-to-negative", &section.falling)];
            for (direction, actions) in directions {
                if let Some(actions) = actions {
                    writeln!(f, "    {direction}")?;
                    self.actions(f, "      ", actions)?;
                }
            }
        }
        automaton.rules.iter().try_for_each(|rule| self.rule(f, rule))
    }

    fn location(
        &self,
        f: &mut fmt::Formatter<'_>,
        automaton: &HybridAutomaton,
        location: &Location,
    ) -> fmt::Result {
        for equation in &location.dynamics {
            writeln!(f, "    der({}) = {}", self.name(equation.variable), self.expression(equation.right))?;
        }
        for equation in &location.values {
            writeln!(f, "    {} = {}", self.name(equation.variable), self.expression(equation.right))?;
        }
        for constraint in &location.constraints {
            let (left, right) = (self.expression(constraint.left), self.expression(constraint.right));
            writeln!(f, "    constraint {left} = {right}")?;
        }
        if let Some(invariant) = location.invariant {
            writeln!(f, "    invariant {}", self.expression(invariant))?;
        }
        location.transitions.iter().try_for_each(|transition| self.transition(f, automaton, transition))
    }

    fn transition(
        &self,
        f: &mut fmt::Formatter<'_>,
        automaton: &HybridAutomaton,
        transition: &Transition,
    ) -> fmt::Result {
        let (name, trigger) = (&transition.name, self.class.trigger_text(&transition.trigger));
        let to = automaton.locations.get(transition.destination).map_or("?", |l| l.name.as_str());
        writeln!(f, "    transition {name} {trigger}{} goto {to}", priority(transition.priority))?;
        self.actions(f, "      ", &transition.actions)
    }

    fn rule(&self, f: &mut fmt::Formatter<'_>, rule: &Rule) -> fmt::Result {
        let mut clauses = self.optional(" delay ", rule.delay);
        for (wanted, clause) in
            [(rule.latched, " latched"), (rule.cancellable, " cancellable"), (rule.initially, " initially")]
        {
            clauses.push_str(if wanted { clause } else { "" });
        }
        writeln!(f, "  when {}{clauses}{}", self.expression(rule.condition), priority(rule.priority))?;
        self.actions(f, "    ", &rule.actions)
    }

    fn actions(&self, f: &mut fmt::Formatter<'_>, indent: &str, actions: &Actions) -> fmt::Result {
        self.assignments(f, indent, &actions.assignments)?;
        for emission in &actions.emissions {
            writeln!(f, "{indent}emit {}{}", emission.label, self.optional(" if ", emission.when))?;
        }
        actions.holds.iter().try_for_each(|&flag| writeln!(f, "{indent}hold {}", self.name(flag)))
    }

    fn assignments(
        &self,
        f: &mut fmt::Formatter<'_>,
        indent: &str,
        assignments: &[Assignment],
    ) -> fmt::Result {
        assignments.iter().try_for_each(|a| {
            writeln!(f, "{indent}{} := {}", self.name(a.variable), self.expression(a.right))
        })
    }

    fn discrete(&self, f: &mut fmt::Formatter<'_>, discrete: &Discrete) -> fmt::Result {
        match &discrete.clock {
            Clock::None => {}
            Clock::Periodic { period, offset } => {
                let period = self.expression(*period);
                writeln!(f, "  tsample every {period}{}", self.optional(" from ", *offset))?;
            }
            Clock::Announced { next } => writeln!(f, "  tsample {}", self.name(*next))?,
        }
        if let Some(delay) = discrete.delay {
            writeln!(f, "  tdelay {}", self.expression(delay))?;
        }
        if discrete.priority != 0 {
            writeln!(f, " {}", priority(discrete.priority))?;
        }
        self.assignments(f, "  initial ", &discrete.initial)?;
        self.assignments(f, "  update ", &discrete.update)?;
        for emission in &discrete.emissions {
            writeln!(f, "  update emit {}{}", emission.label, self.optional(" if ", emission.when))?;
        }
        for equation in &discrete.values {
            writeln!(f, "  {} = {}", self.name(equation.variable), self.expression(equation.right))?;
        }
        for constraint in &discrete.constraints {
            let (left, right) = (self.expression(constraint.left), self.expression(constraint.right));
            writeln!(f, "  constraint {left} = {right}")?;
        }
        Ok(())
    }

    fn composite(&self, f: &mut fmt::Formatter<'_>, composite: &Composite) -> fmt::Result {
        for member in &composite.members {
            let class = self.model.classes.get(member.class.0 as usize);
            let overrides: Vec<String> = member
                .parameters
                .iter()
                .map(|&(parameter, value)| {
                    let name = class.map_or("?", |class| class.variable_name(parameter));
                    format!("{name} : {}", self.expression(value))
                })
                .collect();
            let overrides =
                if overrides.is_empty() { String::new() } else { format!("({})", overrides.join(", ")) };
            let (element, extents) = (bracketed(&member.element), bracketed(&member.extents));
            let class = class.map_or("?", |class| class.name.as_str());
            writeln!(f, "  {}{element} : {class}{overrides}{extents}", member.name)?;
        }
        let port = |port: &Port| {
            let member = port.member.and_then(|m| composite.members.get(m as usize));
            let class = match member {
                Some(member) => self.model.classes.get(member.class.0 as usize),
                None => Some(self.class),
            };
            let name = class.map_or("?", |class| class.variable_name(port.variable));
            format!("{}{name}", end(composite, port.member, port.copy))
        };
        for wire in composite.wires.iter() {
            let from = match &wire.from {
                Sources::One(one) => port(one),
                Sources::Sum(terms) if terms.is_empty() => "0".to_owned(),
                Sources::Sum(terms) => {
                    let terms: Vec<_> = terms.iter().map(|(w, p)| format!("{w:?}*{}", port(p))).collect();
                    terms.join(" + ")
                }
            };
            writeln!(f, "  {from} -> {}", port(&wire.to))?;
        }
        for wire in composite.event_wires.iter() {
            let name = |e: &crate::EventEnd| format!("{}{}", end(composite, e.member, e.copy), e.label);
            let kind = if wire.synchronised { "sync" } else { "event" };
            writeln!(f, "  {kind} {} -> {}", name(&wire.from), name(&wire.to))?;
        }
        Ok(())
    }
}

impl Class {
    /// A trigger in the notation of the language.
    pub fn trigger_text(&self, trigger: &Trigger) -> String {
        self.trigger_with(trigger, &|node| self.text(node))
    }

    /// A trigger with its expressions put as `text` puts them.
    pub fn trigger_with(&self, trigger: &Trigger, text: &impl Fn(NodeId) -> String) -> String {
        let when =
            |guard: &Option<NodeId>| guard.map(|guard| format!(" when {}", text(guard))).unwrap_or_default();
        match trigger {
            Trigger::When(guard) => format!("when {}", text(*guard)),
            Trigger::On { events, guard } => format!("on {}{}", events.join(", "), when(guard)),
            Trigger::Rate { rate, guard } => format!("rate {}{}", text(*rate), when(guard)),
            Trigger::Invariant { guard } => format!("on invariant{}", when(guard)),
            Trigger::Synchronised { label, guard } => format!("sync {label}{}", when(guard)),
        }
    }
}

impl crate::Member {
    /// Name of a copy within the composite, counted from 0, row by row: `cell[17]`, `grid[2,3]`.
    pub fn copy_name(&self, copy: u32) -> String {
        copy_name(&self.name, &self.extents, &self.element, copy)
    }

    /// Number of copies.
    pub fn copies(&self) -> u32 {
        self.extents.iter().product()
    }
}

/// See [`crate::Member::copy_name`].
pub(crate) fn copy_name(name: &str, extents: &[u32], element: &[u32], copy: u32) -> String {
    if !element.is_empty() {
        return format!("{name}{}", bracketed(element));
    }
    let (mut rest, mut indices) = (copy, Vec::with_capacity(extents.len()));
    for &extent in extents.iter().rev() {
        let extent = extent.max(1);
        indices.push(rest % extent + 1);
        rest /= extent;
    }
    indices.reverse();
    format!("{name}{}", bracketed(&indices))
}

fn end(composite: &Composite, member: Option<u32>, copy: u32) -> String {
    match member.and_then(|m| composite.members.get(m as usize)) {
        Some(member) => format!("{}.", member.copy_name(copy)),
        None => String::new(),
    }
}

fn bracketed(indices: &[u32]) -> String {
    if indices.is_empty() {
        return String::new();
    }
    let indices: Vec<String> = indices.iter().map(u32::to_string).collect();
    format!("[{}]", indices.join(","))
}

fn priority(priority: i32) -> String {
    if priority == 0 { String::new() } else { format!(" priority {priority}") }
}
