//! What mutations start from: every model of the repository, and what once broke a parser.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Which notation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Notation {
    Hsml,
    Xml,
}

impl Notation {
    pub(crate) fn extension(self) -> &'static str {
        match self {
            Notation::Hsml => "hsml",
            Notation::Xml => "xml",
        }
    }

    /// Where what once broke something is kept.
    pub(crate) fn folder(self) -> PathBuf {
        root().join("tests/fuzz").join(self.extension())
    }
}

/// Texts and the words they are made of.
pub(crate) struct Corpus {
    pub(crate) notation: Notation,
    /// The models of the repository as they are.
    pub(crate) files: Vec<Vec<u8>>,
    /// What once broke something; it has no part in mutations, so that these do not change when it grows.
    pub(crate) broken: Vec<(PathBuf, Vec<u8>)>,
    /// Files and blocks of them; a mutation starts from one of these.
    pub(crate) pieces: Vec<Vec<u8>>,
    /// Every word and symbol of the files, and troublesome ones.
    pub(crate) words: Vec<Vec<u8>>,
}

/// Folders with models, relative to the root of the repository.
const FOLDERS: [&str; 6] = [
    "tests/suite",
    "tests/reference/xmllint",
    "examples",
    "docs/book",
    "crates/sophy-syntax/tests/corpus",
    "crates/sophy-cli/templates",
];

const HSML_TROUBLE: &[&str] = &[
    "end",
    "'",
    "''",
    "\"",
    "“",
    "”",
    "‘a’",
    "%",
    "%%",
    "1..2",
    "1.",
    ".5",
    "1e",
    "1e999",
    "==",
    "−",
    "×",
    "≤",
    "（",
    "）",
    "negative-to-positive",
    "end negative-to-positive;",
    "endif",
    "\u{feff}",
    "\u{a0}",
    "\u{0}",
    "\u{2028}",
    "😀",
    "é",
    "\r",
    "\u{b7}",
    "e\u{301}",
    "end if",
    "end loop",
    "for i in 1..2 loop",
    "if a then b else c",
    "[[1, 2], [3, 4]]",
    "when a do",
    "compose a, b with",
    "sum(i in 1..3 : i)",
    "->",
    "goto",
    "event(S)",
    "initial location",
    "table(\"a.csv\", \"b\", c)",
];

const XML_TROUBLE: &[&str] = &[
    "<",
    ">",
    "&",
    "\"",
    "'",
    "/",
    "</",
    "/>",
    "<!--",
    "-->",
    "--",
    "<![CDATA[",
    "]]>",
    "<?",
    "?>",
    "<?xml version=\"1.0\"?>",
    "&#",
    "&#x;",
    "&#0;",
    "&#x110000;",
    "&#xd800;",
    "&lt",
    "&lt;",
    "&amp;",
    "&e;",
    "&f;",
    "%p;",
    "<!DOCTYPE SophySystem [<!ENTITY e '<name>é'>]>",
    "<!DOCTYPE SophySystem [<!ENTITY e 'x&f;'><!ENTITY f '&e;'>]>",
    "<!DOCTYPE",
    "<!ENTITY e \"y\">",
    "<!ENTITY % p SYSTEM \"p\">",
    "<!ELEMENT a ANY>",
    "<!ATTLIST a b CDATA #IMPLIED>",
    "[",
    "]>",
    "SYSTEM",
    "PUBLIC",
    "<state>",
    "</location>",
    "<name a=",
    "xmlns:a=\"b\"",
    "<a:b>",
    "é",
    "\u{0}",
    "\u{feff}",
    "\u{ffff}",
    "\r",
    "encoding=\"UTF-16\"",
    "encoding=\"ISO-8859-1\"",
    "standalone=\"yes\"",
    "1e999",
    "😀",
];

