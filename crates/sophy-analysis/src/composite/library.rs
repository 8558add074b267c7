use super::build::build_composite;
use crate::component::{Built, Given, GivenValue, Interface, Shared, build};
use crate::declarations::{ComponentDeclaration, ComponentKind};
use crate::lower::Expected;
use sophy_diagnostics::{Diagnostics, Severity};
use sophy_ir::{Class, ClassIndex};
use std::collections::{BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// How deep composites may be nested in specialised form: each level is one of recursion.
const DEEPEST: usize = 200;

/// In how many forms a component may be suspect before it is no longer looked for the values that are to blame.
const MOST_SUSPECT: usize = 16;

/// A component with what decides its structure fixed.
#[derive(Debug)]
pub(crate) struct Entry {
    /// Its position in the library.
    component: usize,
    /// Position among all entries.
    pub(crate) number: usize,
    /// What is to be said of it, if it is used in this form.
    diagnostics: Diagnostics,
    /// Whether there is more to be said of it or of a member than a note.
    is_suspect: bool,
    /// What its members are, if it is a composite.
    members: Vec<Rc<Entry>>,
    /// `None` if it has mistakes.
    pub(crate) class: Option<ClassIndex>,
    pub(crate) interface: Interface,
    /// What members can give, in written order; `None` where that is not known.
    pub(crate) parameters: Vec<(String, Option<Expected>)>,
    /// Parameters whose values decide something of the structure.
    pub(crate) structural: BTreeSet<String>,
}

/// What is fixed of a component, as a key: extents, and values if these are fixed, too.
type Key = (usize, Vec<(String, Vec<usize>, Option<Vec<u64>>)>);

/// All components and the classes made of them. A component is analysed once for each set of values of the
/// parameters that decide its structure; all its copies share the class.
pub(crate) struct Library<'a> {
    pub(crate) components: Vec<&'a ComponentDeclaration>,
    by_name: HashMap<&'a str, usize>,
    pub(crate) classes: Vec<Class>,
    entries: HashMap<Key, Rc<Entry>>,
    /// By component: how many forms are suspect.
    suspect: HashMap<usize, usize>,
    /// How many entries were made.
    made: usize,
    depth: usize,
}

impl<'a> Library<'a> {
    pub(crate) fn new(components: Vec<&'a ComponentDeclaration>) -> Self {
        let mut by_name = HashMap::new();
        for (index, component) in components.iter().enumerate() {
            by_name.entry(component.name.value.as_str()).or_insert(index);
        }
        Library {
            components,
            by_name,
            classes: Vec::new(),
            entries: HashMap::new(),
            suspect: HashMap::new(),
            made: 0,
            depth: 0,
        }
    }

    /// The component of a name.
    pub(crate) fn named(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// The form of a component for parameters that have the `given` values: only what decides its structure is
    /// fixed, and, where the form so found is suspect, all of them, for its own values may be to blame.
    pub(crate) fn entry(&mut self, shared: &mut Shared<'a>, component: usize, given: &Given) -> Rc<Entry> {
        let mut given_here = Given::new();
        loop {
            let key = (component, key_of(&given_here));
            let entry = match self.entries.get(&key) {
                Some(known) => Rc::clone(known),
                None => {
                    let made = Rc::new(self.make(shared, component, &given_here));
                    self.entries.insert(key, Rc::clone(&made));
                    made
                }
            };
            let is_suspect =
                entry.is_suspect && self.suspect.get(&component).is_some_and(|&count| count <= MOST_SUSPECT);
            // What decides the structure is known only once it was built.
            let changed = fix(&mut given_here, given, &entry, |name| entry.structural.contains(name))
                || is_suspect && fix(&mut given_here, given, &entry, |_| true);
            if !changed {
                return entry;
            }
        }
    }

    fn make(&mut self, shared: &mut Shared<'a>, component: usize, given: &Given) -> Entry {
        let declaration = self.components[component];
        let composite = matches!(declaration.kind, ComponentKind::Cc | ComponentKind::System);
        let number = self.made;
        self.made += 1;
        if self.depth >= DEEPEST {
            return Entry {
                component,
                number,
                diagnostics: Diagnostics::default(),
                is_suspect: true,
                members: Vec::new(),
                class: None,
                interface: Interface::default(),
                parameters: Vec::new(),
                structural: BTreeSet::new(),
            };
        }
        self.depth += 1;
        let findings = std::mem::take(&mut shared.findings);
        let (built, members) = if composite {
            build_composite(declaration, self, shared, given)
        } else {
            (build(declaration, shared, given), Vec::new())
        };
        let diagnostics = std::mem::replace(&mut shared.findings, findings).diagnostics;
        self.depth -= 1;
        let Built { class, interface, parameters, structural } = built;
        let class = class.map(|class| {
            self.classes.push(class);
            ClassIndex(self.classes.len() as u32 - 1)
        });
        let is_suspect = class.is_none()
            || diagnostics.iter().any(|found| found.severity != Severity::Note)
            || members.iter().any(|member| member.is_suspect);
        *self.suspect.entry(component).or_default() += usize::from(is_suspect);
        Entry {
            component,
            number,
            diagnostics,
            is_suspect,
            members,
            class,
            interface,
            parameters,
            structural,
        }
    }
}

/// What is to be said of components in the forms in which they are used. `defaults` has each component with its own
/// values, members before composites; these values count for `root` and for what no other component uses.
pub(crate) fn findings_in_use(defaults: &[(usize, Rc<Entry>)], root: Option<usize>) -> Diagnostics {
    let mut diagnostics = Diagnostics::default();
    let mut forms: HashSet<usize> = HashSet::new();
    let mut components: HashSet<usize> = HashSet::new();
    for (component, entry) in defaults.iter().rev() {
        let mut pending = Vec::new();
        if root == Some(*component) || !components.contains(component) {
            pending.push(entry);
        }
        while let Some(entry) = pending.pop() {
            if forms.insert(entry.number) {
                components.insert(entry.component);
                diagnostics.extend(entry.diagnostics.clone());
                pending.extend(&entry.members);
            }
        }
    }
    diagnostics
}

/// Fixes the given values that decide something of a form, and the extents that it does not have yet; whether
/// there were any.
fn fix(fixed: &mut Given, given: &Given, form: &Entry, decides: impl Fn(&str) -> bool) -> bool {
    let mut changed = false;
    for (name, value) in given {
        let values = value.values.clone().filter(|_| decides(name));
        let own = form.parameters.iter().find(|(parameter, _)| parameter == name);
        let own = own.and_then(|(_, symbol)| Some(symbol.as_ref()?.shape));
        if values.is_some() || own.is_some_and(|own| own != value.shape) {
            let value = GivenValue { shape: value.shape, values };
            if fixed.get(name) != Some(&value) {
                fixed.insert(name.clone(), value);
                changed = true;
            }
        }
    }
    changed
}

fn key_of(given: &Given) -> Vec<(String, Vec<usize>, Option<Vec<u64>>)> {
    let bits = |values: &Vec<f64>| values.iter().map(|value| value.to_bits()).collect();
    let part = |(name, value): (&String, &GivenValue)| {
        (name.clone(), value.shape.extents(), value.values.as_ref().map(bits))
    };
    given.iter().map(part).collect()
}
