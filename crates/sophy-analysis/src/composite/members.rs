use super::library::{Entry, Library};
use crate::checks::{
    hs0107_declared_twice, hs0108_defined_twice, hs0126_out_of_range, hs0138_unknown_component,
    hs0139_unknown_parameter, hs0140_array_of_components,
};
use crate::component::{Builder, Given, GivenValue};
use crate::declarations::{
    ComponentKind, ExpressionText, MemberDeclaration, MemberItem, ParameterDeclaration, Spanned,
};
use crate::lower::{Expected, Place, Shape, Symbol, SymbolKind, SymbolValue, Typed};
use sophy_diagnostics::{Diagnostic, Span};
use sophy_ir::{Allowed, Class, Graph, Member, NodeId, VariableId};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::rc::Rc;

/// Members of a composite.
#[derive(Default)]
pub(crate) struct Members {
    pub(crate) list: Vec<Member>,
    /// Per member: what it is a copy of.
    pub(crate) entries: Vec<Rc<Entry>>,
    /// Per member: the kind of its component.
    pub(crate) kinds: Vec<ComponentKind>,
    /// All forms of components that they are, those with mistakes, too.
    pub(crate) used: BTreeMap<usize, Rc<Entry>>,
    by_name: HashMap<String, Named>,
    /// Whether some member, entered or not, has no class: then the composite has none either.
    pub(crate) broken: bool,
    /// Whether some member is not known at all.
    pub(crate) missing: bool,
}

/// What a member name stands for.
#[derive(Debug)]
pub(crate) enum Named {
    /// One member, or an array of equal ones.
    One(usize),
    /// Elements that were declared one by one, by their indices.
    Elements(HashMap<Vec<u32>, usize>, Span),
    /// Its declaration has mistakes.
    Broken,
}

impl Members {
    pub(crate) fn named(&self, name: &str) -> Option<&Named> {
        self.by_name.get(name)
    }

    pub(crate) fn names(&self) -> BTreeSet<&str> {
        self.by_name.keys().map(String::as_str).collect()
    }

    /// `cell[17]`.
    pub(crate) fn full_name(&self, position: usize, copy: u32) -> String {
        let member = &self.list[position];
        let indices = if member.extents.is_empty() {
            member.element.clone()
        } else {
            let mut rest = copy;
            let mut indices: Vec<u32> = Vec::new();
            for &extent in member.extents.iter().rev() {
                indices.push(rest % extent.max(1) + 1);
                rest /= extent.max(1);
            }
            indices.reverse();
            indices
        };
        if indices.is_empty() {
            return member.name.clone();
        }
        let indices: Vec<String> = indices.iter().map(u32::to_string).collect();
        format!("{}[{}]", member.name, indices.join(","))
    }
}

/// The most copies an array of components may have.
pub(crate) const MOST_COPIES: u64 = 100_000_000;

/// Makes the members of a composite, loops run.
pub(crate) fn expand_members<'a>(builder: &mut Builder<'_, 'a>, library: &mut Library<'a>) -> Members {
    let mut members = Members::default();
    let declaration = builder.declaration;
    expand(builder, library, &declaration.members, &mut members);
    members
}

fn expand<'a>(
    builder: &mut Builder<'_, 'a>,
    library: &mut Library<'a>,
    items: &'a [MemberItem],
    members: &mut Members,
) {
    for item in items {
        match item {
            MemberItem::Member(member) => {
                if add(builder, library, member, members).is_none() {
                    members.broken = true;
                    members.missing = true;
                    if !member.name.value.is_empty() {
                        members.by_name.entry(member.name.value.clone()).or_insert(Named::Broken);
                    }
                }
            }
            MemberItem::For(turns) => {
                builder.each_turn(turns, |builder| expand(builder, library, &turns.items, members));
            }
        }
    }
}

