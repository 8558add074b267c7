//! `sum(i in 1..n where c : e)`: written out, since the bounds are known before a run.

use super::expression::{LARGEST, Reader};
use super::scope::{Symbol, SymbolKind, SymbolValue};
use super::typed::{Shape, Typed, Varies};
use crate::checks::{
    hs0117_hidden_name, hs0201_unknown_function, hs0209_units, hs0210_wrong_kind, hs0211_shape,
    hs0216_reduction_of_nothing,
};
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Binary, NodeId, Quantity};
use sophy_syntax::ast;

/// Each is a level of recursion.
const MOST_BINDERS: usize = 16;

/// How a reduction combines what its body gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Combination {
    Sum,
    Fold(Binary),
    All,
    Any,
}

impl Combination {
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "sum" => Combination::Sum,
            "min" => Combination::Fold(Binary::Min),
            "max" => Combination::Fold(Binary::Max),
            "all" => Combination::All,
            "any" => Combination::Any,
            _ => return None,
        })
    }

    pub(super) fn is_logical(self) -> bool {
        matches!(self, Combination::All | Combination::Any)
    }
}

impl Reader<'_, '_, '_> {
    pub(super) fn reduction(&mut self, reduction: &ast::Reduction) -> Option<Typed> {
        let name = reduction.name()?;
        let span = self.span(reduction.name_range()?);
        let combination = Combination::named(&name);
        if combination.is_none() {
            self.report(hs0201_unknown_function::not_a_reduction(span, &name));
        }
        let binders = reduction.binders();
        if binders.len() > MOST_BINDERS {
            self.too_large(span, None);
            return None;
        }
        let mut values = Vec::new();
        let complete = self.each(reduction, &binders, &mut values);
        let combination = combination?;
        complete?;
        if let Combination::Fold(_) = combination
            && values.is_empty()
        {
            let range = binders.last().map_or(reduction.range(), |binder| binder.range.clone());
            let diagnostic = hs0216_reduction_of_nothing::diagnostic(self.span(range), &name);
            self.report(diagnostic);
            return None;
        }
        let body = reduction.body()?;
        let at = self.span(body.range());
        let mut kept = Vec::with_capacity(values.len());
        for value in values {
            kept.push(if combination.is_logical() {
                self.truth(value, &body)?
            } else {
                self.as_number(value, &body)?
            });
        }
        self.combined(combination, &name, kept, at)
    }

    fn truth(&mut self, value: Typed, body: &ast::Expression) -> Option<Typed> {
        if !value.is_boolean() {
            let (span, written) = (self.span(body.range()), self.written(body));
            self.report(hs0210_wrong_kind::not_a_truth(span, &written, value.quantity));
            return None;
        }
        self.as_single(value, body)
    }

    /// The values of the body for all values of the binders that are left; stops at the first with a mistake.
    fn each(
        &mut self,
        reduction: &ast::Reduction,
        binders: &[ast::Binder],
        values: &mut Vec<Typed>,
    ) -> Option<()> {
        let Some((binder, others)) = binders.split_first() else {
            if let Some(condition) = reduction.condition() {
                let span = self.span(condition.range());
                let holds = self.condition(Some(&condition))?;
                let Some(numbers) = self.lowering.known(&holds) else {
                    self.not_known(span, "the condition after `where`");
                    return None;
                };
                if numbers.first() == Some(&0.0) {
                    return Some(());
                }
            }
            values.push(self.expression(&reduction.body()?)?);
            return Some(());
        };
        let from = binder.from.as_ref().and_then(|e| self.known_integer(e, "the first value of a range"));
        let to = binder.to.as_ref().and_then(|e| self.known_integer(e, "the last value of a range"));
        let (at, range) = (self.span(binder.name_range.clone()), self.span(binder.range.clone()));
        let mut complete = Some(());
        let symbols = &mut self.lowering.symbols;
        if let Some(hidden) = symbols.get(&binder.name)
            && self.lowering.findings.binders.insert(at)
        {
            let what = hidden.kind.with_article();
            let found = hs0117_hidden_name::declared(&binder.name, at, what, hidden.span);
            self.report(found);
        }
        let (Some(from), Some(to)) = (from, to) else {
            // Other mistakes of the body are looked for all the same.
            let symbols = &mut self.lowering.symbols;
            let mark = symbols.enter();
            let unknown = Symbol { kind: SymbolKind::LoopVariable, span: at, value: SymbolValue::Broken };
            symbols.bind_symbol(&binder.name, unknown);
            self.each(reduction, others, values);
            self.lowering.symbols.leave(mark);
            return None;
        };
        if to.saturating_sub(from) > LARGEST as i64 {
            self.too_large(range, None);
            return None;
        }
        for i in from..=to {
            self.lowering.symbols.work += 1;
            if !self.has_room(range, None) {
                return None;
            }
            let value = self.loop_value(i);
            let mark = self.lowering.symbols.enter();
            self.lowering.symbols.bind(&binder.name, SymbolKind::LoopVariable, at, value);
            complete = self.each(reduction, others, values);
            self.lowering.symbols.leave(mark);
            if complete.is_none() {
                break;
            }
        }
        complete
    }

    fn loop_value(&mut self, i: i64) -> Typed {
        self.number_literal(i as f64, Quantity::Integer)
    }

    /// One value of all; of none the neutral one, which only `sum`, `all` and `any` have.
    pub(super) fn combined(
        &mut self,
        combination: Combination,
        name: &str,
        values: Vec<Typed>,
        at: Span,
    ) -> Option<Typed> {
        let mut values = values.into_iter();
        let Some(mut result) = values.next() else {
            return Some(match combination {
                Combination::All | Combination::Any => {
                    let node = self.graph().boolean(combination == Combination::All);
                    Typed::truth(node, Varies::Never)
                }
                _ => self.number_literal(0.0, Quantity::Integer),
            });
        };
        for value in values {
            if value.shape != result.shape {
                self.report(hs0211_shape::reduced(at, name, (result.shape, value.shape)));
                return None;
            }
            let varies = result.varies.max(value.varies);
            result = match combination {
                Combination::Sum | Combination::Fold(_) => {
                    let operation = match combination {
                        Combination::Fold(operation) => operation,
                        _ => Binary::Add,
                    };
                    if let Combination::Fold(_) = combination
                        && result.shape != Shape::Scalar
                    {
                        self.report(hs0211_shape::not_ordered(at, name, result.shape));
                        return None;
                    }
                    match result.measured.agree(value.measured) {
                        Ok(measured) => self.by_element(operation, &result, &value, measured),
                        Err(mismatch) => {
                            self.report(hs0209_units::reduced(at, name, mismatch));
                            return None;
                        }
                    }
                }
                Combination::All => {
                    Typed::truth(self.lowering.graph.and(result.node()?, value.node()?), varies)
                }
                Combination::Any => {
                    Typed::truth(self.lowering.graph.or(result.node()?, value.node()?), varies)
                }
            };
        }
        // The number of terms is not a literal of the formula.
        if let Measured::Number(_) = result.measured {
            result.measured = Measured::Number(None);
        }
        Some(result)
    }

    /// The elements of an array as single values.
    pub(super) fn elements(&self, value: &Typed) -> Vec<Typed> {
        let single = |&node: &NodeId| value.with(Shape::Scalar, node);
        value.elements.as_slice().iter().map(single).collect()
    }
}
