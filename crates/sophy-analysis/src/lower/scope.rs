use super::record::Record;
use super::typed::{Shape, Typed, Varies};
use crate::declarations::{Dialect, FunctionDeclaration};
use crate::predefined::{Predefined, QUANTITIES};
use crate::units::Measured;
use sophy_diagnostics::Span;
use sophy_ir::{Quantity, VariableId};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::rc::Rc;

/// What kind of thing a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SymbolKind {
    Constant,
    Parameter,
    Knob,
    State,
    Mode,
    Local,
    Flag,
    Input,
    Output,
    Event,
    Function,
    /// Constants of a file, read by `data("x.toml")`.
    Record,
    /// A component of a composite.
    Member,
    LoopVariable,
    /// Of a function.
    Argument,
}

impl SymbolKind {
    /// `a state`.
    pub(crate) fn with_article(self) -> &'static str {
        match self {
            SymbolKind::Constant => "a constant",
            SymbolKind::Parameter => "a parameter",
            SymbolKind::Knob => "a knob",
            SymbolKind::State => "a state",
            SymbolKind::Mode => "a mode",
            SymbolKind::Local => "a local",
            SymbolKind::Flag => "a flag",
            SymbolKind::Input => "an input",
            SymbolKind::Output => "an output",
            SymbolKind::Event => "an event",
            SymbolKind::Function => "a function",
            SymbolKind::Record => "a record of constants",
            SymbolKind::Member => "a component",
            SymbolKind::LoopVariable => "a loop variable",
            SymbolKind::Argument => "a parameter of the function",
        }
    }

    /// Whether it can change during a run, so that what is fixed before cannot use it.
    pub(crate) fn varies(self) -> bool {
        use SymbolKind as K;
        matches!(self, K::State | K::Mode | K::Local | K::Flag | K::Input | K::Output | K::Event)
    }

    /// Smaller is what a misspelt name more likely stands for.
    fn likelihood(self) -> u8 {
        match self {
            SymbolKind::Argument | SymbolKind::LoopVariable => 0,
            SymbolKind::State => 1,
            SymbolKind::Input => 2,
            SymbolKind::Output => 3,
            kind if kind.varies() => 4,
            _ => 5,
        }
    }
}

/// What a name stands for.
#[derive(Clone, Debug)]
pub(crate) struct Symbol<'a> {
    pub(crate) kind: SymbolKind,
    /// Where it is declared.
    pub(crate) span: Span,
    pub(crate) value: SymbolValue<'a>,
}

/// What the name is worth in an expression.
#[derive(Clone, Debug)]
pub(crate) enum SymbolValue<'a> {
    /// Nothing is known, because its declaration has mistakes: nothing is said of its uses.
    Broken,
    /// Variables of the class.
    Variable(VariableSymbol),
    /// Numbers that are fixed for all classes.
    Numbers(Rc<Numbers>),
    /// A value of the expression's own graph: loop variables, arguments, locals of a `:=` section.
    Bound(Typed),
    /// True in the micro-step in which the event is received.
    Event,
    Function(&'a FunctionDeclaration),
    /// The same, where what its value is follows from the types of its parameters alone.
    TypedFunction(&'a FunctionDeclaration, Shape, Quantity),
    Record(Rc<Record>),
    /// It has no value of its own: members.
    None,
}

/// Variables of a class, one for each element, with consecutive ids.
#[derive(Clone, Debug)]
pub(crate) struct VariableSymbol {
    /// The variable of the first element.
    pub(crate) first: VariableId,
    pub(crate) shape: Shape,
    pub(crate) quantity: Quantity,
    pub(crate) measured: Measured,
    pub(crate) varies: Varies,
    /// Texts it can have; empty if any.
    pub(crate) choices: Rc<[usize]>,
    /// Values of a parameter, where they are known. What needs one while the class is built makes the parameter
    /// structural: see [`super::Lowering::structural`].
    pub(crate) known: Option<Rc<[f64]>>,
}

/// In the place of the variables of a name that is declared further on.
const COMING: VariableId = VariableId(u32::MAX);

impl VariableSymbol {
    /// Whether the name is declared further on: nothing is known of it yet.
    pub(super) fn is_coming(&self) -> bool {
        self.first == COMING
    }
}

/// Numbers with what is known of them.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    /// Row by row.
    pub(crate) elements: Vec<f64>,
    pub(crate) shape: Shape,
    pub(crate) quantity: Quantity,
    pub(crate) measured: Measured,
}

