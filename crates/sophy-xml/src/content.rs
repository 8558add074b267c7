use crate::codes::{
    MISPLACED_ELEMENT, MISSING_ATTRIBUTE, MISSING_ELEMENT, MISSPELLED_ELEMENT, REPEATED_ELEMENT, STRAY_TEXT,
    UNKNOWN_ATTRIBUTE, UNKNOWN_ELEMENT, WRONG_ORDER,
};
use crate::document::{Element, Node};
use crate::schema::{self, Content, ELEMENTS, ElementModel, Occurs, Particle, ROOT};
use sophy_diagnostics::{Diagnostic, Diagnostics, Span, closest};

/// Checks the whole tree against the definition and fills in what each element was meant to be.
///
/// A misspelled name counts as what was meant, and an element out of order as the one that it is, so that
/// what they contain is checked and read, and that nothing is called missing that is there.
pub(crate) fn check(root: &mut Element, diagnostics: &mut Diagnostics) {
    if root.name == ROOT {
        root.meant = Some(ROOT);
    } else {
        let mut diagnostic = Diagnostic::error(
            if schema::element(&root.name).is_some() { MISPLACED_ELEMENT } else { UNKNOWN_ELEMENT },
            root.name_span,
            format!("the root element is `{}`, not `{ROOT}`", root.name),
        );
        // Children decide what a misspelled root is.
        let familiar =
            root.elements().filter(|child| child.name == "locations" || child.name == "states").count();
        if closest(&root.name, [ROOT]).is_some() || familiar > 0 {
            root.meant = Some(ROOT);
            diagnostic = diagnostic.help(format!("did you mean `{ROOT}`?"));
        } else {
            root.meant = schema::element(&root.name).map(|model| model.name);
            diagnostic = diagnostic.help(format!("a SOPHY file is one element <{ROOT}> … </{ROOT}>"));
        }
        diagnostics.push(diagnostic);
    }
    check_element(root, diagnostics);
}

/// Checks an element whose meaning is known, and what it contains.
fn check_element(element: &mut Element, diagnostics: &mut Diagnostics) {
    let Some(model) = element.meant.and_then(schema::element) else { return };
    check_attributes(element, model, diagnostics);
    match model.content {
        Content::Text => check_text_only(element, diagnostics),
        Content::Elements(particles) => {
            check_stray_text(element, particles, diagnostics);
            name_children(element, particles, diagnostics);
            check_order(element, particles, diagnostics);
            check_occurrence(element, particles, diagnostics);
        }
    }
    for node in &mut element.children {
        if let Node::Element(child) = node {
            // Depth is limited by the parser.
            check_element(child, diagnostics);
        }
    }
}

fn check_attributes(element: &Element, model: &ElementModel, diagnostics: &mut Diagnostics) {
    let known = model.attribute.map(|(name, _)| name);
    for attribute in element.attributes.iter().filter(|attribute| Some(attribute.name.as_str()) != known) {
        let message = format!("`{}` has no attribute `{}`", element.name, attribute.name);
        let mut diagnostic = Diagnostic::error(UNKNOWN_ATTRIBUTE, attribute.name_span, message);
        diagnostic = match known {
            Some(known) if element.attribute(known).is_none() => {
                diagnostic.help(format!("did you mean `{known}`?"))
            }
            Some(known) => diagnostic.help(format!("its only attribute is `{known}`")),
            None => diagnostic.help(attribute_help(element, &attribute.name)),
        };
        diagnostics.push(diagnostic);
    }
    if let Some((name, true)) = model.attribute
        && element.attribute(name).is_none()
        // An attribute of another name has already been called this one.
        && element.attributes.is_empty()
    {
        let message = format!("`{}` needs the attribute `{name}`", element.name);
        diagnostics.push(
            Diagnostic::error(MISSING_ATTRIBUTE, element.name_span, message)
                .help(format!("write <{} {name}=\"…\">", element.name)),
        );
    }
}

/// An attribute may be meant as the child element of the same name, as in `<location name="Flight">`.
fn attribute_help(element: &Element, attribute: &str) -> String {
    let model = element.meant.and_then(schema::element);
    let is_child = model.is_some_and(|model| match model.content {
        Content::Text => false,
        Content::Elements(particles) => particles.iter().any(|particle| particle.takes(attribute)),
    });
    if is_child {
        format!("write it as an element: <{attribute}>…</{attribute}>")
    } else {
        "delete it; the element has no attributes".to_owned()
    }
}

fn check_text_only(element: &Element, diagnostics: &mut Diagnostics) {
    for child in element.elements() {
        let message = format!("`{}` contains text only, no `{}`", element.name, child.name);
        let known = schema::element(&child.name).is_some();
        let code = if known { MISPLACED_ELEMENT } else { UNKNOWN_ELEMENT };
        let mut diagnostic =
            Diagnostic::error(code, child.name_span, message).label(element.name_span, "in this element");
        if known {
            diagnostic = diagnostic.help(belongs(&child.name));
        } else {
            diagnostic = diagnostic.help("for a `<` in an expression write `&lt;`");
        }
        diagnostics.push(diagnostic);
    }
}

