use super::components::Census;
use serde::Serialize;
use sophy_ir::{
    Actions, Assignment, Automaton, Body, Class, EventSection, HybridAutomaton, Leaf, Location, Model,
    NodeId, Quantity, Role, Rule, System, Transition, VariableId,
};
use std::collections::HashMap;
use std::sync::Arc;

/// A hybrid automaton, once for all copies.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AutomatonDescription {
    /// The component, the first one if there are several of its kind; empty for a model of one component.
    pub component: String,
    /// Name it was declared with.
    pub class: String,
    /// How many there are.
    pub copies: u64,
    /// Location a run starts in.
    pub initial: String,
    /// Its locations.
    pub locations: Vec<LocationDescription>,
    /// Event sections and rules: what happens in all locations.
    pub reactions: Vec<Reaction>,
}

/// A location and the ways out of it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LocationDescription {
    /// Name.
    pub name: String,
    /// What it is, in the author's words.
    pub documentation: String,
    /// What holds as long as it may be kept, as text.
    pub invariant: Option<String>,
    /// Equations that hold besides, as text.
    pub constraints: Vec<String>,
    /// Outgoing transitions, in written order.
    pub transitions: Vec<TransitionDescription>,
}

/// A transition.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransitionDescription {
    /// Name.
    pub name: String,
    /// Location it leads to.
    pub to: String,
    /// When it is taken, as text.
    pub trigger: String,
    /// Whether every comparison of its condition has crossings in closed form (is affine); unknown for what this
    /// version cannot run.
    pub affine: Option<bool>,
    /// New values, as text.
    pub resets: Vec<String>,
    /// Event labels it emits.
    pub emits: Vec<String>,
    /// Smaller goes first.
    pub priority: i32,
}

/// What happens in all locations: an event section (in one direction) or a rule.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reaction {
    /// When, as text.
    pub when: String,
    /// What is done, as text.
    pub does: Vec<String>,
    /// Smaller goes first.
    pub priority: i32,
}

pub(super) fn automata(model: &Model, census: &Census, system: &System) -> Vec<AutomatonDescription> {
    let flat: HashMap<String, Automaton> = system
        .automata
        .iter()
        .filter(|automaton| automaton.kind.role == Role::Component)
        .map(|automaton| (automaton.name(system), automaton))
        .collect();
    let mut found = Vec::new();
    for (class, of_class) in model.classes.iter().zip(&census.of_class) {
        let Body::Automaton(automaton) = &class.body else { continue };
        let bare = automaton.locations.len() < 2
            && automaton.locations.iter().all(|location| location.transitions.is_empty())
            && automaton.events.is_empty()
            && automaton.rules.is_empty();
        if of_class.copies == 0 || bare {
            continue;
        }
        let text = Text {
            class,
            texts: &model.texts,
            automaton,
            flat: flat.get(of_class.instance.as_str()),
            system,
        };
        found.push(AutomatonDescription {
            component: of_class.place.clone(),
            class: class.name.clone(),
            copies: of_class.copies,
            initial: text.location_name(automaton.initial_location),
            locations: automaton.locations.iter().enumerate().map(|(n, l)| text.location(n, l)).collect(),
            reactions: text.reactions(),
        });
    }
    found
}

struct Text<'a> {
    class: &'a Class,
    texts: &'a [String],
    automaton: &'a HybridAutomaton,
    /// The same of the first copy in the flat system.
    flat: Option<&'a Automaton>,
    system: &'a System,
}

