use sophy_diagnostics::closest;

/// How many names a list shows.
const SHOWN: usize = 12;

/// A way out for a name that does not exist: the name that was meant, or those that exist.
pub(super) struct Suggestion<'n> {
    /// The name that was meant, if one is close.
    pub(super) meant: Option<&'n str>,
    /// What to say.
    pub(super) help: String,
}

/// Looks for `name` among `candidates`, likelier ones first; `what` are they, in the plural.
pub(super) fn suggest<'n>(name: &str, candidates: &[&'n str], what: &str) -> Suggestion<'n> {
    let meant = closest(name, candidates.iter().copied());
    let help = match meant {
        Some(meant) => format!("did you mean `{meant}`?"),
        None if candidates.is_empty() => format!("there are no {what}: declare it"),
        None => format!("declare it, or use one of the {what}: {}", list(candidates)),
    };
    Suggestion { meant, help }
}

fn list(names: &[&str]) -> String {
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    match names.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