fn check_stray_text(element: &Element, particles: &[Particle], diagnostics: &mut Diagnostics) {
    for node in &element.children {
        let Node::Text(text) = node else { continue };
        if text.is_blank() {
            continue;
        }
        let (_, map) = text.trimmed();
        let message = format!("text stands between the elements of `{}`", element.name);
        diagnostics.push(
            Diagnostic::error(STRAY_TEXT, map.whole(), message)
                .label(element.name_span, "in this element")
                .note(format!("`{}` contains {}", element.name, schema::sequence(particles)))
                .help("put it into one of these elements, or make it a comment: <!-- … -->"),
        );
    }
}

/// Finds what each child is meant to be, and complains about those that are nothing here.
fn name_children(element: &mut Element, particles: &[Particle], diagnostics: &mut Diagnostics) {
    let (parent, parent_span) = (element.name.clone(), element.name_span);
    // An unknown name is none of those that are there already and cannot stand twice.
    let present: Vec<&str> =
        particles.iter().map(|p| p.name).filter(|name| element.elements().any(|c| c.name == *name)).collect();
    let open = |p: &&Particle| !present.contains(&p.name) || p.occurs.repeatable();
    for node in &mut element.children {
        let Node::Element(child) = node else { continue };
        if let Some(particle) = particles.iter().find(|particle| particle.takes(&child.name)) {
            child.meant = Some(particle.name);
            // The printed definition itself has `inpuvent`, so that is no mistake.
            if child.name == "outpuvent" {
                diagnostics.push(
                    Diagnostic::warning(MISSPELLED_ELEMENT, child.name_span, "`outpuvent` is a misprint")
                        .help("write `outputevent`"),
                );
            }
            continue;
        }
        let known = ELEMENTS.iter().any(|model| model.name == child.name);
        let mut diagnostic = if known {
            Diagnostic::error(
                MISPLACED_ELEMENT,
                child.name_span,
                format!("`{}` has no place in `{parent}`", child.name),
            )
            .label(parent_span, "in this element")
            .help(belongs(&child.name))
        } else {
            Diagnostic::error(
                UNKNOWN_ELEMENT,
                child.name_span,
                format!("`{}` is not an element of `{parent}`", child.name),
            )
        };
        if known {
            child.meant = schema::element(&child.name).map(|model| model.name);
        } else {
            child.meant = closest(&child.name, particles.iter().filter(open).map(|p| p.name))
                .and_then(schema::element)
                .map(|model| model.name);
            diagnostic = match child.meant {
                Some(meant) => diagnostic.help(format!("did you mean `{meant}`?")),
                None => diagnostic
                    .note(format!("`{parent}` contains {}", schema::sequence(particles)))
                    .help("put text for people into `documentation`, for other tools into a `hint`"),
            };
        }
        diagnostics.push(diagnostic);
    }
}

/// Where an element belongs, in words.
fn belongs(name: &str) -> String {
    match schema::parents(name).as_slice() {
        [] => format!("`{name}` is the root element of a file; a file describes one system"),
        [parent] => format!("it belongs in `{parent}`"),
        parents => format!("it belongs in `{}`", parents.join("`, `")),
    }
}

/// Complains about the fewest elements that must be moved to put all in order.
fn check_order(element: &Element, particles: &[Particle], diagnostics: &mut Diagnostics) {
    let children: Vec<(usize, &Element)> = element
        .elements()
        .filter_map(|child| Some((particles.iter().position(|p| Some(p.name) == child.meant)?, child)))
        .collect();
    let stay = longest_in_order(&children.iter().map(|(at, _)| *at).collect::<Vec<_>>(), particles.len());
    let kept = |index: usize| stay.binary_search(&index).is_ok();
    for (_, (at, child)) in children.iter().enumerate().filter(|(index, _)| !kept(*index)) {
        let split = stay.partition_point(|&kept| children[kept].0 <= *at);
        let before = stay[..split].last().map(|&kept| children[kept]);
        let after = stay.get(split).map(|&kept| children[kept]);
        let message = format!("`{}` is out of order in `{}`", child.name, element.name);
        let mut diagnostic = Diagnostic::error(WRONG_ORDER, child.name_span, message);
        // The neighbour on whose wrong side it stands.
        let standing_after = |other: &Element| other.name_span.start < child.name_span.start;
        match (before, after) {
            (_, Some((_, next))) if standing_after(next) => {
                diagnostic = diagnostic.label(next.name_span, format!("`{}` comes before this", child.name));
            }
            (Some((_, previous)), _) if !standing_after(previous) => {
                diagnostic =
                    diagnostic.label(previous.name_span, format!("`{}` comes after this", child.name));
            }
            _ => {}
        }
        diagnostics.push(diagnostic.help(format!("the order is {}", schema::sequence(particles))));
    }
}

