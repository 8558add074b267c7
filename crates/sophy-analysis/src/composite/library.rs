use super::build::build_composite;
use crate::component::{Built, Given, Interface, Shared, build};
use crate::declarations::{ComponentDeclaration, ComponentKind};
use sophy_ir::{Class, ClassIndex};
use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

/// How deep composites may be nested in specialised form: each level is one of recursion.
const DEEPEST: usize = 200;

/// A component with what decides its structure fixed.
#[derive(Debug)]
pub(crate) struct Entry {
    /// `None` if it has mistakes.
    pub(crate) class: Option<ClassIndex>,
    pub(crate) interface: Interface,
    /// Parameters whose values decide something of the structure.
    pub(crate) structural: BTreeSet<String>,
}

/// Values of structural parameters as a key.
type Key = (usize, Vec<(String, Vec<u64>)>);

/// All components and the classes made of them. A component is analysed once for each set of values of the
/// parameters that decide its structure; all its copies share the class.
pub(crate) struct Library<'a> {
    pub(crate) components: Vec<&'a ComponentDeclaration>,
    by_name: HashMap<&'a str, usize>,
    pub(crate) classes: Vec<Class>,
    entries: HashMap<Key, Rc<Entry>>,
    depth: usize,
}

impl<'a> Library<'a> {
    pub(crate) fn new(components: Vec<&'a ComponentDeclaration>) -> Self {
        let mut by_name = HashMap::new();
        for (index, component) in components.iter().enumerate() {
            by_name.entry(component.name.value.as_str()).or_insert(index);
        }
        Library { components, by_name, classes: Vec::new(), entries: HashMap::new(), depth: 0 }
    }

    /// The component of a name.
    pub(crate) fn named(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// The class of a component whose parameters have the `given` values where these decide its structure.
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
            // What decides the structure is known only once it was built.
            let decisive: Given = given
                .iter()
                .filter(|(name, _)| entry.structural.contains(*name))
                .map(|(name, values)| (name.clone(), values.clone()))
                .collect();
            if decisive.keys().all(|name| given_here.contains_key(name)) {
                return entry;
            }
            given_here.extend(decisive);
        }
    }

    fn make(&mut self, shared: &mut Shared<'a>, component: usize, given: &Given) -> Entry {
        let declaration = self.components[component];
        let composite = matches!(declaration.kind, ComponentKind::Cc | ComponentKind::System);
        if self.depth >= DEEPEST {
            return Entry { class: None, interface: Interface::default(), structural: BTreeSet::new() };
        }
        self.depth += 1;
        let Built { class, interface, structural } = if composite {
            build_composite(declaration, self, shared, given)
        } else {
            build(declaration, shared, given)
        };
        self.depth -= 1;
        let class = class.map(|class| {
            self.classes.push(class);
            ClassIndex(self.classes.len() as u32 - 1)
        });
        Entry { class, interface, structural }
    }
}

fn key_of(given: &Given) -> Vec<(String, Vec<u64>)> {
    given.iter().map(|(name, values)| (name.clone(), values.iter().map(|v| v.to_bits()).collect())).collect()
}
