use super::{HsmlReading, read_hsml};
use crate::checks::hs0141_import;
use crate::declarations::{Declarations, Spanned};
use sophy_diagnostics::{SourceId, Sources, World, WorldError, simplified};
use std::collections::{HashSet, VecDeque};
use std::path::{Path, PathBuf};

/// Reads a file of HSML and all that it imports, directly or through others, each file once.
///
/// The paths of imports start at the folder of the file that names them; files may import one another. The reading
/// is that of the file at `path`, but its declarations are those of all files, its own first, and name no imports
/// any more. Which paths lead to one file is the world's to say. Spans tell which file something comes from. A file that cannot be imported is an error where it is
/// named.
///
/// # Errors
/// [`WorldError`] if the file at `path` itself cannot be read.
pub fn read_with_imports(
    world: &dyn World,
    sources: &mut Sources,
    path: &Path,
) -> Result<HsmlReading, WorldError> {
    let bytes = world.read(path)?;
    let mut all = read_hsml(sources, &path.display().to_string(), &bytes);
    let mut known = HashSet::from([world.identity(path)]);
    let mut pending: VecDeque<(SourceId, Spanned<String>)> =
        imports(&mut all.declarations, all.source).collect();
    while let Some((importing, import)) = pending.pop_front() {
        // An import without a path has been complained about.
        if import.value.is_empty() {
            continue;
        }
        let folder = Path::new(sources.name(importing)).parent().unwrap_or(Path::new(""));
        let path = folder.join(&import.value);
        if !known.insert(world.identity(&path)) {
            continue;
        }
        let path = shortened(&path, world);
        match bytes_of(world, &path) {
            Ok(bytes) => {
                let mut reading = read_hsml(sources, &path.display().to_string(), &bytes);
                pending.extend(imports(&mut reading.declarations, reading.source));
                all.diagnostics.extend(reading.diagnostics);
                merge(&mut all.declarations, reading.declarations);
            }
            Err(why) => all.diagnostics.push(hs0141_import::diagnostic(&import, &why)),
        }
    }
    Ok(all)
}

fn bytes_of(world: &dyn World, path: &Path) -> Result<Vec<u8>, String> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("hsml")) {
        return Err("only files of HSML (.hsml) can be imported".to_owned());
    }
    world.read(path).map_err(|error| error.reason)
}

/// Takes the imports out.
fn imports(
    declarations: &mut Declarations,
    source: SourceId,
) -> impl Iterator<Item = (SourceId, Spanned<String>)> + use<> {
    std::mem::take(&mut declarations.imports).into_iter().map(move |import| (source, import))
}

fn merge(all: &mut Declarations, other: Declarations) {
    let Declarations { imports: _, constants, functions, components } = other;
    all.constants.extend(constants);
    all.functions.extend(functions);
    all.components.extend(components);
}

/// For messages and for what the file imports: `models/b.hsml` rather than `models/parts/../b.hsml`, unless `parts` is a
/// link to a folder elsewhere.
fn shortened(path: &Path, world: &dyn World) -> PathBuf {
    let short = simplified(path);
    if world.identity(&short) == world.identity(path) { short } else { path.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_diagnostics::{MemoryWorld, Style, render};

    fn read(world: &dyn World, path: &str) -> (Vec<String>, Vec<String>, String) {
        let mut sources = Sources::default();
        let reading = read_with_imports(world, &mut sources, Path::new(path)).expect("the file is there");
        let functions = reading.declarations.functions.iter();
        let functions =
            functions.map(|f| format!("{} of {}", f.name.value, sources.name(f.name.span.source)));
        let messages = reading.diagnostics.iter().map(|d| render(d, &sources, Style::Plain)).collect();
        assert!(reading.declarations.imports.is_empty());
        (functions.collect(), messages, sources.name(reading.source).to_owned())
    }

    #[test]
    fn files_are_read_once_whatever_way_leads_to_them() {
        let world = MemoryWorld::default()
            .with("models/main.hsml", "import \"parts/a.hsml\"; import \"b.hsml\"; function f(x) = x;")
            .with("models/parts/a.hsml", "import \"../b.hsml\"; import \"./a.hsml\"; function g(x) = x;")
            .with("models/b.hsml", "import \"main.hsml\"; function h(x) = x;");
        let (functions, messages, main) = read(&world, "models/main.hsml");
        assert_eq!(functions, ["f of models/main.hsml", "g of models/parts/a.hsml", "h of models/b.hsml"]);
        assert_eq!(messages, Vec::<String>::new());
        assert_eq!(main, "models/main.hsml");
    }

    #[test]
    fn a_path_through_a_folder_and_back_is_the_same_file() {
        let world = MemoryWorld::default()
            .with("./models/main.hsml", "import \"a/../b.hsml\"; import \"b.hsml\"; function f(x) = x;")
            .with("models/b.hsml", "import \"../models/./main.hsml\"; function h(x) = x;");
        let (functions, messages, _) = read(&world, "models/a/../main.hsml");
        assert_eq!(functions, ["f of models/a/../main.hsml", "h of models/b.hsml"]);
        assert_eq!(messages, Vec::<String>::new());
    }

    /// A world that knows more of its folders: `lib` is a link to `parts/old`, and this folder is `models`.
    struct Linked(MemoryWorld);

    impl World for Linked {
        fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
            self.0.read(&self.identity(path))
        }

        fn identity(&self, path: &Path) -> PathBuf {
            let path = path.to_string_lossy().replace("lib/", "parts/old/").replace("../models/", "");
            simplified(Path::new(&path))
        }
    }

    #[test]
    fn links_and_the_working_directory_are_the_worlds_to_follow() {
        let world = Linked(
            MemoryWorld::default()
                .with(
                    "main.hsml",
                    "import \"lib/../b.hsml\"; import \"../models/main.hsml\"; function f(x) = x;",
                )
                .with("parts/b.hsml", "import \"../main.hsml\"; import \"./b.hsml\"; function g(x) = x;")
                .with("b.hsml", "function h(x) = x;"),
        );
        let (functions, messages, _) = read(&world, "main.hsml");
        assert_eq!(functions, ["f of main.hsml", "g of lib/../b.hsml"]);
        assert_eq!(messages, Vec::<String>::new());
    }

    #[test]
    fn what_cannot_be_imported_is_said_where_it_is_named() {
        let world = MemoryWorld::default()
            .with("main.hsml", "import \"lib/a.hsml\";\nimport \"old.xml\";\nfunction f(x) = x;")
            .with("lib/a.hsml", "import \"nowhere.hsml\";\nfunction g(x) = x;");
        let (functions, messages, _) = read(&world, "main.hsml");
        assert_eq!(functions.len(), 2);
        let [xml, missing] = messages.as_slice() else { panic!("{messages:?}") };
        assert!(xml.contains("main.hsml:2:8") && xml.contains("only files of HSML"), "{xml}");
        assert!(missing.contains("lib/a.hsml:1:8") && missing.contains("no such file"), "{missing}");
    }

    #[test]
    fn mistakes_of_imported_files_are_found() {
        let world = MemoryWorld::default()
            .with("main.hsml", "import \"a.hsml\";\n")
            .with("a.hsml", "function f(x) = x +;\n");
        let (_, messages, _) = read(&world, "main.hsml");
        assert!(messages.len() == 1 && messages[0].contains("a.hsml:1:"), "{messages:?}");
    }
}
