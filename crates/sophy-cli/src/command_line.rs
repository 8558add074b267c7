use crate::arguments::Arguments;
use clap::CommandFactory;
use sophy::{SourceId, Sources, Span};
use std::ops::Range;

/// The command line as a text that messages can point into.
pub(crate) struct CommandLine {
    source: SourceId,
    /// Flag (by its main name) and value of each argument that has both, and where the value stands.
    values: Vec<(String, String, Range<usize>)>,
}

impl CommandLine {
    /// Takes the command line of this process into `sources`.
    pub(crate) fn of_process(sources: &mut Sources) -> Self {
        let arguments: Vec<String> =
            std::env::args_os().skip(1).map(|argument| argument.to_string_lossy().into_owned()).collect();
        CommandLine::new(&arguments, sources)
    }

    fn new(arguments: &[String], sources: &mut Sources) -> Self {
        let mut text = "sophy".to_owned();
        let mut values = Vec::new();
        let mut flag = None;
        for argument in arguments {
            text.push(' ');
            let start = text.len();
            text.push_str(argument);
            match (flag.take(), argument.strip_prefix("--").and_then(|rest| rest.split_once('='))) {
                (Some(flag), _) => values.push((flag, argument.clone(), start..text.len())),
                (None, Some((name, value))) => {
                    values.push((main_name(name), value.to_owned(), text.len() - value.len()..text.len()));
                }
                (None, None) => flag = argument.strip_prefix("--").map(main_name),
            }
        }
        CommandLine { source: sources.add("command line", text), values }
    }

    /// Where the last value of `flag` stands.
    pub(crate) fn flag(&self, flag: &str) -> Span {
        self.flag_with(flag, "")
    }

    /// Where `start` stands in the last value of `flag` that holds it.
    pub(crate) fn flag_with(&self, flag: &str, start: &str) -> Span {
        let found = self.values.iter().rev().find_map(|(name, value, range)| {
            let within = value.find(start).filter(|_| name == flag)?;
            let length = if start.is_empty() { value.len() } else { start.len() };
            Some(range.start + within..range.start + within + length)
        });
        // `--quantum V` stands for `--quantum *=V`.
        let found = found.or_else(|| (start == "*").then(|| self.flag(flag).range()));
        Span::new(self.source, found.unwrap_or(0..0))
    }
}

/// `--stop-time` is `--stop`.
fn main_name(name: &str) -> String {
    let command = Arguments::command();
    let run = command.find_subcommand("run");
    let mut known = run.into_iter().flat_map(clap::Command::get_arguments);
    let argument =
        known.find(|argument| argument.get_all_aliases().is_some_and(|aliases| aliases.contains(&name)));
    format!("--{}", argument.and_then(clap::Arg::get_long).unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_behind_flags_aliases_and_equals_signs() {
        let arguments =
            ["run", "a.xml", "--set", "TAU=4", "--stop-time=20", "--start-value", "x=1", "--quantum", "1e-3"];
        let mut sources = Sources::default();
        let line = CommandLine::new(&arguments.map(str::to_owned), &mut sources);
        assert_eq!(sources.excerpt(line.flag_with("--set", "TAU")), "TAU");
        assert_eq!(sources.excerpt(line.flag("--stop")), "20");
        assert_eq!(sources.excerpt(line.flag_with("--initial", "x")), "x");
        assert_eq!(sources.excerpt(line.flag_with("--quantum", "*")), "1e-3");
        assert_eq!(sources.excerpt(line.flag("--every")), "");
    }
}
