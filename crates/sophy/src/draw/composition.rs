use super::notation::{Notation, tidy};
use super::ports::Ports;
use sophy_files::{Arrow, ArrowEnd, BoxKind, Diagram, DiagramBox, DiagramKind, DiagramPort, Line};
use sophy_ir::{Class, Clock, Composite, Discrete, EventEnd, Model, Port, Sources};
use std::collections::{HashMap, HashSet};

/// Members of one name are one box, the elements of a vector one port, parallel connections one arrow.
pub(super) fn composition(model: &Model, class: &Class, composite: &Composite) -> Diagram {
    let mut drawing = Drawing::new(model, class, composite);
    for wire in composite.wires.iter() {
        match &wire.from {
            Sources::One(from) => drawing.wire(from, &wire.to, 1.0),
            Sources::Sum(terms) => terms
                .iter()
                .filter(|(weight, _)| *weight != 0.0)
                .for_each(|(weight, from)| drawing.wire(from, &wire.to, *weight)),
        }
    }
    for wire in composite.event_wires.iter() {
        drawing.event_wire(&wire.from, &wire.to);
    }
    drawing.finish()
}

/// A discrete-time component: its ports, and what it does at an execution.
pub(super) fn discrete(notation: Notation<'_>, discrete: &Discrete) -> Diagram {
    let class = notation.class;
    let name = |id: sophy_ir::VariableId| notation.name(id);
    let mut lines = Vec::new();
    match &discrete.clock {
        Clock::None => {}
        Clock::Periodic { period, offset } => {
            let from = offset.map(|offset| format!(" from {} s", notation.short(offset))).unwrap_or_default();
            lines.push(format!("every {} s{from}", notation.short(*period)));
        }
        Clock::Announced { next } => lines.push(format!("at {}", name(*next))),
    }
    let updates = discrete.update.iter();
    lines.extend(updates.map(|a| format!("{} := {}", name(a.variable), notation.value(a.variable, a.right))));
    lines.extend(discrete.values.iter().filter_map(|e| notation.equation(e.variable, e.right)));
    let one = DiagramBox {
        name: class.name.clone(),
        lines: lines.into_iter().map(|text| Line { derivative_of: None, text }).collect(),
        inputs: Ports::inputs(class).finished(),
        outputs: Ports::outputs(class).finished(),
        tip: class.documentation.clone(),
        ..DiagramBox::default()
    };
    Diagram {
        title: class.name.clone(),
        kind: DiagramKind::Composition,
        boxes: vec![one],
        arrows: Vec::new(),
    }
}

/// All members of one name that are of one kind.
struct Group<'a> {
    name: &'a str,
    class: &'a Class,
    copies: u64,
    /// Extents of the array, if it is one.
    shape: String,
    tip: &'a str,
    inputs: Ports,
    outputs: Ports,
}

/// Connections between two ports.
#[derive(Default)]
struct Bundle {
    copies: HashSet<[(Option<u32>, u32); 2]>,
    weight: f64,
    dashed: bool,
}

struct Drawing<'a> {
    model: &'a Model,
    class: &'a Class,
    groups: Vec<Group<'a>>,
    /// The group of each member.
    group_of: Vec<usize>,
    /// The composite's own ports.
    inputs: Ports,
    outputs: Ports,
    /// Ends are groups with ports; the composite itself is `None`.
    bundles: Vec<(End, End, Bundle)>,
    known: HashMap<(End, End), usize>,
    composite: &'a Composite,
}

type End = (Option<usize>, usize);

impl<'a> Drawing<'a> {
    fn new(model: &'a Model, class: &'a Class, composite: &'a Composite) -> Self {
        let mut groups: Vec<Group<'a>> = Vec::new();
        let mut known: HashMap<(&str, &str), usize> = HashMap::new();
        let mut group_of = Vec::with_capacity(composite.members.len());
        for member in &composite.members {
            let class = model.class(member.class);
            // Elements that were specialised differently are one all the same.
            let group = *known.entry((&member.name, &class.name)).or_insert_with(|| {
                let (inputs, outputs) = (Ports::inputs(class), Ports::outputs(class));
                let extents: Vec<String> = member.extents.iter().map(u32::to_string).collect();
                let shape = extents.join(",");
                groups.push(Group { name: &member.name, class, copies: 0, shape, tip: "", inputs, outputs });
                groups.len() - 1
            });
            groups[group].copies += u64::from(member.copies());
            if groups[group].tip.is_empty() {
                groups[group].tip = &member.documentation;
            }
            group_of.push(group);
        }
        let (inputs, outputs) = (Ports::inputs(class), Ports::outputs(class));
        Drawing {
            model,
            class,
            groups,
            group_of,
            inputs,
            outputs,
            bundles: Vec::new(),
            known: HashMap::new(),
            composite,
        }
    }

