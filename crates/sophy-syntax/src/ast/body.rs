//! Bodies and their sections.

use super::{
    AssignmentsSection, ComponentsSection, ConnectionsSection, Expression, Name, Statements, Type, Unit,
    ValueRange, View, child, children, expression_after, expressions, keyword, name_at, names, statements_of,
    tokens,
};
use crate::ast::Equations;
use crate::kinds::{SyntaxKind, SyntaxNode};
use std::ops::Range;

view! {
    /// `body … end body;`.
    Body = Body;
    /// `declarations … end declarations;`.
    Declarations = Declarations;
    /// `state x, y : real[3] in (0, 1) := 0 "m";`.
    Variable = Variable;
    /// `tsample t_next := 0;` or `tsample every Ts from t0;`.
    Clock = Clock;
    /// `tdelay 2e-4;`.
    ComputationDelay = ComputationDelay;
    /// `priority 1;`.
    Priority = Priority;
    /// `initial … end initial;` or `update … end update;`.
    StatementSection = StatementSection;
    /// `dynamics … end dynamics;`, `constraints …` or `output …`.
    EquationSection = EquationSection;
    /// `event(S) … end event;`.
    EventSection = EventSection;
    /// `negative-to-positive …` or `positive-to-negative …`.
    Direction = Direction;
    /// `rules … end rules;`.
    Rules = Rules;
    /// `when c … do … end when;`.
    Rule = Rule;
    /// `initial location Flight;`.
    InitialLocation = InitialLocation;
    /// `location Flight … end location;`.
    Location = Location;
    /// `invariant x < 1;`.
    Invariant = Invariant;
    /// `transition name when g goto Thrust do … end transition;`.
    Transition = Transition;
    /// A part of a rule, trigger or clock that starts with a word: `delay 0.5`, `latched`.
    Clause = Clause;
    /// What a [`Transition`] waits for.
    Trigger = Trigger;
    /// `:= 1`.
    InitialValue = InitialValue;
}

views_of! {
    /// A section of a body.
    Section:
        Declarations, StatementSection, EquationSection, EventSection, Rules, InitialLocation, Location,
        ComponentsSection, ConnectionsSection, AssignmentsSection;
    /// An item of a `location`.
    LocationItem: Declarations, EquationSection, Invariant, Transition;
    /// An item of `declarations`.
    Declaration: Variable, Clock, ComputationDelay, Priority;
}

impl Body {
    /// Its sections, in order.
    pub fn sections(&self) -> impl Iterator<Item = Section> + use<> {
        children(self.syntax())
    }
}

impl Declarations {
    /// What is declared, in order.
    pub fn items(&self) -> impl Iterator<Item = Declaration> + use<> {
        children(self.syntax())
    }
}

/// What a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum VariableKind {
    State,
    Local,
    Mode,
    Flag,
}

impl Variable {
    /// What it is; `None` if its word is none of the known ones.
    pub fn kind(&self) -> Option<VariableKind> {
        match keyword(self.syntax())?.text() {
            "state" => Some(VariableKind::State),
            "local" => Some(VariableKind::Local),
            "mode" => Some(VariableKind::Mode),
            "flag" => Some(VariableKind::Flag),
            _ => None,
        }
    }

    /// Its names: several share type, range, value and unit.
    pub fn names(&self) -> impl Iterator<Item = Name> + use<> {
        names(self.syntax()).skip(1)
    }

    /// The type after `:`.
    pub fn declared_type(&self) -> Option<Type> {
        child(self.syntax())
    }

    /// The values it may take, after `in`.
    pub fn value_range(&self) -> Option<ValueRange> {
        child(self.syntax())
    }

