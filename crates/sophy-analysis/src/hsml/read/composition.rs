use super::reader::Reader;
use crate::declarations::{ConnectionItem, MemberDeclaration, MemberItem, ParameterDeclaration, PortText};
use sophy_syntax::ast::{ComponentsItem, Compose, Connection, ConnectionsItem, Instance, Port, View};

impl Reader<'_> {
    pub(super) fn members(&mut self, items: impl Iterator<Item = ComponentsItem>) -> Vec<MemberItem> {
        let read = |item| match item {
            ComponentsItem::Instance(instance) => MemberItem::Member(self.member(&instance)),
            ComponentsItem::ForLoop(view) => {
                let items = self.members(view.items());
                MemberItem::For(self.repeated(&view, items))
            }
        };
        items.map(read).collect()
    }

    fn member(&mut self, instance: &Instance) -> MemberDeclaration {
        let mut parameters = Vec::new();
        for argument in instance.arguments() {
            parameters.push(ParameterDeclaration {
                name: self.name(argument.name(), &argument),
                documentation: String::new(),
                kind: None,
                value: self.required(argument.value(), &argument),
                unit: self.unit(argument.unit()),
            });
        }
        MemberDeclaration {
            name: self.name(instance.name(), instance),
            parameters,
            indices: self.expressions(instance.indices()),
            documentation: instance.documentation(),
            component: self.name(instance.component(), instance),
            extents: self.expressions(instance.shape()),
        }
    }

    pub(super) fn connections(
        &mut self,
        items: impl Iterator<Item = ConnectionsItem>,
    ) -> Vec<ConnectionItem> {
        let mut connections = Vec::new();
        for item in items {
            match item {
                ConnectionsItem::Connection(view) => connections.push(self.connection(&view)),
                ConnectionsItem::Compose(view) => connections.push(self.composition(&view)),
                ConnectionsItem::ForLoop(view) => {
                    let items = self.connections(view.items());
                    connections.push(ConnectionItem::For(self.repeated(&view, items)));
                }
            }
        }
        connections
    }

    /// An end that is missing, which the parser has said, has no parts.
    fn connection(&mut self, connection: &Connection) -> ConnectionItem {
        let end = |port: Option<Port>| match port {
            Some(port) => self.port(&port),
            None => PortText { parts: Vec::new(), span: self.keyword(connection) },
        };
        ConnectionItem::Connect { from: end(connection.source()), to: end(connection.target()) }
    }

    fn composition(&mut self, compose: &Compose) -> ConnectionItem {
        ConnectionItem::Compose {
            span: self.keyword(compose),
            members: compose.parts().map(|port| self.port(&port)).collect(),
            matrix: self.required(compose.matrix(), compose),
        }
    }

    fn port(&self, port: &Port) -> PortText {
        let parts = port.parts().into_iter();
        PortText {
            parts: parts.map(|part| (self.spanned(part.name), self.expressions(part.indices))).collect(),
            span: self.span(port.range()),
        }
    }
}
