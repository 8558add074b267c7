//! Text, comments, sections and instructions.

use crate::codes::{
    BAD_COMMENT, BAD_DECLARATION, BARE_LESS_THAN, BARE_SECTION_END, MISSPELLED_DECLARATION,
    OTHER_INSTRUCTION, OUTSIDE_ROOT, UNTERMINATED,
};
use crate::parser::Parser;
use sophy_diagnostics::{Diagnostic, closest};
use std::ops::Range;

impl Parser<'_> {
    /// A run of text up to the next tag, reference or line end that is not a single newline.
    pub(crate) fn text(&mut self) {
        let rest = self.rest();
        if rest.starts_with('\r') {
            // XML line ends are newlines, whatever the file has (XML 1.0, section 2.11).
            let length = if rest.starts_with("\r\n") { 2 } else { 1 };
            return self.add_replaced("\n", length);
        }
        let end = rest.find(['<', '&', '\r']).unwrap_or(rest.len());
        let run = &rest[..end];
        if let Some(at) = run.find("]]>") {
            let span = self.span(self.here().of(at..at + 3));
            self.diagnostics.push(
                Diagnostic::error(BARE_SECTION_END, span, "`]]>` must not stand in text")
                    .help("write `]]&gt;`"),
            );
        }
        self.add_plain(end);
    }

    pub(crate) fn bare_less_than(&mut self) {
        let mut diagnostic = Diagnostic::error(
            BARE_LESS_THAN,
            self.span(self.here().of(0..1)),
            "`<` begins a tag in XML; in text it is written `&lt;`",
        );
        let rest = self.rest();
        diagnostic = if rest.starts_with("<=") {
            diagnostic.help("write `&lt;=`")
        } else if rest.starts_with("<>") {
            diagnostic.help("write `&lt;&gt;`")
        } else {
            diagnostic.help("write `&lt;`")
        };
        self.diagnostics.push(diagnostic);
        self.add_plain(1);
    }

    /// Text before or after the root element.
    pub(crate) fn outside(&mut self) {
        let rest = self.rest();
        let end = rest.match_indices('<').map(|(at, _)| at).find(|at| *at > 0).unwrap_or(rest.len());
        let run = &rest[..end];
        let blanks = run.len() - run.trim_start().len();
        self.take(blanks);
        let length = run.trim().len();
        if length > 0 {
            let place = self.take(length);
            let side = if self.root.is_some() { "after" } else { "before" };
            self.diagnostics.push(
                Diagnostic::error(
                    OUTSIDE_ROOT,
                    self.span(place),
                    format!("text stands {side} the root element"),
                )
                .help("delete it, or make it a comment: <!-- … -->"),
            );
        }
        self.take(end - blanks - length);
    }

    pub(crate) fn comment(&mut self) {
        let Some(end) = self.rest()[4..].find("-->") else { return self.unterminated("comment", "-->") };
        let body = &self.rest()[4..4 + end];
        let place = self.take(4 + end + 3);
        // `--->` ends a comment with a hyphen too many.
        if body.contains("--") || body.ends_with('-') {
            self.diagnostics.push(
                Diagnostic::error(BAD_COMMENT, self.span(place), "a comment must not contain `--`")
                    .help("use other characters to draw a line, such as `==` or `**`"),
            );
        }
    }

    pub(crate) fn section(&mut self) {
        let Some(end) = self.rest()[9..].find("]]>") else {
            return self.unterminated("CDATA section", "]]>");
        };
        if self.open.is_empty() {
            let place = self.take(9 + end + 3);
            let message = "a CDATA section stands outside the root element";
            return self.diagnostics.push(Diagnostic::error(OUTSIDE_ROOT, self.span(place), message));
        }
        self.take(9);
        let mut left = end;
        while left > 0 {
            let run = &self.rest()[..left];
            let length = match run.find('\r') {
                Some(0) => {
                    let length = if run.starts_with("\r\n") { 2 } else { 1 };
                    self.add_replaced("\n", length);
                    left -= length;
                    continue;
                }
                Some(at) => at,
                None => left,
            };
            self.add_plain(length);
            left -= length;
        }
        self.take(3);
    }

    fn unterminated(&mut self, what: &str, end: &str) {
        let opening = self.span(self.here().of(0..2));
        self.take(self.rest().len());
        self.diagnostics.push(
            Diagnostic::error(UNTERMINATED, opening, format!("this {what} does not end"))
                .note("everything from here to the end of the file belongs to it")
                .help(format!("close it with `{end}`")),
        );
    }

    /// `<?target …?>`
    pub(crate) fn instruction(&mut self) {
        let rest = self.rest();
        let Some(end) = rest[2..].find("?>").map(|at| at + 2) else {
            return self.unterminated("instruction", "?>");
        };
        let body = &rest[2..end];
        let (target, content) = body.split_at(body.find(char::is_whitespace).unwrap_or(body.len()));
        let place = self.take(end + 2);
        let span = self.span(place.clone());
        let before_root = self.root.is_none() && self.open.is_empty();
        if target == "xml" {
            self.xml_declaration(content, place);
        } else if before_root && (content.contains("version") || closest(target, ["xml"]).is_some()) {
            let message = format!("`<?{target}` is not the XML declaration");
            self.diagnostics.push(
                Diagnostic::warning(MISSPELLED_DECLARATION, span, message)
                    .note("it is an instruction to another program and says nothing here")
                    .help("did you mean `<?xml`?"),
            );
        } else {
            let message = format!("the instruction `<?{target}` has no meaning for SOPHY");
            self.diagnostics.push(Diagnostic::note_at(OTHER_INSTRUCTION, span, message));
        }
    }

    fn xml_declaration(&mut self, content: &str, place: Range<usize>) {
        let first = place.start == 0 || (place.start == 3 && self.inputs[0].text.starts_with('\u{FEFF}'));
        let span = self.span(place);
        if !first {
            return self.diagnostics.push(
                Diagnostic::error(
                    BAD_DECLARATION,
                    span,
                    "the XML declaration must be the very first of a file",
                )
                .help("delete what stands before it, blanks and empty lines too"),
            );
        }
        let quoted = |name: &str| {
            let value = content.split_once(name)?.1.trim_start().strip_prefix('=')?.trim_start();
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            value[1..].split(quote).next()
        };
        match quoted("version") {
            Some("1.0") => {}
            Some(_) => self.diagnostics.push(
                Diagnostic::error(BAD_DECLARATION, span, "only XML 1.0 is read")
                    .help("write version=\"1.0\""),
            ),
            None => self.diagnostics.push(
                Diagnostic::error(BAD_DECLARATION, span, "the XML declaration has no version")
                    .help("write <?xml version=\"1.0\" encoding=\"UTF-8\"?>"),
            ),
        }
        if let Some(encoding) = quoted("encoding")
            && !["UTF-8", "UTF8", "US-ASCII", "ASCII"].iter().any(|name| name.eq_ignore_ascii_case(encoding))
        {
            self.diagnostics.push(
                Diagnostic::warning(
                    BAD_DECLARATION,
                    span,
                    format!("the file says it is {encoding}, but it is read as UTF-8"),
                )
                .help("write encoding=\"UTF-8\""),
            );
        }
    }
}
