//! Composites and values of parameters.

use super::{Expression, ForLoop, Name, Unit, View, bracketed, child, children, expressions, name_at, names};
use crate::kinds::{SyntaxElement, SyntaxKind, SyntaxNode};

view! {
    /// `components … end components;`.
    ComponentsSection = ComponentsSection;
    /// `name[i] : Type(p : 1)[3, 4];`.
    Instance = Instance;
    /// `p : 1` of an [`Instance`].
    InstanceArgument = InstanceArgument;
    /// `connections … end connections;`.
    ConnectionsSection = ConnectionsSection;
    /// `a.b[i] -> c.d;`.
    Connection = Connection;
    /// `compose a, b with [[1]];`.
    Compose = Compose;
    /// `a.b[i]`.
    Port = Port;
    /// `assignments … end assignments;`.
    AssignmentsSection = AssignmentsSection;
    /// `g : 9.82 "m/s2";`.
    Assignment = Assignment;
}

views_of! {
    /// An item of `components`.
    ComponentsItem: Instance, ForLoop;
    /// An item of `connections`.
    ConnectionsItem: Connection, Compose, ForLoop;
}

impl ComponentsSection {
    /// What stands in it, in order.
    pub fn items(&self) -> impl Iterator<Item = ComponentsItem> + use<> {
        children(self.syntax())
    }
}

impl Instance {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 0)
    }

    /// The indices after its name, as in `craft[i] : …`.
    pub fn indices(&self) -> Vec<Expression> {
        bracketed(self.syntax(), SyntaxKind::Indices)
    }

    /// The component it is a copy of.
    pub fn component(&self) -> Option<Name> {
        super::tokens(self.syntax())
            .skip_while(|token| token.kind() != SyntaxKind::Colon)
            .nth(1)
            .and_then(|token| super::name_of_token(&token))
    }

    /// The values of its parameters.
    pub fn arguments(&self) -> impl Iterator<Item = InstanceArgument> + use<> {
        self.syntax()
            .children()
            .filter(|node| node.kind() == SyntaxKind::InstanceArguments)
            .flat_map(|node| children(&node))
    }

    /// The numbers of copies, as in `Cell[3, 4]`; none for a single one.
    pub fn shape(&self) -> Vec<Expression> {
        bracketed(self.syntax(), SyntaxKind::Shape)
    }
}

impl InstanceArgument {
    /// The parameter.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 0)
    }

    /// After `:`.
    pub fn value(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

impl ConnectionsSection {
    /// What stands in it, in order.
    pub fn items(&self) -> impl Iterator<Item = ConnectionsItem> + use<> {
        children(self.syntax())
    }
}

impl Connection {
    /// Left of `->`.
    pub fn source(&self) -> Option<Port> {
        self.syntax()
            .children_with_tokens()
            .take_while(|e| e.kind() != SyntaxKind::Arrow)
            .filter_map(SyntaxElement::into_node)
            .find_map(Port::cast)
    }

    /// Right of `->`.
    pub fn target(&self) -> Option<Port> {
        self.syntax()
            .children_with_tokens()
            .skip_while(|e| e.kind() != SyntaxKind::Arrow)
            .filter_map(SyntaxElement::into_node)
            .find_map(Port::cast)
    }
}

impl Compose {
    /// What is composed.
    pub fn parts(&self) -> impl Iterator<Item = Port> + use<> {
        children(self.syntax())
    }

    /// After `with`.
    pub fn matrix(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }
}

/// A name in a [`Port`] and the indices after it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PortPart {
    /// The name.
    pub name: Name,
    /// The indices; none if there are no brackets.
    pub indices: Vec<Expression>,
}

impl Port {
    /// The names between the points, in order: a port alone, or a component and its port.
    pub fn parts(&self) -> Vec<PortPart> {
        let mut parts: Vec<PortPart> =
            names(self.syntax()).map(|name| PortPart { name, indices: Vec::new() }).collect();
        for node in self.syntax().children().filter(|node| node.kind() == SyntaxKind::Indices) {
            let start = usize::from(node.text_range().start());
            if let Some(part) = parts.iter_mut().rfind(|part| part.name.range.end <= start) {
                part.indices.extend(expressions(&node));
            }
        }
        parts
    }
}

impl AssignmentsSection {
    /// The values of parameters, in order.
    pub fn items(&self) -> impl Iterator<Item = Assignment> + use<> {
        children(self.syntax())
    }
}

impl Assignment {
    /// The parameter.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 0)
    }

    /// Its value.
    pub fn value(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}
