//! The user's functions: a call is the body, lowered with the arguments in the place of the parameters.

use super::expression::Reader;
use super::lowering::{Expected, Lowering};
use super::scope::{Place, Symbol, SymbolKind, SymbolValue};
use super::typed::{Shape, Typed, Varies};
use crate::checks::{hs0107_declared_twice, hs0202_wrong_number_of_arguments, hs0210_wrong_kind};
use crate::declarations::{Dialect, FunctionDeclaration, TypeText};
use crate::units::Measured;
use sophy_diagnostics::{Diagnostic, Diagnostics, Severity, Span};
use sophy_ir::{Leaf, NodeId, Quantity, VariableId};
use sophy_syntax::ast::Expression;

/// How to call a function.
pub(super) fn usage_of(function: &FunctionDeclaration) -> String {
    let parameters: Vec<&str> = function.parameters.iter().map(|(name, _)| name.value.as_str()).collect();
    format!("{}({})", function.name.value, parameters.join(", "))
}

impl<'a> Reader<'_, '_, 'a> {
    pub(super) fn user_call(
        &mut self,
        function: &'a FunctionDeclaration,
        result: Option<(Shape, Quantity)>,
        span: Span,
        written: &[Expression],
    ) -> Option<Typed> {
        let name = function.name.value.as_str();
        let arguments: Vec<Option<Typed>> =
            written.iter().map(|argument| self.expression(argument)).collect();
        if arguments.len() != function.parameters.len() {
            let (usage, declared) = (usage_of(function), Some(function.name.span));
            let given = arguments.len();
            let error = hs0202_wrong_number_of_arguments::diagnostic(span, name, given, &usage, declared);
            self.report(error);
            return None;
        }
        let arguments: Vec<Typed> = arguments.into_iter().collect::<Option<_>>()?;
        let mut fitting = Vec::with_capacity(arguments.len());
        for ((argument, written), (parameter, kind)) in
            arguments.into_iter().zip(written).zip(&function.parameters)
        {
            let what = format!("parameter `{}` of `{name}`", parameter.value);
            let expected = self.lowering.expected(kind.as_ref(), what, parameter.span)?;
            let at = self.span(written.range());
            let well_formed = self.text.well_formed;
            fitting.push(self.lowering.fit(argument, at, &expected).filter(|_| well_formed));
        }
        let arguments: Vec<Typed> = fitting.into_iter().collect::<Option<_>>()?;
        if !self.has_room(span, Some(name)) {
            return None;
        }
        if let (Some((shape, quantity)), true) = (result, self.lowering.symbols.unapplied) {
            // Its body was checked; to go through it at every call would double the work with every level.
            return Some(self.lowering.placeholder(shape, quantity));
        }
        if self.lowering.symbols.in_function() {
            return self.lowering.applied(function, arguments, self.untaken);
        }
        // What is wrong with these arguments only is reported at the call.
        let findings = &mut *self.lowering.findings;
        let before = std::mem::take(&mut findings.diagnostics);
        let (unknown, logarithms) = (findings.unknown_names.len(), findings.logarithms.len());
        let value = self.lowering.applied(function, arguments, self.untaken);
        let findings = &mut *self.lowering.findings;
        let inside = std::mem::replace(&mut findings.diagnostics, before);
        findings.unknown_names.truncate(unknown);
        findings.logarithms.truncate(logarithms);
        if let Some(error) = first_error(&inside) {
            self.report(at_call(error, span, name));
        }
        value
    }
}

fn first_error(diagnostics: &Diagnostics) -> Option<&Diagnostic> {
    diagnostics.iter().find(|diagnostic| diagnostic.severity == Severity::Error)
}

/// A mistake within a function that its arguments are the cause of.
fn at_call(inside: &Diagnostic, span: Span, name: &str) -> Diagnostic {
    if inside.span() == Some(span) {
        return inside.clone();
    }
    let message = format!("in this call of `{name}`: {}", inside.message);
    let mut error = Diagnostic::error(inside.code, span, message);
    for label in &inside.labels {
        let said = if label.message.is_empty() { "here" } else { label.message.as_str() };
        error = error.label(label.span, said);
    }
    error.notes.clone_from(&inside.notes);
    error.helps.clone_from(&inside.helps);
    error
}

