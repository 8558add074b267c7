use super::notation::Notation;
use sophy_files::{Arrow, ArrowEnd, BoxKind, Diagram, DiagramBox, DiagramKind, Line};
use sophy_ir::{Actions, Equation, HybridAutomaton, Location, NodeId, Rule, Transition, Trigger, VariableId};

/// Locations with their equations and the transitions between them (thesis figure 8.1).
///
/// Event sections and rules hold in all locations: they are loops of the only one, or a note beside several.
pub(super) fn automaton(notation: Notation<'_>, automaton: &HybridAutomaton) -> Diagram {
    let (class, drawing) = (notation.class, Drawing { notation, automaton });
    let everywhere = drawing.everywhere();
    let locations = automaton.locations.iter().enumerate();
    let mut boxes: Vec<DiagramBox> = locations.map(|(n, l)| drawing.location(n, l, &everywhere)).collect();
    let mut arrows: Vec<Arrow> = Vec::new();
    for (source, location) in automaton.locations.iter().enumerate() {
        arrows.extend(location.transitions.iter().map(|transition| drawing.transition(source, transition)));
    }
    let reactions = drawing.reactions();
    if boxes.len() == 1 {
        arrows.extend(reactions);
    } else {
        let mut lines: Vec<Line> = everywhere.iter().filter_map(|equation| drawing.value(equation)).collect();
        for reaction in reactions {
            let what: Vec<String> = reaction.below;
            lines.push(plain(format!("{}: {}", reaction.above.join(" "), what.join(", "))));
        }
        if !lines.is_empty() {
            let name = "in all locations".to_owned();
            boxes.push(DiagramBox { kind: BoxKind::Note, name, lines, ..DiagramBox::default() });
        }
    }
    Diagram { title: class.name.clone(), kind: DiagramKind::Automaton, boxes, arrows }
}

struct Drawing<'a> {
    notation: Notation<'a>,
    automaton: &'a HybridAutomaton,
}

