use crate::support::Folder;

#[test]
fn info_draws_the_automaton() {
    let folder = Folder::with_oscillator("info-draw");
    let answer = folder.sophy(&["info", "oscillator.xml", "--draw", "a.svg", "--draw", "a.dot", "--draw", "a.png"]);
    answer.ends(0, &["wrote a.svg", "wrote a.dot", "wrote a.png"]);
    let svg = folder.read("a.svg");
    for text in ["Right", "Left", "x &lt; 0", "−stiffness·x"] {
        assert!(svg.contains(text), "{text}\n{svg}");
    }
    let dot = folder.read("a.dot");
    assert!(dot.contains("b0 -> b1 [label=\"x < 0\"") && dot.contains("start0 -> b0;"), "{dot}");
    folder.sophy(&["info", "oscillator.xml", "--draw", "a.pdf"]).ends(2, &["a.pdf", ".svg"]);
    folder.sophy(&["info", "oscillator.xml", "--draw", "b.svg", "--component", "wheel"]).ends(2, &["`wheel`"]);
}

#[test]
fn info_cuts_long_lists() {
    let folder = Folder::new("info-long");
    folder.write(
        "chain.hsml",
        "
CTC Cell is
interface
  input(inp, signal); output(out, signal);
end interface;
body
  declarations state x := 0; end declarations;
  dynamics der(x) = inp - x; end dynamics;
  output out = x; end output;
end body;

SYSTEM Chain is
body
  components cell : Cell[2000]; end components;
  connections
    cell[2000].out -> cell[1].inp;
    for i in 1..1999 loop cell[i].out -> cell[i+1].inp; end loop;
  end connections;
end body;
",
    );
    let info = folder.sophy(&["info", "chain.hsml"]);
    info.ends(0, &[]);
    for text in ["cell : Cell[2000]", "2 000 in all", "more states (--all shows them)", "bandwidth 1 999", "Index 0"] {
        assert!(info.out.contains(text), "{text}\n{}", info.out);
    }
    assert!(info.out.lines().count() < 200, "{}", info.out);
    assert!(folder.sophy(&["info", "chain.hsml", "--all"]).out.lines().count() > 2000);
}
