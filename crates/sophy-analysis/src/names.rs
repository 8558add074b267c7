use crate::declarations::Declarations;
use crate::predefined::{Predefined, QUANTITIES};
use sophy_diagnostics::Span;
use sophy_ir::VariableId;
use std::collections::HashMap;

/// What a declared name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Constant,
    Function,
    State,
    Input,
    Output,
}

impl Kind {
    /// `a state`.
    pub(crate) fn with_article(self) -> &'static str {
        match self {
            Kind::Constant => "a constant",
            Kind::Function => "a function",
            Kind::State => "a state",
            Kind::Input => "an input",
            Kind::Output => "an output",
        }
    }
}

/// The declaration a name leads to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Symbol {
    pub(crate) kind: Kind,
    /// Place in its list in the declarations.
    pub(crate) position: usize,
    pub(crate) span: Span,
}

/// A name declared again.
pub(crate) struct Repeated<'a> {
    pub(crate) name: &'a str,
    pub(crate) first: Symbol,
    pub(crate) again: Symbol,
}

/// All names of a system: constants, functions, states, inputs and outputs share one space.
///
/// An output with the name of a state *is* that state: it has no symbol of its own.
#[derive(Default)]
pub(crate) struct Names<'a> {
    symbols: HashMap<&'a str, Symbol>,
    /// Outputs, those that are states included, to their place in the declarations.
    outputs: HashMap<&'a str, usize>,
    /// In written order: constants, states, inputs, outputs, functions.
    in_order: Vec<&'a str>,
    variables: HashMap<&'a str, VariableId>,
}

impl<'a> Names<'a> {
    /// Enters all declared names; the first declaration of a name counts. Empty names are left out.
    pub(crate) fn collect(declarations: &'a Declarations) -> (Self, Vec<Repeated<'a>>) {
        let d = declarations;
        let mut names = Names::default();
        let mut repeated = Vec::new();
        let constants = d.constants.iter().map(|c| &c.name).enumerate().map(|n| (Kind::Constant, n));
        let states = d.states.iter().map(|v| &v.name).enumerate().map(|n| (Kind::State, n));
        let inputs = d.inputs.iter().map(|v| &v.name).enumerate().map(|n| (Kind::Input, n));
        let outputs = d.outputs.iter().map(|v| &v.name).enumerate().map(|n| (Kind::Output, n));
        let functions = d.functions.iter().map(|f| &f.name).enumerate().map(|n| (Kind::Function, n));
        for (kind, (position, name)) in constants.chain(states).chain(inputs).chain(outputs).chain(functions)
        {
            let symbol = Symbol { kind, position, span: name.span };
            names.enter(name.value.as_str(), symbol, &mut repeated);
        }
        (names, repeated)
    }

    fn enter(&mut self, name: &'a str, symbol: Symbol, repeated: &mut Vec<Repeated<'a>>) {
        if name.is_empty() {
            return;
        }
        let known_output = symbol.kind == Kind::Output && self.outputs.contains_key(name);
        match self.symbols.get(name) {
            Some(first) if symbol.kind == Kind::Output && first.kind == Kind::State && !known_output => {}
            Some(&first) => {
                repeated.push(Repeated { name, first, again: symbol });
                return;
            }
            None => {
                if symbol.kind != Kind::Function {
                    let id = VariableId(u32::try_from(self.variables.len()).unwrap_or(u32::MAX));
                    self.variables.insert(name, id);
                }
                self.symbols.insert(name, symbol);
                self.in_order.push(name);
            }
        }
        if symbol.kind == Kind::Output {
            self.outputs.insert(name, symbol.position);
        }
    }

    pub(crate) fn symbol(&self, name: &str) -> Option<Symbol> {
        self.symbols.get(name).copied()
    }

    /// The place of an output in the declarations, also of one that is a state.
    pub(crate) fn output(&self, name: &str) -> Option<usize> {
        self.outputs.get(name).copied()
    }

    /// The variable of the model that a name becomes; functions become none.
    pub(crate) fn variable(&self, name: &str) -> Option<VariableId> {
        self.variables.get(name).copied()
    }

    /// Names of one kind, in written order.
    pub(crate) fn of_kind(&self, kind: Kind) -> impl Iterator<Item = &'a str> {
        self.in_order.iter().copied().filter(move |name| self.symbols[name].kind == kind)
    }

    /// Names that can stand for a value: first what the model declares, then what is predefined.
    pub(crate) fn values(&self) -> Vec<&'a str> {
        let order = [Kind::State, Kind::Input, Kind::Output, Kind::Constant];
        let declared = order.into_iter().flat_map(|kind| self.of_kind(kind));
        declared.chain(QUANTITIES).collect()
    }

    /// Names that can be called.
    pub(crate) fn functions(&self) -> Vec<&'a str> {
        let mut functions: Vec<&'a str> = self.of_kind(Kind::Function).collect();
        Predefined::names().for_each(|name| functions.push(name));
        functions
    }
}
