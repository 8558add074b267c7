use super::complaints::Complaints;
use super::expressions::{Expressions, Locals};
use super::hints::complaints_at;
use super::{Location, Names, Transition};
use sophy_analysis::{
    ComponentDeclaration, Dialect, EquationDeclaration, EquationItem, Equations, LocationDeclaration,
    Spanned, Statement, TransitionDeclaration, TriggerDeclaration, VariableRole,
};
use std::borrow::Cow;
use std::collections::HashMap;

/// The locations, each with what holds everywhere; at least one.
pub(super) fn locations<'c>(
    component: &'c ComponentDeclaration,
    names: &Names<'c>,
    expressions: &mut Expressions,
    complaints: &mut Complaints,
) -> Vec<Location<'c>> {
    let body = plain_equations(&component.equations, complaints);
    let mut restating = Restating { component, names, body, expressions, complaints };
    if component.locations.is_empty() && component.dialect == Dialect::Hsml {
        restating.complaints.restated(
            component.name.span,
            format!("`{}` has no locations; its equations become those of one, `Main`", component.name.value),
        );
        return vec![restating.location(None)];
    }
    component.locations.iter().map(|location| restating.location(Some(location))).collect()
}

/// The equations outside of `if` and `for`; complains about the others.
fn plain_equations<'c>(
    equations: &'c Equations,
    complaints: &mut Complaints,
) -> Vec<&'c EquationDeclaration> {
    let mut plain = Vec::new();
    for item in equations.dynamics.iter().chain(&equations.output) {
        match item {
            EquationItem::Equation(equation) => match equation.target.indices.first() {
                None => plain.push(equation),
                Some(index) => complaints.cannot(
                    index.span,
                    format!("SOPHY XML has no vectors, as `{}` is", equation.target.name.value),
                    "write its elements as variables of their own",
                ),
            },
            EquationItem::If { span, .. } => complaints.cannot(
                *span,
                "SOPHY XML has no equations under conditions",
                "write each right-hand side as `if … then … else …`",
            ),
            EquationItem::For(repeated) => complaints.cannot(
                repeated.variable.span,
                "SOPHY XML has no loops",
                "write the equations one by one",
            ),
        }
    }
    plain
}

struct Restating<'a, 'c> {
    component: &'c ComponentDeclaration,
    names: &'a Names<'c>,
    /// Equations that hold everywhere.
    body: Vec<&'c EquationDeclaration>,
    expressions: &'a mut Expressions,
    complaints: &'a mut Complaints,
}

