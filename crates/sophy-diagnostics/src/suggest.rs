/// The candidate that a person most likely meant by `name`, if one is close.
///
/// Close is: equal but for case; `name` is a word of the candidate, or its first or last letters
/// (`Mode` for `ChargeMode`, `C` for `Capacity`); or few letters differ (a third of the longer name, swapped
/// neighbours counting as one). Of dotted names that begin alike only the last parts count. Earlier candidates win
/// ties, so order them by likelihood.
pub fn closest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let mut best: Option<(usize, &str)> = None;
    for candidate in candidates {
        if candidate == name || candidate.is_empty() {
            continue;
        }
        if let Some(distance) = closeness(name, candidate)
            && best.is_none_or(|(least, _)| distance < least)
        {
            best = Some((distance, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// Smaller is closer; `None` is not close at all.
fn closeness(name: &str, candidate: &str) -> Option<usize> {
    match (name.rsplit_once('.'), candidate.rsplit_once('.')) {
        (Some((path, last)), Some((known, candidate))) if path == known => {
            closeness_of_words(last, candidate)
        }
        _ => closeness_of_words(name, candidate),
    }
}

/// The longest text that is looked at letter by letter; the work grows with the square of it.
const MOST_LETTERS: usize = 200;

fn closeness_of_words(name: &str, candidate: &str) -> Option<usize> {
    let (lower, lower_candidate) = (name.to_lowercase(), candidate.to_lowercase());
    if lower == lower_candidate {
        return Some(0);
    }
    let (letters, others) = (name.chars().count(), candidate.chars().count());
    let limit = letters.max(others).div_ceil(3);
    if letters > 1 && letters.max(others) <= MOST_LETTERS && letters.abs_diff(others) <= limit {
        let distance = edit_distance(&lower, &lower_candidate);
        if distance <= limit && distance < letters {
            return Some(1 + distance);
        }
    }
    if words(candidate).any(|word| word.to_lowercase() == lower) {
        return Some(10);
    }
    if lower_candidate.starts_with(&lower) {
        return Some(20);
    }
    words(candidate).any(|word| word.to_lowercase().starts_with(&lower)).then_some(30)
}

/// `ChargeMode` → `Charge`, `Mode`; `max_speed` → `max`, `speed`.
fn words(name: &str) -> impl Iterator<Item = &str> {
    let mut after_lower = false;
    let starts = name.char_indices().filter(move |&(_, c)| {
        let starts = c.is_uppercase() && after_lower;
        after_lower = c.is_lowercase() || c.is_numeric();
        starts
    });
    let ends = starts.map(|(at, _)| at).chain([name.len()]);
    let parts = ends.scan(0, |start, end| Some(name.get(std::mem::replace(start, end)..end).unwrap_or("")));
    parts.flat_map(|part| part.split(|c: char| !c.is_alphanumeric()))
}

/// Damerau–Levenshtein distance (optimal string alignment), in characters.
fn edit_distance(a: &str, b: &str) -> usize {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let mut before: Vec<usize> = vec![0; b.len() + 1];
    let mut previous: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let substitute = previous[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = substitute.min(previous[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut previous, row);
    }
    previous[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_person_meant() {
        let meant = |name, candidates: &[&'static str]| closest(name, candidates.iter().copied());
        assert_eq!(meant("Positoin", &["Speed", "Position"]), Some("Position"));
        assert_eq!(meant("position", &["Speed", "Position"]), Some("Position"));
        assert_eq!(meant("Mode", &["Capacity", "ChargeMode", "V"]), Some("ChargeMode"));
        assert_eq!(meant("C", &["Capacity", "ChargeMode"]), Some("Capacity"));
        assert_eq!(meant("M", &["Capacity", "ChargeMode"]), Some("ChargeMode"));
        assert_eq!(meant("Charge", &["Nominal", "Payload", "Safe"]), None);
        assert_eq!(meant("FootHeight", &["G", "L", "TAU"]), None);
        assert_eq!(meant("x2", &["x1", "y"]), Some("x1"));
        assert_eq!(meant("speed", &["altitude", "ground_Speed"]), Some("ground_Speed"));
        assert_eq!(words("oneTwo_three2Four").collect::<Vec<_>>(), ["one", "Two", "three2", "Four"]);
    }

    #[test]
    fn dotted_names_that_begin_alike_are_told_apart_by_their_end() {
        let meant = |name, candidates: &[&'static str]| closest(name, candidates.iter().copied());
        assert_eq!(meant("room.Q", &["room.C", "room.loss"]), None);
        assert_eq!(
            meant("thermostat.temp", &["thermostat.heat", "thermostat.temperature"]),
            Some("thermostat.temperature")
        );
        assert_eq!(meant("cell[2].spede", &["cell[1].speed", "cell[2].speed"]), Some("cell[2].speed"));
        assert_eq!(meant("speed", &["cell.heat", "cell.speed"]), Some("cell.speed"));
    }
}
