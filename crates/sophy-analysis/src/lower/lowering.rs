use super::expression::Reader;
use super::files::Files;
use super::scope::{Place, SymbolValue, Symbols};
use super::typed::{Shape, Typed, Varies};
use crate::checks::{hs0210_wrong_kind, hs0211_shape, hs0213_not_known};
use crate::declarations::{Dialect, ExpressionText};
use crate::findings::Findings;
use crate::units::Measured;
use sophy_diagnostics::{Diagnostic, Span};
use sophy_ir::{Comparison, Graph, Leaf, Node, NodeId, Quantity, Special, Value, evaluate};
use std::collections::BTreeSet;

/// Lowers expressions of a component to its graph.
///
/// After a mistake it goes on, to find others, and gives `None`. Of an expression that is not well formed, whose
/// structure is a guess, only unknown names are reported.
pub(crate) struct Lowering<'l, 'a> {
    pub(crate) graph: &'l mut Graph,
    /// See [`sophy_ir::Class::specials`].
    pub(crate) specials: &'l mut Vec<Special>,
    pub(crate) symbols: &'l mut Symbols<'a>,
    pub(crate) place: Place,
    pub(crate) findings: &'l mut Findings,
    /// See [`sophy_ir::Model::texts`].
    pub(crate) texts: &'l mut Vec<String>,
    pub(crate) files: &'l mut Files<'a>,
    pub(crate) dialect: Dialect,
    /// Parameters whose values have decided something of the structure: an extent, an index, the bounds of a loop.
    pub(crate) structural: &'l mut BTreeSet<String>,
}

/// What the right-hand side of an equation or assignment must be.
#[derive(Clone, Debug)]
pub(crate) struct Expected {
    pub(crate) shape: Shape,
    pub(crate) quantity: Quantity,
    pub(crate) measured: Measured,
    /// Texts it may be; empty if any.
    pub(crate) choices: Vec<usize>,
    /// What gets the value, as a subject: `` `der(x)` ``, `` input `u` of `relay` ``.
    pub(crate) what: String,
    /// Where that stands, for a label.
    pub(crate) span: Option<Span>,
}

impl Expected {
    /// What a variable of the class can be.
    pub(crate) fn of(typed: &Typed, what: impl Into<String>, span: Option<Span>) -> Self {
        Expected {
            shape: typed.shape,
            quantity: typed.quantity,
            measured: typed.measured,
            choices: Vec::new(),
            what: what.into(),
            span,
        }
    }
}

