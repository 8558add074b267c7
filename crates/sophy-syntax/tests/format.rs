//! The layout of files: what it looks like, and what it must not change.

mod corpus;

use corpus::{CORPUS, shown, tokens};
use proptest::prelude::*;
use sophy_syntax::{SyntaxKind, format, parse_file};

/// What layout must not change: all tokens and comments, in order.
fn essence(text: &str) -> Vec<String> {
    let kept = tokens(text).into_iter().filter(|(kind, _)| *kind != SyntaxKind::Whitespace);
    kept.map(|(_, text)| text.trim_end().to_owned()).collect()
}

fn check(text: &str, expected: &str) {
    assert_eq!(format(text).as_deref(), Ok(expected), "{text}");
    assert_eq!(format(expected).as_deref(), Ok(expected), "once more");
}

/// `section` in the body of a component.
fn in_body(section: &str) -> String {
    format!("CTC C is\nbody\n{section}end body;\n")
}

#[test]
fn one_item_on_a_line() {
    check(
        "CTC C is interface input(u,signal[3,3],(0,1),\"m\");output(y,string,{\"a\",\"b\"});end interface;body \
         declarations state x,y:real[2]in(0,1):=-1\"m\";mode m in{-1,1}:=1;end declarations;initial x:=1;end \
         initial;end body;end C;",
        r#"CTC C is
interface
  input(u, signal[3,3], (0, 1), "m");
  output(y, string, {"a", "b"});
end interface;
body
  declarations
    state x, y : real[2] in (0, 1) := -1 "m";
    mode m in {-1, 1} := 1;
  end declarations;
  initial
    x := 1;
  end initial;
end body;
end C;
"#,
    );
}

#[test]
fn spaces_around_operators() {
    check(
        &in_body(
            "dynamics der( x )=-a*b+( c-d )/e ^ 2 ; y=f ( x , 1 )[ i ,j ]; b=not(a<b)and x>=1;z=a . b [1];end dynamics;\n",
        ),
        &in_body(
            "  dynamics\n    der(x) = -a*b + (c - d)/e^2;\n    y = f(x, 1)[i, j];\n    b = not (a < b) and x >= 1;\n    \
             z = a.b[1];\n  end dynamics;\n",
        ),
    );
    check(
        "CC C is body components a:A(p:1,q : 2)[3, 4];end components;connections for i in 1 .. n loop a[ i ].y->b.u; \
         end loop;end connections;end body;",
        "CC C is\nbody\n  components\n    a : A(p : 1, q : 2)[3,4];\n  end components;\n  connections\n    for i in \
         1..n loop\n      a[i].y -> b.u;\n    end loop;\n  end connections;\nend body;\n",
    );
}

#[test]
fn blocks_are_indented() {
    check(
        &in_body(
            "location A invariant x<1;transition t on e,f when x>0 priority 2 goto B do if a then x:=1;elsif b then do \
             hold S;else emit l;endif;end transition;transition u rate 2 goto A;end location;\nrules when c delay 1 \
             latched do x:=1;end when;end rules;event(S)priority 1 negative-to-positive x:=1;end \
             negative-to-positive;end event;\n",
        ),
        &in_body(
            "  location A
    invariant x < 1;
    transition t on e, f when x > 0 priority 2 goto B do
      if a then
        x := 1;
      elsif b then do
        hold S;
      else
        emit l;
      endif;
    end transition;
    transition u rate 2 goto A;
  end location;
  rules
    when c delay 1 latched do
      x := 1;
    end when;
  end rules;
  event(S) priority 1
    negative-to-positive
      x := 1;
    end negative-to-positive;
  end event;
",
        ),
    );
}

#[test]
fn comments_stay_where_they_are() {
    check(
        "\n\n% first\n\n\n\n  %% doc\nCTC C is    % of the header\nbody\n\n % of the content\n declarations\n\n\n state x; % of x\n\n\n\
         \n % last\n\n end declarations;\n dynamics\n der(x) = a % of a\n + % of the sign\n  % own\n b;\n if c then\n x = 1;\n % of \
         the branch\n else\n x = 2;\n\n end if;\n end dynamics;\nend body; % end\n\n\n% over\n\n\n",
        "% first

%% doc
CTC C is  % of the header
body
  % of the content
  declarations
    state x;  % of x

    % last
  end declarations;
  dynamics
    der(x) = a  % of a
        +  % of the sign
        % own
        b;
    if c then
      x = 1;
      % of the branch
    else
      x = 2;
    end if;
  end dynamics;
end body;  % end

% over
",
    );
}

#[test]
fn long_lines_go_on_after_a_comma_or_before_an_operator() {
    check(
        "function euler321(th : real[3]) : real[3,3] = [[1, sin(th[1])*tan(th[2]), cos(th[1])*tan(th[2])], [0, \
         cos(th[1]), -sin(th[1])], [0, sin(th[1])/cos(th[2]), cos(th[1])/cos(th[2])]];",
        "function euler321(th : real[3]) : real[3,3] =
    [[1, sin(th[1])*tan(th[2]), cos(th[1])*tan(th[2])],
     [0, cos(th[1]), -sin(th[1])],
     [0, sin(th[1])/cos(th[2]), cos(th[1])/cos(th[2])]];
",
    );
    check(
        &in_body(
            "dynamics\nder(x) = first_coefficient*first_variable + second_coefficient*second_variable - \
             third_coefficient*(third_variable + fourth_variable);\nend dynamics;\n",
        ),
        &in_body(
            "  dynamics
    der(x) = first_coefficient*first_variable + second_coefficient*second_variable
        - third_coefficient*(third_variable + fourth_variable);
  end dynamics;
",
        ),
    );
}

#[test]
fn a_file_with_mistakes_is_refused() {
    let errors = format("CTC C is body dynamics x = ; end dynamics; end body;").unwrap_err();
    assert_eq!(errors.len(), 1);
}

#[test]
fn a_line_is_only_longer_than_allowed_where_it_cannot_go_on() {
    for (name, text) in CORPUS {
        for line in format(text).unwrap().lines() {
            let code = line.split("  %").next().unwrap_or("");
            assert!(code.chars().count() <= 100, "{name}: {line}");
        }
    }
}

#[test]
fn the_corpus_keeps_its_tokens_and_comments() {
    for (name, text) in CORPUS {
        let once = format(text).unwrap();
        assert_eq!(essence(&once), essence(text), "{name}");
        assert_eq!(format(&once).unwrap(), once, "{name}: once more");
    }
}

/// White space and comments between two tokens.
fn gap() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => Just(" ".to_owned()),
        3 => "[ \t]{1,3}",
        3 => "( ?\r?\n){1,4} {0,3}",
        1 => " ?% [a-z;]{0,5}\n",
        1 => "\n?%% [a-z]{0,5}\n{1,3}",
        1 => "(\n% [a-z]{0,2}){1,3}\n",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn layout_changes_neither_tokens_nor_comments(
        file in 0..CORPUS.len(),
        gaps in prop::collection::vec(gap(), 1200).no_shrink(),
    ) {
        let meaningful = tokens(CORPUS[file].1).into_iter().filter(|(kind, _)| !kind.is_trivia());
        let text: String = meaningful.zip(&gaps).map(|((_, token), gap)| format!("{token}{gap}")).collect();
        prop_assert_eq!(shown(&text, &parse_file(&text)), "", "white space means nothing");
        let once = format(&text).unwrap();
        prop_assert_eq!(essence(&once), essence(&text));
        let twice = format(&once).unwrap();
        prop_assert_eq!(twice, once);
    }
}