fn add<'a>(
    builder: &mut Builder<'_, 'a>,
    library: &mut Library<'a>,
    written: &'a MemberDeclaration,
    members: &mut Members,
) -> Option<()> {
    let name = &written.name;
    if name.value.is_empty() || written.component.value.is_empty() {
        return None;
    }
    let Some(component) = library.named(&written.component.value) else {
        builder.report(hs0138_unknown_component::diagnostic(&written.component, &library.components));
        return None;
    };
    let element = whole_numbers(builder, &written.indices, "an index")?;
    let extents = whole_numbers(builder, &written.extents, "the number of copies")?;
    let copies: u64 = extents.iter().map(|&n| u64::from(n)).product();
    if copies > MOST_COPIES || extents.contains(&0) {
        let span = written.extents.first().map_or(name.span, |extent| extent.span);
        builder.report(hs0140_array_of_components::extent(&name.value, &extents, span));
        return None;
    }
    if !element.is_empty() && !extents.is_empty() {
        builder.report(hs0140_array_of_components::both(&name.value, name.span));
        return None;
    }
    let default = library.entry(builder.shared, component, &Given::new());
    let values = values(builder, written, &default);
    let given = values.iter().map(|(name, _, value)| (name.value.clone(), given(builder, value))).collect();
    let entry = library.entry(builder.shared, component, &given);
    members.used.entry(entry.number).or_insert_with(|| Rc::clone(&entry));
    // A component with mistakes still has ports: what connects them is checked, and nothing comes of it.
    let class = entry.class.unwrap_or_default();
    members.broken |= entry.class.is_none();
    let parameters = match entry.class.and_then(|class| library.classes.get(class.0 as usize)) {
        Some(class) => parameters(builder, &entry, class, written, values),
        None => Vec::new(),
    };
    enter(builder, name, &element, members)?;
    members.list.push(Member {
        name: name.value.clone(),
        class,
        extents,
        element,
        parameters,
        documentation: written.documentation.clone(),
        span: Some(name.span),
    });
    members.entries.push(entry);
    members.kinds.push(library.components[component].kind);
    Some(())
}

/// Enters a member under its name; says so if the name is taken.
fn enter<'a>(
    builder: &mut Builder<'_, 'a>,
    name: &'a Spanned<String>,
    element: &[u32],
    members: &mut Members,
) -> Option<()> {
    let position = members.list.len();
    let known = members.by_name.get_mut(&name.value);
    match (known, element.is_empty()) {
        (Some(Named::Elements(elements, first)), false) => {
            if elements.insert(element.to_vec(), position).is_some() {
                let first = *first;
                let indices: Vec<String> = element.iter().map(u32::to_string).collect();
                let what = format!("`{}[{}]`", name.value, indices.join(","));
                builder.report(hs0108_defined_twice::diagnostic(&what, first, name.span));
                return None;
            }
            return Some(());
        }
        (Some(Named::One(first)), _) => {
            let first = members.list[*first].span.unwrap_or(name.span);
            let kinds = ((SymbolKind::Member, first), (SymbolKind::Member, name.span));
            builder.report(hs0107_declared_twice::diagnostic(&name.value, kinds.0, kinds.1));
            return None;
        }
        (Some(Named::Elements(_, first)), true) => {
            let first = *first;
            let kinds = ((SymbolKind::Member, first), (SymbolKind::Member, name.span));
            builder.report(hs0107_declared_twice::diagnostic(&name.value, kinds.0, kinds.1));
            return None;
        }
        (Some(Named::Broken), _) => return None,
        (None, _) => {}
    }
    let symbol = Symbol { kind: SymbolKind::Member, span: name.span, value: SymbolValue::None };
    if !builder.declare(name, symbol) {
        return None;
    }
    let named = if element.is_empty() {
        Named::One(position)
    } else {
        Named::Elements(HashMap::from([(element.to_vec(), position)]), name.span)
    };
    members.by_name.insert(name.value.clone(), named);
    Some(())
}

fn whole_numbers<'a>(
    builder: &mut Builder<'_, 'a>,
    texts: &'a [ExpressionText],
    what: &str,
) -> Option<Vec<u32>> {
    let mut numbers = Vec::with_capacity(texts.len());
    for text in texts {
        let number = builder.at(Place::PARAMETER).constant_integer(text, what)?;
        match u32::try_from(number) {
            Ok(number) if number > 0 => numbers.push(number),
            _ => {
                builder.report(hs0140_array_of_components::not_positive(what, number, text.span));
                return None;
            }
        }
    }
    Some(numbers)
}

