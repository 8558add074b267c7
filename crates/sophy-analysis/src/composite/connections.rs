use super::matrix::compose;
use super::members::{Members, Named};
use crate::checks::{
    hs0410_unknown_port, hs0411_connection_direction, hs0412_connected_units, hs0413_driven_twice,
    hs0415_connected_types, hs0416_connected_shapes, hs0418_connected_ranges,
};
use crate::component::{Builder, Interface, Port, PortType, shape_of_part};
use crate::declarations::{ComponentKind, ConnectionItem, Direction, PortText};
use crate::lower::Shape;
use sophy_diagnostics::Span;
use sophy_ir::{Composite, EventEnd, EventWire, Quantity, Sources, VariableId, Wire};
use std::collections::HashMap;

/// One end of a connection.
#[derive(Clone, Debug)]
pub(crate) struct End {
    /// `None` for a port of the composite itself.
    pub(crate) member: Option<usize>,
    pub(crate) copy: u32,
    pub(crate) what: EndKind,
    pub(crate) span: Span,
}

#[derive(Clone, Debug)]
pub(crate) enum EndKind {
    /// Elements of a port.
    Values { port: Box<Port>, positions: Vec<usize>, shape: Shape },
    /// An event label.
    Event { label: String, direction: Direction },
}

/// Wires while they are made.
pub(crate) struct Wiring<'m> {
    pub(crate) members: &'m Members,
    pub(crate) interface: &'m Interface,
    pub(crate) composite: Composite,
    /// Where each port is fed.
    pub(crate) fed: HashMap<sophy_ir::Port, Span>,
    /// Whether an end of a connection is not written, or not known.
    pub(crate) incomplete: bool,
    /// Where events are joined.
    joined: HashMap<(EventEnd, EventEnd), Span>,
}

/// The connections of a composite, loops run.
pub(crate) fn connect<'m>(
    builder: &mut Builder<'_, '_>,
    members: &'m Members,
    interface: &'m Interface,
) -> Wiring<'m> {
    let declaration = builder.declaration;
    let mut wiring = Wiring {
        members,
        interface,
        composite: Composite::default(),
        fed: HashMap::new(),
        incomplete: false,
        joined: HashMap::new(),
    };
    let written = builder.graph.len();
    connect_items(builder, &declaration.connections, &mut wiring);
    // Indices and weights are numbers by now; what they were computed with is no part of the model.
    builder.graph.truncate(written);
    wiring.composite.wires.shrink_to_fit();
    wiring.composite.event_wires.shrink_to_fit();
    wiring
}

fn connect_items<'a>(builder: &mut Builder<'_, 'a>, items: &'a [ConnectionItem], wiring: &mut Wiring<'_>) {
    for item in items {
        match item {
            ConnectionItem::Connect { from, to } => connect_one(builder, from, to, wiring),
            ConnectionItem::Compose { span, members, matrix } => {
                wiring.incomplete |= compose(builder, *span, members, matrix, wiring).is_none();
            }
            ConnectionItem::For(turns) => {
                builder.each_turn(turns, |builder| connect_items(builder, &turns.items, wiring));
            }
        }
    }
}

fn connect_one<'a>(
    builder: &mut Builder<'_, 'a>,
    from: &'a PortText,
    to: &'a PortText,
    wiring: &mut Wiring<'_>,
) {
    let (source, target) = (end(builder, from, wiring), end(builder, to, wiring));
    let (Some(source), Some(target)) = (source, target) else {
        wiring.incomplete = true;
        return;
    };
    if !directions(builder, &source, &target) {
        return;
    }
    match (&source.what, &target.what) {
        (EndKind::Event { direction, .. }, EndKind::Event { direction: other, .. })
            if (*direction == Direction::Synchronised) != (*other == Direction::Synchronised) =>
        {
            builder.report(hs0415_connected_types::event_and_label(source.span, target.span));
        }
        (EndKind::Event { label: from_label, direction }, EndKind::Event { label, direction: other }) => {
            let end = |end: &End, label: &str| EventEnd {
                member: end.member.map(|member| member as u32),
                copy: end.copy,
                label: label.into(),
            };
            let wire = EventWire {
                from: end(&source, from_label),
                to: end(&target, label),
                synchronised: *direction == Direction::Synchronised && *other == Direction::Synchronised,
                span: Some(source.span.to(target.span)),
            };
            add_event_wire(builder, wire, target.span, wiring);
        }
        (EndKind::Values { .. }, EndKind::Values { .. }) => values(builder, &source, &target, wiring),
        _ => builder.report(hs0415_connected_types::event_and_value(source.span, target.span)),
    }
}

