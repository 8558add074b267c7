use super::connections::{Wiring, connect};
use super::library::{Entry, Library};
use super::members::{Members, expand_members};
use crate::checks::{hs0127_declaration_for_another_kind, hs0414_not_connected};
use crate::component::{Builder, Built, Given, Interface, Shared};
use crate::declarations::{ComponentDeclaration, ComponentKind, Direction};
use sophy_ir::{Body, Composite, EventEnd};
use std::collections::HashSet;
use std::rc::Rc;
use std::sync::Arc;

/// Analyses a composite: its members, each with its class, and what connects them.
pub(crate) fn build_composite<'a>(
    declaration: &'a ComponentDeclaration,
    library: &mut Library<'a>,
    shared: &mut Shared<'a>,
    given: &Given,
) -> (Built, Vec<Rc<Entry>>) {
    let errors = shared.findings.error_count();
    let mut builder = Builder::new(declaration, shared, given);
    builder.check_sections();
    builder.foreshadow();
    builder.declare_parameters();
    let interface = builder.declare_variables();
    if declaration.kind == ComponentKind::System {
        for port in interface.ports.iter().filter(|port| port.direction == Direction::Input) {
            builder.report(hs0127_declaration_for_another_kind::system_input(&port.name, port.span));
        }
    }
    let members = expand_members(&mut builder, library);
    let before = builder.shared.findings.error_count();
    let Wiring { composite, incomplete, .. } = connect(&mut builder, &members, &interface);
    // A connection with a mistake feeds nothing: what it was to feed would be complained about, too.
    if builder.shared.findings.error_count() == before && !members.missing && !incomplete {
        check_connected(&mut builder, &members, &interface, &composite);
    }
    builder.check_uses();
    let composite = Composite { members: members.list, ..composite };
    let body = (!members.broken).then_some(Body::Composite(composite));
    (builder.finish(body, interface, errors), members.used.into_values().collect())
}

/// Complains about inputs of members and outputs of the composite that nothing feeds.
fn check_connected(
    builder: &mut Builder<'_, '_>,
    members: &Members,
    interface: &Interface,
    composite: &Composite,
) {
    let fed: HashSet<sophy_ir::Port> = composite.wires.iter().map(|wire| wire.to).collect();
    let is_fed = |member: Option<u32>, copy: u32, variable: u32| {
        fed.contains(&sophy_ir::Port { member, copy, variable: sophy_ir::VariableId(variable) })
    };
    for (position, member) in members.list.iter().enumerate() {
        let entry: &Rc<Entry> = &members.entries[position];
        let copies: u32 = member.extents.iter().product();
        for port in entry.interface.ports.iter().filter(|port| port.direction == Direction::Input) {
            let elements = port.shape.len() as u32;
            let open = (0..copies)
                .find(|&copy| (0..elements).any(|k| !is_fed(Some(position as u32), copy, port.first.0 + k)));
            if let Some(copy) = open {
                let name = members.full_name(position, copy);
                let span = member.span.unwrap_or(port.span);
                builder.report(hs0414_not_connected::input(&name, &port.name, span, port.span));
            }
        }
    }
    check_events_connected(builder, members, interface, composite);
    for port in interface.ports.iter().filter(|port| port.direction == Direction::Output) {
        if (0..port.shape.len() as u32).any(|k| !is_fed(None, 0, port.first.0 + k)) {
            builder.report(hs0414_not_connected::output(&port.name, port.span));
        }
    }
}

/// The same of events: without a sender they never happen, which may be meant.
fn check_events_connected(
    builder: &mut Builder<'_, '_>,
    members: &Members,
    interface: &Interface,
    composite: &Composite,
) {
    let sent: HashSet<EventEnd> = composite.event_wires.iter().map(|wire| wire.to).collect();
    let is_sent = |member: Option<usize>, copy: u32, label: &Arc<str>| {
        let member = member.map(|member| member as u32);
        sent.contains(&EventEnd { member, copy, label: Arc::clone(label) })
    };
    for (position, member) in members.list.iter().enumerate() {
        let copies: u32 = member.extents.iter().product();
        for event in &members.entries[position].interface.input_events {
            let is_open = |&copy: &u32| !is_sent(Some(position), copy, &event.name);
            if let (Some(copy), Some(declared)) = ((0..copies).find(is_open), event.span.or(member.span)) {
                let name = members.full_name(position, copy);
                let span = member.span.unwrap_or(declared);
                builder.report(hs0414_not_connected::event_input(&name, &event.name, span, declared));
            }
        }
    }
    for event in &interface.output_events {
        if let Some(span) = event.span.filter(|_| !is_sent(None, 0, &event.name)) {
            builder.report(hs0414_not_connected::event_output(&event.name, span));
        }
    }
}
