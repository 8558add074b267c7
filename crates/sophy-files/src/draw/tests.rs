use super::diagram::*;
use super::layers::{Flow, Item, Link, Pin};
use super::routes::{Layout, layout};
use super::{dot, draw, sheet};
use proptest::prelude::*;
use std::path::Path;

fn lines(equations: &[(&str, &str)]) -> Vec<Line> {
    let line = |(name, text): &(&str, &str)| Line {
        derivative_of: (!name.is_empty()).then(|| (*name).to_owned()),
        text: (*text).to_owned(),
    };
    equations.iter().map(line).collect()
}

fn transition(from: usize, to: usize, above: &[&str], below: &[&str]) -> Arrow {
    let end = |of| ArrowEnd { of, port: None };
    let texts = |lines: &[&str]| lines.iter().map(|&line| line.to_owned()).collect();
    Arrow { from: end(from), to: end(to), above: texts(above), below: texts(below), ..Arrow::default() }
}

fn hopper() -> Diagram {
    let location = |name: &str, equations: &[(&str, &str)]| DiagramBox {
        name: name.to_owned(),
        lines: lines(equations),
        ..DiagramBox::default()
    };
    let contact = [("position", "= speed"), ("speed", "= eta/position − gamma·speed − g")];
    let mut boxes = vec![
        location("Flight", &[("position", "= speed"), ("speed", "= −g")]),
        location("Compression", &contact),
        location(
            "Thrust",
            &[("position", "= speed"), ("speed", "= tau − gamma·speed − g"), ("clock", "= 1")],
        ),
        location("Decompression", &contact),
    ];
    boxes[0].kind = BoxKind::Initial;
    let arrows = vec![
        transition(0, 1, &["position < L"], &[]),
        transition(1, 2, &["speed > 0"], &["clock := 0"]),
        transition(2, 3, &["clock > Tp"], &["eta2 := (eta/L + tau)·position"]),
        transition(3, 0, &["position > L"], &["!lift"]),
    ];
    Diagram { title: "Hopper".to_owned(), kind: DiagramKind::Automaton, boxes, arrows }
}

fn ring_with_loop() -> Diagram {
    let mut diagram = hopper();
    diagram.arrows.push(transition(
        0,
        0,
        &["|speed| < 0.01 and position < 2·L and battery.charge > 20 or emergency"],
        &["?stop  !stopped"],
    ));
    diagram.arrows.push(transition(1, 0, &["position > 2·L"], &["!lost"]));
    diagram
}

fn missile() -> Diagram {
    let port = |name: &&str| DiagramPort { name: (*name).to_owned(), ..DiagramPort::default() };
    let member = |name: &str, class: &str, inputs: &[&str], outputs: &[&str]| DiagramBox {
        name: name.to_owned(),
        caption: class.to_owned(),
        inputs: inputs.iter().map(port).collect(),
        outputs: outputs.iter().map(port).collect(),
        ..DiagramBox::default()
    };
    let mut boxes = vec![
        member("disturbance", "", &[], &["disturbance"]),
        member("airframe", "Airframe", &["F [lbf]", "wind"], &["phi [rad]", "p [rad/s]"]),
        member("relay", "Roll", &["e"], &["F [lbf]"]),
        member("control", "RateController", &["phi [rad]", "mode"], &["u"]),
        member("manager", "Manager", &["engage", "hit"], &["stat"]),
        member("cell", "Cell[1000]", &["inp"], &["out"]),
        member("sensor", "Sensor", &["p"], &["hit"]),
        member("phi", "", &["phi"], &[]),
    ];
    boxes[0].kind = BoxKind::Input;
    boxes[5].kind = BoxKind::Stack;
    boxes[7].kind = BoxKind::Output;
    let symbols =
        [(3, 0, Symbol::Real), (3, 1, Symbol::Text), (4, 0, Symbol::Boolean), (4, 1, Symbol::Event)];
    for (number, port, symbol) in symbols {
        boxes[number].inputs[port].symbol = symbol;
    }
    boxes[3].outputs[0].symbol = Symbol::Real;
    boxes[4].outputs[0].symbol = Symbol::Text;
    boxes[6].outputs[0].symbol = Symbol::Event;
    let wire = |from: (usize, usize), to: (usize, usize)| Arrow {
        from: ArrowEnd { of: from.0, port: Some(from.1) },
        to: ArrowEnd { of: to.0, port: Some(to.1) },
        ..Arrow::default()
    };
    let mut arrows = vec![
        wire((0, 0), (1, 1)),
        wire((1, 0), (3, 0)),
        wire((3, 0), (2, 0)),
        wire((2, 0), (1, 0)),
        wire((1, 0), (7, 0)),
        wire((1, 1), (6, 0)),
        wire((6, 0), (4, 1)),
        wire((4, 0), (3, 1)),
        wire((1, 1), (5, 0)),
        wire((5, 0), (5, 0)),
    ];
    arrows[6].dashed = true;
    arrows[8].above = vec!["×1000".to_owned()];
    arrows[9].above = vec!["×999".to_owned()];
    Diagram { title: "Missile".to_owned(), kind: DiagramKind::Composition, boxes, arrows }
}