/// Whether what feeds can feed and what is fed can be fed.
fn directions(builder: &mut Builder<'_, '_>, source: &End, target: &End) -> bool {
    let feeds = |end: &End, as_source: bool| {
        let direction = match &end.what {
            EndKind::Values { port, .. } => port.direction,
            EndKind::Event { direction, .. } => *direction,
        };
        // Seen from within, the inputs of the composite feed and its outputs are fed.
        let gives = (direction == Direction::Output) == end.member.is_some();
        direction == Direction::Synchronised || gives == as_source
    };
    match (feeds(source, true), feeds(target, false)) {
        (true, true) => true,
        (source_right, target_right) => {
            let reversed = feeds(target, true) && feeds(source, false);
            let wrong = if source_right { target.span } else { source.span };
            builder.report(hs0411_connection_direction::diagnostic(
                wrong,
                !source_right,
                target_right,
                reversed,
                (source.member.is_none(), target.member.is_none()),
            ));
            false
        }
    }
}

fn values(builder: &mut Builder<'_, '_>, source: &End, target: &End, wiring: &mut Wiring<'_>) {
    let (
        EndKind::Values { port: from, positions, shape },
        EndKind::Values { port: to, positions: to_positions, shape: to_shape },
    ) = (&source.what, &target.what)
    else {
        return;
    };
    let (from, to): (&Port, &Port) = (from, to);
    let receiver = target.member.and_then(|member| wiring.members.kinds.get(member).copied());
    if !suits(from.kind, to.kind, receiver) {
        builder.report(hs0415_connected_types::diagnostic((from, source.span), (to, target.span), receiver));
        return;
    }
    if shape != to_shape {
        builder.report(hs0416_connected_shapes::diagnostic((*shape, source.span), (*to_shape, target.span)));
        return;
    }
    if let Err(mismatch) = from.measured.agree(to.measured) {
        builder.report(hs0412_connected_units::diagnostic((from, source.span), (to, target.span), &mismatch));
    }
    hs0418_connected_ranges::find(builder, (from, source.span), (to, target.span));
    for (&k, &to_k) in positions.iter().zip(to_positions) {
        let port = |end: &End, port: &Port, k: usize| sophy_ir::Port {
            member: end.member.map(|member| member as u32),
            copy: end.copy,
            variable: VariableId(port.first.0 + k as u32),
        };
        let wire = Wire {
            to: port(target, to, to_k),
            from: Sources::One(port(source, from, k)),
            span: Some(source.span.to(target.span)),
        };
        add_wire(builder, wire, target.span, wiring);
    }
}

/// Adds a wire unless its target is fed already.
pub(crate) fn add_wire(builder: &mut Builder<'_, '_>, wire: Wire, at: Span, wiring: &mut Wiring<'_>) {
    if let Some(&first) = wiring.fed.get(&wire.to) {
        let name = port_name(wire.to, wiring);
        builder.report(hs0413_driven_twice::diagnostic(&name, first, at));
        return;
    }
    wiring.fed.insert(wire.to, at);
    wiring.composite.wires.push(wire);
}

/// Adds an event wire unless it is there. Several sources may send to one input.
fn add_event_wire(builder: &mut Builder<'_, '_>, wire: EventWire, at: Span, wiring: &mut Wiring<'_>) {
    let there = (wire.from.clone(), wire.to.clone());
    let back = (wire.to.clone(), wire.from.clone());
    let first = wiring.joined.get(&there).or_else(|| wiring.joined.get(&back).filter(|_| wire.synchronised));
    if let Some(&first) = first {
        let name = |end: &EventEnd| match end.member {
            None => end.label.to_string(),
            Some(member) => {
                format!("{}.{}", wiring.members.full_name(member as usize, end.copy), end.label)
            }
        };
        builder.report(hs0413_driven_twice::event(&name(&wire.from), &name(&wire.to), first, at));
        return;
    }
    wiring.joined.insert(there, at);
    wiring.composite.event_wires.push(wire);
}

fn port_name(port: sophy_ir::Port, wiring: &Wiring<'_>) -> String {
    let element = |ports: &[Port]| {
        let found = ports
            .iter()
            .find(|p| (p.first.0..p.first.0 + p.shape.len() as u32).contains(&port.variable.0))?;
        Some(format!("{}{}", found.name, found.shape.suffix((port.variable.0 - found.first.0) as usize)))
    };
    match port.member {
        None => element(&wiring.interface.ports).unwrap_or_default(),
        Some(member) => {
            let own = element(&wiring.members.entries[member as usize].interface.ports).unwrap_or_default();
            format!("{}.{own}", wiring.members.full_name(member as usize, port.copy))
        }
    }
}

/// Whether a port of one type can feed one of another; `receiver` is the kind of component fed.
pub(crate) fn suits(from: PortType, to: PortType, receiver: Option<ComponentKind>) -> bool {
    use PortType::{Held, Signal};
    match (from, to) {
        (Signal, Held(Quantity::Real)) => receiver == Some(ComponentKind::Dtc),
        (Held(Quantity::Real), Signal) => true,
        (from, to) => from == to,
    }
}

