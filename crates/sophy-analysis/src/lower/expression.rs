use super::lowering::{Lowering, whole};
use super::scope::{Numbers, SymbolValue, VariableSymbol};
use super::typed::{Elements, Shape, Typed, Varies};
use crate::checks::hs0148_of_another_location;
use crate::checks::{
    hs0203_number_as_condition, hs0205_division_by_zero, hs0207_not_available,
    hs0208_function_without_arguments, hs0209_units, hs0210_wrong_kind, hs0211_shape, hs0217_no_such_part,
    hs0219_two_events, hs0304_too_large,
};
use crate::declarations::{Dialect, ExpressionText};
use crate::findings::UnknownName;
use crate::predefined::Predefined;
use crate::units::{Measured, Mismatch, Unit};
use sophy_diagnostics::{Diagnostic, Span};
use sophy_ir::{Binary, Comparison, Graph, Leaf, Model, Node, NodeId, Quantity, Special, Unary, VariableId};
use sophy_syntax::ast::{self, ChainOperator, Expression, LiteralValue, PrefixOperator};
use std::ops::Range;

/// How many operations functions and reductions of a component may be written out to, and how many elements a
/// value may have.
pub(super) const LARGEST: usize = 200_000;

/// How deep an expression may be nested when functions stand in the place of their calls.
const DEEPEST: usize = 256;

/// Lowers the parts of one expression.
pub(super) struct Reader<'r, 'l, 'a> {
    pub(super) lowering: &'r mut Lowering<'l, 'a>,
    pub(super) text: &'r ExpressionText,
    /// Whether the part is one that is never evaluated.
    pub(super) untaken: bool,
}

impl<'a> Reader<'_, '_, 'a> {
    pub(super) fn expression(&mut self, expression: &Expression) -> Option<Typed> {
        self.lowering.symbols.work += 1;
        if self.lowering.symbols.depth >= DEEPEST {
            self.too_large(self.span(expression.range()), None);
            return None;
        }
        self.lowering.symbols.depth += 1;
        let value = match expression {
            Expression::Literal(literal) => self.literal(literal),
            Expression::StringLiteral(string) => string.value().map(|text| self.lowering.text(&text)),
            Expression::Reference(reference) => {
                reference.name().and_then(|name| self.reference(&name, self.span(reference.range())))
            }
            Expression::Call(call) => self.call(call),
            Expression::Parentheses(parentheses) => {
                parentheses.inner().and_then(|inner| self.expression(&inner))
            }
            Expression::Prefix(prefix) => self.prefix(prefix),
            Expression::Power(power) => self.power(power),
            Expression::Chain(chain) => self.chain(chain),
            Expression::Comparison(comparison) => self.comparison(comparison),
            Expression::Conditional(conditional) => self.conditional(conditional),
            Expression::Vector(vector) => self.vector(vector),
            Expression::Index(index) => self.selection(index.base(), index.parts(), index.range()),
            Expression::Path(path) => self.selection(path.base(), path.parts(), path.range()),
            Expression::Reduction(reduction) => self.reduction(reduction),
        };
        self.lowering.symbols.depth -= 1;
        value
    }

    /// A number or an array of numbers.
    pub(super) fn number(&mut self, expression: Option<&Expression>) -> Option<Typed> {
        let expression = expression?;
        let value = self.expression(expression)?;
        self.as_number(value, expression)
    }

    /// In SOPHY XML a truth value counts as 1 or 0.
    pub(super) fn as_number(&mut self, value: Typed, expression: &Expression) -> Option<Typed> {
        match value.quantity {
            Quantity::Real | Quantity::Integer => Some(value),
            Quantity::Boolean if self.lowering.dialect == Dialect::Xml => {
                let elements = Elements::from(self.lowering.stored(&value));
                Some(Typed { elements, quantity: Quantity::Real, ..value })
            }
            quantity => {
                let written = self.written(expression);
                let span = self.span(expression.range());
                self.report(hs0210_wrong_kind::not_a_number(span, &written, quantity));
                None
            }
        }
    }

