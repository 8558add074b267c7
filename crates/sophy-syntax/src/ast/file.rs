//! Files, and what stands in them outside of bodies.

use super::{
    Body, Expression, Name, View, bracketed, child, children, expression_after, expressions, keyword,
    name_at, name_of_token, names, tokens,
};
use crate::kinds::{SyntaxKind, SyntaxNode, SyntaxToken};
use std::ops::Range;

view! {
    /// A whole file.
    File = Root;
    /// `import "other.hsml";`.
    Import = Import;
    /// `constant g = 9.82 "m/s2";`.
    Constant = Constant;
    /// `function f(a, b : real[3]) : real = e;`.
    Function = Function;
    /// A parameter of a [`Function`].
    FunctionParameter = FunctionParameter;
    /// `CTC Name is …`.
    Component = Component;
    /// `interface … end interface;`.
    Interface = Interface;
    /// `input(u, signal, (0, 1), "N");` and the like.
    InterfaceItem = InterfaceItem;
    /// `real[3]`.
    Type = Type;
    /// `(0, 5)` or `{"high", "low"}`.
    ValueRange = ValueRange;
    /// `"m/s"`.
    Unit = Unit;
}

views_of! {
    /// An item of a file.
    FileItem: Import, Constant, Function, Component;
}

impl File {
    /// What stands in it, in order.
    pub fn items(&self) -> impl Iterator<Item = FileItem> + use<> {
        children(self.syntax())
    }
}

impl Import {
    /// The path, without quotes.
    pub fn path(&self) -> Option<Name> {
        string_of(self.syntax())
    }
}

impl Constant {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// The type after `:`.
    pub fn declared_type(&self) -> Option<Type> {
        child(self.syntax())
    }

    /// The expression after `=`.
    pub fn value(&self) -> Option<Expression> {
        expression_after(self.syntax(), SyntaxKind::Equal)
    }

    /// The unit after it.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

impl Function {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// Its parameters, in order.
    pub fn parameters(&self) -> impl Iterator<Item = FunctionParameter> + use<> {
        self.syntax()
            .children()
            .filter(|node| node.kind() == SyntaxKind::FunctionParameters)
            .flat_map(|node| children(&node))
    }

    /// The type of its value.
    pub fn value_type(&self) -> Option<Type> {
        child(self.syntax())
    }

    /// The expression after `=`.
    pub fn value(&self) -> Option<Expression> {
        expression_after(self.syntax(), SyntaxKind::Equal)
    }
}

impl FunctionParameter {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 0)
    }

    /// The type after `:`.
    pub fn declared_type(&self) -> Option<Type> {
        child(self.syntax())
    }
}

/// What a component is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ComponentKind {
    /// Continuous-time component.
    Ctc,
    /// Discrete-time component.
    Dtc,
    /// Logic-based component.
    Lbc,
    /// Composite component.
    Cc,
    /// A composite without inputs, on which a run is started.
    System,
}

impl Component {
    /// What it is; `None` if its word is none of the known ones.
    pub fn kind(&self) -> Option<ComponentKind> {
        match self.kind_word()?.text.as_str() {
            "CTC" => Some(ComponentKind::Ctc),
            "DTC" => Some(ComponentKind::Dtc),
            "LBC" => Some(ComponentKind::Lbc),
            "CC" => Some(ComponentKind::Cc),
            "SYSTEM" | "System" => Some(ComponentKind::System),
            _ => None,
        }
    }

    /// The word that says what it is.
    pub fn kind_word(&self) -> Option<Name> {
        name_at(self.syntax(), 0)
    }

    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// Its interface.
    pub fn interface(&self) -> Option<Interface> {
        child(self.syntax())
    }

    /// All interfaces: more than one is a mistake.
    pub fn interfaces(&self) -> impl Iterator<Item = Interface> + use<> {
        children(self.syntax())
    }

    /// Its body.
    pub fn body(&self) -> Option<Body> {
        child(self.syntax())
    }

    /// All bodies: more than one is a mistake.
    pub fn bodies(&self) -> impl Iterator<Item = Body> + use<> {
        children(self.syntax())
    }
}

impl Interface {
    /// Its items, in order.
    pub fn items(&self) -> impl Iterator<Item = InterfaceItem> + use<> {
        children(self.syntax())
    }
}

/// What an item of an interface is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum InterfaceItemKind {
    Input,
    Output,
    Knob,
    /// `view` or `scope`.
    View,
    Sync,
}

impl InterfaceItem {
    /// What it is; `None` if its word is none of the known ones.
    pub fn kind(&self) -> Option<InterfaceItemKind> {
        match keyword(self.syntax())?.text() {
            "input" => Some(InterfaceItemKind::Input),
            "output" => Some(InterfaceItemKind::Output),
            "knob" => Some(InterfaceItemKind::Knob),
            "view" | "scope" => Some(InterfaceItemKind::View),
            "sync" => Some(InterfaceItemKind::Sync),
            _ => None,
        }
    }

    /// Where the word that says so stands.
    pub fn kind_range(&self) -> Option<Range<usize>> {
        keyword(self.syntax()).map(|token| token.text_range().into())
    }

    /// Its name.
    pub fn name(&self) -> Option<Name> {
        let open = |token: &SyntaxToken| token.kind() != SyntaxKind::LeftParenthesis;
        tokens(self.syntax()).skip_while(open).nth(1).and_then(|token| name_of_token(&token))
    }

    /// Its type.
    pub fn declared_type(&self) -> Option<Type> {
        child(self.syntax())
    }

    /// The values it may take.
    pub fn value_range(&self) -> Option<ValueRange> {
        child(self.syntax())
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

impl Type {
    /// Its name, as `real`.
    pub fn name(&self) -> Option<Name> {
        names(self.syntax()).next()
    }

    /// The numbers of rows and columns in brackets; none for a scalar.
    pub fn shape(&self) -> Vec<Expression> {
        bracketed(self.syntax(), SyntaxKind::Shape)
    }
}

impl ValueRange {
    /// Whether it lists its values, as `{1, 2}`, rather than giving bounds.
    pub fn is_list(&self) -> bool {
        tokens(self.syntax()).next().is_some_and(|token| token.kind() == SyntaxKind::LeftBrace)
    }

    /// The bounds or the values, in order.
    pub fn values(&self) -> Vec<Expression> {
        expressions(self.syntax()).collect()
    }
}

impl Unit {
    /// Its text without quotes, and where it stands.
    pub fn text(&self) -> Option<Name> {
        string_of(self.syntax())
    }
}

/// The string in a node, without quotes.
fn string_of(node: &SyntaxNode) -> Option<Name> {
    let token = tokens(node).find(|token| token.kind() == SyntaxKind::String)?;
    let text = token.text().trim_matches(['"', '“', '”', '„']).to_owned();
    Some(Name { text, range: token.text_range().into() })
}
