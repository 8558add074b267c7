//! The definition `SophySystem.dtd` as a table; a test compares the two.

/// What an element may have and contain.
pub(crate) struct ElementModel {
    pub(crate) name: &'static str,
    /// Its attribute, and whether it must be there; no element has two.
    pub(crate) attribute: Option<(&'static str, bool)>,
    pub(crate) content: Content,
}

pub(crate) enum Content {
    /// Text only.
    Text,
    /// Elements in this order, nothing else.
    Elements(&'static [Particle]),
}

/// One place in a sequence.
pub(crate) struct Particle {
    pub(crate) name: &'static str,
    /// A misspelling of it that is printed in the thesis.
    misprint: Option<&'static str>,
    pub(crate) occurs: Occurs,
}

impl Particle {
    pub(crate) fn takes(&self, name: &str) -> bool {
        self.name == name || self.misprint == Some(name)
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Occurs {
    Once,
    /// `?`
    AtMostOnce,
    /// `+`
    AtLeastOnce,
    /// `*`
    Any,
}

impl Occurs {
    pub(crate) fn required(self) -> bool {
        matches!(self, Occurs::Once | Occurs::AtLeastOnce)
    }

    pub(crate) fn repeatable(self) -> bool {
        matches!(self, Occurs::AtLeastOnce | Occurs::Any)
    }

    /// As the definition writes it.
    pub(crate) fn mark(self) -> &'static str {
        match self {
            Occurs::Once => "",
            Occurs::AtMostOnce => "?",
            Occurs::AtLeastOnce => "+",
            Occurs::Any => "*",
        }
    }
}

/// The element that a SOPHY file consists of.
pub(crate) const ROOT: &str = "SophySystem";

/// The model of element `name`.
pub(crate) fn element(name: &str) -> Option<&'static ElementModel> {
    ELEMENTS.iter().find(|element| element.name == name)
}

/// The elements that may contain a `name`.
pub(crate) fn parents(name: &str) -> Vec<&'static str> {
    let contains = |element: &&ElementModel| match element.content {
        Content::Text => false,
        Content::Elements(particles) => particles.iter().any(|particle| particle.takes(name)),
    };
    ELEMENTS.iter().filter(contains).map(|element| element.name).collect()
}

/// `name, documentation?, …`: the content of an element as the definition writes it.
pub(crate) fn sequence(particles: &[Particle]) -> String {
    let write = |particle: &Particle| format!("{}{}", particle.name, particle.occurs.mark());
    particles.iter().map(write).collect::<Vec<_>>().join(", ")
}

pub(crate) const ELEMENTS: &[ElementModel] = &[
    group(
        ROOT,
        &[
            once("name"),
            at_most_once("documentation"),
            at_most_once("hints"),
            at_most_once("constants"),
            once("states"),
            once("inputs"),
            once("outputs"),
            once("locations"),
        ],
    ),
    text("name"),
    text("documentation"),
    group("constants", &[at_least_once("constant")]),
    text_with("constant", ("symbol", true)),
    group("hints", &[at_least_once("hint")]),
    text_with("hint", ("hintname", true)),
    group("states", &[any("state")]),
    text_with("state", ("documentation", false)),
    group("inputs", &[any("input")]),
    text_with("input", ("documentation", false)),
    group("outputs", &[any("output")]),
    text_with("output", ("documentation", false)),
    group("locations", &[at_least_once("location")]),
    group(
        "location",
        &[
            once("name"),
            at_most_once("documentation"),
            any("diffequation"),
            any("outputmap"),
            at_most_once("transitions"),
        ],
    ),
    text_with("diffequation", ("state", true)),
    text_with("outputmap", ("output", true)),
    group("transitions", &[at_least_once("transition")]),
    group(
        "transition",
        &[
            once("name"),
            at_most_once("documentation"),
            once("domain"),
            once("reset"),
            Particle { misprint: Some("inpuvent"), ..any("inputevent") },
            Particle { misprint: Some("outpuvent"), ..any("outputevent") },
        ],
    ),
    text("domain"),
    group("reset", &[once("destination"), any("statereset")]),
    text("destination"),
    text_with("statereset", ("state", true)),
    text("inputevent"),
    text("inpuvent"),
    text("outputevent"),
    text("outpuvent"),
];

const fn text(name: &'static str) -> ElementModel {
    ElementModel { name, attribute: None, content: Content::Text }
}

const fn text_with(name: &'static str, attribute: (&'static str, bool)) -> ElementModel {
    ElementModel { name, attribute: Some(attribute), content: Content::Text }
}

const fn group(name: &'static str, particles: &'static [Particle]) -> ElementModel {
    ElementModel { name, attribute: None, content: Content::Elements(particles) }
}

const fn once(name: &'static str) -> Particle {
    particle(name, Occurs::Once)
}

const fn at_most_once(name: &'static str) -> Particle {
    particle(name, Occurs::AtMostOnce)
}

const fn at_least_once(name: &'static str) -> Particle {
    particle(name, Occurs::AtLeastOnce)
}

const fn any(name: &'static str) -> Particle {
    particle(name, Occurs::Any)
}

const fn particle(name: &'static str, occurs: Occurs) -> Particle {
    Particle { name, misprint: None, occurs }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `<!ELEMENT …>` and `<!ATTLIST …>` of the table, in its order.
    fn printed() -> Vec<String> {
        let mut lines = Vec::new();
        for element in ELEMENTS {
            let content = match element.content {
                Content::Text => "#PCDATA".to_owned(),
                Content::Elements(particles) => {
                    let write = |p: &Particle| match p.misprint {
                        Some(misprint) => format!("({} | {misprint}){}", p.name, p.occurs.mark()),
                        None => format!("{}{}", p.name, p.occurs.mark()),
                    };
                    particles.iter().map(write).collect::<Vec<_>>().join(", ")
                }
            };
            lines.push(format!("<!ELEMENT {} ({content})>", element.name));
            if let Some((attribute, required)) = element.attribute {
                let default = if required { "#REQUIRED" } else { "#IMPLIED" };
                lines.push(format!("<!ATTLIST {} {attribute} CDATA {default}>", element.name));
            }
        }
        lines
    }

    #[test]
    fn the_table_is_the_definition() {
        let declares = |line: &&str| line.starts_with("<!ELEMENT") || line.starts_with("<!ATTLIST");
        let mut definition: Vec<_> = crate::DTD.lines().map(str::trim).filter(declares).collect();
        let mut table = printed();
        definition.sort_unstable();
        table.sort_unstable();
        assert_eq!(table, definition);
    }

    #[test]
    fn parents_of_a_name() {
        assert_eq!(parents("name"), [ROOT, "location", "transition"]);
        assert_eq!(parents("inpuvent"), ["transition"]);
        assert_eq!(parents(ROOT), [""; 0]);
    }
}
