use std::fs;
use std::path::Path;

/// A message: expected, with a part of its text, or found, with all of it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Message {
    /// From 1; 0 if it has no place.
    pub(crate) line: usize,
    pub(crate) severity: String,
    pub(crate) code: String,
    /// Message, ways out and notes.
    pub(crate) text: String,
}

impl Message {
    /// Whether `found` is what was expected.
    pub(crate) fn describes(&self, found: &Message) -> bool {
        (self.line, &self.severity, &self.code) == (found.line, &found.severity, &found.code)
            && found.text.contains(&self.text)
    }
}

/// What stands in the comments of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Expectations {
    pub(crate) root: Option<String>,
    pub(crate) messages: Vec<Message>,
    pub(crate) stop: f64,
    pub(crate) quantum: f64,
    pub(crate) knobs: Vec<(String, f64)>,
    pub(crate) inputs: Vec<(String, f64)>,
    /// Name, value, tolerance.
    pub(crate) finals: Vec<(String, f64, f64)>,
    pub(crate) final_labels: Vec<(String, String)>,
    /// Time, name, tolerance.
    pub(crate) events: Vec<(f64, String, f64)>,
    pub(crate) no_events: bool,
}

impl Expectations {
    /// Those of the file at `path`.
    pub(crate) fn of(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let mark = if path.extension().is_some_and(|extension| extension == "xml") { "<!--!" } else { "%!" };
        let mut expectations = Expectations { stop: 1.0, quantum: 1e-6, ..Expectations::default() };
        for (line, content) in (1..).zip(text.lines()) {
            for part in content.split(mark).skip(1) {
                let part = part.split("-->").next().unwrap_or_default();
                let above = part.chars().take_while(|&c| c == '^').count();
                let understood = expectations.add(part[above..].trim(), line - above);
                understood.unwrap_or_else(|| panic!("{}:{line}: `{part}`", path.display()));
            }
        }
        expectations
    }

    /// `None` if it cannot be understood.
    fn add(&mut self, part: &str, line: usize) -> Option<()> {
        let (word, rest) = part.split_once(' ')?;
        match word {
            "error" | "warning" | "note" => {
                let (code, text) = rest.split_once(' ').unwrap_or((rest, ""));
                let (severity, code, text) = (word.to_owned(), code.to_owned(), text.trim().to_owned());
                self.messages.push(Message { line, severity, code, text });
            }
            "root" => self.root = Some(rest.to_owned()),
            "stop" => self.stop = rest.parse().ok()?,
            "quantum" => self.quantum = rest.parse().ok()?,
            "knob" => self.knobs.push(setting(rest)?),
            "input" => self.inputs.push(setting(rest)?),
            "final" => match rest.split_once("+-") {
                Some((setting_, tolerance)) => {
                    let (name, value) = setting(setting_)?;
                    self.finals.push((name, value, number(tolerance)?));
                }
                None => {
                    let (name, label) = rest.split_once('=')?;
                    self.final_labels.push((name.trim().to_owned(), label.trim().to_owned()));
                }
            },
            "event" => {
                let (event, tolerance) = rest.split_once("+-")?;
                let (time, name) = event.trim().split_once(' ')?;
                self.events.push((number(time)?, name.trim().to_owned(), number(tolerance)?));
            }
            "no" => self.no_events = true,
            _ => return None,
        }
        Some(())
    }
}

/// `name = 1.5`
fn setting(text: &str) -> Option<(String, f64)> {
    let (name, value) = text.split_once('=')?;
    Some((name.trim().to_owned(), number(value)?))
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok()
}
