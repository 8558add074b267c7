use super::files::Files;
use super::lowering::{Expected, Lowering};
use super::names_in;
use super::scope::{Globals, Numbers, Place, Symbol, SymbolKind, SymbolValue, Symbols};
use crate::checks::{hs0301_circular_constants, hs0302_recursive_function};
use crate::declarations::{Dialect, ExpressionText, FunctionDeclaration, ParameterDeclaration, Spanned};
use crate::dependency_order::dependency_order;
use crate::findings::Findings;
use crate::units::{self, Measured};
use sophy_diagnostics::Severity;
use sophy_ir::Graph;
use std::collections::{BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// A constant, parameter or function, which may use others.
#[derive(Clone, Copy)]
pub(crate) struct Definition<'a> {
    pub(crate) name: &'a Spanned<String>,
    pub(crate) text: &'a ExpressionText,
    /// The function it is, if it is one.
    pub(crate) function: Option<&'a FunctionDeclaration>,
}

impl<'a> Definition<'a> {
    pub(crate) fn of_parameter(parameter: &'a ParameterDeclaration) -> Self {
        Definition { name: &parameter.name, text: &parameter.value, function: None }
    }

    pub(crate) fn of_function(function: &'a FunctionDeclaration) -> Self {
        Definition { name: &function.name, text: &function.body, function: Some(function) }
    }
}

/// Definitions by position, each after those it uses. Those that go round in a circle are left out, and reported
/// (HS0301, HS0302). Of several with one name the first is the one that is used.
pub(crate) fn in_order(definitions: &[Definition<'_>], findings: &mut Findings) -> Vec<usize> {
    let mut first: HashMap<&str, usize> = HashMap::with_capacity(definitions.len());
    for (position, definition) in definitions.iter().enumerate() {
        first.entry(definition.name.value.as_str()).or_insert(position);
    }
    let needs = |definition: &Definition<'_>| {
        let hides: HashSet<&str> = match definition.function {
            Some(function) => function.parameters.iter().map(|(name, _)| name.value.as_str()).collect(),
            None => HashSet::new(),
        };
        let used = names_in(definition.text).into_iter().filter(|name| !hides.contains(name.as_str()));
        used.filter_map(|name| first.get(name.as_str()).copied()).collect()
    };
    let needs: Vec<Vec<usize>> = definitions.iter().map(needs).collect();
    let sorted = dependency_order(&needs);
    for cycle in &sorted.cycles {
        let members: Vec<&Definition<'_>> =
            cycle.iter().filter_map(|&index| definitions.get(index)).collect();
        findings.report(if members.iter().all(|member| member.function.is_some()) {
            hs0302_recursive_function::diagnostic(&members)
        } else {
            let members: Vec<_> = members.iter().map(|member| (member.name, member.text)).collect();
            hs0301_circular_constants::diagnostic(&members, "constant")
        });
    }
    sorted.order
}

/// Constants and functions of files, each after those it uses; each computed or checked once. Functions of SOPHY XML
/// use the constants of a component and are checked there ([`Lowering::check_functions`]).
///
/// Mistakes are reported; what has one is [`SymbolValue::Broken`]. The first declaration of a name counts; that
/// there are others is not reported here, nor is what is wrong with the unit of a constant.
pub(crate) fn lower_globals<'a>(
    constants: &[&'a ParameterDeclaration],
    functions: &[&'a FunctionDeclaration],
    dialect: Dialect,
    files: &mut Files<'a>,
    texts: &mut Vec<String>,
    findings: &mut Findings,
) -> Globals<'a> {
    let definitions: Vec<Definition<'a>> =
        (constants.iter().map(|constant| Definition::of_parameter(constant)))
            .chain(functions.iter().map(|function| Definition::of_function(function)))
            .collect();
    let order = in_order(&definitions, findings);
    let mut globals = Rc::new(declared(&definitions));
    for index in order {
        let Some(&definition) = definitions.get(index) else { continue };
        let name = definition.name.value.as_str();
        if globals.get(name).is_none_or(|symbol| symbol.span != definition.name.span) {
            continue; // declared before
        }
        let (mut graph, mut specials, mut structural) = (Graph::default(), Vec::new(), BTreeSet::new());
        let mut symbols = Symbols::new(Rc::clone(&globals));
        let mut lowering = Lowering {
            graph: &mut graph,
            specials: &mut specials,
            symbols: &mut symbols,
            place: Place::CONSTANT,
            findings: &mut *findings,
            texts: &mut *texts,
            files: &mut *files,
            dialect,
            structural: &mut structural,
        };
        let value = match (definition.function, constants.get(index)) {
            (Some(function), _) if dialect == Dialect::Xml => {
                Some((SymbolKind::Function, SymbolValue::Function(function)))
            }
            (Some(function), _) => {
                lowering.place = Place::FUNCTION;
                Some((SymbolKind::Function, lowering.check_function(function)))
            }
            (None, Some(constant)) => lowering.constant(constant),
            (None, None) => None,
        };
        drop(symbols);
        if let (Some((kind, value)), Some(globals)) = (value, Rc::get_mut(&mut globals))
            && let Some(symbol) = globals.get_mut(name)
        {
            symbol.kind = kind;
            symbol.value = value;
        }
    }
    Rc::try_unwrap(globals).unwrap_or_else(|shared| Globals::clone(&shared))
}

/// All names, nothing known of them yet.
fn declared<'a>(definitions: &[Definition<'a>]) -> Globals<'a> {
    let mut globals = Globals::new();
    for definition in definitions.iter().filter(|definition| !definition.name.value.is_empty()) {
        let kind = if definition.function.is_some() { SymbolKind::Function } else { SymbolKind::Constant };
        let symbol = Symbol { kind, span: definition.name.span, value: SymbolValue::Broken };
        globals.entry(definition.name.value.clone()).or_insert(symbol);
    }
    globals
}

impl<'a> Lowering<'_, 'a> {
    /// A constant of a file: numbers, truth values, a text or a record.
    fn constant(&mut self, constant: &'a ParameterDeclaration) -> Option<(SymbolKind, SymbolValue<'a>)> {
        if let Some(record) = self.record(&constant.value) {
            return Some((SymbolKind::Record, SymbolValue::Record(record?)));
        }
        let errors = self.findings.diagnostics.count(Severity::Error);
        let mut value = self.value(&constant.value)?;
        let what = format!("constant `{}`", constant.name.value);
        if let Some(kind) = &constant.kind {
            let measured = value.measured;
            let expected = self.expected(Some(kind), what.clone(), kind.name.span)?;
            value = self.fit(value, constant.value.span, &expected)?;
            value.measured = measured;
        }
        if let Some(unit) = &constant.unit
            && let Ok(parsed) = units::parse(&unit.value)
        {
            let measured = Measured::Known(parsed.unit);
            let expected = Expected { measured, ..Expected::of(&value, what, Some(unit.span)) };
            value = self.fit(value, constant.value.span, &expected)?;
        }
        let elements = self.known(&value)?;
        if self.findings.diagnostics.count(Severity::Error) > errors {
            return None;
        }
        // A literal has no unit, and yet a constant is a quantity: nothing is known of its unit.
        let measured = match value.measured {
            Measured::Number(_) => Measured::Unchecked,
            known => known,
        };
        let numbers = Numbers { elements, shape: value.shape, quantity: value.quantity, measured };
        Some((SymbolKind::Constant, SymbolValue::Numbers(Rc::new(numbers))))
    }
}
