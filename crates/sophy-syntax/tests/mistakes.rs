//! What is said of a mistake in a file, and that the rest of the file is read as it was meant.

mod corpus;

use corpus::{shown, text};
use sophy_syntax::{SyntaxKind, parse_file};

/// The kinds of all items of a file, in order: what a reader of the file works with.
fn outline(text: &str) -> Vec<SyntaxKind> {
    use SyntaxKind as K;
    let items = [
        K::Component,
        K::Interface,
        K::InterfaceItem,
        K::Body,
        K::Declarations,
        K::Variable,
        K::Clock,
        K::StatementSection,
        K::EquationSection,
        K::EventSection,
        K::Direction,
        K::Rules,
        K::Rule,
        K::InitialLocation,
        K::Location,
        K::Invariant,
        K::Transition,
        K::ComponentsSection,
        K::Instance,
        K::ConnectionsSection,
        K::Connection,
        K::AssignmentsSection,
        K::Assignment,
        K::AssignmentStatement,
        K::IfStatement,
        K::Branch,
        K::ForLoop,
        K::Equation,
    ];
    let syntax = parse_file(text).syntax();
    syntax.descendants().map(|node| node.kind()).filter(|kind| items.contains(kind)).collect()
}

/// In `file`, `right` is written as `wrong`: one message, the rest as before.
fn check(file: &str, right: &str, wrong: &str, expected: &str) {
    let mistaken = message(file, right, wrong, expected);
    assert_eq!(outline(&mistaken), outline(text(file)), "{file}: `{right}` written `{wrong}`");
}

/// Like [`check`], where something is lost with the mistake.
fn message(file: &str, right: &str, wrong: &str, expected: &str) -> String {
    assert!(text(file).contains(right), "{file}: {right}");
    let mistaken = text(file).replacen(right, wrong, 1);
    let parse = parse_file(&mistaken);
    assert_eq!(parse.syntax().to_string(), mistaken, "the tree keeps every byte");
    assert_eq!(shown(&mistaken, &parse), format!("{expected}\n"), "{file}: `{right}` written `{wrong}`");
    mistaken
}

#[test]
fn a_missing_or_wrong_end_is_one_message() {
    check(
        "roll",
        "end dynamics;",
        "end dynamcs;",
        "HS0016:11 `dynamcs`: `dynamics` is open, but `dynamcs` is ended here | write `end dynamics;`",
    );
    check(
        "roll",
        "end declarations;",
        "",
        "HS0015:9 `dynamics`: `end declarations` is missing before `dynamics` | write `end declarations;`",
    );
    check(
        "roll",
        "end dynamics;",
        "",
        "HS0015:12 `output`: `end dynamics` is missing before `output` | write `end dynamics;`",
    );
    check(
        "roll",
        "end event;",
        "",
        "HS0015:23 `assignments`: `end event` is missing before `assignments` | write `end event;`",
    );
    check(
        "roll",
        "end negative-to-positive;",
        "",
        "HS0015:19 `positive-to-negative`: `end negative-to-positive` is missing before `positive-to-negative` | write `end negative-to-positive;`",
    );
    check(
        "roll",
        "end body;",
        "",
        "HS0015:23 ``: `end body` is missing at the end of the file | write `end body;`",
    );
    check(
        "roll",
        "end interface;",
        "",
        "HS0015:5 `body`: `end interface` is missing before `body` | write `end interface;`",
    );
    check(
        "hopper",
        "    transition ground_impact when position < L goto Compression;\n  end location;",
        "    transition ground_impact when position < L goto Compression;\n",
        "HS0015:24 `location`: `end location` is missing before `location` | write `end location;`",
    );
    check(
        "hopper",
        "end transition;",
        "",
        "HS0015:30 `end`: `end transition` is missing before `end location` | write `end transition;`",
    );
    check(
        "logic",
        "do m := \"idle\"; end when;",
        "do m := \"idle\";",
        "HS0015:20 `when`: `end when` is missing before `when` | write `end when;`",
    );
    check(
        "logic",
        "end loop;",
        "end for;",
        "HS0016:29 `for`: `loop` is open, but `for` is ended here | write `end loop;`",
    );
    check(
        "sampled",
        "end if;",
        "end;",
        "HS0016:24 `end`: this `end` does not say what it ends | write `end if;`",
    );
    check(
        "sampled",
        "end if;",
        "",
        "HS0015:25 `end`: `end if` is missing before `end update` | write `end if;`",
    );
    check(
        "roll",
        "end body;",
        "end body;\nend Rol;",
        "HS0016:25 `Rol`: `Roll` is open, but `Rol` is ended here | write `end Roll;`",
    );
}

