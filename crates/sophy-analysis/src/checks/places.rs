use sophy_diagnostics::{Diagnostic, Span};

/// How many further places of a mistake are shown.
const SHOWN: usize = 3;

/// Points at the other places of a mistake that is reported once.
pub(super) fn further_places(mut diagnostic: Diagnostic, further: &[Span]) -> Diagnostic {
    for &span in further.iter().take(SHOWN) {
        diagnostic = diagnostic.label(span, "also here");
    }
    match further.len().saturating_sub(SHOWN) {
        0 => diagnostic,
        1 => diagnostic.note("and 1 more place"),
        more => diagnostic.note(format!("and {more} more places")),
    }
}

/// Items under their names, names in the order in which they first occur.
pub(super) fn grouped<'n, T>(items: impl IntoIterator<Item = (&'n str, T)>) -> Vec<(&'n str, Vec<T>)> {
    let mut groups: Vec<(&str, Vec<T>)> = Vec::new();
    let mut group_of = std::collections::HashMap::new();
    for (name, item) in items {
        let group = *group_of.entry(name).or_insert_with(|| {
            groups.push((name, Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(item);
    }
    groups
}