    /// A single number.
    pub(super) fn single(&mut self, expression: Option<&Expression>) -> Option<Typed> {
        let value = self.number(expression)?;
        self.as_single(value, expression?)
    }

    pub(super) fn as_single(&mut self, value: Typed, expression: &Expression) -> Option<Typed> {
        if value.shape == Shape::Scalar {
            return Some(value);
        }
        let written = self.written(expression);
        self.report(hs0211_shape::not_single(self.span(expression.range()), &written, value.shape));
        None
    }

    /// A single truth value; a number is a mistake.
    pub(super) fn condition(&mut self, expression: Option<&Expression>) -> Option<Typed> {
        let expression = expression?;
        let value = self.expression(expression)?;
        if !value.is_boolean() {
            let number = value.node().and_then(|node| self.graph().as_number(node));
            let text = value.quantity == Quantity::Text;
            let written = self.written(expression);
            let span = self.span(expression.range());
            self.report(hs0203_number_as_condition::diagnostic(span, &written, number, text));
            return None;
        }
        self.as_single(value, expression)
    }

    fn literal(&mut self, literal: &ast::Literal) -> Option<Typed> {
        match literal.value()? {
            LiteralValue::Boolean(b) => {
                let node = self.graph().boolean(b);
                Some(Typed::truth(node, Varies::Never))
            }
            LiteralValue::Number(x) => {
                let written = self.text.text.get(literal.range()).unwrap_or("");
                let integer = !written.contains(['.', 'e', 'E']) && whole(x).is_some();
                let quantity = if integer { Quantity::Integer } else { Quantity::Real };
                Some(self.number_literal(x, quantity))
            }
        }
    }

    pub(super) fn number_literal(&mut self, x: f64, quantity: Quantity) -> Typed {
        let node = self.graph().number(x);
        Typed::scalar(node, quantity, Measured::literal(x), Varies::Never)
    }

    /// The value of a name.
    fn reference(&mut self, name: &str, span: Span) -> Option<Typed> {
        let Some(symbol) = self.lowering.symbols.look_up(name) else {
            return self.predefined_quantity(name, span);
        };
        let what = symbol.kind.with_article();
        match symbol.value {
            SymbolValue::Broken if symbol.kind.varies() && self.lowering.place.most <= Varies::Parameters => {
                self.not_available(name, span, what)
            }
            SymbolValue::Broken => None,
            SymbolValue::Variable(variable) => {
                if variable.varies > self.lowering.place.most {
                    return self.not_available(name, span, what);
                }
                if variable.is_coming() {
                    self.report(hs0207_not_available::too_early(span, name, symbol.span));
                    return None;
                }
                Some(self.lowering.leaves(&variable, 0..variable.shape.len(), variable.shape))
            }
            SymbolValue::Numbers(numbers) => Some(self.lowering.numbers(&numbers)),
            SymbolValue::Bound(value) => Some(value),
            SymbolValue::Event => {
                if !self.lowering.place.conditions {
                    return self.not_available(name, span, what);
                }
                let node = self.lowering.special(Special::Event(name.to_owned()));
                Some(Typed::truth(node, Varies::Instants))
            }
            SymbolValue::Function(_) | SymbolValue::TypedFunction(..) => {
                let usage = self.usage(name);
                self.report(hs0208_function_without_arguments::diagnostic(span, name, &usage));
                None
            }
            SymbolValue::Record(record) => {
                let entries: Vec<&str> = record.entries.keys().map(String::as_str).collect();
                self.report(hs0217_no_such_part::whole_record(span, name, &entries));
                None
            }
            SymbolValue::None => {
                self.report(hs0217_no_such_part::no_value(span, name, what, symbol.span));
                None
            }
        }
    }