impl<'a> Lowering<'_, 'a> {
    /// The value of an expression.
    pub(crate) fn value(&mut self, text: &ExpressionText) -> Option<Typed> {
        let expression = text.expression.as_ref()?;
        let value = Reader { lowering: self, text, untaken: false }.expression(expression);
        value.filter(|_| text.well_formed)
    }

    /// The value of an expression that must be of a certain kind; see [`Lowering::fit`].
    pub(crate) fn value_for(&mut self, text: &ExpressionText, expected: &Expected) -> Option<Typed> {
        let value = self.value(text)?;
        self.fit(value, text.span, expected)
    }

    /// A single truth value; the node is boolean.
    pub(crate) fn condition(&mut self, text: &ExpressionText) -> Option<NodeId> {
        let expression = text.expression.as_ref()?;
        let value = Reader { lowering: self, text, untaken: false }.condition(Some(expression));
        value.filter(|_| text.well_formed)?.node()
    }

    /// A single number.
    pub(crate) fn scalar(&mut self, text: &ExpressionText) -> Option<Typed> {
        let expression = text.expression.as_ref()?;
        let value = Reader { lowering: self, text, untaken: false }.number(Some(expression));
        let value = value.filter(|_| text.well_formed)?;
        if value.shape != Shape::Scalar {
            let written = text.text.get(expression.range()).unwrap_or("");
            self.report(hs0211_shape::not_single(text.span, written, value.shape));
            return None;
        }
        Some(value)
    }

    /// A whole number that is needed to build the class; `what` is it, in messages: `the extent of a vector`.
    pub(crate) fn constant_integer(&mut self, text: &ExpressionText, what: &str) -> Option<i64> {
        let number = self.constant_number(text, what)?;
        match whole(number) {
            Some(integer) => Some(integer),
            None => {
                self.report(hs0210_wrong_kind::not_whole(text.span, what, number));
                None
            }
        }
    }

    /// A number that is needed to build the class.
    pub(crate) fn constant_number(&mut self, text: &ExpressionText, what: &str) -> Option<f64> {
        let value = self.scalar(text)?;
        let known = self.known(&value);
        if known.is_none() {
            self.report(hs0213_not_known::diagnostic(text.span, what));
        }
        known?.first().copied()
    }

    /// The numbers of a value (1 and 0 for truth values), if they follow from what is written and from known
    /// values of parameters. The parameters are noted as structural.
    pub(crate) fn known(&mut self, value: &Typed) -> Option<Vec<f64>> {
        let mut parameters = Vec::new();
        let numbers = self.evaluated(value, &mut parameters)?;
        self.structural.extend(parameters);
        Some(numbers)
    }

    /// The same, without consequences; `parameters` gets the names of those that were used.
    pub(crate) fn evaluated(&self, value: &Typed, parameters: &mut Vec<String>) -> Option<Vec<f64>> {
        if value.varies > Varies::Parameters {
            return None;
        }
        let mut numbers = Vec::with_capacity(value.elements.as_slice().len());
        for &node in value.elements.as_slice() {
            if let Some(number) = self.graph.as_number(node) {
                numbers.push(number);
                continue;
            }
            let mut complete = true;
            let result = evaluate(self.graph, node, &mut |leaf| {
                let known = match leaf {
                    Leaf::Variable(id) => self.symbols.known_value(id),
                    _ => None,
                };
                match known {
                    Some((name, number)) => {
                        parameters.push(name.to_owned());
                        Value::Real(number)
                    }
                    None => {
                        complete = false;
                        Value::Real(f64::NAN)
                    }
                }
            });
            if !complete {
                return None;
            }
            numbers.push(result.real());
        }
        Some(numbers)
    }

    /// The variable or variables of a name of the component, as a reference to it gives them.
    pub(crate) fn variable(&mut self, name: &str) -> Option<Typed> {
        match self.symbols.get(name)?.value.clone() {
            SymbolValue::Variable(variable) => {
                Some(self.leaves(&variable, 0..variable.shape.len(), variable.shape))
            }
            SymbolValue::Bound(value) => Some(value),
            _ => None,
        }
    }

    /// The nodes under which elements are stored: 1 and 0 for truth values, all others as they are.
    pub(crate) fn stored(&mut self, value: &Typed) -> Vec<NodeId> {
        let elements = value.elements.as_slice();
        if value.quantity != Quantity::Boolean {
            return elements.to_vec();
        }
        let truth_as_number = |&node: &NodeId| {
            // A variable that is only passed on needs no decision.
            if let Node::Compare(Comparison::Greater, left, right) = self.graph.node(node)
                && let Node::Leaf(Leaf::Variable(id)) = self.graph.node(left)
                && self.graph.as_number(right) == Some(0.5)
                && self.symbols.is_boolean(id)
            {
                return left;
            }
            let (one, zero) = (self.graph.number(1.0), self.graph.number(0.0));
            self.graph.select(node, one, zero)
        };
        elements.iter().map(truth_as_number).collect()
    }

    /// Truth values of what is stored as numbers.
    pub(super) fn truths(&mut self, numbers: &[NodeId]) -> Vec<NodeId> {
        let half = self.graph.number(0.5);
        numbers.iter().map(|&node| self.graph.compare(Comparison::Greater, node, half)).collect()
    }

    /// A leaf of its own for what is read besides variables and time.
    pub(super) fn special(&mut self, special: Special) -> NodeId {
        /// How far back an equal one is looked for, so that a long list costs no quadratic search.
        const RECENT: usize = 64;
        let start = self.specials.len().saturating_sub(RECENT);
        let is_new_draw = matches!(special, Special::Chance(_));
        let equal = self.specials[start..].iter().position(|known| *known == special && !is_new_draw);
        let position = match equal {
            Some(position) => start + position,
            None => {
                self.specials.push(special);
                self.specials.len() - 1
            }
        };
        self.graph.leaf(Leaf::Special(u32::try_from(position).unwrap_or(u32::MAX)))
    }

    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.findings.report(diagnostic);
    }
}

/// The integer that a number is.
pub(super) fn whole(number: f64) -> Option<i64> {
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    (number.fract() == 0.0 && number.abs() <= LARGEST).then_some(number as i64)
}
