use crate::class::{Class, ClassIndex, VariableId, VariableKind};

/// What was written, names resolved and checked: classes of components, and which of them a run is started on.
///
/// A model that exists is correct: it can be flattened and run once its inputs are given. Copies of a component
/// are not stored: a composite names its members and how many copies there are of each, and every copy refers to
/// the one class. A model that is a single component has no composite; its variables have no prefix.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// All classes; members come before the composites that hold them.
    pub classes: Vec<Class>,
    /// What a run is started on.
    pub root: ClassIndex,
    /// Texts that strings can be, by number (see [`Quantity::Text`]).
    pub texts: Vec<String>,
    /// Tables and signal files, by number.
    pub tables: Vec<Table>,
}

/// What kind of value a variable has. In expressions every value is a number or a truth value; texts are
/// numbered by [`Model::texts`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// A real number.
    #[default]
    Real,
    /// A whole number.
    Integer,
    /// `true` or `false`; 1 or 0 where it is stored.
    Boolean,
    /// One of the model's texts.
    Text,
}

/// Values over a grid: a column of a file over another one.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// File and column, for messages.
    pub name: String,
    /// Strictly increasing.
    pub knots: Vec<f64>,
    /// One per knot.
    pub values: Vec<f64>,
    /// What holds between the knots.
    pub between: Interpolation,
    /// What holds beyond the last knot: the last value if `true`, else nothing, and a run that gets there stops.
    pub extends: bool,
}

/// What a table is between its knots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Interpolation {
    /// The value at the knot before.
    Hold,
    /// A straight line.
    Linear,
    /// A natural cubic spline.
    Cubic,
}

impl Model {
    /// A class.
    pub fn class(&self, index: ClassIndex) -> &Class {
        &self.classes[index.0 as usize]
    }

    /// The class a run is started on.
    pub fn root(&self) -> &Class {
        self.class(self.root)
    }

    /// Name of the whole.
    pub fn name(&self) -> &str {
        self.classes.get(self.root.0 as usize).map_or("", |class| &class.name)
    }

    /// The number of a text, entered if it is new.
    pub fn text_number(texts: &mut Vec<String>, text: &str) -> usize {
        texts.iter().position(|known| known == text).unwrap_or_else(|| {
            texts.push(text.to_owned());
            texts.len() - 1
        })
    }
}

impl Class {
    /// A variable.
    pub fn variable(&self, id: VariableId) -> &crate::Variable {
        &self.variables[id.0 as usize]
    }

    /// Ids of all variables that satisfy `kind`, in written order.
    pub fn variables_of(&self, kind: impl Fn(VariableKind) -> bool) -> impl Iterator<Item = VariableId> {
        let numbered = self.variables.iter().enumerate();
        numbered.filter(move |(_, v)| kind(v.kind)).map(|(position, _)| VariableId(position as u32))
    }

    /// The variable of a name.
    pub fn variable_named(&self, name: &str) -> Option<VariableId> {
        self.variables.iter().position(|v| v.name == name).map(|position| VariableId(position as u32))
    }
}
