use serde::Serialize;
use sophy_ir::{Body, Class, ClassIndex, Member, Model, VariableKind};
use std::collections::HashMap;

/// A component, or an array of components.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComponentDescription {
    /// Name within the composite that holds it; of the whole, its own name.
    pub name: String,
    /// What it is: CTC, DTC, LBC, CC, or SYSTEM if it is the whole and a composite without inputs.
    pub kind: &'static str,
    /// Name it was declared with.
    pub class: String,
    /// 0 for the whole, 1 for its members …
    pub depth: usize,
    /// Extents of an array, as in `3,4`; the number of elements that were written one by one; else empty.
    pub shape: String,
    /// How many there are in the whole model.
    pub copies: u64,
    /// What it means, in the author's words.
    pub documentation: String,
}

/// Which components there are; no work is done for copies.
pub(super) struct Census {
    pub(super) components: Vec<ComponentDescription>,
    pub(super) of_class: Vec<OfClass>,
}

/// What is known of all components of a class.
#[derive(Clone, Debug, Default)]
pub(super) struct OfClass {
    pub(super) copies: u64,
    /// The first of them: with the numbers of copies, and without, as its parameters are called.
    pub(super) instance: String,
    pub(super) place: String,
}

struct Pending {
    name: String,
    class: ClassIndex,
    depth: usize,
    shape: String,
    copies: u64,
    documentation: String,
    instance: String,
    place: String,
}

impl Census {
    pub(super) fn new(model: &Model) -> Self {
        let mut census =
            Census { components: Vec::new(), of_class: vec![OfClass::default(); model.classes.len()] };
        let root = model.root;
        let mut pending = vec![Pending {
            name: model.name().to_owned(),
            class: root,
            depth: 0,
            shape: String::new(),
            copies: 1,
            documentation: String::new(),
            instance: String::new(),
            place: String::new(),
        }];
        while let Some(next) = pending.pop() {
            let Some(class) = model.classes.get(next.class.0 as usize) else { continue };
            if let Body::Composite(composite) = &class.body {
                pending.extend(members(&composite.members, &next).into_iter().rev());
            }
            if let Some(of_class) = census.of_class.get_mut(next.class.0 as usize) {
                if of_class.copies == 0 {
                    (of_class.instance, of_class.place) = (next.instance, next.place);
                }
                of_class.copies += next.copies;
            }
            census.list(ComponentDescription {
                name: next.name,
                kind: if next.depth == 0 && is_system(class) { "SYSTEM" } else { kind(class) },
                class: class.name.clone(),
                depth: next.depth,
                shape: next.shape,
                copies: next.copies,
                documentation: next.documentation,
            });
        }
        census
    }

    /// Elements that were specialised differently are one all the same, unless they have members of their own.
    fn list(&mut self, next: ComponentDescription) {
        if let Some(last) = self.components.last_mut()
            && (last.depth, &last.name, &last.class) == (next.depth, &next.name, &next.class)
            && next.kind != "CC"
            && let (Ok(a), Ok(b)) = (last.shape.parse::<u64>(), next.shape.parse::<u64>())
        {
            last.shape = (a + b).to_string();
            last.copies += next.copies;
            return;
        }
        self.components.push(next);
    }
}

/// The members of a composite; elements of one name that were written one by one are one, too.
fn members(members: &[Member], of: &Pending) -> Vec<Pending> {
    let mut found: Vec<Pending> = Vec::new();
    let mut known: HashMap<(&str, ClassIndex), usize> = HashMap::new();
    let below =
        |path: &str, name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    for member in members {
        let position = *known.entry((&member.name, member.class)).or_insert_with(|| {
            let first = member.copy_name(0);
            let place = if member.element.is_empty() { &member.name } else { &first };
            let extents: Vec<String> = member.extents.iter().map(u32::to_string).collect();
            found.push(Pending {
                name: member.name.clone(),
                class: member.class,
                depth: of.depth + 1,
                shape: extents.join(","),
                copies: 0,
                documentation: member.documentation.clone(),
                instance: below(&of.instance, &first),
                place: below(&of.place, place),
            });
            found.len() - 1
        });
        let one = &mut found[position];
        one.copies += of.copies * u64::from(member.copies());
        if !member.element.is_empty() {
            one.shape = (one.copies / of.copies.max(1)).to_string();
        }
    }
    let mut first: HashMap<&str, usize> = HashMap::new();
    for (position, member) in members.iter().enumerate() {
        first.entry(&member.name).or_insert(position);
    }
    found.sort_by_key(|one| first.get(one.name.as_str()).copied());
    found
}

fn is_system(class: &Class) -> bool {
    let mut inputs = class.variables_of(|kind| matches!(kind, VariableKind::Input { .. }));
    matches!(class.body, Body::Composite(_)) && inputs.next().is_none() && class.input_events.is_empty()
}

fn kind(class: &Class) -> &'static str {
    match &class.body {
        Body::Automaton(automaton) if automaton.logic => "LBC",
        Body::Automaton(_) => "CTC",
        Body::Discrete(_) => "DTC",
        Body::Composite(_) => "CC",
    }
}
