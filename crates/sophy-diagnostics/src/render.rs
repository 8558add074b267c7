use crate::{Diagnostic, Severity, Sources};
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// Whether to draw with terminal colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// ANSI colours.
    Colour,
    /// Plain text.
    Plain,
}

/// Draws one message with the source lines it is about, as rustc does, without a trailing newline.
pub fn render(diagnostic: &Diagnostic, sources: &Sources, style: Style) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    };
    let mut group = Group::with_title(level.primary_title(&diagnostic.message).id(diagnostic.code.0));
    let mut shown = Vec::new();
    for label in &diagnostic.labels {
        if shown.contains(&label.span.source) {
            continue;
        }
        shown.push(label.span.source);
        let source = label.span.source;
        let annotations = diagnostic.labels.iter().enumerate().filter(|(_, l)| l.span.source == source).map(
            |(index, label)| {
                let kind = if index == 0 { AnnotationKind::Primary } else { AnnotationKind::Context };
                let annotation = kind.span(label.span.range());
                if label.message.is_empty() { annotation } else { annotation.label(&label.message) }
            },
        );
        group = group.element(
            Snippet::source(sources.text(source)).path(sources.name(source)).annotations(annotations),
        );
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(note));
    }
    for help in &diagnostic.helps {
        group = group.element(Level::HELP.message(help));
    }
    let renderer = match style {
        Style::Colour => Renderer::styled(),
        Style::Plain => Renderer::plain(),
    };
    renderer.render(&[group])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Code, Span};

    #[test]
    fn a_message_shows_place_excerpt_and_way_out() {
        let mut sources = Sources::default();
        let id = sources.add("battery.xml", "<domain>C > HFul</domain>");
        let diagnostic = Diagnostic::error(Code("HS0101"), Span::new(id, 12..16), "`HFul` is not declared")
            .label(Span::new(id, 8..9), "compared with this")
            .help("did you mean `HFull`?");
        let text = render(&diagnostic, &sources, Style::Plain);
        assert!(text.contains("error[HS0101]: `HFul` is not declared"), "{text}");
        assert!(text.contains("battery.xml:1:13"), "{text}");
        assert!(text.contains("did you mean `HFull`?"), "{text}");
    }
}
