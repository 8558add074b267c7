//! What is tried on an input, and what must hold.

use crate::corpus::Notation;
use cpu_time::ThreadTime;
use peak_alloc::PeakAlloc;
use sophy_analysis::{Root, analyse, read_hsml};
use sophy_diagnostics::{Diagnostics, MemoryWorld, Sources, Style, render};
use sophy_syntax::{Parse, SyntaxElement, SyntaxKind, SyntaxToken, format, parse_expression, parse_file};
use std::time::Duration;

#[global_allocator]
pub(crate) static MEMORY: PeakAlloc = PeakAlloc;

/// What an input is thrown at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Target {
    /// The parser and the formatter.
    Hsml,
    /// The reader of SOPHY XML.
    Xml,
    /// HSML to declarations to a model.
    HsmlModel,
    /// SOPHY XML to declarations to a model.
    XmlModel,
}

/// What one input took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cost {
    /// Of this thread.
    pub(crate) time: Duration,
    /// Most bytes alive at once, beyond those alive before.
    pub(crate) peak: usize,
    /// Whether there was no mistake in it.
    pub(crate) sound: bool,
}

/// A parser may take this much for each byte of its input …
const BYTES_PER_BYTE: usize = 100;
/// … and this much for none.
const BYTES_FOR_NOTHING: usize = 512 << 10;
/// What an input of up to 100 kB may take; more for longer ones and without optimisation.
const TIME_FOR_100_KB: Duration = Duration::from_secs(if cfg!(debug_assertions) { 4 } else { 1 });

impl Target {
    pub(crate) const ALL: [Target; 4] = [Target::Hsml, Target::Xml, Target::HsmlModel, Target::XmlModel];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Target::Hsml => "hsml",
            Target::Xml => "xml",
            Target::HsmlModel => "hsml-model",
            Target::XmlModel => "xml-model",
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|target| target.name() == name)
    }

    pub(crate) fn notation(self) -> Notation {
        match self {
            Target::Hsml | Target::HsmlModel => Notation::Hsml,
            Target::Xml | Target::XmlModel => Notation::Xml,
        }
    }

    /// Tries `input`.
    ///
    /// # Errors
    /// What does not hold, in one sentence. A panic passes through.
    pub(crate) fn check(self, input: &[u8]) -> Result<Cost, String> {
        let mut meter = Meter { cost: Cost::default(), length: input.len() };
        meter.cost.sound = match self {
            Target::Hsml => hsml(input, &mut meter)?,
            Target::Xml => xml(input, &mut meter)?,
            Target::HsmlModel => hsml_model(input, &mut meter)?,
            Target::XmlModel => xml_model(input, &mut meter)?,
        };
        let cost = meter.cost;
        let limit = TIME_FOR_100_KB.mul_f64((input.len() as f64 / 1e5).max(1.0));
        if cost.time > limit {
            return Err(format!("slow: {:.1} s for {} bytes", cost.time.as_secs_f64(), input.len()));
        }
        let limit = BYTES_PER_BYTE * input.len() + BYTES_FOR_NOTHING;
        if cost.peak > limit && matches!(self, Target::Hsml | Target::Xml) {
            return Err(format!("memory: {} bytes for {}", cost.peak, input.len()));
        }
        Ok(cost)
    }
}

/// Adds up what the parts of a check take.
struct Meter {
    cost: Cost,
    length: usize,
}

impl Meter {
    /// Runs a part that counts.
    fn measure<R>(&mut self, part: impl FnOnce() -> R) -> R {
        MEMORY.reset_peak_usage();
        let before = MEMORY.current_usage();
        let begin = ThreadTime::now();
        let result = part();
        self.cost.time += begin.elapsed();
        self.cost.peak = self.cost.peak.max(MEMORY.peak_usage().saturating_sub(before));
        result
    }
}

fn hsml(input: &[u8], meter: &mut Meter) -> Result<bool, String> {
    let text = &*String::from_utf8_lossy(input);
    meter.length = text.len();
    let file = meter.measure(|| parse_file(text));
    faithful(&file, text)?;
    // Expressions are short; a share of the longer texts is enough.
    if input.len() < 150 || input.len().is_multiple_of(4) {
        let expression = meter.measure(|| parse_expression(text));
        faithful(&expression, text)?;
    }
    let Ok(formatted) = meter.measure(|| format(text)) else {
        return if file.errors().is_empty() { Err("format: refused".into()) } else { Ok(false) };
    };
    if !file.errors().is_empty() {
        return Err("format: laid out in spite of errors".into());
    }
    if format(&formatted).as_deref() != Ok(&formatted) {
        return Err("format: not idempotent".into());
    }
    same_tokens(&file, &parse_file(&formatted))?;
    Ok(true)
}