/// Names that all components see: constants, records and functions of the files.
pub(crate) type Globals<'a> = HashMap<String, Symbol<'a>>;

/// What names mean at a place: those bound there, over those of the location and the component, over those of the
/// files.
pub(crate) struct Symbols<'a> {
    globals: Rc<Globals<'a>>,
    component: HashMap<String, Symbol<'a>>,
    /// In order of entry.
    names: Vec<String>,
    /// By location: what it declares for itself.
    own: Vec<HashMap<String, Symbol<'a>>>,
    /// Names that some location declares.
    own_names: HashSet<String>,
    /// The location we are in; only its own names are seen.
    here: Option<usize>,
    /// Names that the component declares further on: they exist, but cannot be used yet.
    coming: HashMap<String, Symbol<'a>>,
    bound: Vec<(String, Symbol<'a>)>,
    /// In a function, names below are hidden, and so are those of the component but for constants.
    barrier: Option<usize>,
    used: BTreeSet<String>,
    /// Names of the component by the first of their variables, with the location that declares them.
    by_variable: BTreeMap<VariableId, (String, Option<usize>)>,
    /// How many operations functions and reductions have been written out to; see [`super::Lowering`].
    pub(super) work: usize,
    /// How deep the place is nested, functions included.
    pub(super) depth: usize,
    /// How many variables stand for any value.
    pub(super) placeholders: u32,
    /// Whether the body of a function is checked by itself, its arguments standing for any.
    pub(super) unapplied: bool,
    /// Names of the component's locations, in written order: the values of `location`.
    pub(crate) locations: Vec<String>,
}

/// To go back to by [`Symbols::leave`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    bound: usize,
    barrier: Option<usize>,
}

impl<'a> Symbols<'a> {
    pub(crate) fn new(globals: Rc<Globals<'a>>) -> Self {
        Symbols {
            globals,
            component: HashMap::new(),
            names: Vec::new(),
            own: Vec::new(),
            own_names: HashSet::new(),
            here: None,
            coming: HashMap::new(),
            bound: Vec::new(),
            barrier: None,
            used: BTreeSet::new(),
            by_variable: BTreeMap::new(),
            work: 0,
            depth: 0,
            placeholders: 0,
            unapplied: false,
            locations: Vec::new(),
        }
    }

    /// Enters a name of the component; the first declaration of a name counts, and is returned if there is one.
    pub(crate) fn declare(&mut self, name: &str, symbol: Symbol<'a>) -> Option<&Symbol<'a>> {
        let here = self.here;
        if self.declared(name).is_none() && (here.is_some() || !self.own_names.contains(name)) {
            if let Some(here) = here {
                self.own_names.insert(name.to_owned());
                self.own.resize_with(self.own.len().max(here + 1), HashMap::new);
            }
            self.redeclare(name, symbol);
            return None;
        }
        if let Some(here) = here.filter(|&here| self.of_location(here, name).is_none()) {
            // In the location neither is meant for certain.
            self.own.resize_with(self.own.len().max(here + 1), HashMap::new);
            let broken = Symbol { value: SymbolValue::Broken, ..symbol };
            self.own.get_mut(here).and_then(|own| own.insert(name.to_owned(), broken));
            return self.component.get(name);
        }
        self.declared(name).or_else(|| self.elsewhere(name).first().map(|&(_, symbol)| symbol))
    }

    /// In which location we are; what is declared there is its own.
    pub(crate) fn enter_location(&mut self, location: Option<usize>) {
        self.here = location;
    }

    /// Whether we are in a location.
    pub(crate) fn is_in_location(&self) -> bool {
        self.here.is_some()
    }

    /// What a location declares for itself by a name.
    pub(crate) fn of_location(&self, location: usize, name: &str) -> Option<&Symbol<'a>> {
        self.own.get(location)?.get(name)
    }

