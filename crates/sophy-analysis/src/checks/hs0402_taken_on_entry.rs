//! A transition is taken the instant its location is entered. Every way into the location is the crossing of a
//! surface e = 0, and the transition waits for the rate of e to have the sign that it must have for e to cross:
//! the comparison is the wrong way round. So it is in Raibert's hopper as printed (thesis A.6): Compression is
//! entered by `Position < L`, hence with `Speed < 0`, and left when `Speed < 0`; `Speed > 0` was meant.

use crate::component::{BuiltLocation, BuiltTransition};
use crate::declarations::{ComponentDeclaration, ExpressionText, TransitionDeclaration, TriggerDeclaration};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics};
use sophy_ir::{Binary, Comparison, Graph, Leaf, Node, NodeId, Unary, VariableId};
use sophy_syntax::ast::{ComparisonOperator, Expression};
use std::collections::HashMap;

pub(crate) const CODE: Code = Code("HS0402");

/// Looks at every location that is entered by transitions only.
pub(crate) fn find(
    declarations: &ComponentDeclaration,
    locations: &[BuiltLocation<'_>],
    graph: &mut Graph,
    diagnostics: &mut Diagnostics,
) {
    let first = match &declarations.initial_location {
        Some(name) => declarations.locations.iter().position(|l| l.name.value == name.value),
        None => Some(0),
    };
    for (position, location) in locations.iter().enumerate() {
        if Some(position) == first {
            continue;
        }
        let Some((rate, entry)) = rate_on_entry(position, declarations, locations, graph) else { continue };
        for (written, lowered) in
            declarations.locations[position].transitions.iter().zip(&location.transitions)
        {
            if guard_of(written).is_some()
                && lowered.guard.and_then(|guard| half_space(graph, guard)) == Some(rate)
            {
                diagnostics.push(diagnostic(written, entry, &declarations.locations[position].name.value));
            }
        }
    }
}

/// The set in which a quantity is positive or negative.
#[derive(Clone, Copy, PartialEq, Eq)]
struct HalfSpace {
    quantity: NodeId,
    positive: bool,
}

/// What is known of the rate of the surface crossed on entry, the same for all ways into the location, and one
/// of these ways.
fn rate_on_entry<'d>(
    position: usize,
    declarations: &'d ComponentDeclaration,
    locations: &[BuiltLocation<'_>],
    graph: &mut Graph,
) -> Option<(HalfSpace, &'d TransitionDeclaration)> {
    let mut known: Option<(HalfSpace, &TransitionDeclaration)> = None;
    for (source, written) in locations.iter().zip(&declarations.locations) {
        for (transition, written) in source.transitions.iter().zip(&written.transitions) {
            if transition.destination != Some(position) {
                continue;
            }
            if !is_guarded_only(written) {
                return None;
            }
            let rate = rate_at_crossing(source, transition, graph)?;
            match known {
                Some((other, _)) if other != rate => return None,
                Some(_) => {}
                None => known = Some((rate, written)),
            }
        }
    }
    known
}

/// On the surface e = 0 at which `e < 0` becomes true, ė is negative; reversed for `e > 0`. `None` if the guard is
/// not a single inequality, ė is not known, or a reset changes what it depends on.
fn rate_at_crossing(
    source: &BuiltLocation<'_>,
    transition: &BuiltTransition<'_>,
    graph: &mut Graph,
) -> Option<HalfSpace> {
    let crossed = half_space(graph, transition.guard?)?;
    let rates: HashMap<VariableId, Option<NodeId>> =
        source.defined.rates.iter().map(|(&id, definition)| (id, definition.right)).collect();
    let depends_on = graph.dependencies([crossed.quantity]);
    let all_known = depends_on.iter().all(|leaf| match leaf {
        Leaf::Variable(id) => rates.get(id).is_none_or(Option::is_some),
        _ => true,
    });
    if !all_known {
        return None;
    }
    let rate = graph.directional(crossed.quantity, &mut |graph, leaf| match leaf {
        Leaf::Variable(id) => rates.get(&id).copied().flatten(),
        Leaf::Time => Some(graph.number(1.0)),
        _ => None,
    })?;
    let (quantity, flipped) = without_sign(graph, rate);
    let reset = |leaf: &Leaf| {
        transition.actions.assignments.iter().any(|reset| *leaf == Leaf::Variable(reset.variable))
    };
    if graph.dependencies([quantity]).iter().any(reset) || graph.as_number(quantity).is_some() {
        return None;
    }
    Some(HalfSpace { quantity, positive: crossed.positive != flipped })
}

/// The set in which a single inequality holds, whichever way it is written.
fn half_space(graph: &mut Graph, guard: NodeId) -> Option<HalfSpace> {
    let Node::Compare(comparison, a, b) = graph.node(guard) else { return None };
    let positive = match comparison {
        Comparison::Greater | Comparison::GreaterEqual => true,
        Comparison::Less | Comparison::LessEqual => false,
        Comparison::Equal | Comparison::NotEqual => return None,
    };
    let is_zero = |node: NodeId| graph.as_number(node) == Some(0.0);
    let (quantity, flipped) = if is_zero(b) {
        without_sign(graph, a)
    } else if is_zero(a) {
        let (quantity, flipped) = without_sign(graph, b);
        (quantity, !flipped)
    } else if a < b {
        (graph.subtract(a, b), false)
    } else {
        (graph.subtract(b, a), true)
    };
    Some(HalfSpace { quantity, positive: positive != flipped })
}

/// The quantity without the minus signs in front of it, and whether their number is odd.
fn without_sign(graph: &mut Graph, node: NodeId) -> (NodeId, bool) {
    match graph.node(node) {
        Node::Unary(Unary::Negate, inner) => {
            let (quantity, flipped) = without_sign(graph, inner);
            (quantity, !flipped)
        }
        Node::Binary(Binary::Multiply, factor, inner) if graph.as_number(factor) == Some(-1.0) => {
            let (quantity, flipped) = without_sign(graph, inner);
            (quantity, !flipped)
        }
        _ => (node, false),
    }
}

fn diagnostic(
    transition: &TransitionDeclaration,
    entry: &TransitionDeclaration,
    location: &str,
) -> Diagnostic {
    let place = |t: &TransitionDeclaration| guard_of(t).map_or(t.name.span, |guard| guard.span);
    let message =
        format!("`{}` is taken the instant location `{location}` is entered", transition.name.value);
    let mut warning = Diagnostic::warning(CODE, place(transition), message).label(
        place(entry),
        "the location is entered here: the rate of this quantity already has the sign that is waited for",
    );
    if let Some(reversed) = reversed(transition) {
        warning = warning.help(format!("did you mean `{reversed}`?"));
    }
    warning
}

/// The guard of a transition that nothing else triggers.
fn guard_of(transition: &TransitionDeclaration) -> Option<&ExpressionText> {
    match &transition.trigger {
        TriggerDeclaration::When(guard) => guard.as_ref(),
        TriggerDeclaration::WhenOrOn(guard, _) => guard.as_ref(),
        _ => None,
    }
}

fn is_guarded_only(transition: &TransitionDeclaration) -> bool {
    match &transition.trigger {
        TriggerDeclaration::When(_) => true,
        TriggerDeclaration::WhenOrOn(_, events) => events.is_empty(),
        _ => false,
    }
}

/// The guard with the comparison turned round.
fn reversed(transition: &TransitionDeclaration) -> Option<String> {
    let guard = guard_of(transition)?;
    let Expression::Comparison(comparison) = guard.expression.clone()?.unparenthesised()? else {
        return None;
    };
    let operator = match comparison.operator()? {
        ComparisonOperator::Less => ">",
        ComparisonOperator::LessEqual => ">=",
        ComparisonOperator::Greater => "<",
        ComparisonOperator::GreaterEqual => "<=",
        ComparisonOperator::Equal | ComparisonOperator::NotEqual => return None,
    };
    let left = guard.text.get(comparison.left()?.range())?;
    let right = guard.text.get(comparison.right()?.range())?;
    Some(format!("{left} {operator} {right}"))
}

#[cfg(test)]
mod tests {
    use crate::testing::check;

    const FLIGHT: &str = "constant L = 0.5
             state Position
             state Speed
             location Flight
               der Position = Speed
               der Speed = -9.82
               transition impact when ENTRY goto Compression
             location Compression
               der Position = Speed
               der Speed = 8/Position - 9.82
               transition turned when GUARD goto Flight";

    fn taken_on_entry(entry: &str, guard: &str) -> bool {
        let text = FLIGHT.replace("ENTRY", entry).replace("GUARD", guard);
        !crate::testing::diagnostics_of(&text).is_empty()
    }

    #[test]
    fn the_mistake_of_the_printed_hopper() {
        check(
            &FLIGHT.replace("ENTRY", "Position < L").replace("GUARD", "Speed < 0"),
            "warning[HS0402] line 11 `Speed < 0`: `turned` is taken the instant location `Compression` is entered
               line 7 `Position < L`: the location is entered here: the rate of this quantity already has the \
             sign that is waited for
               help: did you mean `Speed > 0`?",
        );
    }

    #[test]
    fn however_the_inequalities_are_written() {
        for entry in
            ["Position < L", "L > Position", "Position - L <= 0", "0 > Position - L", "-Position > -L"]
        {
            for guard in ["Speed < 0", "0 > Speed", "-Speed > 0", "Speed <= 0", "(Speed < 0)"] {
                assert!(taken_on_entry(entry, guard), "{entry}, {guard}");
            }
            for guard in ["Speed > 0", "0 < Speed", "Speed < 1", "Position > L", "Speed < 0 or Position > L"]
            {
                assert!(!taken_on_entry(entry, guard), "{entry}, {guard}");
            }
        }
        assert!(taken_on_entry("Position > L", "Speed > 0"));
        assert!(!taken_on_entry("Position > L", "Speed < 0"));
    }

    #[test]
    fn a_reset_of_what_the_rate_depends_on_excuses() {
        let text = FLIGHT.replace("ENTRY", "Position < L").replace("GUARD", "Speed < 0");
        let reset = text.replace("goto Compression", "goto Compression\n reset Speed = -Speed");
        assert!(crate::testing::diagnostics_of(&reset).is_empty());
    }
}
