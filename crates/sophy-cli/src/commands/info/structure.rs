//! What a model consists of, as text for people.

use super::lists::{Lists, counted, line, table};
use crate::numbers::{brief, count, plural};
use sophy::{
    AutomatonDescription, ClockDescription, ComponentDescription, Description, Quantity,
    TransitionDescription,
};
use std::collections::HashSet;
use std::fmt::Write;

/// States up to which the coupling matrix is printed.
const LARGEST_MATRIX: usize = 24;

pub(super) fn text(d: &Description, lists: Lists) -> String {
    let mut out = String::new();
    line(&mut out, &d.name);
    for paragraph in d.documentation.trim().lines() {
        line(&mut out, &format!("  {}", paragraph.trim()));
    }
    line(&mut out, "");
    line(&mut out, &sizes(d));
    components(&d.components, lists, &mut out);
    quantities("State", "initial", &d.states, lists, &mut out);
    quantities("Mode", "initial", &d.modes, lists, &mut out);
    quantities("Input", "", &d.inputs, lists, &mut out);
    quantities("Output", "", &d.outputs, lists, &mut out);
    quantities("View", "", &d.views, lists, &mut out);
    let (knobs, others): (Vec<Quantity>, Vec<Quantity>) = d.constants.iter().cloned().partition(|c| c.knob);
    quantities("Knob", "value", &knobs, lists, &mut out);
    let noun = if knobs.is_empty() { "Parameter" } else { "Other parameter" };
    quantities(noun, "value", &others, lists, &mut out);
    if !d.constants.is_empty() && d.components.iter().any(|one| !one.shape.is_empty()) {
        line(&mut out, "  (copies written as `NAME : KIND[n]` have their parameters in common)");
    }
    d.automata.iter().for_each(|automaton| locations(automaton, &mut out));
    clocks(&d.clocks, &mut out);
    dependencies(d, lists, &mut out);
    equations(d, lists, &mut out);
    if !d.watches.is_empty() {
        line(&mut out, "\nWatched for changes of sign");
        for watch in &d.watches[..lists.shown(d.watches.len())] {
            line(&mut out, &format!("  {}  ({})", watch.quantity, kind(watch.affine)));
        }
        lists.rest(d.watches.len(), "sign", &mut out);
    }
    if !d.awaits.is_empty() {
        line(&mut out, "\nChecked, but not yet to be run by this version");
        for sentence in &d.awaits[..lists.shown(d.awaits.len())] {
            line(&mut out, &format!("  {sentence}"));
        }
        lists.rest(d.awaits.len(), "part", &mut out);
    }
    out
}

fn sizes(d: &Description) -> String {
    let of = |list: &[Quantity]| list.len() as u64;
    let first = counted(&[
        (d.sizes.components, "component"),
        (of(&d.states), "state"),
        (of(&d.modes), "mode"),
        (of(&d.inputs), "input"),
        (of(&d.outputs), "output"),
        (of(&d.constants), "parameter"),
        (d.sizes.locations, "location"),
        (d.sizes.transitions, "transition"),
    ]);
    let second = counted(&[
        (d.sizes.algebraics, "algebraic variable"),
        (d.watches.len() as u64, "watched sign"),
        (d.sizes.expressions, "expression node"),
    ]);
    format!("{first}\n{second}")
}

/// The tree of components.
fn components(components: &[ComponentDescription], lists: Lists, out: &mut String) {
    if components.len() < 2 {
        return;
    }
    let row = |one: &ComponentDescription| {
        let shape = if one.shape.is_empty() { String::new() } else { format!("[{}]", one.shape) };
        let indent = "  ".repeat(one.depth.min(40));
        let name = if one.depth == 0 {
            one.name.clone()
        } else {
            format!("{indent}{} : {}{shape}", one.name, one.class)
        };
        let copies = if one.copies > 1 { format!("{} in all", count(one.copies)) } else { String::new() };
        let documentation = one.documentation.lines().next().unwrap_or_default();
        [name, one.kind.to_owned(), [copies.as_str(), documentation].join("  ").trim().to_owned()]
    };
    let rows: Vec<[String; 3]> = components[..lists.shown(components.len())].iter().map(row).collect();
    table("Components", "kind", &rows, out);
    lists.rest(components.len(), "component", out);
}

