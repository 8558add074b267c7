use super::checks::Strays;
use super::statements::{assigned_names, equation_names};
use crate::checks::hs0135_index;
use crate::declarations::{ComponentDeclaration, ExpressionText, Spanned};
use crate::findings::Findings;
use crate::lower::{Files, Globals, Lowering, Place, Shape, Symbols, Typed, Varies};
use crate::units::Measured;
use sophy_diagnostics::{Diagnostic, Sources};
use sophy_ir::{Graph, Leaf, NodeId, Quantity, Special, Value, Variable, VariableId, evaluate};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// What the analysis of all components shares.
pub(crate) struct Shared<'a> {
    pub(crate) findings: Findings,
    /// See [`sophy_ir::Model::texts`].
    pub(crate) texts: Vec<String>,
    pub(crate) files: Files<'a>,
    pub(crate) globals: Rc<Globals<'a>>,
    pub(crate) sources: &'a Sources,
}

/// Parameters that a class is specialised to.
pub(crate) type Given = BTreeMap<String, GivenValue>;

/// What a class is made for in the place of a parameter's own value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct GivenValue {
    pub(crate) shape: Shape,
    /// Element by element; `None` if each copy of the class has its own.
    pub(crate) values: Option<Vec<f64>>,
}

/// A class while it is made.
pub(crate) struct Builder<'b, 'a> {
    pub(crate) declaration: &'a ComponentDeclaration,
    pub(crate) shared: &'b mut Shared<'a>,
    pub(crate) given: &'b Given,
    pub(crate) symbols: Symbols<'a>,
    pub(crate) graph: Graph,
    pub(crate) specials: Vec<Special>,
    pub(crate) variables: Vec<Variable>,
    /// Parameters whose values have decided something of the structure.
    pub(crate) structural: BTreeSet<String>,
    /// Values of parameters, where they are known.
    pub(crate) values: HashMap<VariableId, f64>,
    pub(crate) strays: Strays,
    /// Locations of the variables that exist there only.
    pub(crate) homes: BTreeMap<VariableId, usize>,
    /// Names that some `:=` section assigns.
    pub(crate) assigned: BTreeSet<&'a str>,
    /// Names that some equation defines.
    pub(crate) with_equation: BTreeSet<&'a str>,
    /// Names that were suggested for misspelt ones, and so count as used.
    pub(crate) suggested: BTreeSet<String>,
    /// What equations of a discrete-time component define.
    pub(crate) defined_values: BTreeSet<VariableId>,
    /// What constraints with mistakes read: they may have been meant to determine it.
    pub(crate) constrained: BTreeSet<String>,
}

impl<'b, 'a> Builder<'b, 'a> {
    pub(crate) fn new(
        declaration: &'a ComponentDeclaration,
        shared: &'b mut Shared<'a>,
        given: &'b Given,
    ) -> Self {
        let mut symbols = Symbols::new(Rc::clone(&shared.globals));
        symbols.locations = declaration.locations.iter().map(|l| l.name.value.clone()).collect();
        Builder {
            declaration,
            shared,
            given,
            symbols,
            graph: Graph::default(),
            specials: Vec::new(),
            variables: Vec::new(),
            structural: BTreeSet::new(),
            values: HashMap::new(),
            strays: Strays::default(),
            homes: BTreeMap::new(),
            assigned: assigned_names(declaration).into_keys().collect(),
            with_equation: equation_names(declaration).into_keys().collect(),
            suggested: BTreeSet::new(),
            defined_values: BTreeSet::new(),
            constrained: BTreeSet::new(),
        }
    }

    /// Lowers expressions that stand at a place.
    pub(crate) fn at(&mut self, place: Place) -> Lowering<'_, 'a> {
        Lowering {
            graph: &mut self.graph,
            specials: &mut self.specials,
            symbols: &mut self.symbols,
            place,
            findings: &mut self.shared.findings,
            texts: &mut self.shared.texts,
            files: &mut self.shared.files,
            dialect: self.declaration.dialect,
            structural: &mut self.structural,
        }
    }

    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.shared.findings.report(diagnostic);
    }

    /// Does something whose mistakes are reported when it is done again.
    pub(crate) fn silently<T>(&mut self, work: impl FnOnce(&mut Self) -> T) -> T {
        let findings = std::mem::take(&mut self.shared.findings);
        let result = work(self);
        self.shared.findings = findings;
        result
    }

    /// The number of an expression over parameters, where their values are known.
    pub(crate) fn known_value(&self, node: NodeId) -> Option<f64> {
        let mut all = true;
        let value = evaluate(&self.graph, node, &mut |leaf| match leaf {
            Leaf::Variable(id) => Value::Real(self.values.get(&id).copied().unwrap_or_else(|| {
                all = false;
                f64::NAN
            })),
            _ => {
                all = false;
                Value::Real(f64::NAN)
            }
        });
        all.then(|| value.real())
    }

    /// A whole number, such as a priority; `fallback` if nothing is written.
    pub(crate) fn whole_number(
        &mut self,
        text: Option<&ExpressionText>,
        what: &'static str,
        fallback: i32,
    ) -> i32 {
        let Some(text) = text else { return fallback };
        let value = self.at(Place::PARAMETER).constant_integer(text, what);
        value.and_then(|value| i32::try_from(value).ok()).unwrap_or(fallback)
    }

    /// A whole number as a value.
    pub(crate) fn integer(&mut self, value: i64) -> Typed {
        let number = value as f64;
        let node = self.graph.number(number);
        Typed::scalar(node, Quantity::Integer, Measured::literal(number), Varies::Never)
    }

    /// Positions, from 0, of the elements that indices select: all, a row, or one.
    pub(crate) fn positions(
        &mut self,
        name: &Spanned<String>,
        indices: &'a [ExpressionText],
        shape: Shape,
    ) -> Option<Vec<usize>> {
        let extents = shape.extents();
        let mut numbers = Vec::with_capacity(indices.len());
        for (place, index) in indices.iter().enumerate() {
            let place_of_index = Place { what: "an index", ..Place::PARAMETER };
            let number = self.at(place_of_index).constant_integer(index, "an index")?;
            let Some(&extent) = extents.get(place) else {
                self.report(hs0135_index::too_many(name, indices.len(), &shape.to_string(), index.span));
                return None;
            };
            match usize::try_from(number) {
                Ok(number) if (1..=extent).contains(&number) => numbers.push(number - 1),
                _ => {
                    self.report(hs0135_index::outside(name, number, extent, index.span));
                    return None;
                }
            }
        }
        Some(match (shape, numbers.as_slice()) {
            (_, []) => (0..shape.len()).collect(),
            (Shape::Matrix(_, columns), &[row]) => (row * columns..(row + 1) * columns).collect(),
            (Shape::Matrix(_, columns), &[row, column, ..]) => vec![row * columns + column],
            (_, &[position, ..]) => vec![position],
        })
    }

    /// Ids of the elements of a variable.
    pub(crate) fn elements(first: VariableId, count: usize) -> impl Iterator<Item = VariableId> {
        (0..count).map(move |k| VariableId(first.0 + k as u32))
    }
}