#[test]
fn a_misspelt_word_is_one_message() {
    check(
        "roll",
        "  dynamics\n",
        "  dynamcs\n",
        "HS0018:9 `dynamcs`: `dynamcs` does not start a section | did you mean `dynamics`?",
    );
    check(
        "roll",
        "  dynamics\n    S = e + h*m;",
        "  dynamcs\n    S = e + h*m;",
        "HS0018:9 `dynamcs`: `dynamcs` does not start a section | did you mean `dynamics`?",
    );
    check(
        "roll",
        "declarations\n",
        "declaration\n",
        "HS0018:6 `declaration`: `declaration` does not start a section | did you mean `declarations`?",
    );
    check(
        "roll",
        "CTC Roll is",
        "CTX Roll is",
        "HS0018:1 `CTX`: `CTX` does not start a component | did you mean `CTC`?",
    );
    check(
        "roll",
        "input(e, signal);",
        "inptu(e, signal);",
        "HS0018:3 `inptu`: `inptu` does not start an item of an interface | did you mean `input`?",
    );
    check(
        "roll",
        "flag S;",
        "flg S;",
        "HS0018:7 `flg`: `flg` does not start a declaration | did you mean `flag`?",
    );
    message(
        "roll",
        "flag S;",
        "S;",
        "HS0018:7 `S`: `S` does not start a declaration | it starts with `state`, `local`, `mode`, `flag`, `tsample`, `tdelay` or `priority`",
    );
    check(
        "roll",
        "negative-to-positive\n",
        "negative-to-postive\n",
        "HS0018:16 `negative`: this is not a direction in which a flag crosses zero | did you mean `negative-to-positive`?",
    );
    check(
        "hopper",
        "transition ground",
        "transitoin ground",
        "HS0018:21 `transitoin`: `transitoin` does not start a part of a location | did you mean `transition`?",
    );
    check(
        "hopper",
        "goto Compression",
        "got Compression",
        "HS0018:21 `got`: `got` does not start the target of a transition | did you mean `goto`?",
    );
    check(
        "hopper",
        "when position",
        "wehn position",
        "HS0018:21 `wehn`: `wehn` does not start the trigger of a transition | did you mean `when`?",
    );
    check(
        "hopper",
        "location Flight",
        "locaton Flight",
        "HS0018:16 `locaton`: `locaton` does not start a section | did you mean `location`?",
    );
    check(
        "hopper",
        "location Flight",
        "Location Flight",
        "HS0018:16 `Location`: `Location` does not start a section | did you mean `location`?",
    );
    message(
        "hopper",
        "state speed    := 0.1;",
        "speed : real := 0.1;",
        "HS0018:11 `speed`: `speed` does not start a declaration | it starts with `state`, `local`, `mode`, `flag`, `tsample`, `tdelay` or `priority`",
    );
    check(
        "logic",
        "when hit do",
        "whne hit do",
        "HS0018:19 `whne`: `whne` does not start a rule | did you mean `when`?",
    );
    check(
        "logic",
        "latched",
        "lached",
        "HS0018:21 `lached`: `lached` does not start a clause of a rule | did you mean `latched`?",
    );
    check(
        "sampled",
        "tsample every",
        "tsample evry",
        "HS0018:10 `evry`: `evry` does not start a clock | did you mean `every`?",
    );
    check(
        "hybrid",
        "invariant work",
        "invarient work",
        "HS0018:17 `invarient`: `invarient` does not start a part of a location | did you mean `invariant`?",
    );
    check(
        "hybrid",
        "rate lambda",
        "rat lambda",
        "HS0018:40 `rat`: `rat` does not start the trigger of a transition | did you mean `rate`?",
    );
    message(
        "roll",
        "end body;",
        "end body;\ncomponent X is body end body;",
        "HS0018:25 `component`: `component` does not start a component | it starts with `CTC`, `DTC`, `LBC`, `CC` or `SYSTEM`",
    );
}