fn quantities(noun: &str, value_title: &str, quantities: &[Quantity], lists: Lists, out: &mut String) {
    if quantities.is_empty() {
        return;
    }
    let row = |q: &Quantity| {
        let name = match &q.unit {
            Some(unit) => format!("{} [{unit}]", q.name),
            None => q.name.clone(),
        };
        let value = match (&q.text, q.value, value_title) {
            (Some(text), ..) => text.clone(),
            (None, Some(value), _) => value.to_string(),
            (None, None, "initial") => "not given".to_owned(),
            (None, None, _) => String::new(),
        };
        let within = match &q.range {
            Some([low, high]) => format!("in ({low}, {high})"),
            None if !q.choices.is_empty() => format!("in {{{}}}", q.choices.join(", ")),
            None => String::new(),
        };
        let documentation = q.documentation.split_whitespace().collect::<Vec<_>>().join(" ");
        let fixed = if q.structural { "fixed: it decides the structure" } else { "" };
        let remarks = [within.as_str(), fixed, documentation.as_str()].into_iter().filter(|r| !r.is_empty());
        [name, value, remarks.collect::<Vec<_>>().join("  ")]
    };
    let rows: Vec<[String; 3]> = quantities[..lists.shown(quantities.len())].iter().map(row).collect();
    table(&format!("{noun}s"), value_title, &rows, out);
    lists.rest(quantities.len(), &noun.to_lowercase(), out);
}

fn locations(automaton: &AutomatonDescription, out: &mut String) {
    let copies =
        if automaton.copies > 1 { format!(" (as all {})", count(automaton.copies)) } else { String::new() };
    let written = automaton.locations.iter().any(|location| !location.name.is_empty());
    let title = if written { "Locations" } else { "Events and rules" };
    match automaton.component.as_str() {
        "" => line(out, &format!("\n{title}")),
        component => line(out, &format!("\n{title} of {component} : {}{copies}", automaton.class)),
    }
    for location in &automaton.locations {
        let initial = if location.name == automaton.initial { "  (initial)" } else { "" };
        if written {
            line(out, &format!("  {}{initial}", location.name));
        }
        if let Some(invariant) = &location.invariant {
            line(out, &format!("    while {invariant}"));
        }
        location.constraints.iter().for_each(|constraint| line(out, &format!("    {constraint}")));
        location.transitions.iter().for_each(|t| transition(t, out));
    }
    for reaction in &automaton.reactions {
        let priority =
            if reaction.priority == 0 { String::new() } else { format!("  priority {}", reaction.priority) };
        line(out, &format!("  when {}{priority}", reaction.when));
        reaction.does.iter().for_each(|action| line(out, &format!("        {action}")));
    }
}

fn transition(t: &TransitionDescription, out: &mut String) {
    line(out, &format!("    → {}  {}", t.to, t.name));
    let affine = t.affine.map(|affine| format!("  ({})", kind(affine))).unwrap_or_default();
    let priority = if t.priority == 0 { String::new() } else { format!("  priority {}", t.priority) };
    line(out, &format!("        {}{affine}{priority}", t.trigger));
    t.resets.iter().for_each(|reset| line(out, &format!("        {reset}")));
    t.emits.iter().for_each(|label| line(out, &format!("        emits {label}")));
}

/// How crossings are found.
fn kind(affine: bool) -> &'static str {
    if affine { "affine" } else { "not affine" }
}

fn clocks(clocks: &[ClockDescription], out: &mut String) {
    if clocks.is_empty() {
        return;
    }
    let row = |clock: &ClockDescription| {
        let copies =
            if clock.copies > 1 { format!(" (as all {})", count(clock.copies)) } else { String::new() };
        let when = match (&clock.announced_by, clock.period) {
            (Some(variable), _) => format!("when {variable} says"),
            (None, Some(period)) => format!("every {period} s"),
            (None, None) => String::new(),
        };
        let mut more = Vec::new();
        more.extend(clock.offset.map(|offset| format!("from {offset} s")));
        more.extend(clock.delay.map(|delay| format!("delay {delay} s")));
        if clock.priority != 0 {
            more.push(format!("priority {}", clock.priority));
        }
        [format!("{} : {}{copies}", clock.component, clock.class), when, more.join(", ")]
    };
    table("Clocks", "executes", &clocks.iter().map(row).collect::<Vec<_>>(), out);
}

