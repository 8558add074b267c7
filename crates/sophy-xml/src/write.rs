use quick_xml::Writer;
use quick_xml::escape::minimal_escape;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use sophy_analysis::{
    Declarations, EquationDeclaration, FunctionDeclaration, LocationDeclaration, Spanned,
    TransitionDeclaration, VariableDeclaration,
};
use std::io;

/// SOPHY XML that declares `declarations`, valid by [`DTD`](crate::DTD).
///
/// Expressions and documentation stay as they are, references are put where XML needs them, hints come in
/// the order initial state, units, functions, others. What [`read`](crate::read) makes of the text equals
/// `declarations` but for places, if names and expressions have no blanks around them. A character that XML
/// does not have becomes U+FFFD. A system without locations is written, but the definition wants at least one.
pub fn write(declarations: &Declarations) -> String {
    // Writing into memory does not fail.
    document(declarations).unwrap_or_default()
}

fn document(declarations: &Declarations) -> io::Result<String> {
    let mut out = Output { writer: Writer::new_with_indent(Vec::new(), b' ', 2), depth: 0 };
    out.event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    out.event(Event::DocType(BytesText::from_escaped("SophySystem SYSTEM \"SophySystem.dtd\"")))?;
    out.group("SophySystem", |out| system(declarations, out))?;
    let mut text = String::from_utf8_lossy(&out.writer.into_inner()).into_owned();
    text.push('\n');
    Ok(text)
}

fn system(d: &Declarations, out: &mut Output) -> io::Result<()> {
    out.text("name", &d.name.value)?;
    out.documentation(&d.documentation)?;
    if d.initial_location.is_some()
        || !(d.initial.is_empty() && d.units.is_empty() && d.functions.is_empty() && d.hints.is_empty())
    {
        out.group("hints", |out| hints(d, out))?;
    }
    if !d.constants.is_empty() {
        out.group("constants", |out| {
            let mut each = d.constants.iter();
            each.try_for_each(|c| out.text_with("constant", ("symbol", &c.name.value), &c.value.text))
        })?;
    }
    variables(("states", "state"), &d.states, out)?;
    variables(("inputs", "input"), &d.inputs, out)?;
    variables(("outputs", "output"), &d.outputs, out)?;
    out.group("locations", |out| d.locations.iter().try_for_each(|l| location(l, out)))
}

fn hints(d: &Declarations, out: &mut Output) -> io::Result<()> {
    let mut hint = |name: &str, text: &str| out.text_with("hint", ("hintname", name), text);
    if let Some(location) = &d.initial_location {
        hint("initial location", &location.value)?;
    }
    for initial in &d.initial {
        hint(&format!("initial {}", initial.target.value), &initial.right.text)?;
    }
    for (name, unit) in &d.units {
        hint(&format!("unit {}", name.value), &unit.value)?;
    }
    for function in &d.functions {
        hint(&head(function), &function.body.text)?;
    }
    d.hints.iter().try_for_each(|(name, text)| hint(&name.value, &text.value))
}

/// `function f(a, b)`
fn head(function: &FunctionDeclaration) -> String {
    let parameters: Vec<&str> = function.parameters.iter().map(|p| p.value.as_str()).collect();
    format!("function {}({})", function.name.value, parameters.join(", "))
}

fn variables(
    (group, member): (&str, &str),
    variables: &[VariableDeclaration],
    out: &mut Output,
) -> io::Result<()> {
    if variables.is_empty() {
        return out.text(group, "");
    }
    out.group(group, |out| {
        variables.iter().try_for_each(|variable| match variable.documentation.as_str() {
            "" => out.text(member, &variable.name.value),
            text => out.text_with(member, ("documentation", text), &variable.name.value),
        })
    })
}

fn location(location: &LocationDeclaration, out: &mut Output) -> io::Result<()> {
    out.group("location", |out| {
        out.text("name", &location.name.value)?;
        out.documentation(&location.documentation)?;
        equations("diffequation", "state", &location.dynamics, out)?;
        equations("outputmap", "output", &location.outputs, out)?;
        if location.transitions.is_empty() {
            return Ok(());
        }
        out.group("transitions", |out| location.transitions.iter().try_for_each(|t| transition(t, out)))
    })
}

fn equations(
    element: &str,
    attribute: &str,
    equations: &[EquationDeclaration],
    out: &mut Output,
) -> io::Result<()> {
    equations.iter().try_for_each(|e| out.text_with(element, (attribute, &e.target.value), &e.right.text))
}

fn transition(transition: &TransitionDeclaration, out: &mut Output) -> io::Result<()> {
    out.group("transition", |out| {
        out.text("name", &transition.name.value)?;
        out.documentation(&transition.documentation)?;
        out.text("domain", transition.guard.as_ref().map_or("", |guard| &guard.text))?;
        out.group("reset", |out| {
            out.text("destination", &transition.destination.value)?;
            equations("statereset", "state", &transition.resets, out)
        })?;
        events("inputevent", &transition.input_events, out)?;
        events("outputevent", &transition.output_events, out)
    })
}

fn events(element: &str, labels: &[Spanned<String>], out: &mut Output) -> io::Result<()> {
    labels.iter().try_for_each(|label| out.text(element, &label.value))
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
