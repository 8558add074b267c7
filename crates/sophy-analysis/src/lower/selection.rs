//! `x[i]`, `J[i, j]`, `auv.drag.x[3]`.

use super::expression::Reader;
use super::lowering::whole;
use super::record::{Entry, Record};
use super::scope::{Numbers, SymbolKind, SymbolValue, VariableSymbol};
use super::typed::{Shape, Typed};
use crate::checks::{hs0212_index, hs0213_not_known, hs0217_no_such_part};
use sophy_diagnostics::Span;
use sophy_syntax::ast::{Expression, Part};
use std::ops::Range;
use std::rc::Rc;

/// What indices select from. Of a variable only the elements that are asked for become nodes.
enum Base {
    Value(Typed),
    Variable(VariableSymbol),
    Numbers(Numbers),
}

impl Base {
    fn shape(&self) -> Shape {
        match self {
            Base::Value(value) => value.shape,
            Base::Variable(variable) => variable.shape,
            Base::Numbers(numbers) => numbers.shape,
        }
    }
}

impl Reader<'_, '_, '_> {
    /// A base with indices and members after it.
    pub(super) fn selection(
        &mut self,
        base: Option<Expression>,
        parts: Vec<Part>,
        range: Range<usize>,
    ) -> Option<Typed> {
        let base = base?;
        let written = self.written(&base);
        let name = match &base {
            Expression::Reference(reference) => reference.name(),
            _ => None,
        };
        let symbol = name.as_ref().and_then(|name| self.lowering.symbols.get(name)).cloned();
        let mut parts = parts.into_iter();
        let mut base = match (symbol, name) {
            (Some(symbol), Some(name)) => match symbol.value {
                SymbolValue::Record(record) => {
                    self.lowering.symbols.look_up(&name);
                    self.entry(&name, record, &mut parts)?
                }
                SymbolValue::Variable(variable)
                    if variable.varies <= self.lowering.place.most && !variable.is_coming() =>
                {
                    self.lowering.symbols.look_up(&name);
                    Base::Variable(variable)
                }
                SymbolValue::Numbers(numbers) => {
                    self.lowering.symbols.look_up(&name);
                    Base::Numbers(Numbers::clone(&numbers))
                }
                SymbolValue::None if symbol.kind == SymbolKind::Member => {
                    let span = self.span(range);
                    self.report(hs0217_no_such_part::port(span, &name));
                    return None;
                }
                _ => Base::Value(self.expression(&base)?),
            },
            _ => Base::Value(self.expression(&base)?),
        };
        for part in parts {
            base = match part {
                Part::Member(member, at) => {
                    let span = self.span(at);
                    self.report(hs0217_no_such_part::no_parts(span, &written, &member));
                    return None;
                }
                Part::Indices(indices, at) => self.indexed(base, &indices, at, &written)?,
            };
        }
        Some(match base {
            Base::Value(value) => value,
            Base::Variable(variable) => {
                self.lowering.leaves(&variable, 0..variable.shape.len(), variable.shape)
            }
            Base::Numbers(numbers) => self.lowering.numbers(&numbers),
        })
    }

    fn indexed(
        &mut self,
        base: Base,
        indices: &[Expression],
        at: Range<usize>,
        written: &str,
    ) -> Option<Base> {
        let shape = base.shape();
        let positions = self.positions(indices, shape, at, written)?;
        let (range, selected) = match (shape, positions.as_slice()) {
            (Shape::Vector(_), &[i]) => (i..i + 1, Shape::Scalar),
            (Shape::Matrix(_, columns), &[row]) => {
                (row * columns..(row + 1) * columns, Shape::Vector(columns))
            }
            (Shape::Matrix(_, columns), &[row, column]) => {
                let position = row * columns + column;
                (position..position + 1, Shape::Scalar)
            }
            _ => return None,
        };
        Some(match base {
            Base::Value(value) => {
                let elements = value.elements.as_slice().get(range)?.to_vec();
                Base::Value(value.with(selected, elements))
            }
            Base::Variable(variable) => Base::Value(self.lowering.leaves(&variable, range, selected)),
            Base::Numbers(numbers) => {
                let elements = numbers.elements.get(range)?.to_vec();
                Base::Numbers(Numbers { elements, shape: selected, ..numbers })
            }
        })
    }

    /// Indices from 0, of which there are as many as `shape` allows; each within its extent.
    fn positions(
        &mut self,
        indices: &[Expression],
        shape: Shape,
        at: Range<usize>,
        written: &str,
    ) -> Option<Vec<usize>> {
        let extents = shape.extents();
        let mut positions = Vec::new();
        for (place, index) in indices.iter().enumerate() {
            let number = self.known_integer(index, "an index");
            let extent = extents.get(place).copied();
            positions.push(number.zip(extent).and_then(|(number, extent)| {
                let position = usize::try_from(number).ok().and_then(|n| n.checked_sub(1));
                let found = position.filter(|&position| position < extent);
                if found.is_none() {
                    let span = self.span(index.range());
                    self.report(hs0212_index::out_of_bounds(span, written, number, extent, shape));
                }
                found
            }));
        }
        if indices.len() > extents.len() || indices.is_empty() {
            if !indices.is_empty() {
                let span = self.span(at);
                self.report(hs0212_index::wrong_number(span, written, indices.len(), shape));
            }
            return None;
        }
        positions.into_iter().collect()
    }

    /// A whole number that must be known before a run.
    pub(super) fn known_integer(&mut self, expression: &Expression, what: &str) -> Option<i64> {
        let value = self.single(Some(expression))?;
        let span = self.span(expression.range());
        let Some(number) = self.lowering.known(&value).and_then(|numbers| numbers.first().copied()) else {
            self.not_known(span, what);
            return None;
        };
        if whole(number).is_none() {
            self.report(hs0212_index::not_whole(span, what, number));
        }
        whole(number)
    }

    /// In the check of a function that nothing calls yet, its arguments may decide.
    pub(super) fn not_known(&mut self, span: Span, what: &str) {
        if !self.lowering.symbols.unapplied {
            self.report(hs0213_not_known::diagnostic(span, what));
        }
    }

    /// Follows members through a record until there is a value.
    fn entry(
        &mut self,
        name: &str,
        record: Rc<Record>,
        parts: &mut impl Iterator<Item = Part>,
    ) -> Option<Base> {
        let mut path = name.to_owned();
        let mut entry = Entry::Record(record);
        let mut end: Option<Span> = None;
        loop {
            match (&entry, end) {
                (Entry::Numbers(numbers), _) => return Some(Base::Numbers(numbers.clone())),
                (Entry::Text(text), _) => {
                    let text = text.clone();
                    return Some(Base::Value(self.lowering.text(&text)));
                }
                (Entry::Unusable(reason), Some(span)) => {
                    let reason = *reason;
                    self.report(hs0217_no_such_part::unusable(span, &path, reason));
                    return None;
                }
                _ => {}
            }
            let part = parts.next();
            entry = match (entry, part) {
                (Entry::Record(record), Some(Part::Member(member, at))) => {
                    let span = self.span(at);
                    let Some(inner) = record.entries.get(&member) else {
                        let entries: Vec<&str> = record.entries.keys().map(String::as_str).collect();
                        self.report(hs0217_no_such_part::diagnostic(span, &path, &member, &entries));
                        return None;
                    };
                    path = format!("{path}.{member}");
                    end = Some(span);
                    inner.clone()
                }
                (Entry::List(list), Some(Part::Indices(indices, at))) => {
                    let positions = self.positions(&indices, Shape::Vector(list.len()), at, &path)?;
                    path = format!("{path}[…]");
                    Entry::Record(list.get(*positions.first()?)?.clone())
                }
                (Entry::Record(_), Some(Part::Indices(_, at))) => {
                    let span = self.span(at);
                    self.report(hs0217_no_such_part::record_indexed(span, &path));
                    return None;
                }
                (Entry::Record(record), None) => {
                    let entries: Vec<&str> = record.entries.keys().map(String::as_str).collect();
                    let span = end?;
                    self.report(hs0217_no_such_part::whole_record(span, &path, &entries));
                    return None;
                }
                (_, part) => {
                    let at = match part {
                        Some(Part::Member(_, at) | Part::Indices(_, at)) => self.span(at),
                        None => end?,
                    };
                    self.report(hs0217_no_such_part::whole_list(at, &path));
                    return None;
                }
            };
        }
    }
}
