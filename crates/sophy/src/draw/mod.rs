//! What a drawing of a model shows: of an automaton its locations and transitions, of a composite its members and
//! connections. Arranging and drawing are the business of [`sophy_files::draw`].

mod automaton;
mod composition;
mod notation;
mod ports;
#[cfg(test)]
mod tests;

use sophy_diagnostics::closest;
use sophy_files::Diagram;
use sophy_ir::{Body, ClassIndex, Model};
use std::fmt;

/// There is no such component in a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownComponent {
    /// What was asked for.
    pub name: String,
    /// The name most like it.
    pub closest: Option<String>,
}

impl fmt::Display for UnknownComponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the model has no component `{}`", self.name)?;
        match &self.closest {
            Some(closest) => write!(f, "; there is `{closest}`"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnknownComponent {}

/// The drawing of a model, or of one of its components: `relay`, `left.thruster`, `cell[3]`, or the name that a kind
/// of component was declared with.
///
/// A component with locations or events is drawn as its hybrid automaton, a composite as members and connections (equal
/// members and parallel connections are one, with their number), a discrete-time component as a box.
///
/// # Errors
/// [`UnknownComponent`].
pub fn diagram(model: &Model, component: Option<&str>) -> Result<Diagram, UnknownComponent> {
    let index = match component {
        None => model.root,
        Some(name) => find(model, name)?,
    };
    let Some(class) = model.classes.get(index.0 as usize) else { return Ok(Diagram::default()) };
    let notation = notation::Notation { class, texts: &model.texts };
    Ok(match &class.body {
        Body::Automaton(automaton) => automaton::automaton(notation, automaton),
        Body::Discrete(discrete) => composition::discrete(notation, discrete),
        Body::Composite(composite) => composition::composition(model, class, composite),
    })
}

fn find(model: &Model, name: &str) -> Result<ClassIndex, UnknownComponent> {
    if let Some(index) = along(model, name) {
        return Ok(index);
    }
    let named = model.classes.iter().position(|class| class.name == name);
    if let Some(position) = named {
        return Ok(ClassIndex(position as u32));
    }
    // Of a path that is right but for its end, the members there.
    let (before, holder) = match name.rsplit_once('.') {
        Some((path, _)) => (format!("{path}."), along(model, path)),
        None => (String::new(), Some(model.root)),
    };
    let members = match holder.and_then(|index| model.classes.get(index.0 as usize)).map(|class| &class.body)
    {
        Some(Body::Composite(composite)) => composite.members.as_slice(),
        _ => &[],
    };
    let members: Vec<String> = members.iter().map(|member| format!("{before}{}", member.name)).collect();
    let known = members.iter().map(String::as_str);
    let known = known.chain(model.classes.iter().map(|class| class.name.as_str()));
    Err(UnknownComponent { name: name.to_owned(), closest: closest(name, known).map(str::to_owned) })
}

/// The class at the end of a path such as `left.cell[3]`.
fn along(model: &Model, path: &str) -> Option<ClassIndex> {
    let mut at = model.root;
    for part in path.split('.') {
        let part = notation::without_index(part);
        let Body::Composite(composite) = &model.classes.get(at.0 as usize)?.body else { return None };
        at = composite.members.iter().find(|member| member.name == part)?.class;
    }
    Some(at)
}
