use super::expression::{Lowering, Scope, Typed};
use crate::checks::{
    hs0201_unknown_function, hs0202_wrong_number_of_arguments, hs0204_equality, hs0304_too_large,
};
use crate::names::Kind;
use crate::predefined::Predefined;
use sophy_diagnostics::Span;
use sophy_ir::{Binary, Comparison, Unary};
use sophy_syntax::ast::{Call, Expression};

/// How many nodes a model may have; functions that call one another can multiply without bound.
const LARGEST: usize = 1_000_000;

impl Lowering<'_, '_, '_> {
    pub(crate) fn call(&mut self, call: &Call) -> Option<Typed> {
        let name = call.name()?;
        let span = self.span(call.name_range()?);
        let written = call.arguments();
        let arguments: Vec<Option<Typed>> =
            written.iter().map(|argument| self.number(Some(argument.clone()))).collect();
        if let Scope::Function { parameters } = self.scope
            && parameters.iter().any(|(parameter, _)| *parameter == name)
        {
            self.report(hs0201_unknown_function::not_a_function(span, &name, "a parameter", None));
            return None;
        }
        match self.context.names.symbol(&name) {
            Some(symbol) if symbol.kind == Kind::Function => self.user_call(&name, span, arguments),
            Some(symbol) => {
                let what = symbol.kind.with_article();
                self.report(hs0201_unknown_function::not_a_function(span, &name, what, Some(symbol.span)));
                None
            }
            None => match Predefined::named(&name) {
                Some(function) => self.predefined_call(function, &name, span, arguments, &written),
                None if matches!(name.as_str(), "pi" | "time") => {
                    let what = "a predefined quantity";
                    self.report(hs0201_unknown_function::not_a_function(span, &name, what, None));
                    None
                }
                None => {
                    self.unknown(name, span, true);
                    None
                }
            },
        }
    }

    /// Puts the function's definition in the place of the call.
    fn user_call(&mut self, name: &str, span: Span, arguments: Vec<Option<Typed>>) -> Option<Typed> {
        let functions = self.context.functions;
        let expected = functions.parameter_count(name)?;
        if arguments.len() != expected {
            let declared = self.context.names.symbol(name).map(|symbol| symbol.span);
            self.report(hs0202_wrong_number_of_arguments::diagnostic(
                span,
                name,
                arguments.len(),
                &functions.usage(name),
                declared,
            ));
            return None;
        }
        let arguments: Vec<Typed> = arguments.into_iter().collect::<Option<_>>()?;
        let template = functions.template(name)?;
        let varies = arguments.iter().any(|argument| argument.varies);
        if template.compares_equal && varies {
            if matches!(self.scope, Scope::Function { .. }) {
                self.compares_equal = true;
            } else {
                self.report(
                    hs0204_equality::in_function(span, name, Comparison::Equal)
                        .label(template.span, "it compares with `=` or `<>` here"),
                );
                return None;
            }
        }
        if self.graph.len() + template.graph.len() > LARGEST {
            if !self.context.findings.too_large {
                self.context.findings.too_large = true;
                self.report(hs0304_too_large::diagnostic(span, name, LARGEST));
            }
            return None;
        }
        let node = template.expand(self.graph, &arguments);
        Some(Typed { node, boolean: template.boolean, varies })
    }

    fn predefined_call(
        &mut self,
        function: Predefined,
        name: &str,
        span: Span,
        arguments: Vec<Option<Typed>>,
        written: &[Expression],
    ) -> Option<Typed> {
        if !function.takes(arguments.len()) {
            let usage = function.usage(name);
            let given = arguments.len();
            self.report(hs0202_wrong_number_of_arguments::diagnostic(span, name, given, &usage, None));
            return None;
        }
        if function == Predefined::Log {
            self.context.findings.logarithms.push(span);
        }
        if let (Predefined::Modulo | Predefined::Remainder, Some(Some(b)), Some(second)) =
            (function, arguments.get(1), written.get(1))
        {
            let text = self.written(second);
            self.check_divisor(*b, second.range(), &text);
        }
        let arguments: Vec<Typed> = arguments.into_iter().collect::<Option<_>>()?;
        let value = match (function, arguments.as_slice()) {
            (Predefined::Unary(unary), &[x]) => self.unary(unary, x),
            (Predefined::Log, &[x]) => self.unary(Unary::Ln, x),
            (Predefined::Ceil, &[x]) => {
                let negative = self.unary(Unary::Negate, x);
                let floor = self.unary(Unary::Floor, negative);
                self.unary(Unary::Negate, floor)
            }
            (Predefined::Binary(binary), &[a, b]) => self.binary(binary, a, b),
            (Predefined::Fold(binary), &[first, ref rest @ ..]) => {
                rest.iter().fold(first, |value, &next| self.binary(binary, value, next))
            }
            (Predefined::Saturate, &[x]) => {
                let (low, high) = (self.constant(-1.0), self.constant(1.0));
                self.saturate(x, low, high)
            }
            (Predefined::Saturate, &[x, low, high]) => self.saturate(x, low, high),
            (Predefined::Modulo, &[a, b]) => {
                let quotient = self.binary(Binary::Divide, a, b);
                let whole = self.unary(Unary::Floor, quotient);
                self.rest(a, b, whole)
            }
            (Predefined::Remainder, &[a, b]) => {
                let quotient = self.binary(Binary::Divide, a, b);
                let whole = self.truncate(quotient);
                self.rest(a, b, whole)
            }
            (Predefined::Hypotenuse, &[a, b]) => {
                let two = self.constant(2.0);
                let (a, b) = (self.binary(Binary::Power, a, two), self.binary(Binary::Power, b, two));
                let sum = self.binary(Binary::Add, a, b);
                self.unary(Unary::Sqrt, sum)
            }
            _ => return None, // the number of arguments was checked
        };
        Some(value)
    }

    fn constant(&mut self, value: f64) -> Typed {
        Typed { node: self.graph.number(value), boolean: false, varies: false }
    }

    fn unary(&mut self, function: Unary, x: Typed) -> Typed {
        Typed { node: self.graph.unary(function, x.node), ..x }
    }

    fn saturate(&mut self, x: Typed, low: Typed, high: Typed) -> Typed {
        let above = self.binary(Binary::Max, x, low);
        self.binary(Binary::Min, above, high)
    }

    /// `a − b·whole`.
    fn rest(&mut self, a: Typed, b: Typed, whole: Typed) -> Typed {
        let multiple = self.binary(Binary::Multiply, b, whole);
        self.binary(Binary::Subtract, a, multiple)
    }

    /// Rounds towards 0.
    fn truncate(&mut self, x: Typed) -> Typed {
        let zero = self.graph.number(0.0);
        let negative = self.graph.compare(Comparison::Less, x.node, zero);
        let minus = self.graph.unary(Unary::Negate, x.node);
        let floor_of_minus = self.graph.unary(Unary::Floor, minus);
        let up = self.graph.unary(Unary::Negate, floor_of_minus);
        let down = self.graph.unary(Unary::Floor, x.node);
        Typed { node: self.graph.select(negative, up, down), ..x }
    }
}