/// The tree has the text, and the errors have places in it.
fn faithful(parse: &Parse, text: &str) -> Result<(), String> {
    if parse.syntax().text() != text {
        return Err("tree: not the text".into());
    }
    for error in parse.errors() {
        let ranges = error.related.iter().map(|(range, _)| range).chain([&error.range]);
        for range in ranges {
            text.get(range.clone()).ok_or_else(|| format!("range: {range:?} of {}", error.code))?;
        }
    }
    Ok(())
}

/// Layout changes white space only.
fn same_tokens(one: &Parse, other: &Parse) -> Result<(), String> {
    let (one, other) = (one.syntax(), other.syntax());
    let kept = |token: &SyntaxToken| token.kind() != SyntaxKind::Whitespace;
    let mut ones = one.descendants_with_tokens().filter_map(SyntaxElement::into_token).filter(kept);
    let mut others = other.descendants_with_tokens().filter_map(SyntaxElement::into_token).filter(kept);
    loop {
        match (ones.next(), others.next()) {
            (None, None) => return Ok(()),
            (Some(one), Some(other))
                if one.kind() == other.kind() && one.text().trim_end() == other.text().trim_end() => {}
            (one, other) => return Err(format!("format: {one:?} became {other:?}")),
        }
    }
}

fn xml(input: &[u8], meter: &mut Meter) -> Result<bool, String> {
    let mut sources = Sources::default();
    let reading = meter.measure(|| sophy_xml::read(&mut sources, "m.xml", input));
    if reading.declarations.is_none() && !reading.diagnostics.has_errors() {
        return Err("reading: neither declarations nor errors".into());
    }
    places(&reading.diagnostics, &sources, input.len())?;
    Ok(!reading.diagnostics.has_errors())
}

fn hsml_model(input: &[u8], meter: &mut Meter) -> Result<bool, String> {
    let mut sources = Sources::default();
    let reading = meter.measure(|| read_hsml(&mut sources, "m.hsml", input));
    places(&reading.diagnostics, &sources, input.len())?;
    let world = MemoryWorld::default();
    let (model, mistakes) =
        meter.measure(|| analyse(&reading.declarations, Root::Implied, reading.source, &sources, &world));
    places(&mistakes, &sources, input.len())?;
    if model.is_none() && !mistakes.has_errors() && !reading.diagnostics.has_errors() {
        return Err("analysis: neither a model nor errors".into());
    }
    Ok(model.is_some() && !reading.diagnostics.has_errors())
}

fn xml_model(input: &[u8], meter: &mut Meter) -> Result<bool, String> {
    let mut sources = Sources::default();
    let reading = meter.measure(|| sophy_xml::read(&mut sources, "m.xml", input));
    let Some(declarations) = &reading.declarations else { return Ok(false) };
    let world = MemoryWorld::default();
    let (model, mistakes) =
        meter.measure(|| analyse(declarations, Root::Implied, reading.source, &sources, &world));
    places(&mistakes, &sources, input.len())?;
    if model.is_none() && !mistakes.has_errors() && !reading.diagnostics.has_errors() {
        return Err("analysis: neither a model nor errors".into());
    }
    Ok(model.is_some() && !reading.diagnostics.has_errors())
}

/// Messages point into the text, and can be drawn.
fn places(messages: &Diagnostics, sources: &Sources, length: usize) -> Result<(), String> {
    for message in messages.iter() {
        for label in &message.labels {
            let range = label.span.range();
            let text = sources.text(label.span.source);
            text.get(range.clone()).ok_or_else(|| format!("range: {range:?} of {}", message.code))?;
        }
    }
    // Drawing takes long on long lines; a share is enough.
    if length < 1000 && length.is_multiple_of(16) {
        for message in messages.iter().take(3) {
            if render(message, sources, Style::Plain).is_empty() {
                return Err(format!("drawing: nothing for {}", message.code));
            }
        }
    }
    Ok(())
}