#[test]
fn a_missing_part_is_one_message() {
    check("roll", "S = e + h*m;", "S = e + h*m", "HS0017:10 ``: `;` is missing after `m` | write `;` there");
    check(
        "roll",
        "F = 100*m;",
        "F = 100*m $;",
        "HS0001:13 `$`: `$` is not a character of a model | delete it, or put a name that needs it in single quotes: `'Ground Impact'`",
    );
    check(
        "roll",
        "F = 100*m;",
        "F = (100*m;",
        "HS0005:13 `(`: `(` is never closed | add a `)` where the part ends, or delete the `(`",
    );
    check(
        "roll",
        "F = 100*m;",
        "F = 100*m);",
        "HS0004:13 `)`: unmatched `)` | delete it, or add a `(` before `F`",
    );
    check(
        "roll",
        "assignments h : 5;",
        "assignments h : 5",
        "HS0017:23 ``: `;` is missing after `5` | write `;` there",
    );
    check("roll", "CTC Roll is", "CTC Roll", "HS0019:1 ``: `is` is missing here | write `CTC Name is`");
    check(
        "roll",
        "CTC Roll is",
        "Roll is",
        "HS0019:1 `Roll`: the kind of the component is missing here | write for example `CTC Name is`",
    );
    check(
        "roll",
        "input(e, signal);",
        "input(e, signal)",
        "HS0017:3 ``: `;` is missing after `)` | write `;` there",
    );
    check("roll", "event(S)", "event S", "HS0019:15 `S`: `(` is missing here | write `event(S)`");
    check(
        "hopper",
        "goto Compression",
        "Compression",
        "HS0007:21 `Compression`: an operator is missing between `L` and `Compression` | for a product write `L * Compression`",
    );
    check(
        "hopper",
        "der(speed)    = -g;",
        "der(speed)    = -g",
        "HS0017:19 ``: `;` is missing after `g` | write `;` there",
    );
    check(
        "hopper",
        "state speed    := 0.1;",
        "state speed     0.1;",
        "HS0012:11 `0.1`: `0.1` is not expected here",
    );
    check(
        "hopper",
        "state speed    := 0.1;",
        "state end := 0.1;",
        "HS0020:11 `end`: `end` is a reserved word, not a name | choose another name, or quote it: `'end'`",
    );
    check(
        "logic",
        "do m := \"idle\"; end when;",
        "m := \"idle\"; end when;",
        "HS0019:19 `m`: `do` is missing here | write `when condition do statements end when;`",
    );
    check(
        "logic",
        "do m := \"idle\"; end when;",
        "do m := \"idle\" end when;",
        "HS0017:19 ``: `;` is missing after `\"idle\"` | write `;` there",
    );
    check(
        "composite",
        "volts -> motor.u;",
        "volts -> ;",
        "HS0019:15 `;`: the input that is connected is missing here | write `a.output -> b.input;`",
    );
    check(
        "composite",
        "gear  : Gear[2];",
        "gear Gear[2];",
        "HS0019:11 `Gear`: `:` is missing here | write `name : Component;`",
    );
    check(
        "sampled",
        "if norm(x) > 1 then",
        "if norm(x) > 1",
        "HS0019:18 ``: `then` is missing here | write `if condition then`",
    );
    check(
        "sampled",
        "for i in 1..2 loop",
        "for i = 1..2 loop",
        "HS0019:15 `=`: `in` is missing here | write `for i in 1..n loop`",
    );
    check(
        "sampled",
        "for i in 1..2 loop",
        "for i in 1..2",
        "HS0019:15 ``: `loop` is missing here | write `for i in 1..n loop`",
    );
    check(
        "hybrid",
        "on arrival when n < 10 priority 1 goto Busy do",
        "on arrival when n < 10 priority 1 goto Busy",
        "HS0019:18 ``: `do` is missing here | write `goto Location do statements end transition;`",
    );
    message(
        "hybrid",
        "dynamics\n",
        "",
        "HS0020:30 `der`: `der` does not stand directly in a location | equations stand in `dynamics`, `constraints` or `output`",
    );
    check(
        "hybrid",
        "body\n",
        "",
        "HS0019:7 ``: `body` is missing here | the sections of a component stand between `body` and `end body;`",
    );
    check(
        "hybrid",
        "initial location 'Is Idle';",
        "initial location;",
        "HS0019:14 `;`: the name of a location is missing here | write a name there",
    );
    check("roll", "end body;", "end body;\n}", "HS0004:25 `}`: unmatched `}` | delete it");
    message(
        "roll",
        "end body;",
        "end body;\nx = 3; y = 4;\nCTC A is body end body;",
        "HS0020:25 `x`: `x` stands outside of a component | a file holds items that start with `import`, `constant`, `function`, `CTC`, `DTC`, `LBC`, `CC` or `SYSTEM`",
    );
}

