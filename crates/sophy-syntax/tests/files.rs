//! Files: what the grammar accepts, and what the typed view says of it.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test stops at the first surprise")]

mod corpus;

use corpus::{CORPUS, shown, text};
use sophy_syntax::ast::{
    ClockKind, Component, ComponentKind, ComponentsItem, ConnectionsItem, Declaration, DirectionKind,
    EquationItem, EquationSectionKind, Expression, FileItem, InterfaceItemKind, LocationItem, Section,
    Statement, TriggerKind, VariableKind, View,
};
use sophy_syntax::parse_file;

#[test]
fn the_corpus_is_read_without_messages() {
    for (name, text) in CORPUS {
        let parse = parse_file(text);
        assert_eq!(parse.syntax().to_string(), *text, "{name}: the tree keeps every byte");
        assert_eq!(shown(text, &parse), "", "{name}");
    }
}

/// The templates printed in the papers on HSML, names put in the place of what is left open.
#[test]
fn the_templates_of_the_papers_are_accepted() {
    let body = |sections: &str| format!("CTC Component_name is\nbody\n{sections}\nend body;\n%\n");
    let templates = [
        body("initial x := 1; end initial; dynamics der(x) = u; end dynamics; constraints 0 = x; end constraints;\
              output y = x; end output;"),
        body("event(signal_variable)\n  negative-to-positive\n  m := 1;\n  end negative-to-positive;\n  \
              positive-to-negative\n  m := -1;\n  end positive-to-negative;\nend event;"),
        body("dynamics if sgn > 0.0 then do der(x) = 1; else do der(x) = 2; endif; end dynamics;"),
        body("declarations\n    state x; local y; flag S; tsample t_next; tdelay 0.1; priority 1;\n  end declarations;"),
        "DTC Name is body initial end initial; update end update; constraints end constraints; end body;".to_owned(),
        "CC Name is interface end interface; body connections end connections; end body;".to_owned(),
        "System Name is body components end components; connections end connections; end body;".to_owned(),
        "LBC Name is interface input(level, string, {\"high\", \"medium\", \"low\"}); end interface; body end body;"
            .to_owned(),
    ];
    let fragments = [
        body(
            "location A transition near when min(j in 1..5 where j <> id : norm(p[j] - p[id])) < 2 goto A; end location;",
        ),
        body("initial x := delayed(u, T); y := delayed(u, T, u0); b := chance(0.5); end initial;"),
        body(
            "declarations mode alarm : boolean := false; state omega : real[3] := [0, 0, 0.21] \"rad/s\"; end declarations;",
        ),
        body(
            "output y = table(\"aero.csv\", \"Cl\", alpha, linear); z = signal_file(\"pin.csv\", \"Pin\", hold); end output;",
        ),
        "CC N is body connections u -> control.u; airframe.phi -> phi; compose a, b with [[0, 1], [1, 0]]; \
         end connections; end body; end N;"
            .to_owned(),
    ];
    for template in templates.into_iter().chain(fragments) {
        assert_eq!(shown(&template, &parse_file(&template)), "", "{template}");
    }
}

fn components(name: &str) -> Vec<Component> {
    let items = parse_file(text(name)).file().unwrap().items();
    items
        .filter_map(|item| if let FileItem::Component(component) = item { Some(component) } else { None })
        .collect()
}

fn source(expression: Option<Expression>) -> String {
    expression
        .map_or_else(|| "?".to_owned(), |expression| expression.syntax().text().to_string().trim().to_owned())
}

fn texts(expressions: Vec<Expression>) -> Vec<String> {
    expressions.into_iter().map(|expression| source(Some(expression))).collect()
}

#[test]
fn a_file_has_imports_constants_and_functions() {
    let file = parse_file(text("functions")).file().unwrap();
    let items: Vec<FileItem> = file.items().collect();
    let [
        FileItem::Import(import),
        FileItem::Function(_),
        FileItem::Function(euler),
        FileItem::Constant(auv),
        _,
    ] = items.as_slice()
    else {
        panic!("{items:?}")
    };
    assert_eq!(import.path().unwrap().text, "atmosphere.hsml");
    assert_eq!(euler.name().unwrap().text, "euler321");
    let parameters: Vec<_> = euler.parameters().collect();
    assert_eq!(parameters.len(), 1);
    assert_eq!(parameters[0].name().unwrap().text, "th");
    assert_eq!(texts(parameters[0].declared_type().unwrap().shape()), ["3"]);
    assert_eq!(euler.value_type().unwrap().name().unwrap().text, "real");
    assert_eq!(texts(euler.value_type().unwrap().shape()), ["3", "3"]);
    assert!(matches!(euler.value(), Some(Expression::Vector(_))));
    assert_eq!(auv.name().unwrap().text, "auv");
    assert_eq!(source(auv.value()), "data(\"npsauv.toml\")");
}

