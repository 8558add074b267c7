use super::connections::{Wiring, add_wire, member_copy};
use crate::checks::hs0417_composition_matrix;
use crate::component::{Builder, Interface, PortType};
use crate::declarations::{Direction, ExpressionText, PortText};
use crate::lower::{Place, Shape};
use sophy_diagnostics::Span;
use sophy_ir::{Port, Quantity, Sources, VariableId, Wire};

/// `compose a, b with M`: inputs of the members and outputs of the composite are M times outputs of the members and
/// inputs of the composite (thesis A.3, eq. A.15). That the composition has no algebraic loop is seen when it is
/// flattened, where the equations of the outputs are known.
pub(crate) fn compose<'a>(
    builder: &mut Builder<'_, 'a>,
    span: Span,
    members: &'a [PortText],
    matrix: &'a ExpressionText,
    wiring: &mut Wiring<'_>,
) {
    let mut rows: Vec<(String, Port)> = Vec::new();
    let mut columns: Vec<(String, Port)> = Vec::new();
    for written in members {
        let [(name, indices)] = written.parts.as_slice() else {
            builder.report(hs0417_composition_matrix::no_member(written.span));
            return;
        };
        let Some((position, copy)) = member_copy(builder, name, indices, wiring) else { return };
        let entry = &wiring.members.entries[position];
        let prefix = format!("{}.", wiring.members.full_name(position, copy));
        let member = Some(position as u32);
        rows.extend(numeric_ports(&entry.interface, Direction::Input, &prefix, member, copy));
        columns.extend(numeric_ports(&entry.interface, Direction::Output, &prefix, member, copy));
    }
    rows.extend(numeric_ports(wiring.interface, Direction::Output, "", None, 0));
    columns.extend(numeric_ports(wiring.interface, Direction::Input, "", None, 0));
    let Some(value) = builder.at(Place::PARAMETER).value(matrix) else { return };
    if value.shape != Shape::Matrix(rows.len(), columns.len()) {
        let names = |ports: &[(String, Port)]| ports.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        builder.report(hs0417_composition_matrix::shape(
            matrix.span,
            value.shape,
            &names(&rows),
            &names(&columns),
        ));
        return;
    }
    let Some(weights) = builder.at(Place::PARAMETER).known(&value) else {
        builder.report(hs0417_composition_matrix::not_known(matrix.span));
        return;
    };
    for (row, weights) in rows.iter().zip(weights.chunks(columns.len().max(1))) {
        let mut sources: Vec<(f64, Port)> = weights
            .iter()
            .zip(&columns)
            .filter(|(weight, _)| **weight != 0.0)
            .map(|(&weight, &(_, port))| (weight, port))
            .collect();
        let from = match sources.as_slice() {
            &[(1.0, port)] => Sources::One(port),
            _ => Sources::Sum(std::mem::take(&mut sources)),
        };
        add_wire(builder, Wire { to: row.1, from, span: Some(span) }, span, wiring);
    }
}

/// Numeric ports of an interface, element by element.
fn numeric_ports(
    interface: &Interface,
    direction: Direction,
    prefix: &str,
    member: Option<u32>,
    copy: u32,
) -> Vec<(String, Port)> {
    let mut ports = Vec::new();
    for port in interface.ports.iter().filter(|port| port.direction == direction) {
        let numeric = match port.kind {
            PortType::Signal => true,
            PortType::Held(quantity) => matches!(quantity, Quantity::Real | Quantity::Integer),
            PortType::Event => false,
        };
        if numeric {
            ports.extend((0..port.shape.len()).map(|k| {
                let variable = VariableId(port.first.0 + k as u32);
                (format!("{prefix}{}{}", port.name, port.shape.suffix(k)), Port { member, copy, variable })
            }));
        }
    }
    ports
}
