//! What depends on more than the values of the arguments: instants, the past, chance and files.

use super::expression::Reader;
use super::files::Column;
use super::lowering::Lowering;
use super::record::Record;
use super::typed::{Shape, Typed, Varies};
use crate::checks::{hs0209_units, hs0211_shape, hs0215_file, hs0218_derivative, hs0220_wrong_argument};
use crate::declarations::ExpressionText;
use crate::predefined::SpecialFunction;
use crate::units::{Measured, Unit};
use sophy_diagnostics::Span;
use sophy_ir::{Interpolation, NodeId, Quantity, Special};
use sophy_syntax::ast::Expression;
use std::rc::Rc;

impl Reader<'_, '_, '_> {
    /// The number of arguments was checked.
    pub(super) fn special_call(
        &mut self,
        function: SpecialFunction,
        name: &str,
        span: Span,
        written: &[Expression],
    ) -> Option<Typed> {
        use SpecialFunction as S;
        let first = written.first()?;
        match function {
            S::Rises | S::Falls => {
                let condition = self.condition(Some(first));
                self.only_at_instants(name, span)?;
                let node = condition?.node()?;
                let special = if function == S::Rises { Special::Rises(node) } else { Special::Falls(node) };
                let node = self.lowering.special(special);
                Some(Typed::truth(node, Varies::Instants))
            }
            S::Changes => {
                let value = self.expression(first);
                self.only_at_instants(name, span)?;
                let value = self.as_single(value?, first)?;
                let node = self.lowering.special(Special::Changes(value.node()?));
                Some(Typed::truth(node, Varies::Instants))
            }
            S::Chance => {
                let p = self.single(Some(first));
                self.only_at_instants(name, span)?;
                let p = self.within(p?, first, "a probability", |p| (0.0..=1.0).contains(&p))?;
                let node = self.lowering.special(Special::Chance(p.node()?));
                Some(Typed::truth(node, Varies::Instants))
            }
            S::Smooth => {
                let value = self.number(Some(first))?;
                let elements: Vec<NodeId> = value
                    .elements
                    .as_slice()
                    .iter()
                    .map(|&node| self.lowering.special(Special::Smooth(node)))
                    .collect();
                Some(Typed { quantity: Quantity::Real, ..value.with(value.shape, elements) })
            }
            S::Delayed => self.delayed(name, span, written),
            S::Noise => self.noise(name, span, written),
            S::Table => {
                let at = written.get(2)?;
                let value = self.number(Some(at));
                let file = self.string(first, name, "a file: `\"aero.csv\"`");
                let column = self.string(written.get(1)?, name, "a column: `\"Cl\"`");
                let options = self.options(written.get(3..)?, &["linear", "hold", "cubic"]);
                let (file, column, options) = (file?, column?, options?);
                let between = interpolation(&options, Interpolation::Linear);
                let column = Column { file, name: column, knots: None, between, extends: false };
                let spans = (self.span(first.range()), self.span(written.get(1)?.range()));
                self.table(&column, spans, &value?, self.span(at.range()))
            }
            S::SignalFile => {
                let file = self.string(first, name, "a file: `\"pin.csv\"`");
                let column = self.string(written.get(1)?, name, "a column: `\"Pin\"`");
                let options = self.options(written.get(2..)?, &["hold", "linear", "last"]);
                let time = self.predefined_quantity("time", span);
                let (file, column, options, time) = (file?, column?, options?, time?);
                let between = interpolation(&options, Interpolation::Hold);
                let extends = options.iter().any(|option| option == "last");
                let column = Column { file, name: column, knots: Some("time"), between, extends };
                let spans = (self.span(first.range()), self.span(written.get(1)?.range()));
                self.table(&column, spans, &time, span)
            }
            S::Data => {
                self.report(hs0220_wrong_argument::data_inside(span));
                None
            }
            S::Derivative => {
                let name = self.written(first);
                self.report(hs0218_derivative::diagnostic(span, &name));
                None
            }
        }
    }

    /// `delayed(u, T)`, `delayed(u, T, u0)`.
    fn delayed(&mut self, name: &str, span: Span, written: &[Expression]) -> Option<Typed> {
        let (first, second) = (written.first()?, written.get(1)?);
        let value = self.expression(first);
        let delay = self.single(Some(second));
        let before = match written.get(2) {
            Some(before) => Some(self.expression(before)?),
            None => None,
        };
        self.read_past(name, span)?;
        let (value, delay) = (value?, self.in_seconds(delay?, second)?);
        let delay = self.within(delay, second, "a delay", |seconds| seconds > 0.0)?.node()?;
        let mut befores = Vec::new();
        if let (Some(before), Some(third)) = (before, written.get(2)) {
            let expected = super::Expected::of(&value, "what holds before the start", None);
            let at = self.span(third.range());
            let before = self.lowering.fit(before, at, &expected)?;
            befores = self.lowering.stored(&before);
        }
        let nodes = self.lowering.stored(&value);
        let mut elements: Vec<NodeId> = Vec::with_capacity(nodes.len());
        for (position, &value) in nodes.iter().enumerate() {
            let before = befores.get(position).copied();
            elements.push(self.lowering.special(Special::Delayed { value, delay, before }));
        }
        if value.is_boolean() {
            elements = self.lowering.truths(&elements);
        }
        Some(Typed { varies: value.varies.max(Varies::Instants), ..value.with(value.shape, elements) })
    }

    /// `noise("name", sigma, period)`.
    fn noise(&mut self, name: &str, span: Span, written: &[Expression]) -> Option<Typed> {
        let (second, third) = (written.get(1)?, written.get(2)?);
        let stream = self.string(written.first()?, name, "the name of the noise: `\"gust\"`");
        let deviation = self.single(Some(second));
        let period = self.single(Some(third));
        self.read_past(name, span)?;
        let deviation = self.before_a_run(deviation?, second, "a standard deviation")?;
        let deviation = self.within(deviation, second, "a standard deviation", |sigma| sigma >= 0.0)?;
        let period = self.in_seconds(period?, third)?;
        let period = self.before_a_run(period, third, "a period")?;
        let period = self.within(period, third, "a period", |seconds| seconds > 0.0)?.node()?;
        let measured = match deviation.measured {
            Measured::Number(_) => Measured::Number(None),
            known => known,
        };
        let special = Special::Noise { name: stream?, deviation: deviation.node()?, period };
        let node = self.lowering.special(special);
        Some(Typed::scalar(node, Quantity::Real, measured, Varies::Instants))
    }

    /// Refuses what needs a run that has begun.
    fn read_past(&mut self, name: &str, span: Span) -> Option<()> {
        if self.lowering.place.most >= Varies::Instants {
            return Some(());
        }
        self.not_available(name, span, "a function of the course of a run").map(|_| ())
    }

    fn in_seconds(&mut self, value: Typed, written: &Expression) -> Option<Typed> {
        let Err(mismatch) = value.measured.agree(Measured::Known(Unit::SECOND)) else { return Some(value) };
        let (span, text) = (self.span(written.range()), self.written(written));
        self.report(hs0209_units::required(span, &format!("`{text}`"), mismatch));
        None
    }

    fn before_a_run(&mut self, value: Typed, written: &Expression, what: &str) -> Option<Typed> {
        if value.varies <= Varies::Parameters {
            return Some(value);
        }
        let span = self.span(written.range());
        self.report(hs0220_wrong_argument::varies(span, what));
        None
    }

    /// Refuses a value that is known to be wrong. A parameter's value may still change.
    fn within(
        &mut self,
        value: Typed,
        written: &Expression,
        what: &str,
        allowed: impl Fn(f64) -> bool,
    ) -> Option<Typed> {
        let number = self.lowering.graph.as_number(value.node()?);
        match number.filter(|&number| !allowed(number)) {
            None => Some(value),
            Some(number) => {
                let span = self.span(written.range());
                self.report(hs0220_wrong_argument::out_of_range(span, what, number));
                None
            }
        }
    }

    /// An argument that is a text as it stands.
    fn string(&mut self, argument: &Expression, name: &str, what: &str) -> Option<String> {
        match argument {
            Expression::StringLiteral(string) => string.value(),
            _ => {
                let span = self.span(argument.range());
                self.report(hs0220_wrong_argument::no_string(span, name, what));
                None
            }
        }
    }

    /// Words after the arguments proper.
    fn options(&mut self, written: &[Expression], allowed: &[&str]) -> Option<Vec<String>> {
        let mut options = Vec::new();
        for option in written {
            let word = match option {
                Expression::Reference(reference) => reference.name().unwrap_or_default(),
                _ => String::new(),
            };
            if !allowed.contains(&word.as_str()) {
                let (span, text) = (self.span(option.range()), self.written(option));
                self.report(hs0220_wrong_argument::no_option(span, &text, allowed));
                return None;
            }
            options.push(word);
        }
        Some(options)
    }

    /// A table at a value; element by element of an array.
    fn table(&mut self, column: &Column, spans: (Span, Span), at: &Typed, at_span: Span) -> Option<Typed> {
        let table = match self.lowering.files.table(column, spans.0.source) {
            Ok(table) => table,
            Err(mistake) => {
                self.report(hs0215_file::diagnostic(spans.0, spans.1, &column.file, &mistake));
                return None;
            }
        };
        let mut elements = Vec::with_capacity(at.elements.as_slice().len());
        for &node in at.elements.as_slice() {
            let known = self.lowering.graph.as_number(node);
            let folded = match (known, self.lowering.files.tables.get(table)) {
                (Some(x), Some(values)) => match *values.knots.as_slice() {
                    [low, ..] if x < low => Err((x, values)),
                    [.., high] if x > high && !values.extends => Err((x, values)),
                    _ => Ok(super::files::value_at(values, x)),
                },
                _ => Ok(None),
            };
            elements.push(match folded {
                Ok(Some(value)) => self.lowering.graph.number(value),
                Ok(None) => self.lowering.special(Special::Table { table, at: node }),
                Err((x, values)) => {
                    let ends = (values.knots.first().copied(), values.knots.last().copied());
                    self.report(hs0220_wrong_argument::outside_table(at_span, &column.file, x, ends));
                    return None;
                }
            });
        }
        Some(Typed { quantity: Quantity::Real, measured: Measured::Unchecked, ..at.with(at.shape, elements) })
    }
}

