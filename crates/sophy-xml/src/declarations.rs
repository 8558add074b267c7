use crate::codes::EMPTY_NAME;
use crate::document::{Element, Text};
use crate::hints;
use crate::parser::is_xml_character;
use crate::schema::ROOT;
use crate::syntax_errors::syntax_errors;
use sophy_analysis::{
    ComponentDeclaration, ComponentKind, Declarations, Dialect, Direction, EquationDeclaration, EquationItem,
    Equations, ExpressionText, LocationDeclaration, ParameterDeclaration, PortDeclaration, Spanned,
    Statement, Target, TransitionDeclaration, TriggerDeclaration, VariableDeclaration, VariableRole,
};
use sophy_diagnostics::{Diagnostic, Diagnostics, TextMap};

/// What a tree declares whose elements the content check has named; `None` if it is no system.
pub(crate) fn declare(root: &Element, diagnostics: &mut Diagnostics) -> Option<Declarations> {
    if root.meant != Some(ROOT) {
        return None;
    }
    let mut reader = Reader { diagnostics };
    let mut component = ComponentDeclaration::new(ComponentKind::Ctc, reader.name_of(root), Dialect::Xml);
    component.documentation = documentation_of(root);
    component.parameters = members(root, "constants", "constant").map(|e| reader.constant(e)).collect();
    component.variables = members(root, "states", "state").map(|e| reader.state(e)).collect();
    let inputs = members(root, "inputs", "input").map(|e| (Direction::Input, e));
    let outputs = members(root, "outputs", "output").map(|e| (Direction::Output, e));
    component.ports = inputs.chain(outputs).map(|(direction, e)| reader.port(direction, e)).collect();
    component.locations = members(root, "locations", "location").map(|e| reader.location(e)).collect();
    let functions = hints::declare(members(root, "hints", "hint"), &mut component, &mut reader);
    Some(Declarations { functions, components: vec![component], ..Declarations::default() })
}

/// The `member`s of every `group` (there should be one), and those that stand outside it by mistake.
fn members<'a>(parent: &'a Element, group: &'a str, member: &'a str) -> impl Iterator<Item = &'a Element> {
    parent.all(group).flat_map(move |group| group.all(member)).chain(parent.all(member))
}

/// Makes declarations of elements and complains about empty names and malformed expressions.
pub(crate) struct Reader<'d> {
    pub(crate) diagnostics: &'d mut Diagnostics,
}

