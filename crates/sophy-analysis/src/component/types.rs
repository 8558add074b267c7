use super::builder::Builder;
use crate::checks::{hs0120_unknown_type, hs0121_extent, hs0122_unit, hs0126_out_of_range, hs0209_units};
use crate::declarations::{Dialect, RangeText, Spanned, TypeText};
use crate::lower::{Elements, Place, Shape, Typed};
use crate::units::{self, Measured};
use sophy_diagnostics::Span;
use sophy_ir::{Allowed, NodeId, Quantity};

/// Values a variable can have.
#[derive(Clone, Debug, Default)]
pub(crate) struct Range {
    pub(crate) bounds: Option<[NodeId; 2]>,
    pub(crate) choices: Vec<usize>,
    /// The numbers of a set, if they are known.
    pub(crate) numbers: Vec<f64>,
    /// What kind of values a set lists.
    pub(crate) quantity: Option<Quantity>,
}

impl Range {
    /// The numbers it allows, if it is one of numbers.
    pub(crate) fn allowed(&self) -> Option<Allowed> {
        let set = (!self.numbers.is_empty()).then(|| Allowed::OneOf(self.numbers.clone()));
        self.bounds.map(Allowed::Between).or(set)
    }
}

/// A type as declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PortType {
    /// Varies continuously.
    Signal,
    /// Changes at instants.
    Held(Quantity),
    /// Carries no value.
    Event,
}

impl PortType {
    pub(crate) fn quantity(self) -> Quantity {
        match self {
            PortType::Held(quantity) => quantity,
            PortType::Signal | PortType::Event => Quantity::Real,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            PortType::Signal => "signal",
            PortType::Held(Quantity::Real) => "real",
            PortType::Held(Quantity::Integer) => "integer",
            PortType::Held(Quantity::Boolean) => "boolean",
            PortType::Held(Quantity::Text) => "string",
            PortType::Event => "event",
        }
    }
}

/// All type names.
pub(crate) const TYPES: [&str; 6] = ["signal", "real", "integer", "boolean", "string", "event"];

