use crate::digest::Digesting;
use crate::setup::{Setup, read_setup};
use sophy_analysis::{Declarations, Root, analyse, read_with_imports};
use sophy_diagnostics::{Code, Diagnostic, Diagnostics, Severity, SourceId, Sources, World};
use sophy_ir::Model;
use std::path::{Path, PathBuf};

/// What a model or experiment file came to.
///
/// With errors among the diagnostics, `model` is `None` or the setup is incomplete; nothing should be run then.
#[derive(Clone, Debug, Default)]
pub struct Loaded {
    /// Every text that was read; messages and declarations point into them.
    pub sources: Sources,
    /// The model's own file among the sources; the others are the experiment and what the model imports.
    pub source: Option<SourceId>,
    /// The model, if it has no errors.
    pub model: Option<Model>,
    /// What the model's file and its imports declare, as far as they could be read.
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
    /// SHA-256 of the model, as hexadecimal digits: of the bytes of its file, followed by those of the files it
    /// imports and of the tables and data it reads, in the order in which they are read.
    pub model_hash: String,
    /// Text of the experiment file; empty if there is none.
    pub experiment: String,
}

/// What a file is, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Hsml,
    Xml,
    Experiment,
}

/// The models that are understood, in words.
const MODELS: &str = "HSML (.hsml) and SOPHY XML (.xml)";

/// Loads whatever `path` is: a model, or an experiment together with its model.
pub fn load(world: &dyn World, path: &Path) -> Loaded {
    load_as(world, path, Root::Implied)
}

/// The same with the component to run said. A name wins over the one that an experiment says.
pub fn load_as(world: &dyn World, path: &Path, root: Root<'_>) -> Loaded {
    let mut loaded = Loaded::default();
    match kind(path) {
        Some(Kind::Experiment) => read_experiment(world, path, root, &mut loaded),
        Some(_) => read_model(world, path, root, &mut loaded),
        None => {
            let known = format!("models in {MODELS} and experiments (.toml)");
            loaded.diagnostics.push(unknown_kind(path, &known));
        }
    }
    loaded
}

/// Reads and checks a model in HSML (`.hsml`) or SOPHY XML (`.xml`). Every mistake of the file and of what it
/// imports is in the diagnostics.
pub fn load_model(world: &dyn World, path: &Path) -> Loaded {
    let mut loaded = Loaded::default();
    read_model(world, path, Root::Implied, &mut loaded);
    loaded
}

/// Reads an experiment (`.toml`) and the model it names, relative to the experiment's folder.
///
/// Every mistake of both files is in the diagnostics, except those that only show when the two are put
/// together: [`check`](crate::check) finds these.
pub fn load_experiment(world: &dyn World, path: &Path) -> Loaded {
    let mut loaded = Loaded::default();
    read_experiment(world, path, Root::Implied, &mut loaded);
    loaded
}

fn read_experiment(world: &dyn World, path: &Path, root: Root<'_>, loaded: &mut Loaded) {
    let Some(bytes) = read_bytes(world, path, loaded) else { return };
    let text = String::from_utf8_lossy(&bytes).into_owned();
    loaded.provenance.experiment.clone_from(&text);
    let source = loaded.sources.add(path.display().to_string(), text.clone());
    let folder = path.parent().unwrap_or(Path::new(""));
    let reading = read_setup(source, &text, folder);
    loaded.setup = reading.setup;
    loaded.diagnostics.extend(reading.diagnostics);
    if let Some(model) = reading.model {
        let root = match (root, &reading.system) {
            (Root::Named(name), _) => Root::Named(name),
            (_, Some(name)) => Root::Named(name),
            // An experiment is done with one component.
            (_, None) => Root::Implied,
        };
        read_model(world, &model, root, loaded);
    }
}

fn read_model(world: &dyn World, path: &Path, root: Root<'_>, loaded: &mut Loaded) {
    let kind = kind(path);
    if !matches!(kind, Some(Kind::Hsml | Kind::Xml)) {
        loaded.diagnostics.push(unknown_kind(path, MODELS));
        return;
    }
    let world = &Digesting::new(world);
    // Text to declarations.
    let (source, declarations, mistakes) = if kind == Some(Kind::Hsml) {
        match read_with_imports(world, &mut loaded.sources, path) {
            Ok(reading) => (reading.source, Some(reading.declarations), reading.diagnostics),
            Err(error) => return unreadable(path, &error.reason, loaded),
        }
    } else {
        let Some(bytes) = read_bytes(world, path, loaded) else { return };
        let reading = sophy_xml::read(&mut loaded.sources, &path.display().to_string(), &bytes);
        (reading.source, reading.declarations, reading.diagnostics)
    };
    let mut broken = mistakes.has_errors();
    loaded.diagnostics.extend(mistakes);
    // Declarations to a model.
    if let Some(declarations) = &declarations {
        let (model, mistakes) = analyse(declarations, root, source, &loaded.sources, world);
        broken |= mistakes.has_errors();
        loaded.diagnostics.extend(mistakes);
        loaded.model = model.filter(|_| !broken);
    }
    loaded.source = Some(source);
    loaded.declarations = declarations;
    path.clone_into(&mut loaded.provenance.model_file);
    loaded.provenance.model_hash = world.hash();
}

fn read_bytes(world: &dyn World, path: &Path, loaded: &mut Loaded) -> Option<Vec<u8>> {
    world.read(path).map_err(|error| unreadable(path, &error.reason, loaded)).ok()
}

fn unreadable(path: &Path, reason: &str, loaded: &mut Loaded) {
    loaded.unreadable = true;
    loaded.diagnostics.push(nowhere("FI0001", format!("cannot read {}: {reason}", path.display())));
}

fn kind(path: &Path) -> Option<Kind> {
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "hsml" => Some(Kind::Hsml),
        "xml" => Some(Kind::Xml),
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
