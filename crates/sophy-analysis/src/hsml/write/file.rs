use super::Writer;
use super::from_xml::in_words_of_hsml;
use crate::declarations::{
    ComponentDeclaration, ComponentKind, Declarations, Dialect, Direction, FunctionDeclaration,
    KnobDeclaration, PortDeclaration, RangeText, Spanned, TypeText,
};

impl Writer {
    pub(super) fn file(&mut self, declarations: &Declarations) {
        for import in &declarations.imports {
            self.line(&format!("import {};", Self::string(&import.value)));
        }
        self.gap();
        for constant in &declarations.constants {
            self.documentation(&constant.documentation);
            let (name, value) = (self.name(&constant.name), self.right_side(&constant.value));
            let kind = self.typed(constant.kind.as_ref());
            self.line(&format!("constant {name}{kind} = {value}{};", unit(constant.unit.as_ref())));
        }
        self.gap();
        for function in &declarations.functions {
            self.function(function);
        }
        for component in &declarations.components {
            self.gap();
            match component.dialect {
                Dialect::Hsml => self.component(component),
                Dialect::Xml => {
                    let (component, comments) = in_words_of_hsml(component);
                    comments.iter().for_each(|comment| self.comment(comment));
                    self.component(&component);
                }
            }
        }
    }

    fn comment(&mut self, comment: &str) {
        for line in comment.lines() {
            self.line(format!("% {}", line.trim()).trim_end());
        }
    }

    fn function(&mut self, function: &FunctionDeclaration) {
        self.documentation(&function.documentation);
        let mut parameters = Vec::new();
        for (name, kind) in &function.parameters {
            parameters.push(self.name(name) + &self.typed(kind.as_ref()));
        }
        let (name, result) = (self.name(&function.name), self.typed(function.result.as_ref()));
        let body = self.right_side(&function.body);
        self.line(&format!("function {name}({}){result} = {body};", parameters.join(", ")));
    }

    /// ` : real[3]`, or nothing.
    pub(super) fn typed(&mut self, kind: Option<&TypeText>) -> String {
        kind.map_or_else(String::new, |kind| format!(" : {}", self.kind(kind)))
    }

    fn component(&mut self, component: &ComponentDeclaration) {
        self.documentation(&component.documentation);
        let kind = match component.kind {
            ComponentKind::Ctc => "CTC",
            ComponentKind::Dtc => "DTC",
            ComponentKind::Lbc => "LBC",
            ComponentKind::Cc => "CC",
            ComponentKind::System => "SYSTEM",
        };
        let name = self.name(&component.name);
        self.line(&format!("{kind} {name} is"));
        if !(component.ports.is_empty() && component.knobs.is_empty() && component.views.is_empty()) {
            self.block("interface", "interface", |writer| {
                component.ports.iter().for_each(|port| writer.port(port));
                component.knobs.iter().for_each(|knob| writer.knob(knob));
                for view in &component.views {
                    let name = writer.name(view);
                    writer.line(&format!("view({name});"));
                }
            });
        }
        self.block("body", "body", |writer| writer.body(component));
    }

    fn port(&mut self, port: &PortDeclaration) {
        self.documentation(&port.documentation);
        let word = match port.direction {
            Direction::Input => "input",
            Direction::Output => "output",
            Direction::Synchronised => "sync",
        };
        let kind = match (&port.kind, port.direction) {
            (Some(kind), _) => format!(", {}", self.kind(kind)),
            (None, Direction::Synchronised) => String::new(),
            // SOPHY XML does not say it.
            (None, _) => ", signal".to_owned(),
        };
        let (name, rest) =
            (self.name(&port.name), self.range_and_unit(port.range.as_ref(), port.unit.as_ref()));
        self.line(&format!("{word}({name}{kind}{rest});"));
    }

    fn knob(&mut self, knob: &KnobDeclaration) {
        self.documentation(&knob.documentation);
        let (name, rest) =
            (self.name(&knob.name), self.range_and_unit(knob.range.as_ref(), knob.unit.as_ref()));
        self.line(&format!("knob({name}{rest});"));
    }

    fn range_and_unit(&mut self, range: Option<&RangeText>, unit: Option<&Spanned<String>>) -> String {
        let range = range.map_or_else(String::new, |range| format!(", {}", self.range(range)));
        let unit = unit.map_or_else(String::new, |unit| format!(", {}", Self::string(&unit.value)));
        range + &unit
    }
}

/// ` "m/s"`, or nothing.
pub(super) fn unit(unit: Option<&Spanned<String>>) -> String {
    unit.map_or_else(String::new, |unit| format!(" {}", Writer::string(&unit.value)))
}
