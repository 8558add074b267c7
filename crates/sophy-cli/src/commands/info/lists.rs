//! Lists as text; long ones are cut.

use crate::numbers::{count, plural};

/// Lines of a list that are shown unless all are asked for.
const SHOWN: usize = 30;

/// How long lists may become.
#[derive(Clone, Copy)]
pub(super) struct Lists {
    /// Whether they are shown in full.
    pub(super) all: bool,
}

impl Lists {
    pub(super) fn new(all: bool) -> Self {
        Lists { all }
    }

    /// How many of `length` entries are shown; a list is not cut for the sake of a few.
    pub(super) fn shown(self, length: usize) -> usize {
        if self.all || length <= SHOWN + SHOWN / 3 { length } else { SHOWN }
    }

    /// What stands for those that are not shown.
    pub(super) fn rest(self, length: usize, noun: &str, out: &mut String) {
        let rest = length - self.shown(length);
        if rest > 0 {
            line(out, &format!("  … and {} more {noun}s (--all shows them)", count(rest as u64)));
        }
    }
}

/// `title`, `value_title`, then one line for each row: name, value, remark.
pub(super) fn table(title: &str, value_title: &str, rows: &[[String; 3]], out: &mut String) {
    let column =
        |position: usize| rows.iter().map(move |row| row[position].chars().count()).max().unwrap_or(0);
    let (width, value_width) = (column(0).max(title.chars().count()), column(1).max(value_title.len()));
    line(out, &format!("\n{title:<width$}    {value_title}"));
    for [name, value, remark] in rows {
        line(out, &format!("  {name:<width$}  {value:<value_width$}  {remark}"));
    }
}

pub(super) fn line(out: &mut String, text: &str) {
    out.push_str(text.trim_end());
    out.push('\n');
}

/// `3 states, 1 input`, without what there is none of.
pub(super) fn counted(parts: &[(u64, &str)]) -> String {
    let parts = parts.iter().filter(|(number, _)| *number > 0);
    parts.map(|&(number, noun)| plural(number, noun)).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_are_cut_and_say_so() {
        let mut out = String::new();
        Lists::new(false).rest(40, "state", &mut out);
        assert_eq!(out, "");
        Lists::new(false).rest(1030, "state", &mut out);
        assert!(out.contains(&format!("and {} more states", count(1000))), "{out}");
        assert_eq!(Lists::new(true).shown(100_000), 100_000);
    }
}