    /// The expression after `:=`.
    pub fn initial_value(&self) -> Option<Expression> {
        initial_value(self.syntax())
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

fn initial_value(node: &SyntaxNode) -> Option<Expression> {
    child::<InitialValue>(node).and_then(|value| expressions(value.syntax()).next())
}

/// When a discrete-time component executes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClockKind {
    /// At the time in a variable, which the update moves.
    Variable {
        /// The variable.
        name: Name,
        /// Its value at the start.
        initial_value: Option<Expression>,
    },
    /// Every `period` from `start` on.
    Every {
        /// After `every`.
        period: Option<Expression>,
        /// After `from`.
        start: Option<Expression>,
    },
}

impl Clock {
    /// When the component executes.
    pub fn kind(&self) -> Option<ClockKind> {
        match clause_value(self.syntax(), "every") {
            Some(period) => {
                Some(ClockKind::Every { period, start: clause_value(self.syntax(), "from").flatten() })
            }
            None => Some(ClockKind::Variable {
                name: name_at(self.syntax(), 1)?,
                initial_value: initial_value(self.syntax()),
            }),
        }
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

impl ComputationDelay {
    /// From sampling to the change of the outputs.
    pub fn value(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }

    /// Its unit.
    pub fn unit(&self) -> Option<Unit> {
        child(self.syntax())
    }
}

impl Priority {
    /// Smaller executes first.
    pub fn value(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }
}

/// What a section of statements is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum StatementSectionKind {
    Initial,
    Update,
}

impl StatementSection {
    /// What it is for. A misspelt word does not say.
    pub fn kind(&self) -> Option<StatementSectionKind> {
        match keyword(self.syntax())?.kind() {
            SyntaxKind::InitialKeyword => Some(StatementSectionKind::Initial),
            SyntaxKind::UpdateKeyword => Some(StatementSectionKind::Update),
            _ => None,
        }
    }

    /// Its statements.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }
}

/// What a section of equations is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum EquationSectionKind {
    Dynamics,
    Constraints,
    Output,
}

impl EquationSection {
    /// What it is for. A misspelt word does not say.
    pub fn kind(&self) -> Option<EquationSectionKind> {
        match keyword(self.syntax())?.kind() {
            SyntaxKind::DynamicsKeyword => Some(EquationSectionKind::Dynamics),
            SyntaxKind::ConstraintsKeyword => Some(EquationSectionKind::Constraints),
            SyntaxKind::OutputKeyword => Some(EquationSectionKind::Output),
            _ => None,
        }
    }

    /// Its equations.
    pub fn equations(&self) -> Equations {
        super::statements::equations_of(self.syntax())
    }
}

impl EventSection {
    /// The flag that crosses zero: a name, perhaps with an index.
    pub fn flag(&self) -> Option<Expression> {
        expression_after(self.syntax(), SyntaxKind::LeftParenthesis)
    }

    /// After `priority`.
    pub fn priority(&self) -> Option<Expression> {
        clause_value(self.syntax(), "priority").flatten()
    }

    /// What happens in each direction.
    pub fn directions(&self) -> impl Iterator<Item = Direction> + use<> {
        children(self.syntax())
    }
}

/// How a flag crosses zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // the names say it
pub enum DirectionKind {
    NegativeToPositive,
    PositiveToNegative,
}

impl Direction {
    /// How the flag crosses zero.
    pub fn kind(&self) -> Option<DirectionKind> {
        match keyword(self.syntax())?.kind() {
            SyntaxKind::NegativeToPositiveKeyword => Some(DirectionKind::NegativeToPositive),
            SyntaxKind::PositiveToNegativeKeyword => Some(DirectionKind::PositiveToNegative),
            _ => None,
        }
    }

    /// What happens.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }
}

impl Rules {
    /// The rules, in order.
    pub fn rules(&self) -> impl Iterator<Item = Rule> + use<> {
        children(self.syntax())
    }
}

impl Rule {
    /// After `when`.
    pub fn condition(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }

    /// Whether and where it says `initially`.
    pub fn initially(&self) -> Option<Range<usize>> {
        clause(self.syntax(), "initially").map(|clause| clause.range())
    }

    /// Whether and where it says `latched`.
    pub fn latched(&self) -> Option<Range<usize>> {
        clause(self.syntax(), "latched").map(|clause| clause.range())
    }