fn lonely() -> Diagram {
    let mut diagram = hopper();
    diagram.boxes.truncate(1);
    diagram.boxes[0].name = "Roll".to_owned();
    diagram.arrows = vec![
        transition(0, 0, &["S from − to +"], &["m := 1"]),
        transition(0, 0, &["S from + to −"], &["m := −1"]),
    ];
    diagram
}

#[test]
fn every_format_can_be_written() {
    let folder = std::env::temp_dir().join(format!("sophy-drawings-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("folder");
    for (name, diagram) in all() {
        for extension in ["svg", "png", "dot"] {
            let path = folder.join(format!("{name}.{extension}"));
            draw(&path, &diagram).expect("drawn");
            assert!(std::fs::metadata(&path).expect("there").len() > 200);
        }
    }
    std::fs::remove_dir_all(&folder).expect("removed");
    let error = draw(Path::new("a.pdf"), &hopper()).expect_err("unknown");
    assert!(error.to_string().contains(".svg, .png, .dot"), "{error}");
}

fn all() -> [(&'static str, Diagram); 4] {
    [("hopper", hopper()), ("ring", ring_with_loop()), ("missile", missile()), ("lonely", lonely())]
}

/// Boxes (left, top, right, bottom) of the items and the labels.
fn areas(items: &[Item], links: &[Link], layout: &Layout) -> Vec<[f64; 4]> {
    let corners = items.iter().zip(&layout.corners);
    let boxes = corners.map(|(item, &(x, y))| [x, y - item.head, x + item.width, y + item.height]);
    let labels = links.iter().zip(&layout.labels).filter_map(|(link, label)| {
        let (x, y) = (*label)?;
        Some([x - 0.5 * link.width, y - link.above, x + 0.5 * link.width, y + link.below])
    });
    boxes.chain(labels).collect()
}

fn items_and_links() -> impl Strategy<Value = (Vec<Item>, Vec<Link>)> {
    let item = (40.0..220.0_f64, 40.0..120.0_f64, 0.0..30.0_f64).prop_map(|(width, height, head)| Item {
        width,
        height,
        head,
        ..Item::default()
    });
    prop::collection::vec(item, 1..9).prop_flat_map(|items| {
        let count = items.len();
        let link = (0..count, 0..count, 10.0..150.0_f64, 0.0..40.0_f64, 0.0..40.0_f64).prop_map(
            |(from, to, width, above, below)| Link { from, to, width, above, below, ..Link::default() },
        );
        (Just(items), prop::collection::vec(link, 0..16))
    })
}

proptest! {
    #[test]
    fn boxes_and_labels_do_not_overlap_and_are_inside((items, links) in items_and_links()) {
        for flow in [Flow::Around, Flow::Onward] {
            let layout = layout(&items, &links, flow, &[]);
            let areas = areas(&items, &links, &layout);
            for (number, a) in areas.iter().enumerate() {
                let inside = a[0] >= -0.1 && a[1] >= -0.1;
                prop_assert!(inside && a[2] <= layout.size.0 + 0.1 && a[3] <= layout.size.1 + 0.1, "{a:?}");
                for b in &areas[..number] {
                    let apart = a[2] <= b[0] + 0.1 || b[2] <= a[0] + 0.1 || a[3] <= b[1] + 0.1 || b[3] <= a[1] + 0.1;
                    prop_assert!(apart, "{flow:?}: {a:?} and {b:?}");
                }
            }
        }
    }

    /// Arrows run along the axes, from the edge of one box to the edge of the other, and through no box.
    #[test]
    fn arrows_join_their_boxes_and_meet_no_other((items, links) in items_and_links()) {
        for flow in [Flow::Around, Flow::Onward] {
            let layout = layout(&items, &links, flow, &[]);
            for (link, route) in links.iter().zip(&layout.routes) {
                let at_edge = |item: usize, (x, y): (f64, f64)| {
                    let (corner, size) = (layout.corners[item], &items[item]);
                    let side = (x - corner.0).abs() < 0.1 || (x - corner.0 - size.width).abs() < 0.1;
                    side && y > corner.1 - 1.1 && y < corner.1 + size.height + 1.1
                };
                prop_assert!(at_edge(link.from, route[0]) && at_edge(link.to, route[route.len() - 1]), "{route:?}");
                for piece in route.windows(2) {
                    let ((x0, y0), (x1, y1)) = (piece[0], piece[1]);
                    prop_assert!((x0 - x1).abs() < 0.01 || (y0 - y1).abs() < 0.01, "{piece:?}");
                    for (item, corner) in items.iter().zip(&layout.corners) {
                        let across = x0.max(x1) > corner.0 + 0.5 && x0.min(x1) < corner.0 + item.width - 0.5;
                        let along = y0.max(y1) > corner.1 + 1.5 && y0.min(y1) < corner.1 + item.height - 1.5;
                        prop_assert!(!(across && along), "{piece:?} and {corner:?} {item:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_ring_has_two_branches() {
    let items = vec![Item { width: 100.0, height: 60.0, ..Item::default() }; 4];
    let links: Vec<Link> = (0..4).map(|from| Link { from, to: (from + 1) % 4, ..Link::default() }).collect();
    let layout = layout(&items, &links, Flow::Around, &[]);
    let x: Vec<f64> = layout.corners.iter().map(|corner| corner.0).collect();
    assert!(x[0] < x[1] && x[1] < x[2] && x[1] == x[3], "{x:?}");
}

#[test]
fn ports_of_a_composite_stand_at_its_border() {
    let mut items =
        vec![Item { width: 50.0, height: 20.0, left: vec![0.0], right: vec![0.0], ..Item::default() }; 4];
    (items[2].at, items[3].at) = (Pin::First, Pin::Last);
    let links: Vec<Link> = [(0, 1), (1, 0), (2, 1), (1, 3)]
        .into_iter()
        .map(|(from, to)| Link { from, to, ..Link::default() })
        .collect();
    let layout = layout(&items, &links, Flow::Onward, &[]);
    let x: Vec<f64> = layout.corners.iter().map(|corner| corner.0).collect();
    assert!((0..3).all(|n| n == 2 || x[n] > x[2]) && (0..3).all(|n| x[n] < x[3]), "{x:?}");
}

#[test]
fn a_drawing_is_well_formed_and_the_same_every_time() {
    for (name, diagram) in all() {
        let svg = sheet::svg(&diagram);
        assert_eq!(svg, sheet::svg(&diagram));
        let tree = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{name}: {error}\n{svg}"));
        let number = |node: roxmltree::Node<'_, '_>, attribute: &str| -> f64 {
            node.attribute(attribute).and_then(|text| text.parse().ok()).expect("number")
        };
        let (width, height) = (number(tree.root_element(), "width"), number(tree.root_element(), "height"));
        let texts = tree.descendants().filter(|node| node.has_tag_name("text"));
        for text in texts {
            let (x, y, size) = (number(text, "x"), number(text, "y"), number(text, "font-size"));
            let room = crate::plot::text::width(text.text().expect("text"), size);
            let left = match text.attribute("text-anchor") {
                Some("start") => x,
                Some("middle") => x - 0.5 * room,
                _ => x - room,
            };
            assert!(
                left >= 0.0 && left + room <= width && y >= size && y <= height - 3.0,
                "{name}: {text:?}"
            );
        }
        for one in &diagram.boxes {
            assert!(svg.contains(&one.name), "{name}: {}", one.name);
        }
    }
}

#[test]
fn texts_with_markup_are_escaped() {
    let mut diagram = lonely();
    diagram.boxes[0].name = "a<b & \"c\"\\n".to_owned();
    diagram.arrows[0].tip = "<&>".to_owned();
    roxmltree::Document::parse(&sheet::svg(&diagram)).expect("well-formed");
    let dot = dot::dot(&diagram);
    assert!(dot.contains(r#"a<b & \"c\"\\n\nder(position) = speed"#), "{dot}");
}

#[test]
fn what_is_too_long_is_cut() {
    let mut diagram = lonely();
    diagram.arrows[0].above = vec!["word ".repeat(200), "x".repeat(500)];
    let long = "y + ".repeat(100);
    diagram.boxes[0].lines = lines(&[("", long.as_str()); 40]);
    let svg = sheet::svg(&diagram);
    assert!(svg.contains("… and 27 more") && svg.len() < 20_000, "{svg}");
    assert!(dot::dot(&diagram).contains(&"x".repeat(500)), "Graphviz gets everything");
}

#[test]
fn an_automaton_in_dot() {
    let mut diagram = hopper();
    diagram.boxes.truncate(2);
    diagram.arrows = vec![diagram.arrows[0].clone(), transition(1, 0, &["position > L"], &["?go", "!lift"])];
    let expected = r#"digraph "Hopper" {
  label="Hopper"; labelloc=t; rankdir=LR;
  graph [fontname="Roboto, Helvetica, Arial, sans-serif", fontsize=11];
  node [fontname="Roboto, Helvetica, Arial, sans-serif", fontsize=11];
  edge [fontname="Roboto, Helvetica, Arial, sans-serif", fontsize=11];
  b0 [shape=box, style=rounded, label="Flight\nder(position) = speed\nder(speed) = −g"];
  start0 [shape=point];
  start0 -> b0;
  b1 [shape=box, style=rounded, label="Compression\nder(position) = speed\nder(speed) = eta/position − gamma·speed − g"];
  b0 -> b1 [label="position < L"];
  b1 -> b0 [label="position > L\n?go\n!lift"];
}
"#;
    assert_eq!(dot::dot(&diagram), expected);
}

#[test]
fn a_composition_in_dot() {
    let dot = dot::dot(&missile());
    for line in [
        "b0 [shape=plaintext, label=\"disturbance\"];",
        "b2 [shape=record, label=\"{<i0> △ e}|relay\\nRoll|{<o0> △ F [lbf]}\"];",
        "b0 -> b1:i1;",
        "b6:o0 -> b4:i1 [style=dashed];",
        "b5:o0 -> b5:i0 [label=\"×999\"];",
    ] {
        assert!(dot.contains(line), "{line}\n{dot}");
    }
}