    pub(super) fn predefined_quantity(&mut self, name: &str, span: Span) -> Option<Typed> {
        if self.lowering.symbols.hidden(name).is_some() {
            let what = self.lowering.symbols.hidden(name).map_or("", |symbol| symbol.kind.with_article());
            return self.not_available(name, span, what);
        }
        let at_instants =
            self.lowering.place.most >= Varies::Instants && !self.lowering.symbols.in_function();
        if self.of_another_location(name, span) {
            return None;
        }
        match name {
            "pi" => {
                let node = self.graph().number(std::f64::consts::PI);
                let measured = Measured::Known(Unit::ONE);
                Some(Typed::scalar(node, Quantity::Real, measured, Varies::Never))
            }
            "time" if self.lowering.place.time && !self.lowering.symbols.in_function() => {
                let node = self.graph().leaf(Leaf::Time);
                // `sin(time)` is what everybody writes: time is a number of seconds, and adapts.
                let measured = Measured::Unchecked;
                Some(Typed::scalar(node, Quantity::Real, measured, Varies::Continuously))
            }
            "time" => self.not_available(name, span, "the simulated time"),
            "never" if at_instants => {
                let node = self.lowering.special(Special::Never);
                Some(Typed::scalar(node, Quantity::Real, Measured::Number(None), Varies::Never))
            }
            "location_index" if at_instants => {
                let node = self.lowering.special(Special::Location);
                Some(Typed::scalar(node, Quantity::Integer, Measured::Number(None), Varies::Instants))
            }
            "location" if at_instants => Some(self.location()),
            "never" => self.not_available(name, span, "an instant that does not come"),
            "location" | "location_index" => self.not_available(name, span, "the present location"),
            _ => {
                if let Some(function) = Predefined::named(name) {
                    let usage = function.usage(name);
                    self.report(hs0208_function_without_arguments::diagnostic(span, name, &usage));
                } else {
                    self.unknown(name, span, false);
                }
                None
            }
        }
    }

    /// Says so if a name is one that only other locations have.
    fn of_another_location(&mut self, name: &str, span: Span) -> bool {
        let symbols = &self.lowering.symbols;
        let Some(&(location, symbol)) = symbols.elsewhere(name).first() else { return false };
        let place = symbols.locations.get(location).map_or("", String::as_str);
        let found = hs0148_of_another_location::diagnostic(name, span, symbol.kind, place, symbol.span);
        self.report(found);
        true
    }

    /// The name of the present location.
    fn location(&mut self) -> Typed {
        let index = self.lowering.special(Special::Location);
        let locations = self.lowering.symbols.locations.clone();
        let mut value: Option<NodeId> = None;
        for (position, name) in locations.iter().enumerate().rev() {
            let name = self.lowering.text(name).node();
            let number = self.graph().number((position + 1) as f64);
            let here = self.graph().compare(Comparison::Equal, index, number);
            value = match (value, name) {
                (Some(others), Some(name)) => Some(self.graph().select(here, name, others)),
                (_, name) => name,
            };
        }
        match value {
            Some(node) => Typed::scalar(node, Quantity::Text, Measured::Unchecked, Varies::Instants),
            None => self.lowering.text(""),
        }
    }

    pub(super) fn not_available(&mut self, name: &str, span: Span, what: &str) -> Option<Typed> {
        let symbols = &self.lowering.symbols;
        let declared = symbols.get(name).or_else(|| symbols.hidden(name)).map(|symbol| symbol.span);
        let in_function = symbols.in_function();
        let (place, dialect) = (self.lowering.place, self.lowering.dialect);
        let allowed = if in_function { None } else { Some((place, dialect)) };
        self.report(hs0207_not_available::diagnostic(span, name, what, allowed, declared));
        None
    }

    /// Refuses what has a meaning in conditions and actions only.
    pub(super) fn only_at_instants(&mut self, name: &str, span: Span) -> Option<()> {
        if self.lowering.place.conditions && !self.lowering.symbols.in_function() {
            return Some(());
        }
        self.not_available(name, span, "about instants").map(|_| ())
    }

    pub(super) fn unknown(&mut self, name: &str, span: Span, called: bool) {
        let symbols = &self.lowering.symbols;
        let candidates = if called { symbols.functions() } else { symbols.values(self.lowering.dialect) };
        let candidates = candidates.into_iter().map(str::to_owned).collect();
        let name = name.to_owned();
        self.lowering.findings.unknown_names.push(UnknownName { name, span, called, candidates });
    }