    /// Locations that declare a name for themselves, with what it is there.
    pub(crate) fn elsewhere(&self, name: &str) -> Vec<(usize, &Symbol<'a>)> {
        if !self.own_names.contains(name) {
            return Vec::new();
        }
        let scopes = self.own.iter().enumerate();
        scopes.filter_map(|(location, own)| Some((location, own.get(name)?))).collect()
    }

    /// Says that the component will declare a name; what reads it before has its value too early.
    pub(crate) fn foreshadow(&mut self, name: &str, kind: SymbolKind, span: Span) {
        let variable = VariableSymbol {
            first: COMING,
            shape: Shape::Scalar,
            quantity: Quantity::Real,
            measured: Measured::Unchecked,
            varies: Varies::Continuously,
            choices: Rc::from([]),
            known: None,
        };
        let symbol = Symbol { kind, span, value: SymbolValue::Variable(variable) };
        self.coming.entry(name.to_owned()).or_insert(symbol);
    }

    /// Whether the component is going to declare a name.
    pub(super) fn is_coming(&self, name: &str) -> bool {
        self.coming.contains_key(name)
    }

    /// All names of the component are declared.
    pub(crate) fn nothing_coming(&mut self) {
        self.coming.clear();
    }

    /// Replaces what a name of the component stands for, once more is known of it.
    pub(crate) fn redeclare(&mut self, name: &str, symbol: Symbol<'a>) {
        if let SymbolValue::Variable(variable) = &symbol.value {
            self.by_variable.insert(variable.first, (name.to_owned(), self.here));
        }
        if let Some(own) = self.here.and_then(|here| self.own.get_mut(here)) {
            own.insert(name.to_owned(), symbol);
        } else if self.component.insert(name.to_owned(), symbol).is_none() {
            self.names.push(name.to_owned());
        }
    }

    /// Begins an inner scope.
    pub(crate) fn enter(&self) -> Mark {
        Mark { bound: self.bound.len(), barrier: self.barrier }
    }

    /// Begins the scope of a function, which sees what is bound in it and what all components see.
    pub(crate) fn enter_function(&mut self) -> Mark {
        let mark = self.enter();
        self.barrier = Some(self.bound.len());
        mark
    }

    /// Ends the scope: what was bound since is forgotten.
    pub(crate) fn leave(&mut self, mark: Mark) {
        self.bound.truncate(mark.bound);
        self.barrier = mark.barrier;
    }

    /// Binds a name in the present scope; it hides others of the same name.
    pub(crate) fn bind(&mut self, name: &str, kind: SymbolKind, span: Span, value: Typed) {
        self.bind_symbol(name, Symbol { kind, span, value: SymbolValue::Bound(value) });
    }

    pub(crate) fn bind_symbol(&mut self, name: &str, symbol: Symbol<'a>) {
        self.bound.push((name.to_owned(), symbol));
    }

