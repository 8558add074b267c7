//! Calls: of the user's functions, and of those every model knows.

use super::expression::Reader;
use super::functions::usage_of;
use super::reduction::Combination;
use super::scope::{Place, SymbolKind, SymbolValue};
use super::typed::{Shape, Typed, Varies};
use crate::checks::{
    hs0201_unknown_function, hs0202_wrong_number_of_arguments, hs0209_units, hs0211_shape, hs0212_index,
};
use crate::predefined::{ArrayFunction, Predefined, QUANTITIES};
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Binary, Comparison, NodeId, Quantity, Unary};
use sophy_syntax::ast::{Call, Expression};

impl Reader<'_, '_, '_> {
    pub(super) fn call(&mut self, call: &Call) -> Option<Typed> {
        let name = call.name()?;
        let span = self.span(call.name_range()?);
        let written = call.arguments();
        match self.lowering.symbols.look_up(&name) {
            Some(symbol) => match symbol.value {
                SymbolValue::Function(function) => self.user_call(function, None, span, &written),
                SymbolValue::TypedFunction(function, shape, quantity) => {
                    self.user_call(function, Some((shape, quantity)), span, &written)
                }
                value => {
                    written.iter().for_each(|argument| {
                        self.expression(argument);
                    });
                    if symbol.kind != SymbolKind::Function && !matches!(value, SymbolValue::Broken) {
                        let what = symbol.kind.with_article();
                        let declared = Some(symbol.span);
                        self.report(hs0201_unknown_function::not_a_function(span, &name, what, declared));
                    }
                    None
                }
            },
            None => match Predefined::named(&name) {
                Some(function) => self.predefined_call(function, &name, span, &written),
                None => {
                    written.iter().for_each(|argument| {
                        self.expression(argument);
                    });
                    if QUANTITIES.contains(&name.as_str()) {
                        let what = "a predefined quantity";
                        self.report(hs0201_unknown_function::not_a_function(span, &name, what, None));
                    } else {
                        self.unknown(&name, span, true);
                    }
                    None
                }
            },
        }
    }

    /// How to call a function.
    pub(super) fn usage(&self, name: &str) -> String {
        match self.lowering.symbols.get(name).map(|symbol| &symbol.value) {
            Some(SymbolValue::Function(function) | SymbolValue::TypedFunction(function, ..)) => {
                usage_of(function)
            }
            _ => Predefined::named(name).map_or_else(|| format!("{name}(…)"), |f| f.usage(name)),
        }
    }

    fn predefined_call(
        &mut self,
        function: Predefined,
        name: &str,
        span: Span,
        written: &[Expression],
    ) -> Option<Typed> {
        if !function.takes(written.len()) {
            let usage = function.usage(name);
            let given = written.len();
            written.iter().for_each(|argument| {
                self.expression(argument);
            });
            self.report(hs0202_wrong_number_of_arguments::diagnostic(span, name, given, &usage, None));
            return None;
        }
        match function {
            Predefined::Special(special) => self.special_call(special, name, span, written),
            Predefined::Array(array) => self.array_call(array, name, span, written),
            Predefined::Fold(_) if written.len() == 1 => {
                let only = written.first()?;
                let value = self.number(Some(only))?;
                if value.shape == Shape::Scalar {
                    let usage = function.usage(name);
                    self.report(hs0202_wrong_number_of_arguments::diagnostic(span, name, 1, &usage, None));
                    return None;
                }
                let elements = self.elements(&value);
                self.combined(Combination::named(name)?, name, elements, span)
            }
            _ => self.scalar_call(function, name, span, written),
        }
    }

    /// A function of single numbers.
    fn scalar_call(
        &mut self,
        function: Predefined,
        name: &str,
        span: Span,
        written: &[Expression],
    ) -> Option<Typed> {
        let arguments: Vec<Option<Typed>> =
            written.iter().map(|argument| self.element(argument, name)).collect();
        if function == Predefined::Log {
            self.lowering.findings.logarithms.push(span);
        }
        if let (Predefined::Modulo | Predefined::Remainder, Some(Some(b)), Some(second)) =
            (function, arguments.get(1), written.get(1))
        {
            let b = b.clone();
            self.check_divisor(&b, second.range());
        }
        let arguments: Vec<Typed> = arguments.into_iter().collect::<Option<_>>()?;
        let nodes: Vec<NodeId> = arguments.iter().filter_map(Typed::node).collect();
        let measured = self.measured_call(function, name, &arguments, written)?;
        let node = self.scalar_node(function, &nodes)?;
        let integers = arguments.iter().all(|argument| argument.quantity == Quantity::Integer);
        let quantity = match function {
            Predefined::Unary(Unary::Floor | Unary::Sign) | Predefined::Ceil => Quantity::Integer,
            Predefined::Unary(Unary::Abs)
            | Predefined::Fold(_)
            | Predefined::Saturate
            | Predefined::Modulo
            | Predefined::Remainder
                if integers =>
            {
                Quantity::Integer
            }
            _ => Quantity::Real,
        };
        let varies = arguments.iter().map(|argument| argument.varies).max().unwrap_or(Varies::Never);
        Some(Typed::scalar(node, quantity, measured, varies))
    }

    /// An argument of a function that applies to single numbers.
    fn element(&mut self, argument: &Expression, name: &str) -> Option<Typed> {
        let value = self.number(Some(argument))?;
        if value.shape != Shape::Scalar {
            let written = self.written(argument);
            let span = self.span(argument.range());
            self.report(hs0211_shape::not_by_element(span, &written, value.shape, name));
            return None;
        }
        Some(value)
    }

    fn measured_call(
        &mut self,
        function: Predefined,
        name: &str,
        arguments: &[Typed],
        written: &[Expression],
    ) -> Option<Measured> {
        let (first, others) = arguments.split_first()?;
        let unary = match function {
            Predefined::Unary(unary) => Some(unary),
            Predefined::Log => Some(Unary::Ln),
            Predefined::Ceil => Some(Unary::Floor),
            _ => None,
        };
        let result = match (unary, function) {
            (Some(unary), _) => first.measured.unary(unary),
            (None, Predefined::Binary(binary)) => first.measured.binary(binary, others.first()?.measured),
            _ => {
                let mut measured = first.measured;
                for (position, other) in others.iter().enumerate() {
                    match measured.agree(other.measured) {
                        Ok(agreed) => measured = agreed,
                        Err(mismatch) => {
                            let (left, right) =
                                (written.first()?.range(), written.get(position + 1)?.range());
                            let spans = (self.span(left), self.span(right));
                            self.report(hs0209_units::arguments(name, spans.0, spans.1, mismatch));
                            return None;
                        }
                    }
                }
                Ok(measured)
            }
        };
        match result {
            Ok(Measured::Number(_)) if unary.is_none() => Some(Measured::Number(None)),
            Ok(measured) => Some(measured),
            Err(mismatch) => {
                let first = self.span(written.first()?.range());
                let diagnostic = match (function, written.get(1)) {
                    (Predefined::Binary(Binary::Power), Some(exponent)) => {
                        hs0209_units::not_a_number(self.span(exponent.range()), "an exponent", mismatch)
                    }
                    (_, Some(second)) => {
                        hs0209_units::arguments(name, first, self.span(second.range()), mismatch)
                    }
                    _ => hs0209_units::not_a_number(first, &format!("the argument of `{name}`"), mismatch),
                };
                self.report(diagnostic);
                None
            }
        }
    }

    /// The number of arguments was checked.
    fn scalar_node(&mut self, function: Predefined, arguments: &[NodeId]) -> Option<NodeId> {
        let graph = &mut *self.lowering.graph;
        Some(match (function, arguments) {
            (Predefined::Unary(unary), &[x]) => graph.unary(unary, x),
            (Predefined::Log, &[x]) => graph.unary(Unary::Ln, x),
            (Predefined::Ceil, &[x]) => {
                let negative = graph.unary(Unary::Negate, x);
                let floor = graph.unary(Unary::Floor, negative);
                graph.unary(Unary::Negate, floor)
            }
            (Predefined::Binary(binary), &[a, b]) => graph.binary(binary, a, b),
            (Predefined::Fold(binary), &[first, ref rest @ ..]) => {
                rest.iter().fold(first, |value, &next| graph.binary(binary, value, next))
            }
            (Predefined::Saturate, &[x]) => {
                let (low, high) = (graph.number(-1.0), graph.number(1.0));
                let above = graph.binary(Binary::Max, x, low);
                graph.binary(Binary::Min, above, high)
            }
            (Predefined::Saturate, &[x, low, high]) => {
                let above = graph.binary(Binary::Max, x, low);
                graph.binary(Binary::Min, above, high)
            }
            (Predefined::Modulo, &[a, b]) => {
                let quotient = graph.divide(a, b);
                let whole = graph.unary(Unary::Floor, quotient);
                let multiple = graph.multiply(b, whole);
                graph.subtract(a, multiple)
            }
            (Predefined::Remainder, &[a, b]) => {
                let quotient = graph.divide(a, b);
                let whole = self.truncated(quotient);
                let graph = &mut *self.lowering.graph;
                let multiple = graph.multiply(b, whole);
                graph.subtract(a, multiple)
            }
            (Predefined::Hypotenuse, &[a, b]) => {
                let (a, b) = (graph.integer_power(a, 2), graph.integer_power(b, 2));
                let sum = graph.add(a, b);
                graph.unary(Unary::Sqrt, sum)
            }
            _ => return None,
        })
    }

    /// Rounds towards 0.
    fn truncated(&mut self, x: NodeId) -> NodeId {
        let graph = &mut *self.lowering.graph;
        let zero = graph.number(0.0);
        let negative = graph.compare(Comparison::Less, x, zero);
        let minus = graph.unary(Unary::Negate, x);
        let floor_of_minus = graph.unary(Unary::Floor, minus);
        let up = graph.unary(Unary::Negate, floor_of_minus);
        let down = graph.unary(Unary::Floor, x);
        graph.select(negative, up, down)
    }

    /// A function of vectors or matrices.
    fn array_call(
        &mut self,
        function: ArrayFunction,
        name: &str,
        span: Span,
        written: &[Expression],
    ) -> Option<Typed> {
        use ArrayFunction as A;
        let first = written.first()?;
        match function {
            A::Identity => {
                let n = self.extent(first)?;
                let on_diagonal = |position: usize| f64::from(u8::from(position.is_multiple_of(n + 1)));
                self.filled(Shape::Matrix(n, n), first.range(), on_diagonal)
            }
            A::Zeros | A::Ones => {
                let extents: Vec<Option<usize>> = written.iter().map(|e| self.extent(e)).collect();
                let shape = Shape::of(&extents.into_iter().collect::<Option<Vec<_>>>()?)?;
                let number = f64::from(u8::from(function == A::Ones));
                self.filled(shape, first.range(), |_| number)
            }
            A::All | A::Any => {
                let value = self.expression(first)?;
                if !value.is_boolean() || value.shape == Shape::Scalar {
                    return self.wrong_shape(name, "a vector of truth values", first, &value);
                }
                let elements = self.elements(&value);
                self.combined(Combination::named(name)?, name, elements, span)
            }
            A::Size => {
                // Only the shape counts, which is known of what varies, too.
                let place = self.lowering.place;
                self.lowering.place = Place { most: Varies::Continuously, ..place };
                let value = self.expression(first);
                self.lowering.place = place;
                let value = value?;
                let extents = value.shape.extents();
                let which = match written.get(1) {
                    Some(which) => self.known_integer(which, "which extent is meant")?,
                    None => 1,
                };
                let extent = usize::try_from(which - 1).ok().and_then(|which| extents.get(which));
                let Some(&extent) = extent else {
                    let (range, text) = (written.get(1).unwrap_or(first).range(), self.written(first));
                    let at = self.span(range);
                    self.report(hs0212_index::no_extent(at, &text, which, value.shape));
                    return None;
                };
                Some(self.number_literal(extent as f64, Quantity::Integer))
            }
            _ => {
                let arguments: Vec<Option<Typed>> = written.iter().map(|e| self.number(Some(e))).collect();
                let arguments: Vec<Typed> = arguments.into_iter().collect::<Option<_>>()?;
                self.array_value(function, name, span, &arguments, written)
            }
        }
    }

    fn array_value(
        &mut self,
        function: ArrayFunction,
        name: &str,
        span: Span,
        arguments: &[Typed],
        written: &[Expression],
    ) -> Option<Typed> {
        use ArrayFunction as A;
        let (a, first) = (arguments.first()?, written.first()?);
        match (function, arguments) {
            (A::Sum, _) if a.shape != Shape::Scalar => {
                let elements = self.elements(a);
                self.combined(Combination::Sum, name, elements, span)
            }
            (A::Norm, _) if matches!(a.shape, Shape::Vector(_)) => self.norm(a),
            (A::Dot, [a, b]) if matches!(a.shape, Shape::Vector(_)) && a.shape == b.shape => {
                Some(self.dot(a, b))
            }
            (A::Cross, [a, b]) if a.shape == Shape::Vector(3) && b.shape == a.shape => self.cross(a, b),
            (A::Dot | A::Cross, [a, b]) => {
                let spans = (self.span(first.range()), self.span(written.get(1)?.range()));
                let three = function == A::Cross;
                self.report(hs0211_shape::vectors(name, three, spans, (a.shape, b.shape)));
                None
            }
            (A::Transpose, _) if matches!(a.shape, Shape::Matrix(..)) => self.transposed(a),
            (A::Inverse, _) => match a.shape {
                Shape::Matrix(rows, columns) if rows == columns => {
                    let at = self.span(first.range());
                    self.inverse(a, rows, at)
                }
                _ => self.wrong_shape(name, "a square matrix", first, a),
            },
            (A::Transpose, _) => self.wrong_shape(name, "a matrix", first, a),
            (A::Sum, _) => self.wrong_shape(name, "a vector or matrix", first, a),
            _ => self.wrong_shape(name, "a vector", first, a),
        }
    }

    fn wrong_shape(&mut self, name: &str, what: &str, argument: &Expression, value: &Typed) -> Option<Typed> {
        let (span, written) = (self.span(argument.range()), self.written(argument));
        self.report(hs0211_shape::argument(span, name, what, &written, value.shape));
        None
    }

    /// An extent: a whole number from 1 on.
    fn extent(&mut self, expression: &Expression) -> Option<usize> {
        let number = self.known_integer(expression, "an extent")?;
        let extent = usize::try_from(number).ok().filter(|&extent| extent > 0);
        if extent.is_none() {
            let span = self.span(expression.range());
            self.report(hs0212_index::no_such_extent(span, number));
        }
        extent
    }
}