    fn prefix(&mut self, prefix: &ast::Prefix) -> Option<Typed> {
        let operand = prefix.operand();
        match prefix.operator()? {
            PrefixOperator::Not => {
                let value = self.condition(operand.as_ref())?;
                let node = self.lowering.graph.not(value.node()?);
                Some(Typed::truth(node, value.varies))
            }
            PrefixOperator::Plus => self.number(operand.as_ref()),
            PrefixOperator::Minus => {
                let value = self.number(operand.as_ref())?;
                Some(self.negative(&value))
            }
        }
    }

    pub(super) fn negative(&mut self, value: &Typed) -> Typed {
        let graph = &mut *self.lowering.graph;
        let negate = |&node: &NodeId| graph.unary(Unary::Negate, node);
        let elements: Vec<NodeId> = value.elements.as_slice().iter().map(negate).collect();
        let measured = value.measured.unary(Unary::Negate).unwrap_or(value.measured);
        Typed { measured, ..value.with(value.shape, elements) }
    }

    fn power(&mut self, power: &ast::Power) -> Option<Typed> {
        let (base, exponent) = (power.base(), power.exponent());
        let a = self.number(base.as_ref());
        let b = self.number(exponent.as_ref());
        let (a, b) = (self.scalar_base(a?, &base?)?, self.as_single(b?, exponent.as_ref()?)?);
        match a.measured.power(b.measured) {
            Ok(measured) => {
                let quantity = match (a.quantity, b.quantity, self.graph().as_number(b.node()?)) {
                    (Quantity::Integer, Quantity::Integer, Some(n)) if n >= 0.0 => Quantity::Integer,
                    _ => Quantity::Real,
                };
                let node = self.lowering.graph.binary(Binary::Power, a.node()?, b.node()?);
                Some(Typed::scalar(node, quantity, measured, a.varies.max(b.varies)))
            }
            Err(mismatch) => {
                let span = self.span(exponent?.range());
                self.report(hs0209_units::not_a_number(span, "an exponent", mismatch));
                None
            }
        }
    }

    fn scalar_base(&mut self, value: Typed, expression: &Expression) -> Option<Typed> {
        if value.shape != Shape::Scalar {
            let (written, span) = (self.written(expression), self.span(expression.range()));
            self.report(hs0211_shape::power(span, &written, value.shape));
            return None;
        }
        Some(value)
    }

    fn chain(&mut self, chain: &ast::Chain) -> Option<Typed> {
        let steps = chain.steps();
        let logical =
            steps.iter().any(|s| matches!(s.operator, Some(ChainOperator::And | ChainOperator::Or)));
        let first = chain.first();
        let start = first.as_ref().map_or_else(|| chain.range().start, |e| e.range().start);
        let mut value = if logical { self.condition(first.as_ref()) } else { self.number(first.as_ref()) };
        let mut end = first.as_ref().map_or(start, |e| e.range().end);
        for step in &steps {
            let operand = step.operand.as_ref();
            let right = if logical { self.condition(operand) } else { self.number(operand) };
            let left = end;
            end = operand.map_or(end, |e| e.range().end);
            value = match (value, step.operator, right, operand) {
                (Some(a), Some(operator), Some(b), Some(operand)) => {
                    self.apply(operator, (a, start..left), (b, operand.range()))
                }
                _ => None,
            };
        }
        value
    }

    fn apply(
        &mut self,
        operator: ChainOperator,
        a: (Typed, Range<usize>),
        b: (Typed, Range<usize>),
    ) -> Option<Typed> {
        match operator {
            ChainOperator::Add => self.sum(Binary::Add, a, b),
            ChainOperator::Subtract => self.sum(Binary::Subtract, a, b),
            ChainOperator::Multiply => self.product(a, b),
            ChainOperator::Divide => self.quotient(a, b),
            ChainOperator::And | ChainOperator::Or => {
                let varies = a.0.varies.max(b.0.varies);
                let (left, right) = (a.0.node()?, b.0.node()?);
                if operator == ChainOperator::Or {
                    return Some(Typed::truth(self.lowering.graph.or(left, right), varies));
                }
                if let (Some(first), Some(second)) = (self.event_in(left), self.event_in(right)) {
                    let spans = (self.span(a.1), self.span(b.1));
                    self.report(hs0219_two_events::diagnostic(spans.0, &first, spans.1, &second));
                    return None;
                }
                Some(Typed::truth(self.lowering.graph.and(left, right), varies))
            }
        }
    }

