//! HSML ↔ SOPHY XML: what both can say is kept, what one cannot is named.

use crate::load::{Loaded, nowhere};
use sophy_analysis::{ComponentDeclaration, Declarations, Dialect, TriggerDeclaration, write_hsml};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Severity};

/// A model in the other language.
#[derive(Clone, Debug, Default)]
pub struct Conversion {
    /// The text; `None` if the other language cannot say all of the model.
    pub text: Option<String>,
    /// What cannot be said, as errors with a way out, and notes on what is said in other words.
    pub diagnostics: Diagnostics,
}

const OTHER_WORDS: Code = Code("FI0004");

/// A model as SOPHY XML, which holds one component: the one that was loaded to be run.
///
/// A model with errors, or one that does not say what is run, gives no text.
pub fn to_xml(loaded: &Loaded) -> Conversion {
    let (Some(declarations), false) = (&loaded.declarations, loaded.diagnostics.has_errors()) else {
        return Conversion::default();
    };
    match the_component(loaded, declarations) {
        Ok(component) => {
            let Declarations { functions, constants, .. } = declarations;
            let writing = sophy_xml::write(component, functions, constants);
            let mut diagnostics = writing.diagnostics;
            if writing.text.is_some() {
                left_behind(loaded, component.dialect, &mut diagnostics);
            }
            Conversion { text: writing.text, diagnostics }
        }
        Err(error) => {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(*error);
            Conversion { text: None, diagnostics }
        }
    }
}

fn the_component<'d>(
    loaded: &Loaded,
    declarations: &'d Declarations,
) -> Result<&'d ComponentDeclaration, Box<Diagnostic>> {
    let components = &declarations.components;
    let named = |name: &str| components.iter().find(|component| component.name.value == name);
    if let Some(component) = loaded.model.as_ref().and_then(|model| named(model.name())) {
        return Ok(component);
    }
    let names: Vec<String> = components.iter().map(|c| format!("`{}`", c.name.value)).collect();
    let message = "a file of SOPHY XML holds one component, and it is not clear which".to_owned();
    let mut error = nowhere("SX0401", message);
    error.notes.push(format!("there are {}", names.join(", ")));
    error.helps.push("say which one: `--system NAME`".to_owned());
    Err(Box::new(error))
}

/// A model as HSML in the canonical layout.
///
/// A model with errors gives no text: what was not understood would be lost.
pub fn to_hsml(loaded: &Loaded) -> Conversion {
    let (Some(declarations), false) = (&loaded.declarations, loaded.diagnostics.has_errors()) else {
        return Conversion::default();
    };
    let mut diagnostics = Diagnostics::default();
    declarations
        .components
        .iter()
        .filter(|component| component.dialect == Dialect::Xml)
        .for_each(|component| said_otherwise(component, &mut diagnostics));
    left_behind(loaded, Dialect::Xml, &mut diagnostics);
    Conversion { text: Some(write_hsml(declarations)), diagnostics }
}

/// A transition of SOPHY XML may wait for a condition or an event, one of HSML for one of them.
fn said_otherwise(component: &ComponentDeclaration, diagnostics: &mut Diagnostics) {
    for transition in component.locations.iter().flat_map(|location| &location.transitions) {
        // The condition `false` is none.
        if let TriggerDeclaration::WhenOrOn(Some(guard), labels) = &transition.trigger
            && !labels.is_empty()
            && guard.written().trim() != "false"
        {
            let name = &transition.name.value;
            let message = format!(
                "`{name}` waits for its domain or an event; HSML has two transitions of that name for it"
            );
            diagnostics.push(Diagnostic::note_at(OTHER_WORDS, transition.name.span, message));
        }
    }
}

/// What is written has documentation, but no comments.
fn left_behind(loaded: &Loaded, dialect: Dialect, diagnostics: &mut Diagnostics) {
    let name = loaded.provenance.model_file.display().to_string();
    let Some(source) = loaded.sources.ids().find(|&id| loaded.sources.name(id) == name) else { return };
    let text = loaded.sources.text(source);
    let comments = match dialect {
        Dialect::Hsml => comments(text),
        Dialect::Xml => text.matches("<!--").count(),
    };
    let (what, kept) = match dialect {
        Dialect::Hsml => ("`%`", "documentation (`%%`)"),
        Dialect::Xml => ("`<!-- -->`", "`documentation`"),
    };
    let message = match comments {
        0 => return,
        1 => format!("1 comment ({what}) is left behind: only {kept} is kept"),
        many => format!("{many} comments ({what}) are left behind: only {kept} is kept"),
    };
    let mut note = nowhere(OTHER_WORDS.0, message);
    note.severity = Severity::Note;
    diagnostics.push(note);
}

/// Number of comments of HSML that are no documentation.
fn comments(text: &str) -> usize {
    let is_comment = |line: &&str| {
        let mut quote = None;
        for (at, c) in line.char_indices() {
            match (quote, c) {
                (None, '%') => return !line[at..].starts_with("%%"),
                (None, '"' | '\'') => quote = Some(c),
                (Some(open), c) if open == c => quote = None,
                _ => {}
            }
        }
        false
    };
    text.lines().filter(is_comment).count()
}

#[cfg(test)]
mod tests {
    use super::comments;

    #[test]
    fn comments_are_counted_without_documentation_and_texts() {
        assert_eq!(comments("% a\nx; % b\n  %% documentation\nm := \"5 %\"; n := '%';\n\"a\" % c"), 3);
    }
}
