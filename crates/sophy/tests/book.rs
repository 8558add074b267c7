//! The pages of `docs/book` are true: their models, messages, expressions and experiments are checked.
//!
//! What a fenced block says after its first word tells what is done with it:
//!
//! - `xml model`, `hsml`: a whole model. A `text diagnostics` block after it holds its messages, as `sophy check` shows
//!   them; without one it must have none.
//! - `diff FILE`: a change of a file of the repository, checked in the same way.
//! - `expression`: lines `text => value` or `text => error CODE`, evaluated in [`expression_model`].
//! - `toml experiment`: an experiment beside the examples' files; it must fit its model.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

use sophy::{
    Experiment, FileWorld, Loaded, MemoryWorld, Root, Style, load_as, load_experiment, load_model, render,
    simulate,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A fenced block of a page.
struct Block {
    /// File and line, for messages.
    place: String,
    /// The words after the fence.
    words: Vec<String>,
    text: String,
}

#[test]
fn models_have_the_messages_the_book_shows() {
    let mut checked = 0;
    let blocks = blocks();
    for (position, block) in blocks.iter().enumerate() {
        let (name, text) = match words(block).as_slice() {
            ["xml", "model"] => ("model.xml".to_owned(), block.text.clone()),
            ["hsml"] => ("model.hsml".to_owned(), block.text.clone()),
            ["diff", file] => ((*file).to_owned(), changed(&read(file), block)),
            _ => continue,
        };
        let expected = blocks.get(position + 1).filter(|next| words(next) == ["text", "diagnostics"]);
        let world = MemoryWorld::default().with(&name, text);
        let mut loaded = load_as(&world, Path::new(&name), Root::IfClear);
        let composition = sophy::check(&loaded);
        loaded.diagnostics.extend(composition);
        let found = messages(&loaded);
        assert_eq!(found.trim_end(), expected.map_or("", |block| block.text.trim_end()), "{}", block.place);
        checked += 1;
    }
    assert!(checked >= 30, "only {checked} models were found");
}

#[test]
fn expressions_have_the_values_the_book_gives() {
    let mut checked = 0;
    for block in blocks().iter().filter(|block| words(block) == ["expression"]) {
        for line in block.text.lines().filter(|line| !line.trim().is_empty()) {
            let (text, expected) =
                line.rsplit_once("=>").unwrap_or_else(|| panic!("{}: {line}", block.place));
            assert_eq!(value(text.trim()), expected.trim(), "{}: {line}", block.place);
            checked += 1;
        }
    }
    assert!(checked >= 30, "only {checked} expressions were found");
}

#[test]
fn experiments_fit_their_models() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("book");
    fs::create_dir_all(&folder).unwrap();
    for example in ["hopper", "battery"] {
        for entry in fs::read_dir(root().join("examples").join(example)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    let mut checked = 0;
    for block in blocks().iter().filter(|block| words(block) == ["toml", "experiment"]) {
        let path = folder.join("experiment.toml");
        fs::write(&path, &block.text).unwrap();
        let mut loaded = load_experiment(&FileWorld, &path);
        let found = sophy::check(&loaded);
        loaded.diagnostics.extend(found);
        assert_eq!(messages(&loaded), "", "{}", block.place);
        checked += 1;
    }
    assert!(checked >= 2, "only {checked} experiments were found");
}

/// The pages link to one another, and to files of the repository, that are there.
#[test]
fn links_lead_somewhere() {
    let pages = pages().into_iter().chain([root().join("README.md")]);
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for (_, rest) in text.match_indices("](").map(|(at, _)| text.split_at(at + 2)) {
            let target = rest.split([')', '#']).next().unwrap_or_default();
            if target.is_empty() || target.contains("://") {
                continue;
            }
            assert!(page.parent().unwrap().join(target).exists(), "{}: {target}", page.display());
        }
    }
}

/// `messages.md` lists every code, in order, and says of each what the crates say.
#[test]
fn every_code_has_its_line() {
    let page = read("docs/book/messages.md");
    let rows: Vec<(String, String)> = page
        .lines()
        .filter_map(|line| {
            let (link, text) = line.strip_prefix("| [")?.strip_suffix(" |")?.split_once(" | ")?;
            let (code, target) = link.split_once("](messages/")?;
            assert!(target.ends_with(&format!(".md#{})", code.to_lowercase())), "{line}");
            is_code(code).then(|| (code.to_owned(), text.to_owned()))
        })
        .collect();
    let listed: Vec<&str> = rows.iter().map(|(code, _)| code.as_str()).collect();
    let mut in_sources: Vec<String> = codes_in_sources();
    in_sources.sort();
    in_sources.dedup();
    let mut sorted = listed.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, in_sources, "codes of messages.md (left) and of the sources (right)");
    let said: BTreeMap<String, String> = rows.iter().cloned().collect();
    let crates = [sophy_analysis::CODES, sophy_analysis::HSML_CODES, sophy_xml::CODES];
    for (code, kind) in crates.into_iter().flatten() {
        assert_eq!(said[code.0], *kind, "{code}");
    }
    // The index repeats the pages, in their order.
    let pages: Vec<(String, String)> =
        sophy::pages().map(|page| (page.code.to_owned(), page.title.to_owned())).collect();
    assert_eq!(rows, pages);
    for (code, kind) in syntax_codes() {
        assert_eq!(said[&code], kind, "{code}");
    }
}