impl Corpus {
    /// Reads the corpus of a notation.
    ///
    /// # Errors
    /// A folder or file cannot be read.
    pub(crate) fn read(notation: Notation) -> io::Result<Self> {
        let extension = notation.extension();
        let mut files = Vec::new();
        for path in FOLDERS.iter().map(|folder| root().join(folder)).filter(|folder| folder.exists()) {
            for path in files_below(&path)? {
                let ends = |extension| path.extension().is_some_and(|other| other == extension);
                if ends(extension) {
                    files.push(fs::read(&path)?);
                } else if ends("md") {
                    files.extend(blocks(&fs::read_to_string(&path)?, extension));
                }
            }
        }
        let mut corpus = Corpus::new(notation, files);
        for path in files_below(&notation.folder())? {
            let text = fs::read(&path)?;
            corpus.broken.push((path, text));
        }
        Ok(corpus)
    }

    /// A corpus of these files.
    pub(crate) fn new(notation: Notation, files: Vec<Vec<u8>>) -> Self {
        let mut words: BTreeSet<Vec<u8>> = BTreeSet::new();
        for file in &files {
            words.extend(tokens(file).into_iter().filter(|token| !is_space(token)).map(<[u8]>::to_vec));
        }
        let trouble = match notation {
            Notation::Hsml => HSML_TROUBLE,
            Notation::Xml => XML_TROUBLE,
        };
        words.extend(trouble.iter().map(|word| word.as_bytes().to_vec()));
        let pieces = match notation {
            Notation::Hsml => files.iter().flat_map(|file| hsml_pieces(file)).collect(),
            Notation::Xml => files.clone(),
        };
        Corpus { notation, files, pieces, broken: Vec::new(), words: words.into_iter().collect() }
    }
}

/// A file, its components, and the sections of these, each in a component of its own.
fn hsml_pieces(file: &[u8]) -> Vec<Vec<u8>> {
    use sophy_syntax::SyntaxKind as K;
    let mut pieces = vec![file.to_vec()];
    let Ok(text) = std::str::from_utf8(file) else { return pieces };
    for node in sophy_syntax::parse_file(text).syntax().descendants() {
        let inner = node.text().to_string();
        let inner = inner.trim();
        match (node.kind(), node.parent().map(|parent| parent.kind())) {
            (K::Component | K::Function | K::Constant, _) => pieces.push(inner.into()),
            (_, Some(K::Body)) => pieces.push(format!("CTC C is\nbody\n  {inner}\nend body;\n").into()),
            (K::Interface, _) => pieces.push(format!("CTC C is\n{inner}\nbody\nend body;\n").into()),
            (K::Equation | K::AssignmentStatement | K::IfStatement, _) => pieces.push(inner.into()),
            _ => {}
        }
    }
    pieces
}

/// The words, numbers, runs of white space and single symbols of a text, without a gap.
pub(crate) fn tokens(text: &[u8]) -> Vec<&[u8]> {
    let same = |a: &u8, b: &u8| {
        let word = |c: &u8| c.is_ascii_alphanumeric() || *c == b'_' || *c >= 0x80;
        (word(a) && word(b)) || (a.is_ascii_whitespace() && b.is_ascii_whitespace())
    };
    text.chunk_by(same).collect()
}

/// Whether a token is white space.
pub(crate) fn is_space(token: &[u8]) -> bool {
    token.iter().all(u8::is_ascii_whitespace)
}

/// The blocks of code in a page of the book.
fn blocks(page: &str, language: &str) -> Vec<Vec<u8>> {
    let mut blocks = Vec::new();
    let mut open: Option<String> = None;
    for line in page.lines() {
        match (&mut open, line.trim_start().strip_prefix("```")) {
            (None, Some(info)) if info.starts_with(language) => open = Some(String::new()),
            (Some(_), Some(_)) => blocks.extend(open.take().map(String::into_bytes)),
            (Some(block), None) => *block += &format!("{line}\n"),
            _ => {}
        }
    }
    blocks
}

/// All files, in an order that depends on their names only.
fn files_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<_>>()?;
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

/// The root of the repository.
fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_owned()
}