    /// The port of a variable; `source` says whether the arrow begins there.
    fn end(&mut self, port: &Port, source: bool) -> Option<End> {
        let (group, class) = match port.member {
            Some(member) => {
                let class = self.composite.members.get(member as usize)?.class;
                (Some(*self.group_of.get(member as usize)?), self.model.class(class))
            }
            None => (None, self.class),
        };
        let variable = class.variables.get(port.variable.0 as usize)?;
        Some((group, self.side(group, source).variable(class, variable)))
    }

    fn event_end(&mut self, end: &EventEnd, source: bool) -> Option<End> {
        let group = match end.member {
            Some(member) => Some(*self.group_of.get(member as usize)?),
            None => None,
        };
        Some((group, self.side(group, source).event(&end.label)))
    }

    /// Members are sources at their outputs, the composite itself is one at its inputs.
    fn side(&mut self, group: Option<usize>, source: bool) -> &mut Ports {
        match (group, source) {
            (Some(group), true) => &mut self.groups[group].outputs,
            (Some(group), false) => &mut self.groups[group].inputs,
            (None, true) => &mut self.inputs,
            (None, false) => &mut self.outputs,
        }
    }

    fn wire(&mut self, from: &Port, to: &Port, weight: f64) {
        let (Some(a), Some(b)) = (self.end(from, true), self.end(to, false)) else { return };
        self.bundle(a, b, [(from.member, from.copy), (to.member, to.copy)], weight, false);
    }

    fn event_wire(&mut self, from: &EventEnd, to: &EventEnd) {
        let (Some(a), Some(b)) = (self.event_end(from, true), self.event_end(to, false)) else { return };
        self.bundle(a, b, [(from.member, from.copy), (to.member, to.copy)], 1.0, true);
    }

    fn bundle(&mut self, a: End, b: End, copies: [(Option<u32>, u32); 2], weight: f64, dashed: bool) {
        let number = *self.known.entry((a, b)).or_insert_with(|| {
            self.bundles.push((a, b, Bundle { weight, dashed, ..Bundle::default() }));
            self.bundles.len() - 1
        });
        self.bundles[number].2.copies.insert(copies);
    }

    fn finish(self) -> Diagram {
        let mut boxes: Vec<DiagramBox> = Vec::with_capacity(self.groups.len());
        for group in self.groups {
            let many = group.copies != 1 || !group.shape.is_empty();
            let shape = if group.shape.is_empty() { group.copies.to_string() } else { group.shape };
            let caption =
                if many { format!("{}[{shape}]", group.class.name) } else { group.class.name.clone() };
            let tip = if group.tip.is_empty() { group.class.documentation.trim() } else { group.tip.trim() };
            boxes.push(DiagramBox {
                kind: if many { BoxKind::Stack } else { BoxKind::Single },
                name: group.name.to_owned(),
                caption,
                lines: Vec::new(),
                inputs: group.inputs.finished(),
                outputs: group.outputs.finished(),
                tip: tip.to_owned(),
            });
        }
        let own = |kind: BoxKind, port: DiagramPort| {
            let (name, tip) = (port.name.clone(), port.tip.clone());
            let ports = vec![port];
            let (inputs, outputs) =
                if kind == BoxKind::Input { (Vec::new(), ports) } else { (ports, Vec::new()) };
            DiagramBox { kind, name, tip, inputs, outputs, ..DiagramBox::default() }
        };
        let first_input = boxes.len();
        boxes.extend(self.inputs.finished().into_iter().map(|port| own(BoxKind::Input, port)));
        let first_output = boxes.len();
        boxes.extend(self.outputs.finished().into_iter().map(|port| own(BoxKind::Output, port)));
        let end = |(group, port): End, first_own: usize| match group {
            Some(group) => ArrowEnd { of: group, port: Some(port) },
            None => ArrowEnd { of: first_own + port, port: Some(0) },
        };
        let members = &self.composite.members;
        let name = |end: &(Option<u32>, u32)| match end.0.and_then(|member| members.get(member as usize)) {
            Some(member) => member.copy_name(end.1),
            None => self.class.name.clone(),
        };
        let mut arrows = Vec::with_capacity(self.bundles.len());
        for (from, to, bundle) in self.bundles {
            let above = match bundle.copies.len() {
                1 if bundle.weight == 1.0 => Vec::new(),
                1 => vec![format!("·{}", tidy(&format!("{:?}", bundle.weight)))],
                many => vec![format!("×{many}")],
            };
            let tip = match bundle.copies.iter().min() {
                Some([from, to]) if bundle.copies.len() > 1 => {
                    format!("{} -> {} and {} more", name(from), name(to), bundle.copies.len() - 1)
                }
                _ => String::new(),
            };
            let (from, to) = (end(from, first_input), end(to, first_output));
            arrows.push(Arrow { from, to, above, below: Vec::new(), tip, dashed: bundle.dashed });
        }
        Diagram { title: self.class.name.clone(), kind: DiagramKind::Composition, boxes, arrows }
    }
}