    /// Whether and where it says `cancellable`.
    pub fn cancellable(&self) -> Option<Range<usize>> {
        clause(self.syntax(), "cancellable").map(|clause| clause.range())
    }

    /// After `delay`.
    pub fn delay(&self) -> Option<Expression> {
        clause_value(self.syntax(), "delay").flatten()
    }

    /// After `priority`.
    pub fn priority(&self) -> Option<Expression> {
        clause_value(self.syntax(), "priority").flatten()
    }

    /// All clauses, in order: one written twice is a mistake.
    pub fn clauses(&self) -> impl Iterator<Item = Clause> + use<> {
        children(self.syntax())
    }

    /// What happens.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }
}

impl Clause {
    /// Its first word.
    pub fn word(&self) -> Option<Name> {
        let token = keyword(self.syntax())?;
        Some(Name { text: token.text().to_owned(), range: token.text_range().into() })
    }

    /// The expression after it.
    pub fn value(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }
}

fn clause(node: &SyntaxNode, word: &str) -> Option<Clause> {
    children::<Clause>(node).find(|clause| keyword(clause.syntax()).is_some_and(|token| token.text() == word))
}

/// `None` if there is no such clause.
fn clause_value(node: &SyntaxNode, word: &str) -> Option<Option<Expression>> {
    clause(node, word).map(|clause| clause.value())
}

impl InitialLocation {
    /// The name of the location.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 2)
    }
}

impl Location {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// What stands in it, in order.
    pub fn items(&self) -> impl Iterator<Item = LocationItem> + use<> {
        children(self.syntax())
    }

    /// Its transitions, in order.
    pub fn transitions(&self) -> impl Iterator<Item = Transition> + use<> {
        children(self.syntax())
    }
}

impl Invariant {
    /// What holds in the location.
    pub fn condition(&self) -> Option<Expression> {
        expressions(self.syntax()).next()
    }
}

impl Transition {
    /// Its name.
    pub fn name(&self) -> Option<Name> {
        name_at(self.syntax(), 1)
    }

    /// What it waits for.
    pub fn trigger(&self) -> Option<Trigger> {
        child(self.syntax())
    }

    /// After `priority`.
    pub fn priority(&self) -> Option<Expression> {
        clause_value(self.syntax(), "priority").flatten()
    }

    /// The location after `goto`.
    pub fn target(&self) -> Option<Name> {
        tokens(self.syntax())
            .skip_while(|token| token.text() != "goto")
            .nth(1)
            .and_then(|token| super::name_of_token(&token))
    }

    /// What happens on the way; none if there is no `do`.
    pub fn statements(&self) -> Statements {
        statements_of(self.syntax())
    }
}

/// What a transition waits for, beside its guard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TriggerKind {
    /// `when G`: the guard alone.
    Guard,
    /// `on E1, E2`: one of these events.
    Events(Vec<Name>),
    /// `on invariant`: the invariant is left.
    Invariant,
    /// `rate r`: chance, at this rate.
    Rate(Option<Expression>),
    /// `sync L`: transitions with this label in other components.
    Sync(Option<Name>),
}

impl Trigger {
    /// What the transition waits for; `None` if its word is none of the known ones.
    pub fn kind(&self) -> Option<TriggerKind> {
        let Some(word) = name_at(self.syntax(), 0) else {
            return self.guard().map(|_| TriggerKind::Guard);
        };
        let mut names = names(self.syntax()).skip(1);
        match word.text.as_str() {
            "on" => {
                let names: Vec<Name> = names.collect();
                match names.as_slice() {
                    [name] if name.text == "invariant" => Some(TriggerKind::Invariant),
                    _ => Some(TriggerKind::Events(names)),
                }
            }
            "rate" => Some(TriggerKind::Rate(expressions(self.syntax()).next())),
            "sync" => Some(TriggerKind::Sync(names.next())),
            _ => None,
        }
    }

    /// After `when`.
    pub fn guard(&self) -> Option<Expression> {
        clause_value(self.syntax(), "when").flatten()
    }
}
