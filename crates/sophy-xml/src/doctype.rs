use crate::codes::{
    DOCTYPE, EXTERNAL_ENTITY, INTERNAL_DECLARATION, MALFORMED_TAG, OUTSIDE_ROOT, UNTERMINATED,
};
use crate::parser::Parser;
use crate::schema::ROOT;
use crate::tag;
use sophy_diagnostics::Diagnostic;

impl<'a> Parser<'a> {
    /// `<!DOCTYPE name SYSTEM "…" [ … ]>`
    pub(crate) fn doctype(&mut self) {
        let keyword = self.take("<!DOCTYPE".len());
        if self.inputs.len() > 1 || !self.open.is_empty() || self.root.is_some() {
            self.diagnostics.push(
                Diagnostic::error(
                    OUTSIDE_ROOT,
                    self.span(keyword.clone()),
                    "the document type comes too late",
                )
                .help("it stands before the root element"),
            );
        }
        self.take_blanks();
        let name = tag::name(self.rest());
        let place = self.take(name.len());
        if name != ROOT {
            self.diagnostics.push(
                Diagnostic::error(DOCTYPE, self.span(place), format!("the document type is `{name}`"))
                    .help(format!("write <!DOCTYPE {ROOT} SYSTEM \"SophySystem.dtd\">")),
            );
        }
        self.external_definition();
        self.take_blanks();
        if self.rest().starts_with('[') {
            self.take(1);
            self.internal_definition();
            self.take_blanks();
        }
        if self.rest().starts_with('>') {
            self.take(1);
        } else {
            self.diagnostics.push(
                Diagnostic::error(
                    UNTERMINATED,
                    self.span(keyword),
                    "the document type does not end with `>`",
                )
                .help(format!("write <!DOCTYPE {ROOT} SYSTEM \"SophySystem.dtd\">")),
            );
            let rest = self.rest();
            self.take(
                rest.find(['<', '>']).map_or(rest.len(), |at| at + usize::from(rest[at..].starts_with('>'))),
            );
        }
    }

    fn take_blanks(&mut self) {
        let rest = self.rest();
        self.take(rest.len() - rest.trim_start().len());
    }

    /// `SYSTEM "uri"` or `PUBLIC "id" "uri"`: never fetched.
    fn external_definition(&mut self) {
        self.take_blanks();
        let rest = self.rest();
        let literals = match rest.get(..6) {
            Some("SYSTEM") => 1,
            Some("PUBLIC") => 2,
            _ => return,
        };
        self.take(6);
        let mut uri = ("", 0..0);
        for _ in 0..literals {
            self.take_blanks();
            let Some(literal) = literal(self.rest()) else { return };
            uri = (literal, self.take(literal.len() + 2));
        }
        if uri.0.rsplit(['/', '\\']).next() != Some("SophySystem.dtd") {
            let message = format!("the definition `{}` is not read", uri.0);
            self.diagnostics.push(
                Diagnostic::note_at(DOCTYPE, self.span(uri.1), message).note(
                    "every file is checked against the SophySystem.dtd of SOPHY, and nothing is fetched",
                ),
            );
        }
    }

    /// `<!ENTITY …>` and others, up to `]`.
    fn internal_definition(&mut self) {
        while !self.has_said_enough() {
            self.take_blanks();
            let rest = self.rest();
            let end = |mark: &str| rest.find(mark).map_or(rest.len(), |at| at + mark.len());
            if rest.is_empty() {
                return;
            } else if rest.starts_with(']') {
                self.take(1);
                return;
            } else if let Some(comment) = rest.strip_prefix("<!--") {
                self.take(4 + comment.find("-->").map_or(rest.len(), |at| at + 3));
            } else if rest.starts_with("<?") {
                self.take(end("?>"));
            } else if rest.starts_with("<!ENTITY") {
                self.entity_declaration();
            } else if ["<!ELEMENT", "<!ATTLIST", "<!NOTATION"].iter().any(|known| rest.starts_with(known)) {
                let place = self.take(end(">"));
                self.diagnostics.push(
                    Diagnostic::note_at(
                        INTERNAL_DECLARATION,
                        self.span(place),
                        "this declaration is ignored",
                    )
                    .note("every file is checked against the SophySystem.dtd of SOPHY"),
                );
            } else {
                // Up to what may be a declaration again.
                let first = rest.chars().next().map_or(1, char::len_utf8);
                let after = rest.get(first..).unwrap_or("");
                let ends = ["]", "<!", "<?"].iter().filter_map(|end| after.find(end));
                let place = self.take(ends.min().map_or(rest.len(), |at| at + first));
                self.diagnostics.push(
                    Diagnostic::error(MALFORMED_TAG, self.span(place), "this is not a declaration")
                        .help("delete it; a file needs declarations of its own for entities only"),
                );
            }
        }
    }

    /// `<!ENTITY name "text">`, or one that is not read: a parameter entity, or one in another file.
    fn entity_declaration(&mut self) {
        let place = self.here();
        let declaration = self.rest();
        self.take("<!ENTITY".len());
        self.take_blanks();
        let parameter = self.rest().starts_with('%');
        if parameter {
            self.take(1);
            self.take_blanks();
        }
        let name: &'a str = tag::name(self.rest());
        self.take(name.len());
        self.take_blanks();
        let external = ["SYSTEM", "PUBLIC"].iter().any(|keyword| self.rest().starts_with(keyword));
        if external {
            self.take(6);
        }
        let mut text = None;
        self.take_blanks();
        while let Some(literal) = literal(self.rest()) {
            text.get_or_insert(literal);
            self.take(literal.len() + 2);
            self.take_blanks();
        }
        let rest = self.rest();
        self.take(
            rest.find(['>', '<', ']']).map_or(rest.len(), |at| at + usize::from(rest[at..].starts_with('>'))),
        );
        let span = self.span(place.of(0..declaration.len() - self.rest().len()));
        match text {
            _ if external => {
                self.diagnostics.push(
                    Diagnostic::error(
                        EXTERNAL_ENTITY,
                        span,
                        format!("the entity `{name}` is in another file"),
                    )
                    .note("nothing is fetched: a model is what its file says")
                    .help("copy the text into this file"),
                );
                // Its references are no further mistakes.
                self.entities.entry(name).or_insert(name);
            }
            _ if parameter => self.diagnostics.push(Diagnostic::note_at(
                INTERNAL_DECLARATION,
                span,
                format!("the parameter entity `{name}` is ignored"),
            )),
            // The first declaration counts (XML 1.0, section 4.2).
            Some(text) if !name.is_empty() => {
                self.entities.entry(name).or_insert(text);
            }
            _ => self.diagnostics.push(
                Diagnostic::error(MALFORMED_TAG, span, "this is not the declaration of an entity")
                    .help("write <!ENTITY name \"text\">"),
            ),
        }
    }
}

/// The text in quotes that `rest` begins with.
fn literal(rest: &str) -> Option<&str> {
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    rest[1..].split_once(quote).map(|(text, _)| text)
}