impl Reader<'_> {
    fn constant(&mut self, element: &Element) -> ParameterDeclaration {
        ParameterDeclaration {
            name: self.attribute_name(element, "symbol"),
            documentation: String::new(),
            kind: None,
            value: self.expression(&element.text()),
            unit: None,
        }
    }

    fn state(&mut self, element: &Element) -> VariableDeclaration {
        VariableDeclaration {
            role: VariableRole::State,
            name: self.name(&element.text(), element),
            documentation: attribute_documentation(element),
            kind: None,
            range: None,
            initial: None,
            unit: None,
        }
    }

    fn port(&mut self, direction: Direction, element: &Element) -> PortDeclaration {
        PortDeclaration {
            name: self.name(&element.text(), element),
            documentation: attribute_documentation(element),
            direction,
            kind: None,
            range: None,
            unit: None,
        }
    }

    fn location(&mut self, element: &Element) -> LocationDeclaration {
        LocationDeclaration {
            name: self.name_of(element),
            documentation: documentation_of(element),
            variables: Vec::new(),
            equations: Equations {
                dynamics: element.all("diffequation").map(|e| self.equation(e, "state", true)).collect(),
                constraints: Vec::new(),
                output: element.all("outputmap").map(|e| self.equation(e, "output", false)).collect(),
            },
            invariant: None,
            transitions: members(element, "transitions", "transition").map(|e| self.transition(e)).collect(),
        }
    }

    fn transition(&mut self, element: &Element) -> TransitionDeclaration {
        let destination = element.all("reset").find_map(|reset| reset.first("destination"));
        let guard = element.first("domain").map(|domain| self.expression(&domain.text()));
        let events: Vec<_> = element.all("inputevent").map(|e| self.name(&e.text(), e)).collect();
        let mut actions: Vec<_> = members(element, "reset", "statereset").map(|e| self.reset(e)).collect();
        actions.extend(element.all("outputevent").map(|e| Statement::Emit(self.name(&e.text(), e))));
        TransitionDeclaration {
            name: self.name_of(element),
            documentation: documentation_of(element),
            trigger: match events.as_slice() {
                [] => TriggerDeclaration::When(guard),
                _ => TriggerDeclaration::WhenOrOn(guard, events),
            },
            priority: None,
            destination: match destination {
                Some(destination) => self.name(&destination.text(), destination),
                None => missing_name(element),
            },
            actions,
        }
    }

    fn equation(&mut self, element: &Element, attribute: &str, derivative: bool) -> EquationItem {
        EquationItem::Equation(EquationDeclaration {
            derivative,
            target: whole(self.attribute_name(element, attribute)),
            right: self.expression(&element.text()),
        })
    }

    fn reset(&mut self, element: &Element) -> Statement {
        let target = whole(self.attribute_name(element, "state"));
        Statement::Assign { target, right: self.expression(&element.text()) }
    }

    /// The expression that a text is, without the blanks around it. Its syntax errors are reported, unless they
    /// may be due to a mistake of XML in it.
    pub(crate) fn expression(&mut self, text: &Text) -> ExpressionText {
        let (trimmed, map) = text.trimmed();
        self.expression_at(trimmed, map, text.damaged)
    }

    /// The expression that `text` is, a part of what stands in the file, which may be `damaged`.
    pub(crate) fn expression_at(&mut self, text: &str, map: TextMap, damaged: bool) -> ExpressionText {
        let (expression, parse) = ExpressionText::parse(text, map);
        if !damaged && text.chars().all(is_xml_character) {
            self.diagnostics.extend(syntax_errors(&parse, &expression.map));
        }
        expression
    }

    /// The text of the child `name`; empty if there is none, which the content check has said.
    fn name_of(&mut self, element: &Element) -> Spanned<String> {
        match (element.first("name"), element.attribute("name")) {
            (Some(name), _) => self.name(&name.text(), name),
            // Where the name should not be, but is.
            (None, Some(name)) => self.trimmed_name(name, element, "name"),
            (None, None) => missing_name(element),
        }
    }

    fn attribute_name(&mut self, element: &Element, attribute: &str) -> Spanned<String> {
        match element.required_attribute(attribute) {
            Some(value) => self.trimmed_name(value, element, attribute),
            None => missing_name(element),
        }
    }

    /// The name that the text of `element` is, without the blanks around it.
    pub(crate) fn name(&mut self, text: &Text, element: &Element) -> Spanned<String> {
        self.trimmed_name(text, element, &element.name)
    }

    fn trimmed_name(&mut self, text: &Text, element: &Element, what: &str) -> Spanned<String> {
        let (name, map) = text.trimmed();
        if name.is_empty() && !text.damaged {
            self.diagnostics.push(
                Diagnostic::error(EMPTY_NAME, element.tag, format!("the `{what}` is empty"))
                    .help("it must be a name; delete the element if it is not needed"),
            );
        }
        Spanned::new(name.to_owned(), map.whole())
    }
}

/// Stands for a name whose absence the content check has reported.
fn missing_name(element: &Element) -> Spanned<String> {
    Spanned::new(String::new(), element.tag)
}

/// The target that a name is, rather than an element of it.
pub(crate) fn whole(name: Spanned<String>) -> Target {
    Target { name, indices: Vec::new() }
}

fn attribute_documentation(element: &Element) -> String {
    element.attribute("documentation").map_or_else(String::new, |text| text.decoded.trim().to_owned())
}

fn documentation_of(element: &Element) -> String {
    element.first("documentation").map_or_else(String::new, |text| outdented(&text.text().decoded))
}

/// The lines of a text without the blanks around it and without the indentation that its lines share.
///
/// A first line that follows the tag directly shows no indentation and does not count.
fn outdented(text: &str) -> String {
    let blanks = |line: &str| line.len() - line.trim_start_matches([' ', '\t']).len();
    let below_tag = text.trim_start_matches([' ', '\t']).starts_with('\n');
    let counted = text.split('\n').skip(usize::from(!below_tag)).filter(|line| !line.trim().is_empty());
    let shared = counted.map(blanks).min().unwrap_or(0);
    let outdent = |line: &str| line[blanks(line).min(shared)..].to_owned();
    let each =
        text.split('\n').map(|line| if line.trim().is_empty() { String::new() } else { outdent(line) });
    let lines: Vec<String> = each.collect();
    lines.join("\n").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::outdented;

    #[test]
    fn documentation_loses_the_indentation_of_its_element() {
        assert_eq!(
            outdented("\n    Two lines,\n      the second deeper\n\n    and one.\n  "),
            "Two lines,\n  the second deeper\n\nand one."
        );
        assert_eq!(outdented("On the line of the tag\n    and below"), "On the line of the tag\nand below");
        assert_eq!(outdented("  short  "), "short");
        assert_eq!(outdented(" \n "), "");
    }
}