/// The codes of expressions, whose crate this one does not use, read off their source.
fn syntax_codes() -> Vec<(String, String)> {
    let text = read("crates/sophy-syntax/src/error.rs");
    let value = |constant: &str| {
        let (_, rest) = text.split_once(&format!("const {constant}: Code = Code(\"")).unwrap();
        rest.split('"').next().unwrap().to_owned()
    };
    let entries = text.lines().filter_map(|line| line.trim().strip_prefix("(codes::")?.strip_suffix("\"),"));
    let codes: Vec<(String, String)> = entries
        .map(|entry| entry.split_once(", \"").unwrap())
        .map(|(constant, kind)| (value(constant), kind.to_owned()))
        .collect();
    assert!(codes.len() >= 14);
    codes
}

/// Every string that is a code, in the sources of all crates.
fn codes_in_sources() -> Vec<String> {
    let mut codes = Vec::new();
    let mut folders: Vec<PathBuf> = fs::read_dir(root().join("crates"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| !path.ends_with("sophy-diagnostics")) // its tests invent some
        .map(|path| path.join("src"))
        .collect();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                codes.extend(text.split('"').filter(|word| is_code(word)).map(str::to_owned));
            }
        }
    }
    codes
}

/// `HS0101`
fn is_code(word: &str) -> bool {
    let bytes = word.as_bytes();
    bytes.len() == 6
        && bytes[..2].iter().all(u8::is_ascii_uppercase)
        && bytes[2..].iter().all(u8::is_ascii_digit)
}

/// The value of an expression at t = 0, or `error CODE …` with the codes of its errors.
fn value(text: &str) -> String {
    let world = MemoryWorld::default().with("m.xml", expression_model(text));
    let loaded = load_model(&world, Path::new("m.xml"));
    let Some(model) = &loaded.model else {
        let codes: Vec<&str> = loaded
            .messages()
            .iter()
            .filter(|message| message.severity == sophy::Severity::Error)
            .map(|message| message.code.0)
            .collect();
        return format!("error {}", codes.join(" "));
    };
    let experiment = Experiment { stop: 0.0, ..Experiment::default() };
    match simulate(model, &experiment) {
        Ok(result) => format!("{}", result.table.reals[0][0]),
        Err(error) => error.to_string(),
    }
}

/// A model with constant `L` = 0.5, constant `'Ground Height'` = 0.25, function `sq(a)` = a*a, state `x` = 2 and
/// the expression as its output.
fn expression_model(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    format!(
        "<SophySystem><name>M</name>\
         <hints><hint hintname=\"initial x\">2</hint><hint hintname=\"function sq(a)\">a*a</hint></hints>\
         <constants><constant symbol=\"L\">0.5</constant><constant symbol=\"Ground Height\">0.25</constant></constants>\
         <states><state>x</state></states><inputs/><outputs><output>y</output></outputs>\
         <locations><location><name>all</name><diffequation state=\"x\">1</diffequation>\
         <outputmap output=\"y\">{text}</outputmap></location></locations></SophySystem>"
    )
}

/// A text whose lines marked `-` are replaced by those marked `+`, place by place.
fn changed(text: &str, diff: &Block) -> String {
    let mut text = text.to_owned();
    let mut lines = diff.text.lines().peekable();
    while lines.peek().is_some() {
        let mut side = |mark: char| {
            let mut side = String::new();
            while let Some(line) = lines.next_if(|line| line.starts_with(mark)) {
                side += &line[1..];
                side.push('\n');
            }
            side
        };
        let (old, new) = (side('-'), side('+'));
        assert!(!old.is_empty() && text.contains(&old), "{}: not in the file:\n{old}", diff.place);
        text = text.replacen(&old, &new, 1);
    }
    text
}

fn messages(loaded: &Loaded) -> String {
    let shown: Vec<String> =
        loaded.messages().iter().map(|message| render(message, &loaded.sources, Style::Plain)).collect();
    let lines = shown.join("\n\n");
    lines.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

fn words(block: &Block) -> Vec<&str> {
    block.words.iter().map(String::as_str).collect()
}

/// The fenced blocks of all pages, page by page.
fn blocks() -> Vec<Block> {
    let mut blocks = Vec::new();
    for page in pages() {
        let name = page.file_name().unwrap().to_string_lossy().into_owned();
        let text = fs::read_to_string(&page).unwrap();
        let mut lines = (1..).zip(text.lines());
        while let Some((number, line)) = lines.next() {
            let Some(words) = line.strip_prefix("```") else { continue };
            let inside: Vec<&str> =
                lines.by_ref().map(|(_, line)| line).take_while(|line| *line != "```").collect();
            blocks.push(Block {
                place: format!("{name}:{number}"),
                words: words.split_whitespace().map(str::to_owned).collect(),
                text: inside.join("\n") + "\n",
            });
        }
    }
    blocks
}

fn pages() -> Vec<PathBuf> {
    let folder = fs::read_dir(root().join("docs/book")).unwrap();
    let mut pages: Vec<PathBuf> = folder.map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    pages
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}