/// A parameter that a member gives a value.
type Value<'a> = (&'a Spanned<String>, &'a ExpressionText, Typed);

/// Values that a member gives to parameters; `default` says what they must be.
fn values<'a>(
    builder: &mut Builder<'_, 'a>,
    written: &'a MemberDeclaration,
    default: &Entry,
) -> Vec<Value<'a>> {
    let mut values = Vec::new();
    let mut first: HashMap<&str, Span> = HashMap::new();
    for ParameterDeclaration { name, value: text, unit, .. } in &written.parameters {
        if let Some(&first) = first.get(name.value.as_str()) {
            let what = format!("the value of `{}`", name.value);
            builder.report(hs0108_defined_twice::diagnostic(&what, first, name.span));
        }
        first.insert(&name.value, name.span);
        let Some((_, parameter)) = default.parameters.iter().find(|(known, _)| *known == name.value) else {
            let names: Vec<&str> = default.parameters.iter().map(|(name, _)| name.as_str()).collect();
            builder.report(hs0139_unknown_parameter::diagnostic(name, &written.component, &names));
            builder.at(Place::PARAMETER).value(text);
            continue;
        };
        let Some(mut value) = builder.at(Place::PARAMETER).value(text) else { continue };
        builder.written_unit(unit.as_ref(), &mut value, name);
        let mut lowering = builder.at(Place::PARAMETER);
        let value = match parameter {
            Some(parameter) => {
                let shape = of_its_own(parameter.shape, value.shape);
                let expected = Expected { shape, ..parameter.clone() };
                lowering.fit(value, text.span, &expected)
            }
            // Its own value has a mistake, so that it could be anything.
            None => Some(value),
        };
        values.extend(value.map(|value| (name, text, value)));
    }
    values
}

/// A value brings its own extents, but not their number.
fn of_its_own(declared: Shape, given: Shape) -> Shape {
    if declared.extents().len() == given.extents().len() { given } else { declared }
}

/// What a form of the component can be made for.
fn given(builder: &mut Builder<'_, '_>, value: &Typed) -> GivenValue {
    let values = builder.at(Place::PARAMETER).evaluated(value, &mut Vec::new());
    GivenValue { shape: value.shape, values }
}

/// What is wrong with the value of a parameter, as far as its range is known.
fn outside(
    graph: &Graph,
    allowed: &Allowed,
    name: &str,
    value: f64,
    at: Span,
    declared: Span,
) -> Option<Diagnostic> {
    match allowed {
        Allowed::OneOf(set) => {
            (!set.contains(&value)).then(|| hs0126_out_of_range::not_in_set(name, at, declared))
        }
        Allowed::Between([low, high]) => {
            let (low, high) = (graph.as_number(*low)?, graph.as_number(*high)?);
            let outside = !(low..=high).contains(&value);
            outside.then(|| hs0126_out_of_range::diagnostic(name, value, low, high, at, declared))
        }
    }
}

/// Values of parameters, element by element.
fn parameters<'a>(
    builder: &mut Builder<'_, 'a>,
    entry: &Entry,
    class: &Class,
    written: &'a MemberDeclaration,
    values: Vec<Value<'a>>,
) -> Vec<(VariableId, NodeId)> {
    let mut parameters = Vec::new();
    for (name, text, value) in values {
        // What decides the structure of a member decides that of the composite, too.
        let decides = entry.structural.contains(&name.value);
        if decides && builder.at(Place::PARAMETER).known(&value).is_none() {
            builder.report(hs0139_unknown_parameter::not_known(name, &written.component, text.span));
        }
        let nodes = builder.at(Place::PARAMETER).stored(&value);
        for (k, node) in nodes.into_iter().enumerate() {
            let element = format!("{}{}", name.value, value.shape.suffix(k));
            let Some(id) = class.variable_named(&element) else { continue };
            parameters.push((id, node));
            let variable = class.variable(id);
            if let (Some(allowed), Some(value)) = (&variable.range, builder.known_value(node)) {
                let declared = variable.span.unwrap_or(name.span);
                let found = outside(&class.graph, allowed, &name.value, value, text.span, declared);
                found.into_iter().for_each(|found| builder.report(found));
            }
        }
    }
    parameters
}