impl Text<'_> {
    fn location_name(&self, position: usize) -> String {
        self.automaton.locations.get(position).map(|location| location.name.clone()).unwrap_or_default()
    }

    fn name(&self, id: VariableId) -> &str {
        self.class.variables.get(id.0 as usize).map_or("?", |variable| variable.name.as_str())
    }

    fn text(&self, node: NodeId) -> String {
        self.class.written(node, Quantity::Real, self.texts)
    }

    fn location(&self, position: usize, location: &Location) -> LocationDescription {
        let affine = self.affine(position);
        let text = |node: NodeId| self.text(node);
        let constraint = |c: &sophy_ir::Constraint| format!("{} = {}", text(c.left), text(c.right));
        LocationDescription {
            name: location.name.clone(),
            documentation: location.documentation.clone(),
            invariant: location.invariant.map(text),
            constraints: location.constraints.iter().map(constraint).collect(),
            transitions: location.transitions.iter().map(|t| self.transition(t, &affine)).collect(),
        }
    }

    /// Name and destination of the transitions of a location that can be run: whether they are affine.
    fn affine(&self, location: usize) -> HashMap<(Arc<str>, usize), bool> {
        let location = sophy_field::LocationIndex::new(location);
        let transitions = self.flat.into_iter().flat_map(|automaton| automaton.outgoing(location));
        let known = transitions.filter_map(|index| self.system.transitions.get(index.position()));
        let known = known.map(|transition| {
            let key = (transition.name, transition.destination.position());
            (key, is_affine(self.system, transition.trigger.guard()))
        });
        known.collect()
    }

    fn transition(
        &self,
        transition: &Transition,
        affine: &HashMap<(Arc<str>, usize), bool>,
    ) -> TransitionDescription {
        let emission = |e: &sophy_ir::Emission| match e.when {
            Some(when) => format!("{} if {}", e.label, self.text(when)),
            None => e.label.to_string(),
        };
        TransitionDescription {
            name: transition.name.to_string(),
            to: self.location_name(transition.destination),
            trigger: self.class.trigger_with(&transition.trigger, &|node| self.text(node)),
            affine: affine.get(&(Arc::clone(&transition.name), transition.destination)).copied(),
            resets: self.resets(&transition.actions),
            emits: transition.actions.emissions.iter().map(emission).collect(),
            priority: transition.priority,
        }
    }

    fn resets(&self, actions: &Actions) -> Vec<String> {
        let assigned = actions.assignments.iter();
        let value = |a: &Assignment| {
            let variable = self.class.variables.get(a.variable.0 as usize);
            self.class.written(a.right, variable.map_or(Quantity::Real, |v| v.quantity), self.texts)
        };
        let assigned = assigned.map(|a| format!("{} := {}", self.name(a.variable), value(a)));
        assigned.chain(actions.holds.iter().map(|&flag| format!("hold {}", self.name(flag)))).collect()
    }

    fn reactions(&self) -> Vec<Reaction> {
        let sections = self.automaton.events.iter().flat_map(|section| self.section(section));
        sections.chain(self.automaton.rules.iter().map(|rule| self.rule(rule))).collect()
    }

    fn section(&self, section: &EventSection) -> Vec<Reaction> {
        let directions =
            [("negative to positive", &section.rising), ("positive to negative", &section.falling)];
        let reaction = |(direction, actions): (&str, &Option<Actions>)| {
            let actions = actions.as_ref()?;
            let when = format!("{} from {direction}", self.name(section.flag));
            Some(Reaction { when, does: self.does(actions), priority: section.priority })
        };
        directions.into_iter().filter_map(reaction).collect()
    }

    fn rule(&self, rule: &Rule) -> Reaction {
        let mut when = self.text(rule.condition);
        if let Some(delay) = rule.delay {
            when = format!("{when}, delay {} s", self.text(delay));
        }
        for (is, word) in
            [(rule.latched, "latched"), (rule.cancellable, "cancellable"), (rule.initially, "initially")]
        {
            if is {
                when = format!("{when}, {word}");
            }
        }
        Reaction { when, does: self.does(&rule.actions), priority: rule.priority }
    }

    fn does(&self, actions: &Actions) -> Vec<String> {
        let emitted = actions.emissions.iter().map(|emission| {
            let when = emission.when.map(|when| format!(" if {}", self.text(when))).unwrap_or_default();
            format!("emit {}{when}", emission.label)
        });
        self.resets(actions).into_iter().chain(emitted).collect()
    }
}

fn is_affine(system: &System, guard: Option<NodeId>) -> bool {
    system.graph.dependencies(guard).into_iter().all(|leaf| match leaf {
        Leaf::Truth(truth) => system.watches.at(system.truths.at(truth.position()).watch.position()).affine,
        _ => true,
    })
}