#[test]
fn an_interface_has_types_ranges_and_units() {
    let [manager] = components("logic").try_into().unwrap();
    assert_eq!(manager.kind(), Some(ComponentKind::Lbc));
    assert_eq!(manager.name().unwrap().text, "Manager");
    let items: Vec<_> = manager.interface().unwrap().items().collect();
    let level = &items[1];
    assert_eq!(level.kind(), Some(InterfaceItemKind::Input));
    assert_eq!(level.name().unwrap().text, "level");
    assert_eq!(&text("logic")[level.name().unwrap().range], "level");
    assert_eq!(level.declared_type().unwrap().name().unwrap().text, "signal");
    assert_eq!(texts(level.value_range().unwrap().values()), ["0", "10"]);
    assert!(!level.value_range().unwrap().is_list());
    assert_eq!(level.unit().unwrap().text().unwrap().text, "m");
    assert_eq!(items[2].declared_type().unwrap().name().unwrap().text, "event");
    let stat = &items[3];
    assert_eq!(stat.kind(), Some(InterfaceItemKind::Output));
    assert!(stat.value_range().unwrap().is_list());
    assert_eq!(texts(stat.value_range().unwrap().values()), ["\"idle\"", "\"tracking\""]);
}

#[test]
fn declarations_say_what_is_declared() {
    let [filter] = components("sampled").try_into().unwrap();
    let section = filter.body().unwrap().sections().next().unwrap();
    let Section::Declarations(declarations) = section else { panic!("{section:?}") };
    let items: Vec<_> = declarations.items().collect();
    let Declaration::Variable(x) = &items[0] else { panic!("{items:?}") };
    assert_eq!(x.kind(), Some(VariableKind::State));
    assert_eq!(x.names().map(|name| name.text).collect::<Vec<_>>(), ["x"]);
    assert_eq!(texts(x.declared_type().unwrap().shape()), ["2"]);
    assert_eq!(source(x.initial_value()), "[0, 0]");
    let Declaration::Clock(clock) = &items[2] else { panic!("{items:?}") };
    let Some(ClockKind::Every { period, start }) = clock.kind() else { panic!("{clock:?}") };
    assert_eq!((source(period), source(start)), ("Ts".to_owned(), "t0".to_owned()));
    let Declaration::ComputationDelay(delay) = &items[3] else { panic!("{items:?}") };
    assert_eq!(source(delay.value()), "2e-4");
    let Declaration::Priority(priority) = &items[4] else { panic!("{items:?}") };
    assert_eq!(source(priority.value()), "1");

    let [controller, _] = components("controller").try_into().unwrap();
    let Some(Section::Declarations(declarations)) = controller.body().unwrap().sections().next() else {
        panic!()
    };
    let Some(Declaration::Clock(clock)) = declarations.items().nth(2) else { panic!() };
    let Some(ClockKind::Variable { name, initial_value }) = clock.kind() else { panic!("{clock:?}") };
    assert_eq!((name.text, source(initial_value)), ("t_next".to_owned(), "0".to_owned()));
}

#[test]
fn several_names_share_a_declaration() {
    let [engagement] = components("events").try_into().unwrap();
    let Some(Section::Declarations(declarations)) = engagement.body().unwrap().sections().next() else {
        panic!()
    };
    let Some(Declaration::Variable(flags)) = declarations.items().nth(2) else { panic!() };
    assert_eq!(flags.kind(), Some(VariableKind::Flag));
    assert_eq!(flags.names().map(|name| name.text).collect::<Vec<_>>(), ["Engaged", "Limit"]);
}

