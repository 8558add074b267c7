use crate::checks::{hs0107_declared_twice, hs0138_unknown_component, hs0142_no_component};
use crate::component::{Given, Shared};
use crate::composite::{Library, findings_in_use};
use crate::declarations::{ComponentDeclaration, ComponentKind, Declarations, Dialect, MemberItem};
use crate::dependency_order::dependency_order;
use crate::findings::Findings;
use crate::lower::{Files, lower_globals};
use sophy_diagnostics::{Diagnostics, SourceId, Sources, Span, World};
use sophy_ir::{Body, Class, ClassIndex, Model};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Which component a model is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Root<'n> {
    /// The component of this name.
    Named(&'n str),
    /// The SYSTEM of the file that is in no other one, or if there is none the component that is in no other one; an
    /// error if that is not clear.
    Implied,
    /// The same, but if it is not clear there is no model, and nothing is said: the file is a library.
    IfClear,
}

/// Finds all mistakes of a file and what it imports, and makes a model of it if there are none.
///
/// `main` is the source of the file itself, in which the root is looked for; tables and data files are read through
/// `world`, their paths start at the folder of the source that names them. Mistakes of grammar, empty names and
/// missing guards are the reader's to report, who knows the file: no model is made from them, but nothing is said of
/// them here.
pub fn analyse(
    declarations: &Declarations,
    root: Root<'_>,
    main: SourceId,
    sources: &Sources,
    world: &dyn World,
) -> (Option<Model>, Diagnostics) {
    let mut findings = Findings::default();
    let mut files = Files::new(world);
    for source in sources.ids() {
        let folder = std::path::Path::new(sources.name(source)).parent().map(std::path::PathBuf::from);
        files.set_folder(source, folder.unwrap_or_default());
    }
    let mut texts = Vec::new();
    let constants: Vec<_> = declarations.constants.iter().collect();
    let functions: Vec<_> = declarations.functions.iter().collect();
    let dialect = declarations.components.first().map_or(Dialect::Hsml, |component| component.dialect);
    let globals = lower_globals(&constants, &functions, dialect, &mut files, &mut texts, &mut findings);
    let globals = Rc::new(globals);
    let mut shared = Shared { findings, texts, files, globals, sources };
    shared.check_globals(&constants, &functions);

    // Members before composites.
    let components: Vec<&ComponentDeclaration> = declarations.components.iter().collect();
    check_names(&components, &mut shared.findings);
    let mut library = Library::new(components);
    let needs: Vec<Vec<usize>> =
        library.components.iter().map(|component| members_of(component, &library)).collect();
    let sorted = dependency_order(&needs);
    let mut circular: HashSet<usize> = HashSet::new();
    for cycle in &sorted.cycles {
        let members: Vec<&ComponentDeclaration> =
            cycle.iter().map(|&index| library.components[index]).collect();
        shared.findings.report(hs0138_unknown_component::circle(&members));
        circular.extend(cycle);
    }
    let mut defaults = Vec::new();
    for index in sorted.order {
        if !needs[index].iter().any(|needed| circular.contains(needed)) {
            defaults.push((index, library.entry(&mut shared, index, &Given::new())));
        } else {
            circular.insert(index);
        }
    }

    let root = find_root(&library, root, main, sources, &mut shared.findings);
    let Shared { mut findings, texts, files, .. } = shared;
    findings.report_all(findings_in_use(&defaults, root));
    let diagnostics = once(findings.diagnostics);
    let well_formed = !diagnostics.has_errors();
    let of_root = defaults.iter().find(|(component, _)| Some(*component) == root);
    let class = of_root.and_then(|(_, entry)| entry.class);
    let model = class.filter(|_| well_formed).map(|class| {
        let (mut classes, root) = reachable(library.classes, class);
        classes.iter_mut().for_each(|class| class.graph.shrink_to_fit());
        Model { classes, root, texts, tables: files.tables }
    });
    (model, diagnostics)
}