    /// An event without which the condition cannot be true.
    fn event_in(&self, condition: NodeId) -> Option<String> {
        let mut pending = vec![condition];
        while let Some(node) = pending.pop() {
            match self.lowering.graph.node(node) {
                Node::And(a, b) => pending.extend([b, a]),
                // Whichever side holds: if one needs no event, neither does the whole.
                Node::Or(a, b) => {
                    let (first, second) = (self.leaf_event(a), self.leaf_event(b));
                    if first.is_some() && second.is_some() {
                        return first;
                    }
                }
                _ => {
                    if let Some(event) = self.leaf_event(node) {
                        return Some(event);
                    }
                }
            }
        }
        None
    }

    fn leaf_event(&self, node: NodeId) -> Option<String> {
        let Node::Leaf(Leaf::Special(position)) = self.lowering.graph.node(node) else { return None };
        match self.lowering.specials.get(position as usize)? {
            Special::Event(name) => Some(name.clone()),
            _ => None,
        }
    }

    /// Complains about a divisor that is the number 0, or a parameter with that value.
    pub(super) fn check_divisor(&mut self, divisor: &Typed, range: Range<usize>) {
        let Some(node) = divisor.node().filter(|_| !self.untaken) else { return };
        let (span, written) = (self.span(range.clone()), self.written_at(range));
        match self.lowering.graph.node(node) {
            Node::Number(bits) if f64::from_bits(bits) == 0.0 => {
                self.report(hs0205_division_by_zero::by_number(span, &written));
            }
            Node::Leaf(Leaf::Variable(id))
                if self.lowering.symbols.known_value(id).is_some_and(|(_, value)| value == 0.0) =>
            {
                self.report(hs0205_division_by_zero::by_parameter(span, &written));
            }
            _ => {}
        }
    }

    fn conditional(&mut self, conditional: &ast::Conditional) -> Option<Typed> {
        let condition = self.condition(conditional.condition().as_ref());
        let decided = condition.as_ref().and_then(|c| self.lowering.evaluated(c, &mut Vec::new()));
        let decided = decided.and_then(|numbers| numbers.first().copied());
        let (then_value, else_value) = (conditional.then_value(), conditional.else_value());
        let a = self.branch(then_value.as_ref(), decided == Some(0.0));
        let b = self.branch(else_value.as_ref(), decided == Some(1.0));
        let (condition, mut a, mut b) = (condition?, a?, b?);
        let (left, right) = (then_value?, else_value?);
        if a.quantity != b.quantity {
            if self.lowering.dialect == Dialect::Hsml && (a.is_boolean() || b.is_boolean())
                || a.quantity == Quantity::Text
                || b.quantity == Quantity::Text
            {
                let (first, second) = (self.span(left.range()), self.span(right.range()));
                let kinds = (a.quantity, b.quantity);
                self.report(hs0210_wrong_kind::branches(first, second, kinds));
                return None;
            }
            (a, b) = (self.as_number(a, &left)?, self.as_number(b, &right)?);
            (a.quantity, b.quantity) = (Quantity::Real, Quantity::Real);
        }
        if a.shape != b.shape {
            let (first, second) = (self.span(left.range()), self.span(right.range()));
            self.report(hs0211_shape::branches(first, second, (a.shape, b.shape)));
            return None;
        }
        let measured = match a.measured.agree(b.measured) {
            Ok(measured) => measured,
            Err(mismatch) => {
                self.mismatch("alternatives", mismatch, left.range(), right.range());
                return None;
            }
        };
        let condition_node = condition.node()?;
        let pairs = a.elements.as_slice().iter().zip(b.elements.as_slice());
        let graph = &mut *self.lowering.graph;
        let elements: Vec<NodeId> = pairs.map(|(&a, &b)| graph.select(condition_node, a, b)).collect();
        let varies = condition.varies.max(a.varies).max(b.varies);
        Some(Typed { measured, varies, ..a.with(a.shape, elements) })
    }