    /// What a name stands for here; remembers the use.
    pub(crate) fn look_up(&mut self, name: &str) -> Option<Symbol<'a>> {
        let found = self.get(name).cloned();
        if found.is_some() && !self.used.contains(name) {
            self.used.insert(name.to_owned());
        }
        found
    }

    /// What a name stands for here.
    pub(crate) fn get(&self, name: &str) -> Option<&Symbol<'a>> {
        let visible = &self.bound[self.barrier.unwrap_or(0).min(self.bound.len())..];
        if let Some((_, symbol)) = visible.iter().rev().find(|(bound, _)| bound == name) {
            return Some(symbol);
        }
        let own = self.declared(name).or_else(|| self.coming.get(name));
        own.filter(|symbol| self.sees(symbol)).or_else(|| self.globals.get(name))
    }

    /// Whether a symbol of the component is visible: in a function only what is fixed.
    fn sees(&self, symbol: &Symbol<'a>) -> bool {
        self.barrier.is_none() || matches!(symbol.kind, SymbolKind::Constant | SymbolKind::Function)
    }

    /// Functions of the files, in written order.
    pub(super) fn declared_functions(&self) -> Vec<&'a FunctionDeclaration> {
        let function = |symbol: &Symbol<'a>| match symbol.value {
            SymbolValue::Function(function) | SymbolValue::TypedFunction(function, ..) => Some(function),
            _ => None,
        };
        let mut functions: Vec<_> = self.globals.values().filter_map(function).collect();
        functions.sort_by_key(|function| (function.name.span.source, function.name.span.start));
        functions
    }

    /// The declaration a variable belongs to, and which element of it the variable is.
    fn declaration(&self, id: VariableId) -> Option<(&str, &VariableSymbol, usize)> {
        let (first, (name, location)) = self.by_variable.range(..=id).next_back()?;
        let SymbolValue::Variable(variable) = &self.in_scope(name, *location)?.value else { return None };
        let element = (id.0 - first.0) as usize;
        (element < variable.shape.len()).then_some((name.as_str(), variable, element))
    }

    fn in_scope(&self, name: &str, location: Option<usize>) -> Option<&Symbol<'a>> {
        match location {
            Some(location) => self.of_location(location, name),
            None => self.component.get(name),
        }
    }

    /// The name that a variable is declared by, without indices.
    pub(crate) fn declared_as(&self, id: VariableId) -> Option<&str> {
        self.declaration(id).map(|(name, ..)| name)
    }

    /// The name and value of a parameter whose value is known.
    pub(super) fn known_value(&self, id: VariableId) -> Option<(&str, f64)> {
        let (name, variable, element) = self.declaration(id)?;
        Some((name, *variable.known.as_ref()?.get(element)?))
    }

    pub(super) fn is_boolean(&self, id: VariableId) -> bool {
        self.declaration(id).is_some_and(|(_, variable, _)| variable.quantity == Quantity::Boolean)
    }

    /// Texts that a variable can be; empty if any.
    pub(super) fn choices(&self, id: VariableId) -> Vec<usize> {
        self.declaration(id).map_or(Vec::new(), |(_, variable, _)| variable.choices.to_vec())
    }

    /// The declaration of a variable, for labels.
    pub(super) fn declared_at(&self, id: VariableId) -> Option<(&str, Span)> {
        self.declaration(id)?;
        let (name, location) = self.by_variable.range(..=id).next_back()?.1;
        Some((name, self.in_scope(name, *location)?.span))
    }

    /// What the component itself declares by a name, whatever is bound over it.
    pub(crate) fn declared(&self, name: &str) -> Option<&Symbol<'a>> {
        let own = self.here.and_then(|here| self.of_location(here, name));
        own.or_else(|| self.component.get(name))
    }

    /// A name of the component that a function cannot see.
    pub(crate) fn hidden(&self, name: &str) -> Option<&Symbol<'a>> {
        let symbol = self.declared(name).or_else(|| self.coming.get(name));
        symbol.filter(|_| self.barrier.is_some())
    }

    /// Whether the place is within a function.
    pub(crate) fn in_function(&self) -> bool {
        self.barrier.is_some()
    }

    /// Names that were looked up.
    pub(crate) fn used(&self) -> &BTreeSet<String> {
        &self.used
    }

    /// Names that can be called, those of the model first.
    pub(crate) fn functions(&self) -> Vec<&str> {
        let functions = self.names().into_iter().filter(|(_, symbol)| symbol.kind == SymbolKind::Function);
        let mut names: Vec<&str> = functions.map(|(name, _)| name).collect();
        Predefined::names().for_each(|name| names.push(name));
        names
    }

    /// Names that stand for a value, likelier ones first: what is bound, what varies, what is fixed, what is
    /// predefined.
    pub(crate) fn values(&self, dialect: Dialect) -> Vec<&str> {
        let mut declared = self.names();
        declared.retain(|(_, symbol)| !matches!(symbol.kind, SymbolKind::Function | SymbolKind::Member));
        declared.sort_by_key(|(_, symbol)| symbol.kind.likelihood());
        let mut names: Vec<&str> = declared.into_iter().map(|(name, _)| name).collect();
        // What XML files can say is older than the names of locations and instants.
        let known = if dialect == Dialect::Xml { 2 } else { QUANTITIES.len() };
        QUANTITIES.iter().take(known).for_each(|name| names.push(name));
        names
    }

    /// Names that are bound here, innermost first, then those of the location and of the component in written order, then those of
    /// the files, sorted.
    pub(crate) fn names(&self) -> Vec<(&str, &Symbol<'a>)> {
        let visible = &self.bound[self.barrier.unwrap_or(0).min(self.bound.len())..];
        let bound = visible.iter().rev().map(|(name, symbol)| (name.as_str(), symbol));
        let component = self.names.iter().filter_map(|name| Some((name.as_str(), self.component.get(name)?)));
        let component = component.filter(|(_, symbol)| self.sees(symbol));
        let own = self.here.and_then(|here| self.own.get(here)).map(in_written_order).unwrap_or_default();
        let own = own.into_iter().filter(|(_, symbol)| self.sees(symbol));
        let mut globals: Vec<(&str, &Symbol<'a>)> =
            self.globals.iter().map(|(name, symbol)| (name.as_str(), symbol)).collect();
        globals.sort_by_key(|(_, symbol)| (symbol.span.source, symbol.span.start));
        bound.chain(own).chain(component).chain(globals).collect()
    }

    /// What locations declare for themselves, with the locations.
    pub(crate) fn of_locations(&self) -> Vec<(usize, &str, &Symbol<'a>)> {
        let scopes = self.own.iter().enumerate();
        let of =
            |(location, own)| in_written_order(own).into_iter().map(move |(name, s)| (location, name, s));
        scopes.flat_map(of).collect()
    }
}

