use super::builder::{Builder, GivenValue};
use crate::checks::{
    hs0107_declared_twice, hs0108_defined_twice, hs0123_knob_without_value, hs0149_name_with_a_bracket,
    hs0209_units, hs0301_circular_constants,
};
use crate::declarations::{
    Dialect, ExpressionText, KnobDeclaration, ParameterDeclaration, RangeText, Spanned,
};
use crate::dependency_order::dependency_order;
use crate::lower::{
    Expected, Place, Shape, Symbol, SymbolKind, SymbolValue, VariableSymbol, Varies, names_in,
};
use sophy_diagnostics::Span;
use sophy_ir::{NodeId, Quantity, Variable, VariableId, VariableKind};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// A parameter as declared: as a knob, by its assignment, or both.
struct Parameter<'a> {
    name: &'a Spanned<String>,
    knob: Option<&'a KnobDeclaration>,
    value: Option<&'a ParameterDeclaration>,
}

impl<'a> Builder<'_, 'a> {
    /// Enters knobs and parameters, each after those its value reads.
    pub(crate) fn declare_parameters(&mut self) {
        let parameters = self.written_parameters();
        let place: HashMap<&str, usize> =
            parameters.iter().enumerate().map(|(index, p)| (p.name.value.as_str(), index)).collect();
        let needs: Vec<Vec<usize>> = parameters
            .iter()
            .map(|parameter| {
                let names = parameter.value.map(|value| self.names_read(&value.value)).unwrap_or_default();
                names.iter().filter_map(|name| place.get(name.as_str()).copied()).collect()
            })
            .collect();
        for parameter in &parameters {
            let symbol = Symbol {
                kind: self.parameter_kind(parameter),
                span: parameter.name.span,
                value: SymbolValue::Broken,
            };
            self.declare(parameter.name, symbol);
        }
        let sorted = dependency_order(&needs);
        for cycle in &sorted.cycles {
            let members: Vec<&ParameterDeclaration> =
                cycle.iter().filter_map(|&index| parameters[index].value).collect();
            self.report(hs0301_circular_constants::parameters(&members, self.declaration.dialect));
        }
        for index in sorted.order {
            self.lower_parameter(&parameters[index]);
        }
        for parameter in &parameters {
            self.bound_parameter(parameter);
        }
    }

    /// The range of a knob may read any parameter, so it is looked at when all are known.
    fn bound_parameter(&mut self, parameter: &Parameter<'a>) {
        let Some(range) = parameter.knob.and_then(|knob| knob.range.as_ref()) else { return };
        let symbol = self.symbols.declared(&parameter.name.value);
        let Some(SymbolValue::Variable(symbol)) = symbol.map(|symbol| &symbol.value) else { return };
        let ids = symbol.first.0..symbol.first.0 + symbol.shape.len() as u32;
        let known: Vec<f64> =
            ids.clone().filter_map(|id| self.values.get(&VariableId(id)).copied()).collect();
        let allowed = self.range_of(Some(range)).allowed();
        for id in ids {
            if let Some(variable) = self.variables.get_mut(id as usize) {
                variable.range.clone_from(&allowed);
            }
        }
        if let (Some(written), false) = (parameter.value, known.is_empty()) {
            self.check_in_range(&parameter.name.value, range, &known, written.value.span);
        }
    }

    /// Names that an expression reads, in SOPHY XML also by way of the functions it calls: these may use constants.
    fn names_read(&self, text: &ExpressionText) -> Vec<String> {
        let mut names = names_in(text);
        let mut next = 0;
        let mut known: HashSet<String> = names.iter().cloned().collect();
        while self.declaration.dialect == Dialect::Xml && next < names.len() {
            if let Some(SymbolValue::Function(function)) =
                self.shared.globals.get(&names[next]).map(|symbol| &symbol.value)
            {
                let arguments: HashSet<&str> =
                    function.parameters.iter().map(|(p, _)| p.value.as_str()).collect();
                let of_body = names_in(&function.body).into_iter();
                names.extend(
                    of_body.filter(|name| !arguments.contains(name.as_str()) && known.insert(name.clone())),
                );
            }
            next += 1;
        }
        names
    }

    /// Enters a name of the component; says so if it is taken.
    pub(crate) fn declare(&mut self, name: &Spanned<String>, symbol: Symbol<'a>) -> bool {
        if name.value.is_empty() {
            return false;
        }
        if let Some(found) = hs0149_name_with_a_bracket::find(name) {
            self.report(found);
        }
        let (kind, again) = (symbol.kind, symbol.span);
        let taken = self.symbols.declare(&name.value, symbol).map(|first| (first.kind, first.span));
        if let Some((first_kind, first)) = taken {
            self.report(hs0107_declared_twice::diagnostic(&name.value, (first_kind, first), (kind, again)));
        } else if let Some(function) = self.function_of_xml(&name.value) {
            let own = (kind, again);
            let (first, again) =
                if function.1.start < again.start { (function, own) } else { (own, function) };
            self.report(hs0107_declared_twice::diagnostic(&name.value, first, again));
        }
        taken.is_none()
    }

    /// Functions of SOPHY XML belong to its one component.
    fn function_of_xml(&self, name: &str) -> Option<(SymbolKind, Span)> {
        let function = self.shared.globals.get(name).filter(|s| s.kind == SymbolKind::Function)?;
        (self.declaration.dialect == Dialect::Xml).then_some((function.kind, function.span))
    }

    /// What members can give the parameters of this component; `None` where that is not known.
    pub(crate) fn parameters_of_members(&self) -> Vec<(String, Option<Expected>)> {
        let declaration = self.declaration;
        let knobs = declaration.knobs.iter().map(|knob| &knob.name);
        let names = knobs.chain(declaration.parameters.iter().map(|parameter| &parameter.name));
        let mut seen: HashSet<&str> = HashSet::new();
        let first = names.filter(|name| !name.value.is_empty() && seen.insert(&name.value));
        let expected = |name: &Spanned<String>| {
            let (_, expected) = self.expected(&name.value, "")?;
            Some(Expected { what: format!("parameter `{}`", name.value), ..expected })
        };
        first.map(|name| (name.value.clone(), expected(name))).collect()
    }

    fn written_parameters(&mut self) -> Vec<Parameter<'a>> {
        let declaration = self.declaration;
        let mut parameters: Vec<Parameter<'a>> = declaration
            .knobs
            .iter()
            .map(|knob| Parameter { name: &knob.name, knob: Some(knob), value: None })
            .collect();
        let mut place: HashMap<&str, usize> = HashMap::new();
        for (index, parameter) in parameters.iter().enumerate() {
            place.entry(parameter.name.value.as_str()).or_insert(index);
        }
        for value in &declaration.parameters {
            let name = value.name.value.as_str();
            match place.get(name).map(|&index| &mut parameters[index]) {
                Some(known) if known.value.is_none() => known.value = Some(value),
                Some(known) if declaration.dialect == Dialect::Hsml => {
                    let first = known.value.map_or(known.name.span, |first| first.name.span);
                    let what = format!("the value of `{name}`");
                    self.report(hs0108_defined_twice::diagnostic(&what, first, value.name.span));
                }
                _ => {
                    place.entry(name).or_insert(parameters.len());
                    parameters.push(Parameter { name: &value.name, knob: None, value: Some(value) });
                }
            }
        }
        parameters
    }

    fn parameter_kind(&self, parameter: &Parameter<'_>) -> SymbolKind {
        match (parameter.knob, self.declaration.dialect) {
            (_, Dialect::Xml) => SymbolKind::Constant,
            (Some(_), _) => SymbolKind::Knob,
            (None, _) => SymbolKind::Parameter,
        }
    }

    fn lower_parameter(&mut self, parameter: &Parameter<'a>) {
        let name = parameter.name;
        let is_first = self.symbols.declared(&name.value).is_some_and(|symbol| symbol.span == name.span);
        let Some(written) = parameter.value else {
            self.report(hs0123_knob_without_value::diagnostic(&name.value, name.span));
            return;
        };
        let xml = self.declaration.dialect == Dialect::Xml;
        let place = if xml { Place { what: "a constant", ..Place::PARAMETER } } else { Place::PARAMETER };
        let Some(mut value) = self.at(place).value(&written.value) else { return };
        if !is_first {
            return;
        }
        let of_knob = parameter.knob.and_then(|knob| knob.unit.as_ref());
        let unit = of_knob.or(written.unit.as_ref());
        self.written_unit(written.unit.as_ref(), &mut value, name);
        let declared = self.measured(of_knob);
        if let (Some(knob), Err(mismatch)) = (of_knob, value.measured.agree(declared)) {
            let what = format!("knob `{}`", name.value);
            self.report(hs0209_units::assigned(written.value.span, &what, Some(knob.span), mismatch));
        }
        let measured = self.measured_in(declared, &value);
        let quantity = if value.quantity == Quantity::Integer { Quantity::Real } else { value.quantity };
        let value = self.as_stored(value);
        // Texts read nothing.
        let texts = parameter.knob.and_then(|knob| knob.range.as_ref());
        let texts = texts.filter(|range| matches!(range, RangeText::Set(_)));
        let choices = self.range_of(texts).choices;
        let first = VariableId(self.variables.len() as u32);
        let (shape, nodes): (Shape, Vec<Option<NodeId>>) = match self.given.get(&name.value) {
            None => (value.shape, value.elements.as_slice().iter().copied().map(Some).collect()),
            Some(GivenValue { shape, values: Some(values) }) => {
                (*shape, values.iter().map(|&value| Some(self.graph.number(value))).collect())
            }
            Some(GivenValue { shape, values: None }) => (*shape, vec![None; shape.len()]),
        };
        let documentation = match parameter.knob {
            Some(knob) if !knob.documentation.is_empty() => &knob.documentation,
            _ => &written.documentation,
        };
        let mut known = Vec::with_capacity(nodes.len());
        for (k, &node) in nodes.iter().enumerate() {
            let computed = node.and_then(|node| self.known_value(node));
            // Each copy says what it is.
            let node = node.unwrap_or_else(|| self.graph.number(0.0));
            let id = VariableId(self.variables.len() as u32);
            if let Some(computed) = computed {
                self.values.insert(id, computed);
                known.push(computed);
            }
            self.variables.push(Variable {
                name: format!("{}{}", name.value, shape.suffix(k)),
                kind: VariableKind::Parameter { value: node, knob: parameter.knob.is_some() },
                quantity,
                range: None,
                choices: choices.clone(),
                viewed: false,
                structural: false,
                unit: self.unit_label(&name.value, unit),
                documentation: documentation.clone(),
                span: Some(name.span),
            });
        }
        let all_known = known.len() == nodes.len();
        let symbol = VariableSymbol {
            first,
            shape,
            quantity,
            measured,
            varies: Varies::Parameters,
            choices: Rc::from(choices),
            known: all_known.then(|| Rc::from(known)),
        };
        let kind = self.parameter_kind(parameter);
        self.symbols
            .redeclare(&name.value, Symbol { kind, span: name.span, value: SymbolValue::Variable(symbol) });
    }
}
