use crate::restate::{self, Location, System, Transition};
use quick_xml::Writer;
use quick_xml::escape::minimal_escape;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use sophy_analysis::{ComponentDeclaration, FunctionDeclaration, ParameterDeclaration};
use sophy_diagnostics::{Diagnostics, Severity};
use std::io;

/// What [`write()`] made of a component.
#[derive(Clone, Debug)]
pub struct Writing {
    /// The SOPHY XML, valid by [`DTD`](crate::DTD); `None` if there are errors among the diagnostics.
    pub text: Option<String>,
    /// Everything that SOPHY XML cannot say, as errors; without them, notes on what it says in other words.
    pub diagnostics: Diagnostics,
}

/// SOPHY XML that declares `component`, with the functions and constants of its file.
///
/// Expressions and documentation stay as they are, references are put where XML needs them, hints come in
/// the order initial state, units, functions, others. What [`read`](crate::read) makes of the text of a component
/// that was SOPHY XML equals it but for places, if names and expressions have no blanks around them. Of an HSML
/// component
///
/// - equations that hold everywhere stand in every location, a local in the place of its name,
/// - a real mode is a state that does not change by itself,
/// - two transitions of one name, one with `when` and one with `on`, are one.
///
/// A character that XML does not have becomes U+FFFD. A system without locations is written, but the definition
/// wants at least one.
pub fn write(
    component: &ComponentDeclaration,
    functions: &[FunctionDeclaration],
    constants: &[ParameterDeclaration],
) -> Writing {
    let (system, diagnostics) = restate::restate(component, functions, constants);
    if diagnostics.has_errors() {
        // How something would be said is of no interest then.
        let mut errors = Diagnostics::default();
        diagnostics.iter().filter(|d| d.severity == Severity::Error).for_each(|d| errors.push(d.clone()));
        return Writing { text: None, diagnostics: errors };
    }
    // Writing into memory does not fail.
    Writing { text: document(&system).ok(), diagnostics }
}

fn document(system: &System<'_>) -> io::Result<String> {
    let mut out = Output { writer: Writer::new_with_indent(Vec::new(), b' ', 2), depth: 0 };
    out.event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    out.event(Event::DocType(BytesText::from_escaped("SophySystem SYSTEM \"SophySystem.dtd\"")))?;
    out.group("SophySystem", |out| content(system, out))?;
    let mut text = String::from_utf8_lossy(&out.writer.into_inner()).into_owned();
    text.push('\n');
    Ok(text)
}

fn content(system: &System<'_>, out: &mut Output) -> io::Result<()> {
    out.text("name", system.name)?;
    out.documentation(system.documentation)?;
    if !system.hints.is_empty() {
        out.group("hints", |out| pairs("hint", "hintname", &system.hints, out))?;
    }
    if !system.constants.is_empty() {
        out.group("constants", |out| pairs("constant", "symbol", &system.constants, out))?;
    }
    variables(("states", "state"), &system.states, out)?;
    variables(("inputs", "input"), &system.inputs, out)?;
    variables(("outputs", "output"), &system.outputs, out)?;
    out.group("locations", |out| system.locations.iter().try_for_each(|l| location(l, out)))
}

fn variables((group, member): (&str, &str), variables: &[(&str, &str)], out: &mut Output) -> io::Result<()> {
    if variables.is_empty() {
        return out.text(group, "");
    }
    out.group(group, |out| {
        variables.iter().try_for_each(|(name, documentation)| match *documentation {
            "" => out.text(member, name),
            text => out.text_with(member, ("documentation", text), name),
        })
    })
}

fn location(location: &Location<'_>, out: &mut Output) -> io::Result<()> {
    out.group("location", |out| {
        out.text("name", &location.name)?;
        out.documentation(location.documentation)?;
        pairs("diffequation", "state", &location.dynamics, out)?;
        pairs("outputmap", "output", &location.output, out)?;
        if location.transitions.is_empty() {
            return Ok(());
        }
        out.group("transitions", |out| location.transitions.iter().try_for_each(|t| transition(t, out)))
    })
}

fn transition(transition: &Transition<'_>, out: &mut Output) -> io::Result<()> {
    out.group("transition", |out| {
        out.text("name", transition.name)?;
        out.documentation(&transition.documentation)?;
        out.text("domain", &transition.domain)?;
        out.group("reset", |out| {
            out.text("destination", transition.destination)?;
            pairs("statereset", "state", &transition.resets, out)
        })?;
        events("inputevent", &transition.input_events, out)?;
        events("outputevent", &transition.output_events, out)
    })
}

/// `<element attribute="first">second</element>` for each pair.
fn pairs<A: AsRef<str>, B: AsRef<str>>(
    element: &str,
    attribute: &str,
    pairs: &[(A, B)],
    out: &mut Output,
) -> io::Result<()> {
    pairs.iter().try_for_each(|(key, text)| out.text_with(element, (attribute, key.as_ref()), text.as_ref()))
}

fn events(element: &str, labels: &[&str], out: &mut Output) -> io::Result<()> {
    labels.iter().try_for_each(|label| out.text(element, label))
}

/// The text so far, and how deep it is nested.
struct Output {
    writer: Writer<Vec<u8>>,
    depth: usize,
}

impl Output {
    fn event(&mut self, event: Event<'_>) -> io::Result<()> {
        self.writer.write_event(event)
    }

    fn group(&mut self, name: &str, content: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<()> {
        self.event(Event::Start(BytesStart::new(name)))?;
        self.depth += 1;
        content(self)?;
        self.depth -= 1;
        self.event(Event::End(BytesEnd::new(name)))
    }

    fn text(&mut self, name: &str, text: &str) -> io::Result<()> {
        self.leaf(BytesStart::new(name), &escape_text(text))
    }

    fn text_with(&mut self, name: &str, (key, value): (&str, &str), text: &str) -> io::Result<()> {
        let mut start = BytesStart::new(name);
        start.push_attribute((key, legal(value).as_str()));
        self.leaf(start, &escape_text(text))
    }

    fn leaf(&mut self, start: BytesStart<'_>, escaped: &str) -> io::Result<()> {
        let end = start.to_end().into_owned();
        self.event(Event::Start(start))?;
        self.event(Event::Text(BytesText::from_escaped(escaped)))?;
        self.event(Event::End(end))
    }

    /// On the line of the tag if it is one line, else below it and indented.
    fn documentation(&mut self, documentation: &str) -> io::Result<()> {
        let escaped = escape_text(documentation);
        if documentation.is_empty() {
            return Ok(());
        }
        if !documentation.contains('\n') {
            return self.leaf(BytesStart::new("documentation"), &escaped);
        }
        let indent = "  ".repeat(self.depth + 1);
        let indented =
            |line: &str| if line.is_empty() { "\n".to_owned() } else { format!("\n{indent}{line}") };
        let lines: String = escaped.split('\n').map(indented).collect();
        self.leaf(BytesStart::new("documentation"), &format!("{lines}\n{}", "  ".repeat(self.depth)))
    }
}

/// `>` stays for the reader's sake, but for the one place where XML forbids it.
fn escape_text(text: &str) -> String {
    // A carriage return as such would be read as a newline.
    minimal_escape(legal(text)).replace("]]>", "]]&gt;")
}

fn legal(text: &str) -> String {
    text.chars().map(|c| if crate::parser::is_xml_character(c) { c } else { '\u{FFFD}' }).collect()
}
