/// Boxes and arrows between them. All texts are plain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagram {
    /// Heading.
    pub title: String,
    /// What it shows.
    pub kind: DiagramKind,
    /// Boxes, in written order.
    pub boxes: Vec<DiagramBox>,
    /// Arrows, in written order.
    pub arrows: Vec<Arrow>,
}

/// What a diagram shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DiagramKind {
    /// Locations and transitions: arrows take the side that is nearest.
    #[default]
    Automaton,
    /// Members and connections: from the right side of a box to the left side of another one.
    Composition,
}

/// What a box stands for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BoxKind {
    /// A location, or a member that there is once.
    #[default]
    Single,
    /// The location a run starts in.
    Initial,
    /// A member of which there are several copies.
    Stack,
    /// An input of the composite itself; its one port is on the right.
    Input,
    /// An output of the composite itself; its one port is on the left.
    Output,
    /// Something that holds everywhere, beside the rest.
    Note,
}

/// A box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiagramBox {
    /// What it stands for.
    pub kind: BoxKind,
    /// In large letters.
    pub name: String,
    /// Under the name, in grey; may be empty.
    pub caption: String,
    /// What is in it.
    pub lines: Vec<Line>,
    /// Ports on the left side, inputs.
    pub inputs: Vec<DiagramPort>,
    /// Ports on the right side, outputs.
    pub outputs: Vec<DiagramPort>,
    /// Shown when the pointer rests on it; may be empty.
    pub tip: String,
}

/// A line in a box.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// The quantity whose derivative the text says: drawn with a dot above, in front of the text.
    pub derivative_of: Option<String>,
    /// The text.
    pub text: String,
}

/// What flows through a port (Taylor's figure 1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Symbol {
    /// △ a continuous-time signal.
    #[default]
    Signal,
    /// ● a real number that changes at instants.
    Real,
    /// □ an integer.
    Integer,
    /// ⊕ a truth value.
    Boolean,
    /// ◇ a message.
    Text,
    /// ▷ an event.
    Event,
}

/// A port.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiagramPort {
    /// Beside the symbol.
    pub name: String,
    /// What flows through it.
    pub symbol: Symbol,
    /// Shown when the pointer rests on it; may be empty.
    pub tip: String,
}

/// Where an arrow begins or ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ArrowEnd {
    /// Position of the box.
    pub of: usize,
    /// Position of the port, among the outputs where the arrow begins and the inputs where it ends; without, the
    /// arrow begins or ends anywhere at the box.
    pub port: Option<usize>,
}

/// An arrow.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrow {
    /// Where it begins.
    pub from: ArrowEnd,
    /// Where it ends.
    pub to: ArrowEnd,
    /// Lines above it.
    pub above: Vec<String>,
    /// Lines under it.
    pub below: Vec<String>,
    /// Shown when the pointer rests on it; may be empty.
    pub tip: String,
    /// Whether it is dashed: events.
    pub dashed: bool,
}