fn interpolation(options: &[String], otherwise: Interpolation) -> Interpolation {
    let named = options.iter().find_map(|option| match option.as_str() {
        "hold" => Some(Interpolation::Hold),
        "linear" => Some(Interpolation::Linear),
        "cubic" => Some(Interpolation::Cubic),
        _ => None,
    });
    named.unwrap_or(otherwise)
}

impl Lowering<'_, '_> {
    /// The record of an expression that is `data("file.toml")`: `None` if it is something else, `Some(None)` if the
    /// file has mistakes.
    pub(crate) fn record(&mut self, text: &ExpressionText) -> Option<Option<Rc<Record>>> {
        let Some(Expression::Call(call)) = &text.expression else { return None };
        if call.name().as_deref() != Some("data") || self.symbols.get("data").is_some() {
            return None;
        }
        let arguments = call.arguments();
        let [argument] = arguments.as_slice() else { return None };
        let mut reader = Reader { lowering: self, text, untaken: false };
        let Some(file) = reader.string(argument, "data", "a file: `\"vehicle.toml\"`") else {
            return Some(None);
        };
        let span = text.map.span(argument.range());
        Some(match self.files.data(&file, span.source) {
            Ok(record) => Some(record),
            Err(mistake) => {
                self.report(hs0215_file::diagnostic(span, span, &file, &mistake));
                None
            }
        })
    }

    /// The shape of a declaration: at most two extents, each a whole number from 1 on.
    pub(crate) fn declared_shape(&mut self, extents: &[ExpressionText]) -> Option<Shape> {
        let mut sizes = Vec::with_capacity(extents.len());
        for extent in extents {
            let number = self.constant_integer(extent, "an extent");
            let size = number.map(|number| usize::try_from(number).ok().filter(|&size| size > 0));
            if let (Some(None), Some(number)) = (size, number) {
                self.report(crate::checks::hs0212_index::no_such_extent(extent.span, number));
            }
            sizes.push(size.flatten());
        }
        let sizes: Vec<usize> = sizes.into_iter().collect::<Option<_>>()?;
        let shape = Shape::of(&sizes);
        match (shape, extents.get(2)) {
            (None, Some(third)) => self.report(hs0211_shape::too_many_dimensions(third.span)),
            (Some(shape), _) if shape.len() > super::expression::LARGEST => {
                if let Some(first) = extents.first() {
                    let largest = super::expression::LARGEST;
                    self.report(crate::checks::hs0304_too_large::expression(first.span, largest));
                }
                return None;
            }
            _ => {}
        }
        shape
    }
}
