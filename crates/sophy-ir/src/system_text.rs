//! The text form of a system: everything with names, in the order of the tables (`--emit system`).

use crate::model::Quantity;
use crate::system::{Declared, FlatReset, FlatTransition, FlatTrigger, Role, Row, System};
use sophy_field::{EventIndex, LocationIndex};
use std::fmt;

impl fmt::Display for System {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "system {}", self.name)?;
        for p in &self.parameters {
            writeln!(f, "  parameter {} = {}{}", p.name, self.text(p.value), unit(p.unit.as_ref()))?;
        }
        for u in &self.inputs {
            writeln!(f, "  input {}{}", u.name(self), kind(&u.declared))?;
        }
        self.write_states(f)?;
        for z in self.algebraics.iter() {
            let name = z.name(self);
            writeln!(f, "  algebraic {name}")?;
            self.write_row(f, &name, z.value)?;
        }
        for y in self.outputs.iter() {
            let (what, name) = (if y.view { "view" } else { "output" }, y.name(self));
            writeln!(f, "  {what} {name}{}", kind(&y.declared))?;
            self.write_row(f, &name, y.value)?;
        }
        for assignment in &self.initial {
            self.write_assignment(f, 2, "initial ", assignment)?;
        }
        for (index, w) in self.watches.iter().enumerate() {
            let kind = if w.affine { "affine" } else { "enclosed" };
            writeln!(f, "  watch w{index} {} ({kind})", self.text(w.difference))?;
        }
        for port in &self.event_inputs {
            writeln!(f, "  event {} -> {}", port.name, self.receivers_text(&port.receivers))?;
        }
        self.write_automata(f)?;
        self.awaits.iter().try_for_each(|awaited| writeln!(f, "  awaits: {awaited}"))
    }
}

impl System {
    fn write_states(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, s) in self.states.iter().enumerate() {
            let kind = if s.discrete { "discrete state" } else { "state" };
            let mut initial = s.initial.map(|i| format!(" := {}", self.text(i))).unwrap_or_default();
            if let Some(flag) = s.sign_of {
                initial = format!(" := side of {}", self.text(flag));
            }
            let texts: Vec<String> = s
                .declared
                .choices
                .iter()
                .filter_map(|&n| Some(format!("{n} {:?}", self.texts.get(n)?)))
                .collect();
            let choices = if texts.is_empty() { String::new() } else { format!(" {{{}}}", texts.join(", ")) };
            let (quantity, unit) = (quantity(s.declared.quantity), unit(s.declared.unit.as_ref()));
            let name = s.name(self);
            writeln!(f, "  {kind} x{index} {name}{quantity}{choices}{initial}{unit}")?;
            if !s.discrete {
                self.write_row(f, &format!("der({name})"), s.rate)?;
            }
        }
        Ok(())
    }

    fn write_row(&self, f: &mut fmt::Formatter<'_>, left: &str, row: Row) -> fmt::Result {
        if self.is_constant(row) {
            return match self.nodes(row).first() {
                Some(&node) => writeln!(f, "    {left} = {}", self.text(node)),
                None => Ok(()),
            };
        }
        let Some(owner) = self.automata.get(row.owner.position()) else { return Ok(()) };
        for (location, &node) in owner.kind.locations.iter().zip(self.nodes(row)) {
            writeln!(f, "    {}: {left} = {}", location.name, self.text(node))?;
        }
        Ok(())
    }

    fn write_automata(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, a) in self.automata.iter().enumerate() {
            let role = match a.kind.role {
                Role::Component => "",
                Role::Flag => " (sides of a flag)",
                Role::Owner => " (no locations)",
            };
            writeln!(f, "  automaton a{index} {}{role}", a.name(self))?;
            for (position, location) in a.kind.locations.iter().enumerate() {
                let initial = match a.kind.role {
                    Role::Component if a.kind.initial.position() == position => " (initial)",
                    Role::Owner => continue,
                    _ => "",
                };
                writeln!(f, "    location {}{initial}", location.name)?;
                for t in a.outgoing(LocationIndex::new(position)) {
                    let Some(t) = self.transitions.get(t.position()) else { continue };
                    let to = a.kind.locations.get(t.destination.position()).map_or("?", |l| l.name.as_str());
                    self.write_transition(f, &t, to)?;
                }
            }
        }
        Ok(())
    }

    fn write_transition(&self, f: &mut fmt::Formatter<'_>, t: &FlatTransition, to: &str) -> fmt::Result {
        let priority = if t.priority == 0 { String::new() } else { format!(" priority {}", t.priority) };
        let silent = if t.silent { " (silent)" } else { "" };
        writeln!(f, "      {} {}{priority} -> {to}{silent}", t.name, self.trigger_text(&t.trigger))?;
        for reset in &t.resets {
            self.write_assignment(f, 8, "", reset)?;
        }
        for emission in &t.emits {
            let when = emission.when.map(|w| format!(" if {}", self.text(w))).unwrap_or_default();
            writeln!(f, "        emit {}{when}", emission.label)?;
        }
        Ok(())
    }

    fn write_assignment(
        &self,
        f: &mut fmt::Formatter<'_>,
        indent: usize,
        what: &str,
        reset: &FlatReset,
    ) -> fmt::Result {
        let state = self.states.get(reset.state.position()).map_or("?".to_owned(), |state| state.name(self));
        writeln!(f, "{:indent$}{what}{state} := {}", "", self.text(reset.value))
    }

    fn receivers_text(&self, receivers: &[EventIndex]) -> String {
        let names = receivers.iter().filter_map(|e| self.events.get(e.position()));
        names.map(|event| event.name(self)).collect::<Vec<_>>().join(", ")
    }

    /// `when GUARD` or `on EVENT when GUARD`.
    pub fn trigger_text(&self, trigger: &FlatTrigger) -> String {
        match trigger {
            FlatTrigger::When(guard) => format!("when {}", self.text(*guard)),
            FlatTrigger::On { events, guard } => {
                let guard = guard.map(|g| format!(" when {}", self.text(g))).unwrap_or_default();
                format!("on {}{guard}", self.receivers_text(events))
            }
        }
    }
}

fn unit(unit: Option<&String>) -> String {
    unit.map(|u| format!(" \"{u}\"")).unwrap_or_default()
}

fn kind(declared: &Declared) -> String {
    format!("{}{}", quantity(declared.quantity), unit(declared.unit.as_ref()))
}

fn quantity(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Real => "",
        Quantity::Integer => " : integer",
        Quantity::Boolean => " : boolean",
        Quantity::Text => " : string",
    }
}
