use super::expression::{Context, Lowering, Scope, Typed};
use crate::checks::hs0107_declared_twice;
use crate::declarations::{Declarations, FunctionDeclaration};
use crate::findings::Findings;
use crate::names::{Kind, Names};
use sophy_diagnostics::Span;
use sophy_ir::{Graph, Leaf, NodeId, VariableId};
use std::collections::HashMap;

/// The user's functions, ready to be put in the place of their calls.
#[derive(Default)]
pub(crate) struct Functions<'a> {
    declared: HashMap<&'a str, &'a FunctionDeclaration>,
    templates: HashMap<&'a str, Template>,
}

/// The body of a function in a graph of its own; parameters are leaves of placeholder variables.
pub(crate) struct Template {
    pub(crate) graph: Graph,
    pub(crate) boolean: bool,
    /// Whether it compares what depends on its parameters with `=` or `<>`.
    pub(crate) compares_equal: bool,
    /// Where the body stands.
    pub(crate) span: Span,
    root: NodeId,
    parameters: usize,
}

/// Parameter `position`, counted down from the top so that it is no variable of the model.
fn placeholder(position: usize) -> VariableId {
    VariableId(u32::MAX - u32::try_from(position).unwrap_or(0))
}

impl Template {
    /// The body in `graph`, arguments in the place of parameters.
    pub(crate) fn expand(&self, graph: &mut Graph, arguments: &[Typed]) -> NodeId {
        graph.import(&self.graph, self.root, &mut |graph, leaf| {
            let parameter = (0..self.parameters).find(|&p| leaf == Leaf::Variable(placeholder(p)));
            match parameter.and_then(|p| arguments.get(p)) {
                Some(argument) => argument.node,
                None => graph.leaf(leaf),
            }
        })
    }
}

impl Functions<'_> {
    pub(crate) fn parameter_count(&self, name: &str) -> Option<usize> {
        self.declared.get(name).map(|function| function.parameters.len())
    }

    /// `None` if its body has mistakes.
    pub(crate) fn template(&self, name: &str) -> Option<&Template> {
        self.templates.get(name)
    }

    /// How to call it.
    pub(crate) fn usage(&self, name: &str) -> String {
        let parameters = self.declared.get(name).map_or(&[][..], |function| &function.parameters);
        let parameters: Vec<&str> = parameters.iter().map(|parameter| parameter.value.as_str()).collect();
        format!("{name}({})", parameters.join(", "))
    }
}

impl<'a> Functions<'a> {
    /// All declared functions, their bodies still to come.
    pub(crate) fn declare(declarations: &'a Declarations, names: &Names<'a>) -> Self {
        let mut functions = Functions::default();
        for name in names.of_kind(Kind::Function) {
            if let Some(symbol) = names.symbol(name) {
                functions.declared.insert(name, &declarations.functions[symbol.position]);
            }
        }
        functions
    }

    /// Lowers the body of a function; what it calls must be known.
    pub(crate) fn define(
        &mut self,
        function: &'a FunctionDeclaration,
        names: &Names<'a>,
        constants: &HashMap<VariableId, f64>,
        findings: &mut Findings,
    ) {
        if let Some(template) = lower_function(function, names, constants, self, findings) {
            self.templates.entry(function.name.value.as_str()).or_insert(template);
        }
    }
}

fn lower_function(
    function: &FunctionDeclaration,
    names: &Names<'_>,
    constants: &HashMap<VariableId, f64>,
    functions: &Functions<'_>,
    findings: &mut Findings,
) -> Option<Template> {
    let mut graph = Graph::default();
    let mut parameters: Vec<(String, Typed)> = Vec::new();
    for (position, name) in function.parameters.iter().enumerate() {
        let first = function.parameters[..position].iter().find(|earlier| earlier.value == name.value);
        if let Some(first) = first {
            findings.report(hs0107_declared_twice::parameter(&name.value, first.span, name.span));
        }
        let node = graph.leaf(Leaf::Variable(placeholder(position)));
        parameters.push((name.value.clone(), Typed { node, boolean: false, varies: true }));
    }
    let mut context = Context { names, functions, constants, findings };
    let text = &function.body;
    let scope = Scope::Function { parameters: &parameters };
    let mut lowering =
        Lowering { context: &mut context, graph: &mut graph, scope, text, compares_equal: false };
    let value = lowering.expression(text.parse.expression()?);
    let compares_equal = lowering.compares_equal;
    let value = value.filter(|_| text.parse.errors().is_empty())?;
    Some(Template {
        root: value.node,
        boolean: value.boolean,
        compares_equal,
        span: text.map.whole(),
        parameters: parameters.len(),
        graph,
    })
}