/// What a written port stands for.
pub(crate) fn end<'a>(
    builder: &mut Builder<'_, 'a>,
    written: &'a PortText,
    wiring: &Wiring<'_>,
) -> Option<End> {
    match written.parts.as_slice() {
        [(name, indices)] => {
            let what = port_end(builder, name, indices, wiring.interface, &|| None, None)?;
            Some(End { member: None, copy: 0, what, span: written.span })
        }
        [(member, member_indices), (name, indices)] => {
            let (position, copy) = member_copy(builder, member, member_indices, wiring)?;
            let entry = &wiring.members.entries[position];
            let component = || Some(wiring.members.list[position].name.clone());
            // What a component with mistakes does not have may be among them.
            if entry.class.is_none() && !entry.interface.has(&name.value) {
                return None;
            }
            let what = port_end(builder, name, indices, &entry.interface, &component, Some(position))?;
            Some(End { member: Some(position), copy, what, span: written.span })
        }
        _ => {
            if !written.parts.is_empty() {
                builder.report(hs0410_unknown_port::too_deep(written.span));
            }
            None
        }
    }
}

/// A member and which of its copies.
pub(crate) fn member_copy<'a>(
    builder: &mut Builder<'_, 'a>,
    name: &'a crate::declarations::Spanned<String>,
    indices: &'a [crate::declarations::ExpressionText],
    wiring: &Wiring<'_>,
) -> Option<(usize, u32)> {
    if name.value.is_empty() {
        return None;
    }
    builder.symbols.look_up(&name.value);
    let Some(named) = wiring.members.named(&name.value) else {
        builder.report(hs0410_unknown_port::member(name, &wiring.members.names()));
        return None;
    };
    let mut numbers = Vec::with_capacity(indices.len());
    for index in indices {
        let place = crate::lower::Place::PARAMETER;
        numbers.push(builder.at(place).constant_integer(index, "an index")?);
    }
    match named {
        Named::Broken => None,
        Named::One(position) => {
            let extents = &wiring.members.list[*position].extents;
            if extents.len() != numbers.len() {
                builder.report(hs0410_unknown_port::number_of_indices(name, extents, numbers.len()));
                return None;
            }
            let mut copy: u64 = 0;
            for (place, (&number, &extent)) in numbers.iter().zip(extents).enumerate() {
                if number < 1 || number > i64::from(extent) {
                    let span = indices.get(place).map_or(name.span, |index| index.span);
                    builder.report(hs0410_unknown_port::outside(name, number, extent, span));
                    return None;
                }
                copy = copy * u64::from(extent) + (number - 1) as u64;
            }
            Some((*position, copy as u32))
        }
        Named::Elements(elements, declared) => {
            let key: Vec<u32> = numbers.iter().map(|&n| u32::try_from(n).unwrap_or(0)).collect();
            match elements.get(&key) {
                Some(&position) => Some((position, 0)),
                None if elements.len() == 1 => {
                    // Meant as an array, perhaps: then all its connections are wrong for one reason.
                    if builder.suggested.insert(format!("{}[]", name.value)) {
                        let only = elements.keys().next().map_or(&[][..], Vec::as_slice);
                        builder.report(hs0410_unknown_port::one_element(name, only, *declared));
                    }
                    None
                }
                None => {
                    builder.report(hs0410_unknown_port::no_element(name, &numbers));
                    None
                }
            }
        }
    }
}

fn port_end<'a>(
    builder: &mut Builder<'_, 'a>,
    name: &'a crate::declarations::Spanned<String>,
    indices: &'a [crate::declarations::ExpressionText],
    interface: &Interface,
    component: &dyn Fn() -> Option<String>,
    member: Option<usize>,
) -> Option<EndKind> {
    if name.value.is_empty() {
        return None;
    }
    if member.is_none() {
        builder.symbols.look_up(&name.value);
    }
    if let Some(port) = interface.ports.iter().find(|port| port.name == name.value) {
        let positions = builder.positions(name, indices, port.shape)?;
        let shape = shape_of_part(port.shape, indices.len());
        return Some(EndKind::Values { port: Box::new(port.clone()), positions, shape });
    }
    let events = [
        (&interface.input_events, Direction::Input),
        (&interface.output_events, Direction::Output),
        (&interface.synchronised, Direction::Synchronised),
    ];
    for (labels, direction) in events {
        if labels.iter().any(|label| *label.name == name.value) {
            return Some(EndKind::Event { label: name.value.clone(), direction });
        }
    }
    builder.report(hs0410_unknown_port::port(name, component().as_deref(), interface));
    None
}