#[test]
fn equations_and_statements_have_targets() {
    let [engagement] = components("events").try_into().unwrap();
    let sections: Vec<_> = engagement.body().unwrap().sections().collect();
    let Section::EquationSection(dynamics) = &sections[2] else { panic!("{sections:?}") };
    assert_eq!(dynamics.kind(), Some(EquationSectionKind::Dynamics));
    let equations = dynamics.equations();
    let EquationItem::IfStatement(conditional) = &equations[0] else { panic!("{equations:?}") };
    let branches: Vec<_> = conditional.branches().collect();
    assert_eq!(source(branches[0].condition()), "sgn > 0.0");
    assert!(branches[1].is_else() && branches[1].condition().is_none());
    let inner = branches[0].equations();
    let EquationItem::Equation(first) = &inner[0] else { panic!("{inner:?}") };
    let target = first.target().unwrap();
    assert_eq!((target.name.text.as_str(), target.derivative, target.indices.len()), ("w1", true, 0));
    assert_eq!(source(first.right()), "(torque - mu*slip)/J1");

    let Section::EventSection(event) = &sections[6] else { panic!("{sections:?}") };
    assert_eq!(source(event.flag()), "Limit");
    assert_eq!(source(event.priority()), "2");
    let directions: Vec<_> = event.directions().collect();
    assert_eq!(directions[0].kind(), Some(DirectionKind::NegativeToPositive));
    let statements = directions[0].statements();
    let Statement::IfStatement(conditional) = &statements[0] else { panic!("{statements:?}") };
    let parts: Vec<_> = conditional.branches().map(|branch| branch.statements().remove(0)).collect();
    assert!(matches!(&parts[0], Statement::Hold(hold) if hold.name().unwrap().text == "Limit"));
    assert!(matches!(&parts[1], Statement::Emit(emit) if emit.name().unwrap().text == "limit"));
    let Statement::AssignmentStatement(assignment) = &parts[2] else { panic!("{parts:?}") };
    assert_eq!(assignment.target().unwrap().name.text, "w1");
    assert_eq!(source(assignment.value()), "w_max - negative-to");

    let [_, a] = components("nested").try_into().unwrap();
    let Some(Section::EquationSection(dynamics)) = a.body().unwrap().sections().next() else { panic!() };
    let EquationItem::ForLoop(for_loop) = &dynamics.equations()[1] else { panic!() };
    assert_eq!(for_loop.variable().unwrap().text, "i");
    let range = for_loop.index_range().unwrap();
    assert_eq!((source(range.first()), source(range.last())), ("1".to_owned(), "n".to_owned()));
    let EquationItem::Equation(indexed) = &for_loop.equations()[0] else { panic!() };
    let target = indexed.target().unwrap();
    assert_eq!(
        (target.name.text.as_str(), target.derivative, texts(target.indices)),
        ("z", true, vec!["i".to_owned()])
    );
}

#[test]
fn rules_have_clauses() {
    let [manager] = components("logic").try_into().unwrap();
    let rules = manager.body().unwrap().sections().find_map(|section| match section {
        Section::Rules(rules) => Some(rules.rules().collect::<Vec<_>>()),
        _ => None,
    });
    let rules = rules.unwrap();
    let delayed = &rules[3];
    assert_eq!(source(delayed.condition()), "p > p_max");
    assert_eq!(source(delayed.delay()), "0.5");
    assert_eq!(source(delayed.priority()), "2");
    assert!(delayed.latched().is_some() && delayed.cancellable().is_some() && delayed.initially().is_none());
    assert_eq!(delayed.statements().len(), 1);
    let last = &rules[4];
    assert_eq!(&text("logic")[last.initially().unwrap()], "initially");
    assert_eq!(source(last.delay()), "2*tau");
    assert!(matches!(last.statements()[1], Statement::ForLoop(_)));
}

#[test]
fn locations_have_transitions_with_triggers() {
    let [queue] = components("hybrid").try_into().unwrap();
    let sections: Vec<_> = queue.body().unwrap().sections().collect();
    assert!(
        matches!(&sections[1], Section::InitialLocation(first) if first.name().unwrap().text == "Is Idle")
    );
    let Section::Location(idle) = &sections[2] else { panic!("{sections:?}") };
    assert_eq!(idle.name().unwrap().text, "Is Idle");
    let Some(LocationItem::Invariant(invariant)) = idle.items().next() else { panic!() };
    assert_eq!(source(invariant.condition()), "work <= 0");
    let Section::Location(busy) = &sections[3] else { panic!("{sections:?}") };
    let transitions: Vec<_> = idle.transitions().chain(busy.transitions()).collect();
    let summary: Vec<String> = transitions
        .iter()
        .map(|transition| {
            let trigger = transition.trigger().unwrap();
            let kind = match trigger.kind().unwrap() {
                TriggerKind::Guard => "guard".to_owned(),
                TriggerKind::Events(names) => {
                    names.into_iter().map(|name| name.text).collect::<Vec<_>>().join(" or ")
                }
                TriggerKind::Invariant => "invariant".to_owned(),
                TriggerKind::Rate(rate) => format!("rate {}", source(rate)),
                TriggerKind::Sync(label) => format!("sync {}", label.unwrap().text),
            };
            format!(
                "{}: {kind}, {}, {} -> {}, {}",
                transition.name().unwrap().text,
                source(trigger.guard()),
                source(transition.priority()),
                transition.target().unwrap().text,
                transition.statements().len()
            )
        })
        .collect();
    assert_eq!(
        summary,
        [
            "arrive: arrival, n < 10, 1 -> Busy, 2",
            "leave: invariant, ?, ? -> Busy, 0",
            "begin: sync start, n > 0, ? -> Busy, 0",
            "fail: rate lambda*age, u > 0, 2 -> Is Idle, 2",
            "finished: arrival or other, ?, 1 -> Busy, 0",
            "empty: guard, work <= 0 and location = \"Busy\", ? -> Is Idle, 1",
        ]
    );
}