/// Indices of a longest part of `places` that does not decrease; `places` are below `count`.
fn longest_in_order(places: &[usize], count: usize) -> Vec<usize> {
    // The longest part that ends in each place, as (length, index of its last), and each one's predecessor.
    let mut best: Vec<Option<(usize, usize)>> = vec![None; count];
    let mut before: Vec<Option<usize>> = Vec::with_capacity(places.len());
    for (index, &place) in places.iter().enumerate() {
        let longest = best[..=place].iter().flatten().max_by_key(|(length, _)| *length).copied();
        before.push(longest.map(|(_, last)| last));
        best[place] = Some((longest.map_or(1, |(length, _)| length + 1), index));
    }
    let mut last = best.iter().flatten().max_by_key(|(length, _)| *length).map(|(_, last)| *last);
    let mut kept = Vec::new();
    while let Some(index) = last {
        kept.push(index);
        last = before[index];
    }
    kept.reverse();
    kept
}

fn check_occurrence(element: &Element, particles: &[Particle], diagnostics: &mut Diagnostics) {
    for (at, particle) in particles.iter().enumerate() {
        let first = element.first(particle.name);
        if first.is_none()
            && particle.occurs.required()
            && element.closed
            && !stands_elsewhere(element, particle)
        {
            let place = place_for(element, &particles[..at]);
            let name = particle.name;
            let many = if particle.occurs == Occurs::AtLeastOnce { "at least one " } else { "" };
            let message = format!("`{}` needs {many}`{name}`", element.name);
            let mut diagnostic = Diagnostic::error(MISSING_ELEMENT, element.name_span, message);
            if let Some((place, previous)) = place {
                diagnostic = diagnostic.label(place, format!("it comes after this `{previous}`"));
            }
            diagnostics.push(diagnostic.help(missing_help(element, name)));
        }
        if particle.occurs.repeatable() {
            continue;
        }
        for again in element.all(particle.name).skip(1) {
            let message = format!("`{}` stands more than once in `{}`", particle.name, element.name);
            let mut diagnostic = Diagnostic::error(REPEATED_ELEMENT, again.name_span, message);
            if let Some(first) = first {
                diagnostic = diagnostic.label(first.name_span, "the first one");
            }
            diagnostics.push(diagnostic.help(repeated_help(particle.name)));
        }
    }
}

/// Whether a missing element is there in another form that has been complained about: as an attribute, or as
/// what it should contain.
fn stands_elsewhere(element: &Element, particle: &Particle) -> bool {
    element.attribute(particle.name).is_some()
        || element.elements().any(|child| schema::parents(&child.name).contains(&particle.name))
}

/// The last element that comes before a missing one.
fn place_for(element: &Element, before: &[Particle]) -> Option<(Span, &'static str)> {
    let last =
        before.iter().rev().find_map(|particle| Some((element.all(particle.name).last()?, particle.name)));
    last.map(|(previous, name)| (previous.name_span, name))
}

fn missing_help(element: &Element, name: &str) -> String {
    match (element.meant, name) {
        (_, "states" | "inputs" | "outputs") => format!("write <{name}></{name}> if there are none"),
        (Some("hints" | "constants" | "transitions"), _) => {
            format!("delete `{}` if there are none", element.name)
        }
        (_, "domain") => "add <domain>…</domain> with the condition under which it is taken".to_owned(),
        _ => format!("add <{name}>…</{name}>"),
    }
}

fn repeated_help(name: &str) -> String {
    match name {
        "domain" => "write one condition: a || b for either, a &amp;&amp; b for both".to_owned(),
        "states" | "inputs" | "outputs" | "constants" | "hints" | "locations" | "transitions" => {
            format!("put all into one `{name}`")
        }
        _ => "delete one of them".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against all subsets.
        #[test]
        fn the_longest_part_in_order_is_the_longest(places in prop::collection::vec(0_usize..5, 0..10)) {
            let kept = longest_in_order(&places, 5);
            let in_order = |part: &[usize]| part.windows(2).all(|pair| places[pair[0]] <= places[pair[1]]);
            prop_assert!(kept.windows(2).all(|pair| pair[0] < pair[1]) && in_order(&kept));
            let subsets = (0..1_u32 << places.len()).map(|bits| {
                (0..places.len()).filter(|i| bits & (1 << i) != 0).collect::<Vec<_>>()
            });
            let longest = subsets.filter(|part| in_order(part)).map(|part| part.len()).max();
            prop_assert_eq!(Some(kept.len()), longest);
        }
    }
}