fn check_names(components: &[&ComponentDeclaration], findings: &mut Findings) {
    let mut first: HashMap<&str, Span> = HashMap::new();
    for component in components.iter().filter(|component| !component.name.value.is_empty()) {
        let (name, span) = (component.name.value.as_str(), component.name.span);
        match first.get(name) {
            Some(&first) => findings.report(hs0107_declared_twice::component(name, first, span)),
            None => {
                first.insert(name, span);
            }
        }
    }
}

/// Components that a composite has members of.
fn members_of(component: &ComponentDeclaration, library: &Library<'_>) -> Vec<usize> {
    let mut found = Vec::new();
    let mut pending: Vec<&MemberItem> = component.members.iter().rev().collect();
    while let Some(item) = pending.pop() {
        match item {
            MemberItem::Member(member) => found.extend(library.named(&member.component.value)),
            MemberItem::For(turns) => pending.extend(turns.items.iter().rev()),
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

fn find_root(
    library: &Library<'_>,
    root: Root<'_>,
    main: SourceId,
    sources: &Sources,
    findings: &mut Findings,
) -> Option<usize> {
    let own: Vec<usize> =
        (0..library.components.len()).filter(|&k| library.components[k].name.span.source == main).collect();
    let first = sources.text(main).chars().next().map_or(0, char::len_utf8);
    let file = Span::new(main, 0..first);
    if let Root::Named(name) = root {
        let found = library.named(name);
        if found.is_none() {
            findings.report(hs0142_no_component::unknown(name, &library.components, file));
        }
        return found;
    }
    let systems: Vec<usize> =
        own.iter().copied().filter(|&k| library.components[k].kind == ComponentKind::System).collect();
    let mut candidates = if systems.is_empty() { own } else { systems };
    if candidates.len() > 1 {
        let mut contained = vec![false; library.components.len()];
        for &k in &candidates {
            members_of(library.components[k], library)
                .into_iter()
                .for_each(|member| contained[member] = true);
        }
        // In a circle everything is contained.
        if candidates.iter().any(|&k| !contained[k]) {
            candidates.retain(|&k| !contained[k]);
        }
    }
    match (candidates.as_slice(), root) {
        (&[only], _) => Some(only),
        (_, Root::IfClear) => None,
        ([], _) => {
            findings.report(hs0142_no_component::none(file));
            None
        }
        (several, _) => {
            let several: Vec<&ComponentDeclaration> =
                several.iter().map(|&k| library.components[k]).collect();
            findings.report(hs0142_no_component::ambiguous(&several));
            None
        }
    }
}

/// What is analysed in several forms says the same several times.
fn once(diagnostics: Diagnostics) -> Diagnostics {
    let mut seen = HashSet::new();
    let mut result = Diagnostics::default();
    for diagnostic in diagnostics.iter() {
        if seen.insert((diagnostic.code, diagnostic.span(), diagnostic.message.clone())) {
            result.push(diagnostic.clone());
        }
    }
    result
}

/// The classes that a root needs, in the same order.
fn reachable(classes: Vec<Class>, root: ClassIndex) -> (Vec<Class>, ClassIndex) {
    let mut needed = vec![false; classes.len()];
    let mut pending = vec![root];
    while let Some(index) = pending.pop() {
        if std::mem::replace(&mut needed[index.0 as usize], true) {
            continue;
        }
        if let Body::Composite(composite) = &classes[index.0 as usize].body {
            pending.extend(composite.members.iter().map(|member| member.class));
        }
    }
    let mut number = Vec::with_capacity(classes.len());
    let mut count = 0;
    for &is_needed in &needed {
        number.push(ClassIndex(count));
        count += u32::from(is_needed);
    }
    let mut kept: Vec<Class> = classes
        .into_iter()
        .zip(&needed)
        .filter(|(_, is_needed)| **is_needed)
        .map(|(class, _)| class)
        .collect();
    for class in &mut kept {
        if let Body::Composite(composite) = &mut class.body {
            for member in &mut composite.members {
                member.class = number[member.class.0 as usize];
            }
        }
    }
    (kept, number[root.0 as usize])
}