/// The coupling matrix D: rows are rates, columns what they read; of a large one, how full it is.
fn dependencies(d: &Description, lists: Lists, out: &mut String) {
    if d.states.is_empty() {
        return;
    }
    if d.dependencies.len() <= LARGEST_MATRIX && !d.dependencies.is_empty() {
        matrix(d, out);
    }
    let Some(s) = &d.sparsity else {
        line(out, "\nDependencies: more than can be written out");
        return;
    };
    if d.dependencies.len() > LARGEST_MATRIX {
        line(out, &format!("\nDependencies of {} rates on {} states", count(s.rows), count(s.rows)));
        line(
            out,
            &format!(
                "  {} of {} entries are not zero",
                count(s.nonzeros),
                brief(s.rows as f64 * s.rows as f64)
            ),
        );
        line(
            out,
            &format!("  in a row at least {}, on average {}, at most {}", s.least, brief(s.mean), s.most),
        );
        line(out, &format!("  bandwidth {}", count(s.bandwidth)));
        if lists.all {
            for row in &d.dependencies {
                line(out, &format!("  der({}) reads {}", row.state, row.reads.join(", ")));
            }
        }
    }
}

/// What constraints determine reads what they read; who solves them for it is not decided yet.
fn constrained(d: &Description, out: &mut String) {
    if d.index > 0 {
        line(out, "  not counted: what is read by way of constraints");
    }
}

fn matrix(d: &Description, out: &mut String) {
    let read: HashSet<&str> = d.dependencies.iter().flat_map(|row| &row.reads).map(String::as_str).collect();
    let named = d.states.iter().chain(&d.modes).chain(&d.inputs).map(|q| q.name.as_str()).chain(["time"]);
    let columns: Vec<&str> = named.filter(|name| read.contains(name)).collect();
    if columns.is_empty() {
        line(out, "\nDependencies: no rate reads a state, a mode, an input or the time");
        constrained(d, out);
        return;
    }
    let width = d.dependencies.iter().map(|row| row.state.chars().count() + 5).max().unwrap_or(0);
    line(out, "\nDependencies (× read in all locations, + in some)");
    line(out, &format!("  {:<width$}  {}", "", columns.join("  ")));
    for row in &d.dependencies {
        let mut text = format!("  {:<width$}", format!("der({})", row.state));
        for column in &columns {
            let everywhere = row.by_location.iter().all(|(_, reads)| reads.iter().any(|read| read == column));
            let mark = match (row.reads.iter().any(|read| read == column), everywhere) {
                (false, _) => '·',
                (true, true) => '×',
                (true, false) => '+',
            };
            let cell = column.chars().count();
            // Writing into a string does not fail.
            let _ = write!(text, "  {mark:<cell$}");
        }
        line(out, &text);
    }
    for row in &d.dependencies {
        for (location, reads) in &row.by_location {
            let reads = if reads.is_empty() { "nothing".to_owned() } else { reads.join(", ") };
            line(out, &format!("  in {location}, der({}) reads {reads}", row.state));
        }
    }
    constrained(d, out);
}

/// What depends on itself, and the index of the equations.
fn equations(d: &Description, lists: Lists, out: &mut String) {
    let knotted: u64 = d.knots.iter().map(|knot| knot.size).sum();
    if !d.knots.is_empty() {
        line(out, "\nVariables that depend on one another");
        for knot in &d.knots[..lists.shown(d.knots.len())] {
            let more = knot.size - knot.members.len() as u64;
            let more = if more > 0 { format!(", … and {} more", count(more)) } else { String::new() };
            line(out, &format!("  {}: {}{more}", count(knot.size), knot.members.join(", ")));
        }
        lists.rest(d.knots.len(), "group", out);
        let alone = (d.states.len() as u64 + d.sizes.algebraics).saturating_sub(knotted);
        if alone > 0 {
            line(out, &format!("  {} on no such loop", plural(alone, "variable")));
        }
    }
    if !d.states.is_empty() || d.index > 0 {
        let index = match d.index {
            0 => "0: ordinary differential equations, no algebraic loop".to_owned(),
            1 => "1: constraints that can be solved for what they determine".to_owned(),
            _ => "at least 2 by structure: constraints have to be differentiated".to_owned(),
        };
        line(out, &format!("\nIndex {index}"));
    }
}
