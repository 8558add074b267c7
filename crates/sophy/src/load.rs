use crate::setup::{Setup, read_setup};
use sha2::{Digest, Sha256};
use sophy_analysis::{Declarations, analyse};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Severity, Sources, World};
use sophy_ir::Model;
use std::path::{Path, PathBuf};

/// What a model or experiment file came to.
///
/// With errors among the diagnostics, `model` is `None` or the setup is incomplete; nothing should be run then.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Every text that was read; messages point into them.
    pub sources: Sources,
    /// The model, if it has no errors.
    pub model: Option<Model>,
    /// What the model's file declares, as far as it could be read.
    pub declarations: Option<Declarations>,
    /// The experiment, the defaults if only a model was loaded.
    pub setup: Setup,
    /// Where the model and the experiment come from.
    pub provenance: Provenance,
    /// Every mistake that was found.
    pub diagnostics: Diagnostics,
    /// Whether a file that was named could not be read at all.
    pub unreadable: bool,
}

impl Loaded {
    /// The messages in the order of their places.
    pub fn messages(&self) -> Vec<Diagnostic> {
        self.diagnostics.clone().sorted(&self.sources)
    }
}

/// Where a result comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// Path of the model's file.
    pub model_file: PathBuf,
    /// SHA-256 of that file's bytes, as hexadecimal digits.
    pub model_hash: String,
    /// Text of the experiment file; empty if there is none.
    pub experiment: String,
}

/// What a file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Model,
    Experiment,
}

/// Loads whatever `path` is: a model, or an experiment together with its model.
pub fn load(world: &dyn World, path: &Path) -> Loaded {
    match kind(path) {
        Some(Kind::Experiment) => load_experiment(world, path),
        Some(Kind::Model) => load_model(world, path),
        None => {
            let mut loaded = Loaded::default();
            loaded.diagnostics.push(unknown_kind(path, "SOPHY XML models (.xml) and experiments (.toml)"));
            loaded
        }
    }
}

/// Reads and checks a model. Every mistake of the file is in the diagnostics.
///
/// SOPHY XML (`.xml`) is understood.
pub fn load_model(world: &dyn World, path: &Path) -> Loaded {
    let mut loaded = Loaded::default();
    read_model(world, path, &mut loaded);
    loaded
}

/// Reads an experiment (`.toml`) and the model it names, relative to the experiment's folder.
///
/// Every mistake of both files is in the diagnostics, except those that only show when the two are put
/// together: [`check`](crate::check) finds these.
pub fn load_experiment(world: &dyn World, path: &Path) -> Loaded {
    let mut loaded = Loaded::default();
    let Some(bytes) = read_bytes(world, path, &mut loaded) else { return loaded };
    let text = String::from_utf8_lossy(&bytes).into_owned();
    loaded.provenance.experiment.clone_from(&text);
    let source = loaded.sources.add(path.display().to_string(), text.clone());
    let folder = path.parent().unwrap_or(Path::new(""));
    let (setup, model, mistakes) = read_setup(source, &text, folder);
    loaded.setup = setup;
    loaded.diagnostics.extend(mistakes);
    if let Some(model) = model {
        read_model(world, &model, &mut loaded);
    }
    loaded
}

fn read_model(world: &dyn World, path: &Path, loaded: &mut Loaded) {
    if kind(path) != Some(Kind::Model) {
        loaded.diagnostics.push(unknown_kind(path, "SOPHY XML models (.xml)"));
        return;
    }
    let Some(bytes) = read_bytes(world, path, loaded) else { return };
    loaded.provenance.model_file = path.to_owned();
    loaded.provenance.model_hash = hash(&bytes);
    // Text to declarations.
    let reading = sophy_xml::read(&mut loaded.sources, &path.display().to_string(), &bytes);
    let mut broken = reading.diagnostics.has_errors();
    loaded.diagnostics.extend(reading.diagnostics);
    loaded.declarations = reading.declarations;
    // Declarations to a model.
    if let Some(declarations) = &loaded.declarations {
        let (model, mistakes) = analyse(declarations);
        broken |= mistakes.has_errors();
        loaded.diagnostics.extend(mistakes);
        loaded.model = model.filter(|_| !broken);
    }
}

fn read_bytes(world: &dyn World, path: &Path, loaded: &mut Loaded) -> Option<Vec<u8>> {
    match world.read(path) {
        Ok(bytes) => Some(bytes),
        Err(error) => {
            loaded.unreadable = true;
            loaded
                .diagnostics
                .push(nowhere("FI0001", format!("cannot read {}: {}", path.display(), error.reason)));
            None
        }
    }
}

fn kind(path: &Path) -> Option<Kind> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "xml" => Some(Kind::Model),
        "toml" => Some(Kind::Experiment),
        _ => None,
    }
}

fn unknown_kind(path: &Path, known: &str) -> Diagnostic {
    let mut diagnostic =
        nowhere("FI0002", format!("cannot tell what {} is by its extension", path.display()));
    diagnostic.helps.push(format!("understood are {known}"));
    diagnostic
}

/// An error that stands in no text.
pub(crate) fn nowhere(code: &'static str, message: String) -> Diagnostic {
    Diagnostic {
        code: Code(code),
        severity: Severity::Error,
        message,
        labels: Vec::new(),
        notes: Vec::new(),
        helps: Vec::new(),
    }
}

fn hash(bytes: &[u8]) -> String {
    use std::fmt::Write;
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        // Writing into a string does not fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}
