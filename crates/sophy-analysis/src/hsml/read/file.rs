use super::reader::Reader;
use crate::declarations::{
    ComponentDeclaration, ComponentKind, Declarations, Dialect, Direction, ExpressionText,
    FunctionDeclaration, KnobDeclaration, ParameterDeclaration, PortDeclaration, RangeText, Spanned,
    TypeText,
};
use crate::hsml::codes::BOUNDS;
use sophy_syntax::ast::{self, FileItem, InterfaceItem, InterfaceItemKind, Unit, ValueRange, View};

impl Reader<'_> {
    pub(super) fn file(&mut self, file: &ast::File) -> Declarations {
        let mut declarations = Declarations::default();
        for item in file.items() {
            match item {
                FileItem::Import(import) => declarations.imports.push(self.name(import.path(), &import)),
                FileItem::Constant(constant) => declarations.constants.push(ParameterDeclaration {
                    name: self.name(constant.name(), &constant),
                    documentation: constant.documentation(),
                    kind: self.type_text(constant.declared_type()),
                    value: self.required(constant.value(), &constant),
                    unit: self.unit(constant.unit()),
                }),
                FileItem::Function(function) => declarations.functions.push(self.function(&function)),
                FileItem::Component(component) => declarations.components.push(self.component(&component)),
            }
        }
        declarations
    }

    fn function(&mut self, function: &ast::Function) -> FunctionDeclaration {
        let parameters = function.parameters();
        FunctionDeclaration {
            name: self.name(function.name(), function),
            documentation: function.documentation(),
            parameters: parameters
                .map(|p| (self.name(p.name(), &p), self.type_text(p.declared_type())))
                .collect(),
            result: self.type_text(function.value_type()),
            body: self.required(function.value(), function),
        }
    }

    fn component(&mut self, view: &ast::Component) -> ComponentDeclaration {
        let kind = match view.kind() {
            // What an unknown word means has been asked.
            Some(ast::ComponentKind::Ctc) | None => ComponentKind::Ctc,
            Some(ast::ComponentKind::Dtc) => ComponentKind::Dtc,
            Some(ast::ComponentKind::Lbc) => ComponentKind::Lbc,
            Some(ast::ComponentKind::Cc) => ComponentKind::Cc,
            Some(ast::ComponentKind::System) => ComponentKind::System,
        };
        let mut component = ComponentDeclaration::new(kind, self.name(view.name(), view), Dialect::Hsml);
        component.documentation = view.documentation();
        for interface in view.interfaces() {
            interface.items().for_each(|item| self.interface_item(&item, &mut component));
        }
        for body in view.bodies() {
            self.body(&body, &mut component);
        }
        component
    }

    fn interface_item(&mut self, item: &InterfaceItem, component: &mut ComponentDeclaration) {
        use InterfaceItemKind as K;
        let known = [
            ("input", K::Input),
            ("output", K::Output),
            ("knob", K::Knob),
            ("view", K::View),
            ("scope", K::View),
            ("sync", K::Sync),
        ];
        let Some(kind) = self.meant(item.kind(), item, &known) else { return };
        let name = self.name(item.name(), item);
        let documentation = item.documentation();
        let range = self.range(item.value_range());
        let unit = self.unit(item.unit());
        let direction = match kind {
            K::View => return component.views.push(name),
            K::Knob => return component.knobs.push(KnobDeclaration { name, documentation, range, unit }),
            K::Input => Direction::Input,
            K::Output => Direction::Output,
            K::Sync => Direction::Synchronised,
        };
        let kind = self.type_text(item.declared_type());
        component.ports.push(PortDeclaration { name, documentation, direction, kind, range, unit });
    }

    pub(super) fn type_text(&mut self, view: Option<ast::Type>) -> Option<TypeText> {
        let view = view?;
        let shape = self.expressions(view.shape());
        let name = match view.name() {
            // The parser has said that it is missing.
            None if !shape.is_empty() => Spanned::new("real".to_owned(), self.span(view.range())),
            name => self.name(name, &view),
        };
        Some(TypeText { name, shape })
    }

    pub(super) fn range(&mut self, view: Option<ValueRange>) -> Option<RangeText> {
        let view = view?;
        let values = self.expressions(view.values());
        if view.is_list() {
            return Some(RangeText::Set(values));
        }
        let count = values.len();
        match <[ExpressionText; 2]>::try_from(values) {
            Ok([low, high]) => Some(RangeText::Bounds(low, high)),
            Err(_) => {
                if !self.is_damaged(&view.range()) {
                    let span = self.span(view.range());
                    let message = format!("a range in parentheses has two bounds, and this one {count}");
                    self.complain(
                        BOUNDS,
                        span,
                        message,
                        "write `(low, high)`, or list all values: `{1, 2, 5}`",
                    );
                }
                None
            }
        }
    }

    pub(super) fn unit(&mut self, view: Option<Unit>) -> Option<Spanned<String>> {
        let view = view?;
        Some(self.spanned(view.text()?))
    }
}