impl<'a> Lowering<'_, 'a> {
    /// The body of a function, parameters bound to arguments.
    fn applied(
        &mut self,
        function: &'a FunctionDeclaration,
        arguments: Vec<Typed>,
        untaken: bool,
    ) -> Option<Typed> {
        let body = function.body.expression.as_ref()?;
        let mark = self.symbols.enter_function();
        for ((parameter, _), argument) in function.parameters.iter().zip(arguments) {
            self.symbols.bind(&parameter.value, SymbolKind::Argument, parameter.span, argument);
        }
        let value = Reader { lowering: self, text: &function.body, untaken }.expression(body);
        let value = match (value, &function.result) {
            (Some(value), Some(kind)) => {
                let what = format!("the value of `{}`", function.name.value);
                let expected = self.expected(Some(kind), what, function.name.span);
                expected.and_then(|expected| self.fit(value, function.body.span, &expected))
            }
            (value, _) => value,
        };
        self.symbols.leave(mark);
        value.filter(|_| function.body.well_formed)
    }

    /// Checks the body of a function by itself, with arguments of which only the declared types are known.
    /// Returns what it stands for: nothing if it has mistakes.
    pub(super) fn check_function(&mut self, function: &'a FunctionDeclaration) -> SymbolValue<'a> {
        let before = self.findings.error_count();
        let mut arguments = Vec::new();
        let mut value = None;
        for (position, (parameter, kind)) in function.parameters.iter().enumerate() {
            let earlier = function.parameters.iter().take(position);
            if let Some((first, _)) = earlier.into_iter().find(|(name, _)| name.value == parameter.value) {
                let again = hs0107_declared_twice::parameter(&parameter.value, first.span, parameter.span);
                self.report(again);
            }
            let expected = self.expected(kind.as_ref(), String::new(), parameter.span);
            arguments.extend(expected.map(|expected| self.placeholder(expected.shape, expected.quantity)));
        }
        if arguments.len() == function.parameters.len() {
            let unapplied = std::mem::replace(&mut self.symbols.unapplied, true);
            // Within a function nothing is reported at a call.
            let mark = self.symbols.enter_function();
            value = self.applied(function, arguments, false);
            self.symbols.leave(mark);
            self.symbols.unapplied = unapplied;
        }
        match value {
            _ if self.findings.error_count() > before || !function.body.well_formed => SymbolValue::Broken,
            Some(value) => SymbolValue::TypedFunction(function, value.shape, value.quantity),
            None => SymbolValue::Function(function),
        }
    }

    /// Checks the functions of a SOPHY XML file, which use the constants of its component. Those with mistakes are
    /// not known any more.
    pub(crate) fn check_functions(&mut self) {
        if self.dialect != Dialect::Xml {
            return; // done once for all components
        }
        let place = std::mem::replace(&mut self.place, Place::FUNCTION);
        for function in self.symbols.declared_functions() {
            let value = self.check_function(function);
            let symbol = Symbol { kind: SymbolKind::Function, span: function.name.span, value };
            if !self.symbols.is_coming(&function.name.value) {
                self.symbols.declare(&function.name.value, symbol);
            }
        }
        self.place = place;
    }

    /// Stands for any value; its variables count down from the top, where the class has none.
    fn placeholder(&mut self, shape: Shape, quantity: Quantity) -> Typed {
        let mut nodes: Vec<NodeId> = Vec::with_capacity(shape.len());
        for _ in 0..shape.len() {
            self.symbols.placeholders += 1;
            let id = VariableId(u32::MAX - self.symbols.placeholders);
            nodes.push(self.graph.leaf(Leaf::Variable(id)));
        }
        if quantity == Quantity::Boolean {
            nodes = self.truths(&nodes);
        }
        Typed {
            elements: nodes.into(),
            shape,
            quantity,
            measured: Measured::Unchecked,
            varies: Varies::Parameters,
        }
    }

    /// What a type says; without one it is a single real number.
    pub(super) fn expected(&mut self, kind: Option<&TypeText>, what: String, span: Span) -> Option<Expected> {
        let (shape, quantity) = match kind {
            Some(kind) => self.declared_type(kind)?,
            None => (Shape::Scalar, Quantity::Real),
        };
        let measured = Measured::Unchecked;
        Some(Expected { shape, quantity, measured, choices: Vec::new(), what, span: Some(span) })
    }

    /// The shape and kind of values that a type names; events have none.
    pub(crate) fn declared_type(&mut self, kind: &TypeText) -> Option<(Shape, Quantity)> {
        let quantity = match kind.name.value.as_str() {
            "real" | "signal" => Quantity::Real,
            "integer" => Quantity::Integer,
            "boolean" => Quantity::Boolean,
            "string" => Quantity::Text,
            other => {
                self.report(hs0210_wrong_kind::no_type(kind.name.span, other));
                return None;
            }
        };
        Some((self.declared_shape(&kind.shape)?, quantity))
    }
}