impl<'c> Restating<'_, 'c> {
    /// A location, or the one in which all of the body holds.
    fn location(&mut self, location: Option<&'c LocationDeclaration>) -> Location<'c> {
        let own = location.map_or_else(Vec::new, |l| plain_equations(&l.equations, self.complaints));
        let equations: Vec<_> = self.body.iter().copied().chain(own).collect();
        let mut locals = self.locals(location, &equations);
        let mut restated = Location {
            name: location.map_or(Cow::Borrowed("Main"), |l| Cow::Borrowed(&l.name.value)),
            documentation: location.map_or("", |l| &l.documentation),
            dynamics: Vec::new(),
            output: Vec::new(),
            transitions: Vec::new(),
        };
        for equation in equations {
            let name = equation.target.name.value.as_str();
            if equation.derivative {
                let right = self.expressions.located(&equation.right, &mut locals, self.complaints);
                restated.dynamics.push((name, right));
            } else if !locals.definitions.contains_key(name) {
                let right = self.expressions.located(&equation.right, &mut locals, self.complaints);
                restated.output.push((name, right));
            }
        }
        restated.dynamics.extend(self.names.modes.iter().map(|&mode| (mode, Cow::Borrowed("0"))));
        if self.component.dialect == Dialect::Hsml {
            restated.output = self.in_order(restated.output);
        }
        let transitions = location.map_or(&[][..], |location| &location.transitions);
        restated.transitions = self.transitions(transitions, &mut locals);
        restated
    }

    /// The locals that a location knows, with their equations.
    fn locals(
        &self,
        location: Option<&'c LocationDeclaration>,
        equations: &[&'c EquationDeclaration],
    ) -> Locals<'c> {
        let mut locals = Locals::default();
        locals.definitions.extend(self.names.locals.iter().map(|&name| (name, None)));
        let own = location.into_iter().flat_map(|location| &location.variables);
        let own = own.filter(|variable| variable.role == VariableRole::Local);
        locals.definitions.extend(own.map(|variable| (variable.name.value.as_str(), None)));
        for equation in equations.iter().filter(|equation| !equation.derivative) {
            if let Some(definition) = locals.definitions.get_mut(equation.target.name.value.as_str()) {
                definition.get_or_insert(&equation.right);
            }
        }
        locals
    }

    /// The maps in the order of the outputs; an output that is a state is mapped to it.
    fn in_order(&self, maps: Vec<(&'c str, Cow<'c, str>)>) -> Vec<(&'c str, Cow<'c, str>)> {
        let mut by_name: HashMap<&str, Vec<(&'c str, Cow<'c, str>)>> = HashMap::new();
        let mut others = Vec::new();
        for (name, right) in maps {
            if self.names.output_set.contains(name) {
                by_name.entry(name).or_default().push((name, right));
            } else {
                others.push((name, right));
            }
        }
        let mut ordered = Vec::new();
        for &output in &self.names.outputs {
            let maps = by_name.remove(output).unwrap_or_default();
            if maps.is_empty() && self.names.states.contains(output) {
                ordered.push((output, Cow::Owned(name_text(output))));
            }
            ordered.extend(maps);
        }
        ordered.extend(others);
        ordered
    }

    /// The transitions; two of one name, one `when` and one `on`, are one.
    fn transitions(
        &mut self,
        transitions: &'c [TransitionDeclaration],
        locals: &mut Locals<'c>,
    ) -> Vec<Transition<'c>> {
        let mut restated: Vec<(Half, Transition<'c>)> = Vec::new();
        for transition in transitions {
            let Some((half, next)) = self.transition(transition, locals) else { continue };
            match restated.last_mut() {
                Some((last_half, last)) if completes(*last_half, last, half, &next) => {
                    if half == Half::Guard {
                        last.domain = next.domain;
                    } else {
                        last.input_events = next.input_events;
                    }
                    if !next.documentation.is_empty() && next.documentation != last.documentation {
                        let both = [&*last.documentation, &*next.documentation].map(str::to_owned);
                        last.documentation = Cow::Owned(both.join("\n").trim().to_owned());
                    }
                    *last_half = Half::Both;
                }
                _ => restated.push((half, next)),
            }
        }
        restated.into_iter().map(|(_, transition)| transition).collect()
    }

    fn transition(
        &mut self,
        transition: &'c TransitionDeclaration,
        locals: &mut Locals<'c>,
    ) -> Option<(Half, Transition<'c>)> {
        if let Some(priority) = &transition.priority {
            let way_out = "write the transitions in the order of their priorities, and delete these: the first one written goes first";
            self.complaints.cannot(priority.span, "SOPHY XML has no priorities", way_out);
        }
        let (half, domain, labels) = self.trigger(transition, locals)?;
        let mut restated = Transition {
            name: &transition.name.value,
            documentation: Cow::Borrowed(&transition.documentation),
            domain,
            destination: &transition.destination.value,
            resets: Vec::new(),
            input_events: labels.iter().map(|label| label.value.as_str()).collect(),
            output_events: Vec::new(),
        };
        for action in &transition.actions {
            match action {
                Statement::Assign { target, right } if target.indices.is_empty() => {
                    let name = target.name.value.as_str();
                    if locals.definitions.contains_key(name) || self.is_assigned_output(name) {
                        let message = format!("SOPHY XML assigns to states only, and `{name}` is none");
                        self.complaints.cannot(target.name.span, message, "declare it as a real mode");
                    }
                    restated.resets.push((name, self.expressions.located(right, locals, self.complaints)));
                }
                Statement::Emit(label) => restated.output_events.push(&label.value),
                other => complaints_at(
                    other,
                    self.complaints,
                    "SOPHY XML has only assignments to states and output events here",
                    "write each assignment as `x := if … then … else x;`",
                ),
            }
        }
        Some((half, restated))
    }

    /// Whether it is an output of an HSML component, and no state.
    fn is_assigned_output(&self, name: &str) -> bool {
        self.component.dialect == Dialect::Hsml
            && self.names.output_set.contains(name)
            && !self.names.states.contains(name)
    }

    fn trigger(
        &mut self,
        transition: &'c TransitionDeclaration,
        locals: &mut Locals<'c>,
    ) -> Option<Awaited<'c>> {
        let span = transition.name.span;
        let mut cannot = |what: &str, way_out: &str| {
            self.complaints.cannot(span, format!("SOPHY XML has no {what}"), way_out);
            None
        };
        match &transition.trigger {
            TriggerDeclaration::When(None) => Some((Half::Both, Cow::Borrowed(""), &[])),
            TriggerDeclaration::When(Some(guard)) => {
                Some((Half::Guard, self.expressions.located(guard, locals, self.complaints), &[]))
            }
            // Never true: only the event is left.
            TriggerDeclaration::On(labels, None) => Some((Half::Events, Cow::Borrowed("false"), labels)),
            TriggerDeclaration::WhenOrOn(guard, labels) => {
                let domain = guard.as_ref().map_or(Cow::Borrowed(""), |guard| {
                    self.expressions.located(guard, locals, self.complaints)
                });
                Some((Half::Both, domain, labels))
            }
            TriggerDeclaration::On(_, Some(_)) => cannot(
                "events under a condition",
                "write a location for each value of the condition, or delete its `when …`",
            ),
            TriggerDeclaration::Rate(..) => cannot("transitions at a rate", "keep the component in HSML"),
            TriggerDeclaration::Invariant(..) => {
                cannot("invariants", "write the negated invariant as the guard: `when not (…)`")
            }
            TriggerDeclaration::Synchronised(..) => {
                cannot("transitions taken together with others", "keep the component in HSML")
            }
        }
    }
}

/// Which half a transition is, its domain and its input events.
type Awaited<'c> = (Half, Cow<'c, str>, &'c [Spanned<String>]);

/// What a transition of HSML is of one of SOPHY XML.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Half {
    Guard,
    Events,
    Both,
}

/// Whether two transitions in a row are the halves of one.
fn completes(first_half: Half, first: &Transition<'_>, second_half: Half, second: &Transition<'_>) -> bool {
    matches!((first_half, second_half), (Half::Guard, Half::Events) | (Half::Events, Half::Guard))
        && first.name == second.name
        && first.destination == second.destination
        && first.resets == second.resets
        && first.output_events == second.output_events
}

/// A name as an expression.
fn name_text(name: &str) -> String {
    if crate::hints::is_identifier(name) { name.to_owned() } else { format!("'{name}'") }
}