fn in_written_order<'s, 'a>(scope: &'s HashMap<String, Symbol<'a>>) -> Vec<(&'s str, &'s Symbol<'a>)> {
    let mut symbols: Vec<_> = scope.iter().map(|(name, symbol)| (name.as_str(), symbol)).collect();
    symbols.sort_by_key(|(_, symbol)| (symbol.span.source, symbol.span.start));
    symbols
}

/// What an expression may use where it stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// For messages: `the value of a parameter`.
    pub(crate) what: &'static str,
    /// What it may depend on at most.
    pub(crate) most: Varies,
    /// Whether it may depend on time.
    pub(crate) time: bool,
    /// Whether events, `rises`, `falls`, `changes` and `chance` have a meaning there.
    pub(crate) conditions: bool,
}

impl Place {
    /// A constant of a file.
    pub(crate) const CONSTANT: Place =
        Place { what: "a constant", most: Varies::Never, time: false, conditions: false };
    /// The body of a function, which may be used anywhere.
    pub(super) const FUNCTION: Place =
        Place { what: "a function", most: Varies::Continuously, time: false, conditions: false };
    /// The value of a parameter.
    pub(crate) const PARAMETER: Place =
        Place { what: "the value of a parameter", most: Varies::Parameters, time: false, conditions: false };
    /// The value a declaration gives at the start.
    pub(crate) const INITIAL: Place =
        Place { what: "an initial value", most: Varies::Parameters, time: false, conditions: false };
    /// An equation.
    pub(crate) const EQUATION: Place =
        Place { what: "an equation", most: Varies::Continuously, time: true, conditions: false };
    /// The condition of a rule, or the guard of a transition; its actions.
    pub(crate) const INSTANT: Place =
        Place { what: "this expression", most: Varies::Continuously, time: true, conditions: true };
}
