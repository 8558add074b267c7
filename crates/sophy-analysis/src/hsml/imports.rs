use super::{HsmlReading, read_hsml};
use crate::checks::hs0141_import;
use crate::declarations::{Declarations, Spanned};
use sophy_diagnostics::{SourceId, Sources, World, WorldError};
use std::collections::{HashSet, VecDeque};
use std::path::{Component, Path, PathBuf};

/// Reads a file of HSML and all that it imports, directly or through others, each file once.
///
/// The paths of imports start at the folder of the file that names them; files may import one another. The reading
/// is that of the file at `path`, but its declarations are those of all files, its own first, and name no imports
/// any more. Spans tell which file something comes from. A file that cannot be imported is an error where it is
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
    let mut known = HashSet::from([simplified(path)]);
    let mut pending: VecDeque<(SourceId, Spanned<String>)> =
        imports(&mut all.declarations, all.source).collect();
    while let Some((importing, import)) = pending.pop_front() {
        // An import without a path has been complained about.
        if import.value.is_empty() {
            continue;
        }
        let folder = Path::new(sources.name(importing)).parent().unwrap_or(Path::new(""));
        let path = simplified(&folder.join(&import.value));
        if !known.insert(path.clone()) {
            continue;
        }
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

/// Without `.` and, where it is clear, `..`: the same file has the same path, by whatever way it is reached.
fn simplified(path: &Path) -> PathBuf {
    let mut simple = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(simple.components().next_back(), Some(Component::Normal(_))) => {
                simple.pop();
            }
            part => simple.push(part),
        }
    }
    simple
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_diagnostics::{MemoryWorld, Style, render};

    fn read(world: &MemoryWorld, path: &str) -> (Vec<String>, Vec<String>, String) {
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