impl<'a> Builder<'_, 'a> {
    /// The type of a name, with its shape; `None` if it has mistakes.
    pub(crate) fn port_type(&mut self, written: &'a TypeText) -> Option<(PortType, Shape)> {
        let kind = match written.name.value.as_str() {
            "signal" => PortType::Signal,
            "real" => PortType::Held(Quantity::Real),
            "integer" => PortType::Held(Quantity::Integer),
            "boolean" => PortType::Held(Quantity::Boolean),
            "string" => PortType::Held(Quantity::Text),
            "event" => PortType::Event,
            other => {
                if !other.is_empty() {
                    self.report(hs0120_unknown_type::diagnostic(other, written.name.span));
                }
                return None;
            }
        };
        Some((kind, self.shape(written)?))
    }

    fn shape(&mut self, written: &'a TypeText) -> Option<Shape> {
        let mut extents = Vec::new();
        for extent in &written.shape {
            let place = Place { what: "an extent", ..Place::PARAMETER };
            let value = self.at(place).constant_integer(extent, "an extent")?;
            match usize::try_from(value) {
                Ok(count) if (1..=hs0121_extent::LARGEST).contains(&count) => extents.push(count),
                _ => {
                    self.report(hs0121_extent::diagnostic(value, extent.span));
                    return None;
                }
            }
        }
        match Shape::of(&extents) {
            Some(shape) if shape.len() <= hs0121_extent::LARGEST => Some(shape),
            _ => {
                let span = written.shape.last().map_or(written.name.span, |extent| extent.span);
                self.report(hs0121_extent::too_many(written.shape.len(), span));
                None
            }
        }
    }

    /// What is known of the unit of a variable. In SOPHY XML units are labels, nothing more.
    pub(crate) fn measured(&mut self, unit: Option<&Spanned<String>>) -> Measured {
        let (Some(unit), Dialect::Hsml) = (unit, self.declaration.dialect) else {
            return Measured::Unchecked;
        };
        match units::parse(&unit.value) {
            Ok(parsed) => {
                for note in &parsed.notes {
                    hs0122_unit::note(note.kind, unit, &mut self.shared.findings);
                }
                Measured::Known(parsed.unit)
            }
            Err(error) => {
                self.report(hs0122_unit::diagnostic(&error, unit));
                Measured::Unchecked
            }
        }
    }

    /// The unit of a parameter: the declared one, else that of its value if it is more than a number.
    pub(crate) fn measured_in(&self, declared: Measured, value: &Typed) -> Measured {
        match (declared, value.measured) {
            (Measured::Unchecked, Measured::Known(known)) => Measured::Known(known),
            (declared, _) => declared,
        }
    }

    /// A value gets the unit that is written behind it; says so if it has another one.
    pub(crate) fn written_unit(
        &mut self,
        unit: Option<&Spanned<String>>,
        value: &mut Typed,
        name: &Spanned<String>,
    ) {
        let Some(written) = unit else { return };
        let measured = self.measured(unit);
        if let Err(mismatch) = value.measured.agree(measured) {
            let what = format!("the value of `{}`", name.value);
            self.report(hs0209_units::assigned(written.span, &what, None, mismatch));
        }
        value.measured = measured;
    }

    /// The unit as written, from the declaration or from what is said apart.
    pub(crate) fn unit_label(&self, name: &str, unit: Option<&Spanned<String>>) -> Option<String> {
        let apart = || {
            let found = self.declaration.units.iter().find(|(of, _)| of.value == name);
            found.map(|(_, unit)| unit.value.clone())
        };
        unit.map(|unit| unit.value.clone()).or_else(apart)
    }

    /// The range of a declaration.
    pub(crate) fn range_of(&mut self, range: Option<&'a RangeText>) -> Range {
        match range {
            None => Range::default(),
            Some(RangeText::Bounds(low, high)) => {
                let low = self.at(Place::PARAMETER).scalar(low).and_then(|v| v.node());
                let high = self.at(Place::PARAMETER).scalar(high).and_then(|v| v.node());
                let bounds = low.zip(high).map(|(low, high)| [low, high]);
                Range { bounds, ..Range::default() }
            }
            Some(RangeText::Set(items)) => {
                let mut choices = Vec::new();
                let mut numbers = Vec::new();
                let mut quantity = None;
                for item in items {
                    let Some(value) = self.at(Place::PARAMETER).value(item) else { continue };
                    quantity = quantity.or(Some(value.quantity));
                    let number = value.node().and_then(|node| self.graph.as_number(node));
                    if let (Quantity::Text, Some(number)) = (value.quantity, number) {
                        choices.push(number as usize);
                    } else if matches!(value.quantity, Quantity::Real | Quantity::Integer) {
                        numbers.extend(value.node().and_then(|node| self.known_value(node)));
                    }
                }
                if numbers.len() < items.len() {
                    numbers.clear();
                }
                Range { bounds: None, choices, numbers, quantity }
            }
        }
    }

    /// Complains about values that are not in the range.
    pub(crate) fn check_in_range(&mut self, name: &str, range: &'a RangeText, values: &[f64], at: Span) {
        match range {
            RangeText::Bounds(low, high) => {
                let low_value = self.at(Place::PARAMETER).scalar(low).and_then(|v| v.node());
                let high_value = self.at(Place::PARAMETER).scalar(high).and_then(|v| v.node());
                let [low_value, high_value] =
                    [low_value, high_value].map(|node| node.and_then(|node| self.known_value(node)));
                let (Some(least), Some(greatest)) = (low_value, high_value) else { return };
                if least > greatest {
                    self.report(hs0126_out_of_range::reversed(least, greatest, low.span, high.span));
                } else if let Some(&value) = values.iter().find(|v| !(least..=greatest).contains(*v)) {
                    self.report(hs0126_out_of_range::diagnostic(name, value, least, greatest, at, low.span));
                }
            }
            RangeText::Set(items) => {
                let mut allowed = Vec::new();
                for item in items {
                    let node = self.at(Place::PARAMETER).value(item).and_then(|value| value.node());
                    match node.and_then(|node| self.known_value(node)) {
                        Some(value) => allowed.push(value),
                        None => return,
                    }
                }
                if let (Some(&_), Some(first)) =
                    (values.iter().find(|value| !allowed.contains(value)), items.first())
                {
                    self.report(hs0126_out_of_range::not_in_set(name, at, first.span));
                }
            }
        }
    }

    /// The value as a variable stores it: truth values as 1 and 0.
    pub(crate) fn as_stored(&mut self, value: Typed) -> Typed {
        if !value.is_boolean() {
            return value;
        }
        let (one, zero) = (self.graph.number(1.0), self.graph.number(0.0));
        let nodes: Vec<NodeId> =
            value.elements.as_slice().iter().map(|&node| self.graph.select(node, one, zero)).collect();
        Typed { elements: Elements::from(nodes), ..value }
    }
}
