use super::complaints::Complaints;
use super::expressions::Expressions;
use sophy_analysis::{
    ComponentDeclaration, Dialect, FunctionDeclaration, ParameterDeclaration, RangeText, Spanned, Statement,
};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

type Hints<'c> = Vec<(String, Cow<'c, str>)>;

/// The hints in the order first location, initial state, units, knobs, views, functions, documentation, others.
pub(super) fn hints<'c>(
    component: &'c ComponentDeclaration,
    functions: &'c [FunctionDeclaration],
    constants: &'c [ParameterDeclaration],
    expressions: &mut Expressions,
    complaints: &mut Complaints,
) -> Hints<'c> {
    let mut hints = Hints::new();
    if let Some(location) = &component.initial_location {
        hints.push(("initial location".to_owned(), Cow::Borrowed(&location.value)));
    }
    initial(component, &mut hints, expressions, complaints);
    units(component, constants, &mut hints);
    for knob in &component.knobs {
        let range = knob
            .range
            .as_ref()
            .map_or(Cow::Borrowed(""), |range| Cow::Owned(range_text(range, expressions, complaints)));
        hints.push((format!("knob {}", knob.name.value), range));
    }
    for view in &component.views {
        hints.push((format!("view {}", view.value), Cow::Borrowed("")));
    }
    for function in functions {
        hints.push((head(function), expressions.constant(&function.body, complaints)));
    }
    documentation(component, functions, constants, &mut hints);
    let others = component.hints.iter();
    hints.extend(others.map(|(name, text)| (name.value.clone(), Cow::Borrowed(text.value.as_str()))));
    hints
}

fn initial<'c>(
    component: &'c ComponentDeclaration,
    hints: &mut Hints<'c>,
    expressions: &mut Expressions,
    complaints: &mut Complaints,
) {
    let declared = component.variables.iter().filter_map(|v| Some((&v.name, v.initial.as_ref()?)));
    let assigned = component.initial.iter().filter_map(|statement| match statement {
        Statement::Assign { target, right } if target.indices.is_empty() => Some((&target.name, right)),
        other => {
            let way_out = "assign numbers and constants to states, one by one";
            complaints_at(other, complaints, "SOPHY XML has initial values only, no statements", way_out);
            None
        }
    });
    let all: Vec<_> = declared.chain(assigned).collect();
    let ports = component.ports.iter().map(|port| port.name.value.as_str());
    let changing: HashSet<&str> =
        ports.chain(component.variables.iter().map(|variable| variable.name.value.as_str())).collect();
    for (name, value) in all {
        if component.dialect == Dialect::Hsml
            && let Some(other) = first_reference(value, &changing)
        {
            complaints.cannot(
                value.span,
                format!("in SOPHY XML the initial value of `{}` cannot depend on `{other}`", name.value),
                "write it with parameters only",
            );
        }
        hints.push((format!("initial {}", name.value), expressions.constant(value, complaints)));
    }
}

/// The first of `names` that an expression reads.
fn first_reference(expression: &sophy_analysis::ExpressionText, names: &HashSet<&str>) -> Option<String> {
    use sophy_syntax::ast::Expression;
    let tree = expression.expression.as_ref()?;
    tree.syntax().descendants().find_map(|node| match Expression::cast(node)? {
        Expression::Reference(reference) => reference.name().filter(|name| names.contains(name.as_str())),
        _ => None,
    })
}

/// Complains about a statement.
pub(super) fn complaints_at(statement: &Statement, complaints: &mut Complaints, what: &str, way_out: &str) {
    let mut statement = statement;
    let span = loop {
        match statement {
            Statement::Assign { target, .. } => break target.name.span,
            Statement::Emit(name) | Statement::Hold(name) => break name.span,
            Statement::For(repeated) => break repeated.variable.span,
            Statement::If { branches, otherwise } => match (branches.first(), otherwise.first()) {
                (Some((condition, _)), _) => break condition.span,
                (None, Some(first)) => statement = first,
                (None, None) => return,
            },
        }
    };
    complaints.cannot(span, what, way_out);
}

/// Units, once for each name.
fn units<'c>(
    component: &'c ComponentDeclaration,
    constants: &'c [ParameterDeclaration],
    hints: &mut Hints<'c>,
) {
    let mut push = |name: &Spanned<String>, unit: &'c Spanned<String>| {
        hints.push((format!("unit {}", name.value), Cow::Borrowed(unit.value.as_str())));
    };
    component.units.iter().for_each(|(name, unit)| push(name, unit));
    let variables = component.variables.iter().map(|v| (&v.name, &v.unit));
    let ports = component.ports.iter().map(|p| (&p.name, &p.unit));
    let knobs = component.knobs.iter().map(|k| (&k.name, &k.unit));
    let parameters = constants.iter().chain(&component.parameters).map(|p| (&p.name, &p.unit));
    let mut seen: HashSet<&str> = HashSet::new();
    for (name, unit) in variables.chain(ports).chain(knobs).chain(parameters) {
        if let Some(unit) = unit
            && seen.insert(&name.value)
        {
            push(name, unit);
        }
    }
}

fn range_text(range: &RangeText, expressions: &mut Expressions, complaints: &mut Complaints) -> String {
    let mut text = |expression| expressions.constant(expression, complaints);
    match range {
        RangeText::Bounds(low, high) => format!("({}, {})", text(low), text(high)),
        RangeText::Set(values) => format!("{{{}}}", values.iter().map(text).collect::<Vec<_>>().join(", ")),
    }
}

/// `function f(a, b)`
fn head(function: &FunctionDeclaration) -> String {
    let parameters: Vec<&str> = function.parameters.iter().map(|(name, _)| name.value.as_str()).collect();
    format!("function {}({})", function.name.value, parameters.join(", "))
}

/// Of knobs, constants and functions, which have none in the definition; one text for each name.
fn documentation<'c>(
    component: &'c ComponentDeclaration,
    functions: &'c [FunctionDeclaration],
    constants: &'c [ParameterDeclaration],
    hints: &mut Hints<'c>,
) {
    let knobs = component.knobs.iter().map(|knob| (&knob.name, &knob.documentation));
    let parameters = constants.iter().chain(&component.parameters).map(|p| (&p.name, &p.documentation));
    let functions = functions.iter().map(|function| (&function.name, &function.documentation));
    let mut at: HashMap<&str, usize> = HashMap::new();
    for (name, text) in knobs.chain(parameters).chain(functions).filter(|(_, text)| !text.is_empty()) {
        let next = *at.entry(&name.value).or_insert(hints.len());
        match hints.get_mut(next) {
            Some((_, present)) => *present = Cow::Owned(format!("{present}\n{text}")),
            None => hints.push((format!("documentation {}", name.value), Cow::Borrowed(text))),
        }
    }
}