impl Drawing<'_> {
    fn name(&self, id: VariableId) -> &str {
        self.notation.name(id)
    }

    fn text(&self, node: NodeId) -> String {
        self.notation.short(node)
    }

    /// Values that are the same in all of several locations.
    fn everywhere(&self) -> Vec<Equation> {
        let [first, others @ ..] = self.automaton.locations.as_slice() else { return Vec::new() };
        if others.is_empty() {
            return Vec::new();
        }
        let known: Vec<std::collections::HashMap<VariableId, NodeId>> = others
            .iter()
            .map(|location| location.values.iter().map(|value| (value.variable, value.right)).collect())
            .collect();
        let same =
            |value: &&Equation| known.iter().all(|other| other.get(&value.variable) == Some(&value.right));
        first.values.iter().filter(same).cloned().collect()
    }

    fn location(&self, number: usize, location: &Location, everywhere: &[Equation]) -> DiagramBox {
        let class = self.notation.class;
        let rests = |equation: &&Equation| class.graph.as_number(equation.right) != Some(0.0);
        let mut lines: Vec<Line> = location.dynamics.iter().filter(rests).map(|e| self.rate(e)).collect();
        let rest: Vec<&str> = location
            .dynamics
            .iter()
            .filter(|e| !rests(e))
            .map(|equation| self.name(equation.variable))
            .collect();
        if lines.is_empty() && !rest.is_empty() {
            lines.push(plain(format!("{} constant", rest.join(", "))));
        }
        let hoisted = |value: &&Equation| !everywhere.iter().any(|other| other.variable == value.variable);
        lines.extend(location.values.iter().filter(hoisted).filter_map(|value| self.value(value)));
        for constraint in &location.constraints {
            lines.push(plain(format!("{} = {}", self.text(constraint.left), self.text(constraint.right))));
        }
        if let Some(invariant) = location.invariant {
            lines.push(plain(format!("while {}", self.text(invariant))));
        }
        let kind = if number == self.automaton.initial_location { BoxKind::Initial } else { BoxKind::Single };
        let name = if location.name.is_empty() { class.name.clone() } else { location.name.clone() };
        DiagramBox { kind, name, lines, tip: self.tip(location), ..DiagramBox::default() }
    }

    /// Everything that holds in a location, with the units.
    fn tip(&self, location: &Location) -> String {
        let mut lines = Vec::new();
        if !location.documentation.is_empty() {
            lines.push(location.documentation.split_whitespace().collect::<Vec<_>>().join(" "));
        }
        for equation in &location.dynamics {
            let unit =
                self.notation.class.variables.get(equation.variable.0 as usize).and_then(|v| v.unit.as_ref());
            let unit =
                unit.map(|unit| format!(" ({} in {unit})", self.name(equation.variable))).unwrap_or_default();
            lines.push(format!(
                "der({}) = {}{unit}",
                self.name(equation.variable),
                self.text(equation.right)
            ));
        }
        lines.extend(location.values.iter().filter_map(|value| self.value(value)).map(|line| line.text));
        lines.join("; ")
    }

    fn rate(&self, equation: &Equation) -> Line {
        let text = format!("= {}", self.text(equation.right));
        Line { derivative_of: Some(self.name(equation.variable).to_owned()), text }
    }

    fn value(&self, equation: &Equation) -> Option<Line> {
        self.notation.equation(equation.variable, equation.right).map(plain)
    }

    /// The guard above the arrow; what is received (?), assigned and emitted (!) under it.
    fn transition(&self, source: usize, transition: &Transition) -> Arrow {
        let guard = |guard: &Option<NodeId>| guard.map(|guard| self.text(guard));
        let (mut above, mut below) = (Vec::new(), Vec::new());
        match &transition.trigger {
            Trigger::When(condition) => above.push(self.text(*condition)),
            Trigger::On { events, guard: condition } => {
                above.extend(guard(condition));
                below.push(events.iter().map(|label| format!("?{label}")).collect::<Vec<_>>().join(" "));
            }
            Trigger::Rate { rate, guard: condition } => {
                above.push(format!("rate {} 1/s", self.text(*rate)));
                above.extend(guard(condition));
            }
            Trigger::Invariant { guard: condition } => {
                above.push("invariant left".to_owned());
                above.extend(guard(condition));
            }
            Trigger::Synchronised { label, guard: condition } => {
                above.extend(guard(condition));
                below.push(format!("sync {label}"));
            }
        }
        if transition.priority != 0 {
            above.push(format!("priority {}", transition.priority));
        }
        below.extend(self.actions(&transition.actions));
        let name = if transition.name.is_empty() { "transition" } else { &transition.name };
        let mut tip =
            format!("{name}: {}", above.iter().chain(&below).cloned().collect::<Vec<_>>().join("; "));
        if !transition.documentation.is_empty() {
            tip = format!(
                "{} — {tip}",
                transition.documentation.split_whitespace().collect::<Vec<_>>().join(" ")
            );
        }
        let dashed = matches!(&transition.trigger, Trigger::On { .. } | Trigger::Synchronised { .. });
        arrow(source, transition.destination, above, below, tip, dashed)
    }

    /// Event sections and rules.
    fn reactions(&self) -> Vec<Arrow> {
        let mut arrows = Vec::new();
        for section in &self.automaton.events {
            let sides = [("from − to +", &section.rising), ("from + to −", &section.falling)];
            for (direction, actions) in sides {
                if let Some(actions) = actions {
                    let above = vec![format!("{} {direction}", self.name(section.flag))];
                    let below = self.actions(actions);
                    let tip = above.iter().chain(&below).cloned().collect::<Vec<_>>().join("; ");
                    arrows.push(arrow(0, 0, above, below, tip, false));
                }
            }
        }
        arrows.extend(self.automaton.rules.iter().map(|rule| self.rule(rule)));
        arrows
    }

    fn rule(&self, rule: &Rule) -> Arrow {
        let mut above = vec![format!("when {}", self.text(rule.condition))];
        if let Some(delay) = rule.delay {
            above.push(format!("after {} s", self.text(delay)));
        }
        let below = self.actions(&rule.actions);
        let tip = above.iter().chain(&below).cloned().collect::<Vec<_>>().join("; ");
        arrow(0, 0, above, below, tip, false)
    }

    fn actions(&self, actions: &Actions) -> Vec<String> {
        let assigned = actions.assignments.iter();
        let value = |a: &sophy_ir::Assignment| self.notation.value(a.variable, a.right);
        let mut lines: Vec<String> =
            assigned.map(|a| format!("{} := {}", self.name(a.variable), value(a))).collect();
        for emission in &actions.emissions {
            let when = emission.when.map(|when| format!(" if {}", self.text(when))).unwrap_or_default();
            lines.push(format!("!{}{when}", emission.label));
        }
        lines.extend(actions.holds.iter().map(|&flag| format!("hold {} = 0", self.name(flag))));
        lines
    }
}

fn plain(text: String) -> Line {
    Line { derivative_of: None, text }
}

fn arrow(from: usize, to: usize, above: Vec<String>, below: Vec<String>, tip: String, dashed: bool) -> Arrow {
    let end = |of| ArrowEnd { of, port: None };
    Arrow { from: end(from), to: end(to), above, below, tip, dashed }
}