#[test]
fn signs_are_not_mixed_up() {
    check(
        "roll",
        "m := 1;",
        "m = 1;",
        "HS0021:17 `=`: `=` states an equation; a statement assigns with `:=` | write `:=`",
    );
    check(
        "roll",
        "F = 100*m;",
        "F := 100*m;",
        "HS0021:13 `:=`: `:=` assigns at an instant; an equation is written with `=` | write `=`",
    );
    check(
        "roll",
        "F = 100*m;",
        "F = 100*m = 3;",
        "HS0022:13 `=`: a comparison with `=` in an equation needs parentheses | write `name = (a = b);`, or end the first equation with `;`",
    );
    check(
        "roll",
        "F = 100*m;",
        "100*m = F;",
        "HS0023:13 `100*m`: the left side of this equation is not `x`, `x[i]` or `der(x)` | solve it for one variable, or put it in `constraints`",
    );
    check(
        "roll",
        "assignments h : 5;",
        "assignments h = 5;",
        "HS0021:23 `=`: `:` gives a parameter its value | write `:`",
    );
    check(
        "hopper",
        "state speed    := 0.1;",
        "state speed    = 0.1;",
        "HS0021:11 `=`: an initial value is given with `:=` | write `:=`",
    );
    check(
        "composite",
        "volts -> motor.u;",
        "volts = motor.u;",
        "HS0021:15 `=`: a connection is written with `->` | write `a.output -> b.input;`",
    );
    check(
        "composite",
        "volts -> motor.u;",
        "volts - motor.u;",
        "HS0021:15 `-`: a connection is written with `->` | write `a.output -> b.input;`",
    );
    check(
        "composite",
        "gear  : Gear[2];",
        "gear := Gear[2];",
        "HS0021:11 `:=`: a component of a composite is given with `:` | write `name : Component;`",
    );
}
#[test]
fn an_open_quote_is_one_message() {
    check(
        "roll",
        "h : 5;",
        "h : \"5;",
        "HS0003:23 `\"5`: the string that starts here is never closed | a string ends with `\"` on the same line",
    );
    message(
        "logic",
        "m = \"idle\" do",
        "m = \"idle do",
        "HS0003:18 `\"`: the string that starts here is never closed | a string ends with `\"` on the same line",
    );
}

#[test]
fn what_stands_twice_is_one_message() {
    check(
        "roll",
        "e, signal",
        "e, signal, real",
        "HS0012:3 `real`: a second type is not expected here | delete one of the two",
    );
    check(
        "logic",
        "latched",
        "latched latched",
        "HS0012:21 `latched`: a second `latched` is not expected here | delete one of the two",
    );
    check(
        "logic",
        ":= false",
        ":= false := true",
        "HS0012:12 `:=`: a second value is not expected here | delete one of the two",
    );
    check(
        "composite",
        "Gear[2]",
        "Gear[2][3]",
        "HS0012:11 `[`: a second number of copies is not expected here | delete one of the two",
    );
    message(
        "roll",
        "end interface;",
        "end interface;\ninterface end interface;",
        "HS0020:5 `interface`: a component has one interface, before its body | put it all into the first one",
    );
    message(
        "roll",
        "end event;",
        "end event;\nend body;\nbody",
        "HS0020:24 `body`: a component has one body | put it all into the first one",
    );
}