    /// A branch; in one that is never taken, nothing is divided by zero.
    fn branch(&mut self, expression: Option<&Expression>, untaken: bool) -> Option<Typed> {
        let before = self.untaken;
        self.untaken |= untaken;
        let value = expression.and_then(|e| self.expression(e));
        self.untaken = before;
        value
    }

    /// Two operands whose units do not fit.
    pub(super) fn mismatch(
        &mut self,
        done: &str,
        mismatch: Mismatch,
        left: Range<usize>,
        right: Range<usize>,
    ) {
        let diagnostic = hs0209_units::operands(done, self.span(left), self.span(right), mismatch);
        self.report(diagnostic);
    }

    /// The component becomes larger than any that could be run; said once.
    pub(super) fn too_large(&mut self, span: Span, function: Option<&str>) {
        if !self.lowering.findings.too_large {
            self.lowering.findings.too_large = true;
            self.report(match function {
                Some(name) => hs0304_too_large::diagnostic(span, name, LARGEST),
                None => hs0304_too_large::expression(span, LARGEST),
            });
        }
    }

    /// Whether there is room for more; reports if there is not.
    pub(super) fn has_room(&mut self, span: Span, function: Option<&str>) -> bool {
        let full = self.lowering.symbols.work > LARGEST || self.lowering.graph.len() > LARGEST;
        if full {
            self.too_large(span, function);
        }
        !full && !self.lowering.findings.too_large
    }

    /// Reports unless the text has mistakes of grammar: its structure is then a guess.
    pub(super) fn report(&mut self, diagnostic: Diagnostic) {
        if self.text.well_formed {
            self.lowering.report(diagnostic);
        }
    }

    pub(super) fn graph(&mut self) -> &mut Graph {
        self.lowering.graph
    }

    pub(super) fn span(&self, range: Range<usize>) -> Span {
        self.text.map.span(range)
    }

    pub(super) fn written(&self, expression: &Expression) -> String {
        self.written_at(expression.range())
    }

    pub(super) fn written_at(&self, range: Range<usize>) -> String {
        self.text.text.get(range).unwrap_or("").to_owned()
    }
}

impl Lowering<'_, '_> {
    /// A text by its number.
    pub(super) fn text(&mut self, text: &str) -> Typed {
        let number = Model::text_number(self.texts, text);
        let node = self.graph.number(number as f64);
        Typed::scalar(node, Quantity::Text, Measured::Unchecked, Varies::Never)
    }

    /// Numbers that are fixed for all classes.
    pub(super) fn numbers(&mut self, numbers: &Numbers) -> Typed {
        let is_truth = numbers.quantity == Quantity::Boolean;
        let node = |&number: &f64| {
            if is_truth { self.graph.boolean(number != 0.0) } else { self.graph.number(number) }
        };
        let nodes: Vec<NodeId> = numbers.elements.iter().map(node).collect();
        Typed {
            elements: nodes.into(),
            shape: numbers.shape,
            quantity: numbers.quantity,
            measured: numbers.measured,
            varies: Varies::Never,
        }
    }

    /// References to some elements of a variable.
    pub(super) fn leaves(&mut self, variable: &VariableSymbol, range: Range<usize>, shape: Shape) -> Typed {
        let id = |element: usize| {
            VariableId(variable.first.0.saturating_add(u32::try_from(element).unwrap_or(u32::MAX)))
        };
        let mut nodes: Vec<NodeId> =
            range.map(|element| self.graph.leaf(Leaf::Variable(id(element)))).collect();
        if variable.quantity == Quantity::Boolean {
            nodes = self.truths(&nodes);
        }
        Typed {
            elements: nodes.into(),
            shape,
            quantity: variable.quantity,
            measured: variable.measured,
            varies: variable.varies,
        }
    }
}
