use super::connections::{Wiring, add_wire, member_copy, suits};
use crate::checks::{hs0412_connected_units, hs0415_connected_types, hs0417_composition_matrix};
use crate::component::{self, Builder, Interface, PortType};
use crate::declarations::{Direction, ExpressionText, PortText};
use crate::lower::{Place, Shape};
use sophy_diagnostics::Span;
use sophy_ir::{NodeId, Port, Quantity, Sources, VariableId, Wire};
use std::collections::HashSet;

/// A row or column of the matrix: an element of a port.
struct Element<'p> {
    name: String,
    port: &'p component::Port,
    end: Port,
}

/// `compose a, b with M`: inputs of the members and outputs of the composite are M times outputs of the members and
/// inputs of the composite (thesis A.3, eq. A.15). That the composition has no algebraic loop is seen when it is
/// flattened, where the equations of the outputs are known. `None` if it has mistakes and feeds nothing.
pub(crate) fn compose<'a>(
    builder: &mut Builder<'_, 'a>,
    span: Span,
    members: &'a [PortText],
    matrix: &'a ExpressionText,
    wiring: &mut Wiring<'_>,
) -> Option<()> {
    let mut rows: Vec<Element<'_>> = Vec::new();
    let mut columns: Vec<Element<'_>> = Vec::new();
    let (known, interface) = (wiring.members, wiring.interface);
    for written in members {
        let [(name, indices)] = written.parts.as_slice() else {
            if !written.parts.is_empty() {
                builder.report(hs0417_composition_matrix::no_member(written.span));
            }
            return None;
        };
        let (position, copy) = member_copy(builder, name, indices, wiring)?;
        let entry = &known.entries[position];
        // A component with mistakes may have more ports than are known.
        entry.class?;
        let prefix = format!("{}.", known.full_name(position, copy));
        let member = Some(position as u32);
        rows.extend(numeric_ports(&entry.interface, Direction::Input, &prefix, member, copy));
        columns.extend(numeric_ports(&entry.interface, Direction::Output, &prefix, member, copy));
    }
    rows.extend(numeric_ports(interface, Direction::Output, "", None, 0));
    columns.extend(numeric_ports(interface, Direction::Input, "", None, 0));
    let value = builder.at(Place::PARAMETER).value(matrix)?;
    if value.shape != Shape::Matrix(rows.len(), columns.len()) {
        let names = |elements: &[Element<'_>]| elements.iter().map(|e| e.name.clone()).collect::<Vec<_>>();
        builder.report(hs0417_composition_matrix::shape(
            matrix.span,
            value.shape,
            &names(&rows),
            &names(&columns),
        ));
        return None;
    }
    let Some(weights) = builder.at(Place::PARAMETER).known(&value) else {
        builder.report(hs0417_composition_matrix::not_known(matrix.span));
        return None;
    };
    let nodes = value.elements.as_slice();
    let width = columns.len().max(1);
    let mut complained = HashSet::new();
    for ((row, weights), nodes) in rows.iter().zip(weights.chunks(width)).zip(nodes.chunks(width)) {
        let mut sources: Vec<(f64, Port)> = Vec::new();
        for ((&weight, &node), column) in weights.iter().zip(nodes).zip(&columns) {
            if weight == 0.0 {
                continue;
            }
            sources.push((weight, column.end));
            // Once for all elements of two vectors.
            let ports = (column.end.member, column.port.first, row.end.member, row.port.first);
            if !complained.contains(&ports)
                && !joins(builder, matrix.span, (weight, node), column, row, wiring)
            {
                complained.insert(ports);
            }
        }
        let from = match sources.as_slice() {
            // A row of zeros connects nothing.
            [] => continue,
            &[(1.0, port)] => Sources::One(port),
            _ => Sources::Sum(sources.into()),
        };
        add_wire(builder, Wire { to: row.end, from, span: Some(span) }, span, wiring);
    }
    Some(())
}

/// Whether an entry of the matrix can join two ports: by a written 1 or -1 they are joined as by a connection; any
/// other factor may convert, from a whole number to a real one or from one unit to another.
fn joins(
    builder: &mut Builder<'_, '_>,
    matrix: Span,
    (weight, node): (f64, NodeId),
    from: &Element<'_>,
    to: &Element<'_>,
    wiring: &Wiring<'_>,
) -> bool {
    let written = (from.name.as_str(), to.name.as_str());
    let receiver = to.end.member.and_then(|member| wiring.members.kinds.get(member as usize).copied());
    let kind = match from.port.kind {
        PortType::Held(Quantity::Integer) if weight.fract() != 0.0 => PortType::Held(Quantity::Real),
        kind => kind,
    };
    if !suits(kind, to.port.kind, receiver) {
        builder.report(hs0415_connected_types::in_matrix(matrix, written, from.port, to.port, receiver));
        return false;
    }
    let joined = builder.graph.as_number(node).is_some_and(|number| number.abs() == 1.0);
    match from.port.measured.agree(to.port.measured) {
        Err(mismatch) if joined => {
            builder.report(hs0412_connected_units::in_matrix(matrix, written, from.port, to.port, &mismatch));
            false
        }
        _ => true,
    }
}

/// Numeric ports of an interface, element by element.
fn numeric_ports<'p>(
    interface: &'p Interface,
    direction: Direction,
    prefix: &str,
    member: Option<u32>,
    copy: u32,
) -> Vec<Element<'p>> {
    let mut elements = Vec::new();
    for port in interface.ports.iter().filter(|port| port.direction == direction) {
        let numeric = match port.kind {
            PortType::Signal => true,
            PortType::Held(quantity) => matches!(quantity, Quantity::Real | Quantity::Integer),
            PortType::Event => false,
        };
        if numeric {
            elements.extend((0..port.shape.len()).map(|k| Element {
                name: format!("{prefix}{}{}", port.name, port.shape.suffix(k)),
                port,
                end: Port { member, copy, variable: VariableId(port.first.0 + k as u32) },
            }));
        }
    }
    elements
}