#[test]
fn composites_have_instances_and_connections() {
    let [turret] = components("composite").try_into().unwrap();
    let sections: Vec<_> = turret.body().unwrap().sections().collect();
    let Section::ComponentsSection(section) = &sections[1] else { panic!("{sections:?}") };
    let instances: Vec<_> = section.items().collect();
    let ComponentsItem::Instance(motor) = &instances[0] else { panic!("{instances:?}") };
    assert_eq!(
        (motor.name().unwrap().text.as_str(), motor.component().unwrap().text.as_str()),
        ("motor", "Motor")
    );
    let resistance = motor.arguments().next().unwrap();
    assert_eq!(
        (resistance.name().unwrap().text, source(resistance.value())),
        ("R".to_owned(), "2".to_owned())
    );
    assert_eq!(resistance.unit().unwrap().text().unwrap().text, "ohm");
    let ComponentsItem::Instance(mesh) = &instances[2] else { panic!("{instances:?}") };
    assert_eq!(texts(mesh.shape()), ["3", "4"]);

    let Section::ConnectionsSection(section) = &sections[2] else { panic!("{sections:?}") };
    let connections: Vec<_> = section.items().collect();
    let ConnectionsItem::Connection(second) = &connections[1] else { panic!("{connections:?}") };
    let target = second.target().unwrap().parts();
    assert_eq!(target.iter().map(|part| part.name.text.as_str()).collect::<Vec<_>>(), ["gear", "torque"]);
    assert_eq!(texts(target[0].indices.clone()), ["1"]);
    assert_eq!(second.source().unwrap().parts().len(), 2);
    let ConnectionsItem::ForLoop(rows) = &connections[3] else { panic!("{connections:?}") };
    let Some(ConnectionsItem::ForLoop(columns)) = rows.items().next() else { panic!() };
    let Some(ConnectionsItem::Connection(inner)) = columns.items().next() else { panic!() };
    assert_eq!(texts(inner.target().unwrap().parts()[1].indices.clone()), ["2"]);
    let ConnectionsItem::Compose(compose) = &connections[4] else { panic!("{connections:?}") };
    assert_eq!(compose.parts().count(), 2);
    assert_eq!(source(compose.matrix()), "[[0, 1], [1, 0]]");

    let [race] = components("hovercraft").try_into().unwrap();
    let Some(Section::ComponentsSection(section)) = race.body().unwrap().sections().next() else { panic!() };
    let Some(ComponentsItem::ForLoop(copies)) = section.items().next() else { panic!() };
    let Some(ComponentsItem::Instance(craft)) = copies.items().next() else { panic!() };
    assert_eq!(texts(craft.indices()), ["i"]);
}

#[test]
fn assignments_give_parameters_their_values() {
    let [engagement] = components("events").try_into().unwrap();
    let Some(Section::AssignmentsSection(section)) = engagement.body().unwrap().sections().last() else {
        panic!()
    };
    let values: Vec<String> = section
        .items()
        .map(|item| format!("{} {}", item.name().unwrap().text, source(item.value())))
        .collect();
    assert_eq!(values, ["J1 1", "J2 2", "mu 0.3", "w_max 100"]);
    assert_eq!(section.items().nth(1).unwrap().unit().unwrap().text().unwrap().text, "kg*m2");
}

#[test]
fn documentation_stands_before_what_it_documents() {
    let [c] = components("comments").try_into().unwrap();
    assert_eq!(c.documentation(), "The first line\nand the second one.");
    let input = c.interface().unwrap().items().next().unwrap();
    assert_eq!(input.documentation(), "the input");
    let Some(Section::Declarations(declarations)) = c.body().unwrap().sections().next() else { panic!() };
    assert_eq!(declarations.items().next().unwrap().documentation(), "A state.");
    let Some(Section::EquationSection(dynamics)) = c.body().unwrap().sections().nth(1) else { panic!() };
    assert_eq!(dynamics.documentation(), "");
    assert_eq!(components("roll")[0].documentation(), "");
}
