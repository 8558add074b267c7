//! The phase portrait: one variable over another, in the colours of the locations.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

use sophy_record::{ColumnKind, Table};

use super::PlotOptions;
use super::axis::{Axis, LARGEST, extent, range};
use super::content::{Content, column, value_before};
use super::curve::round;
use super::palette;
use super::svg::{Anchor, INK, Svg, TEXT};
use super::text::{fitted, width};
use crate::FileError;

const DEFAULT_SIZE: f64 = 460.0;
/// Edges of the portrait, some 25 bytes each; the picture becomes coarser to stay below.
const MOST_EDGES: usize = 15_000;
/// Pixels of the coarsest cell.
const COARSEST_CELL: f64 = 4.0;
/// With more places of transitions than this they hide the curve.
const MOST_DOTS: usize = 300;

/// Draws `vertical` over `horizontal` as a square figure.
pub(super) fn phase_figure(
    table: &Table,
    content: &Content<'_>,
    (horizontal, vertical): (&str, &str),
    options: &PlotOptions,
    title: Option<&str>,
) -> Result<String, FileError> {
    let (across, up) = (real(table, horizontal)?, real(table, vertical)?);
    let unit = |name: &str| column(table, name).map(|column| column.unit.as_deref());
    let (across_unit, up_unit) = (unit(horizontal)?, unit(vertical)?);

    let sheet = options.size.map_or(DEFAULT_SIZE, |(w, h)| f64::from(w.min(h)).clamp(200.0, 20_000.0));
    let x_axis = Axis::new(range(extent(across), 0.05), 6.0);
    let y_axis = Axis::new(range(extent(up), 0.05), 6.0);
    let left = 40.0 + y_axis.ticks.iter().map(|tick| width(&tick.1, TEXT)).fold(10.0, f64::max);
    let top = if title.is_some() { 34.0 } else { 12.0 };
    let locations: Vec<(u32, &str)> = match content.automaton() {
        Some(band) => {
            let mut present: Vec<u32> = band.spans.iter().map(|span| span.1).collect();
            present.sort_unstable();
            present.dedup();
            present.iter().filter_map(|&l| Some((l, band.names.get(l as usize)?.as_str()))).collect()
        }
        None => Vec::new(),
    };
    let side = sheet - left - 16.0;
    let place = Place { left, top, side, x_axis, y_axis };
    let dots = transition_points(content, &place, across, up);
    let marked = dots.len() <= MOST_DOTS;
    let transitions = match (dots.is_empty(), marked) {
        (true, _) => None,
        (false, true) => Some((Sign::Transition, "transition".to_owned())),
        (false, false) => {
            Some((Sign::Nothing, format!("{} transitions, too many to mark", content.transitions)))
        }
    };
    let key = Key::new(&locations, transitions, left, left + side);
    let height = top + side + 44.0 + key.height;

    let mut svg = Svg::new(sheet, height, title.unwrap_or("Phase portrait"));
    if let Some(title) = title {
        svg.text((0.5 * sheet, 20.0), Anchor::Middle, 14.0, &fitted(title, 14.0, sheet - 32.0));
    }
    place.draw_grid(&mut svg);
    draw_orbit(&mut svg, content, &place, across, up);
    draw_points(&mut svg, &place, across, up, if marked { &dots } else { &[] });
    let x_title = place.x_axis.title(horizontal, across_unit);
    svg.text(
        (left + 0.5 * side, top + side + 33.0),
        Anchor::Middle,
        TEXT,
        &fitted(&x_title, TEXT, side + 20.0),
    );
    let y_title = place.y_axis.title(vertical, up_unit);
    svg.upright_text((16.0, top + 0.5 * side), TEXT, &fitted(&y_title, TEXT, side + 20.0));
    key.draw(&mut svg, top + side + 56.0);
    Ok(svg.finish())
}

fn real<'a>(table: &'a Table, name: &str) -> Result<&'a [f64], FileError> {
    table.real(name).ok_or_else(|| {
        let reals = table.schema.columns.iter().filter(|c| c.kind == ColumnKind::Real);
        let known = reals.map(|c| c.name.as_str()).collect::<Vec<_>>().join(", ");
        FileError::NoVariable { name: name.to_owned(), known }
    })
}

struct Place {
    left: f64,
    top: f64,
    side: f64,
    x_axis: Axis,
    y_axis: Axis,
}

impl Place {
    fn x(&self, value: f64) -> f64 {
        self.left + self.x_axis.fraction(value) * self.side
    }

    fn y(&self, value: f64) -> f64 {
        self.top + (1.0 - self.y_axis.fraction(value)) * self.side
    }

    fn draw_grid(&self, svg: &mut Svg) {
        let (left, top, right, bottom) = (self.left, self.top, self.left + self.side, self.top + self.side);
        let grid = "stroke=\"#000\" stroke-opacity=\"0.1\" stroke-width=\"0.6\"";
        let frame = format!("stroke=\"{INK}\" stroke-width=\"0.8\"");
        for (value, label) in &self.x_axis.ticks {
            let x = self.x(*value);
            svg.line((x, top), (x, bottom), grid);
            svg.line((x, bottom), (x, bottom + 4.0), &frame);
            svg.text((x, bottom + 16.0), Anchor::Middle, TEXT, label);
        }
        for (value, label) in &self.y_axis.ticks {
            let y = self.y(*value);
            svg.line((left, y), (right, y), grid);
            svg.line((left - 4.0, y), (left, y), &frame);
            svg.text((left - 7.0, y + 0.36 * TEXT), Anchor::End, TEXT, label);
        }
        svg.line((left, top), (left, bottom), &frame);
        svg.line((left, bottom), (right, bottom), &frame);
    }
}

/// The curve in the colours of the locations, and its jumps.
fn draw_orbit(svg: &mut Svg, content: &Content<'_>, place: &Place, across: &[f64], up: &[f64]) {
    let mut cell = 0.25;
    let lines = loop {
        let limit = if cell < COARSEST_CELL { MOST_EDGES } else { usize::MAX };
        match orbit(content, place, across, up, cell, limit) {
            Some(lines) => break lines,
            None => cell *= 2.0,
        }
    };
    for (ink, line) in lines {
        let (colour, style) = match ink {
            Ink::Jump => {
                (INK.to_owned(), "stroke-width=\"0.8\" stroke-opacity=\"0.6\" stroke-dasharray=\"1.2 2\"")
            }
            Ink::Plain => (palette::CURVES[0].to_owned(), SOLID),
            Ink::Location(location) => (palette::location(location), SOLID),
        };
        svg.path(&line, &format!("stroke=\"{colour}\" {style}"));
    }
}

const SOLID: &str = "stroke-width=\"1.2\" stroke-linejoin=\"round\" stroke-linecap=\"round\"";

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Ink {
    Jump,
    Plain,
    Location(u32),
}

/// An edge that would only touch cells of its colour that are drawn already is left out: an orbit that repeats
/// costs no more than its first round, and a cloud no more than its cells. `None` if it takes more than `limit`.
fn orbit(
    content: &Content<'_>,
    place: &Place,
    across: &[f64],
    up: &[f64],
    cell: f64,
    limit: usize,
) -> Option<BTreeMap<Ink, String>> {
    let spans = content.automaton().map_or(&[][..], |band| band.spans.as_slice());
    let mut span = 0;
    let mut lines: BTreeMap<Ink, String> = BTreeMap::new();
    let mut edges = 0;
    let across_cells = libm::ceil((place.left + place.side) / cell) as usize + 1;
    let all_cells = across_cells * (libm::ceil((place.top + place.side) / cell) as usize + 1);
    let mut covered: BTreeMap<Ink, Vec<bool>> = BTreeMap::new();
    let mut before: Option<(f64, [f64; 2])> = None;
    // Where the pen of each colour stands.
    let mut pens: BTreeMap<Ink, [f64; 2]> = BTreeMap::new();
    let cell_of = |[x, y]: [f64; 2]| (y / cell) as usize * across_cells + (x / cell) as usize;
    for ((&t, &x), &y) in content.time.iter().zip(across).zip(up) {
        if x.is_nan() || y.is_nan() || x.abs() >= LARGEST || y.abs() >= LARGEST {
            before = None;
            continue;
        }
        let here = [place.x(x), place.y(y)].map(|v| round(v, 2));
        let Some((old_time, old)) = before else {
            before = Some((t, here));
            continue;
        };
        while spans.get(span + 1).is_some_and(|next| next.0 <= old_time) {
            span += 1;
        }
        let new_location = spans.get(span + 1).is_some_and(|next| next.0 <= t);
        if cell_of(old) == cell_of(here) && !new_location {
            continue;
        }
        let ink = match spans.get(span) {
            _ if old_time == t => Ink::Jump,
            Some(span) => Ink::Location(span.1),
            None => Ink::Plain,
        };
        let covered = covered.entry(ink).or_insert_with(|| vec![false; all_cells]);
        let mut fresh = false;
        let length = f64::max((here[0] - old[0]).abs(), (here[1] - old[1]).abs());
        let pieces = libm::ceil(length / cell).max(1.0) as i32;
        for piece in 0..=pieces {
            let share = f64::from(piece) / f64::from(pieces);
            let point = [0, 1].map(|axis| old[axis] + share * (here[axis] - old[axis]));
            // All points lie on the sheet: the axes hold all the values.
            if let Some(cell) = covered.get_mut(cell_of(point)) {
                fresh |= !std::mem::replace(cell, true);
            }
        }
        if fresh && old != here {
            let line = lines.entry(ink).or_default();
            if pens.insert(ink, here) != Some(old) {
                let _ = write!(line, "M{} {}L", old[0], old[1]);
            }
            let _ = write!(line, "{} {} ", here[0], here[1]);
            edges += 1;
            if edges > limit {
                return None;
            }
        }
        before = Some((t, here));
    }
    Some(lines)
}

/// Where transitions were taken, each place once.
fn transition_points(content: &Content<'_>, place: &Place, across: &[f64], up: &[f64]) -> Vec<(f64, f64)> {
    let mut seen = HashSet::new();
    let mut points = Vec::new();
    for &time in &content.marks {
        let (x, y) = (value_before(content.time, across, time), value_before(content.time, up, time));
        let (x, y) = (place.x(x), place.y(y));
        if x.is_finite() && y.is_finite() && seen.insert([x, y].map(|v| libm::round(v) as i64)) {
            points.push((x, y));
        }
    }
    points
}

/// A dot at each transition, a ring at the start, a square at the end.
fn draw_points(svg: &mut Svg, place: &Place, across: &[f64], up: &[f64], dots: &[(f64, f64)]) {
    for &(x, y) in dots {
        svg.circle((x, y), 2.0, DOT);
    }
    let finite = |i: &usize| across[*i].abs() < LARGEST && up[*i].abs() < LARGEST;
    let rows = 0..across.len().min(up.len());
    let at = |i: usize| (place.x(across[i]), place.y(up[i]));
    if let Some(first) = rows.clone().find(finite) {
        svg.circle(at(first), 4.0, HOLLOW);
    }
    if let Some(last) = rows.rev().find(finite) {
        let (x, y) = at(last);
        svg.rect((x - 3.5, y - 3.5), (7.0, 7.0), HOLLOW);
    }
}

const DOT: &str = "fill=\"#222\" stroke=\"#fff\" stroke-width=\"0.6\"";
const HOLLOW: &str = "fill=\"#fff\" fill-opacity=\"0.7\" stroke=\"#222\" stroke-width=\"1.2\"";

enum Sign {
    Location(u32),
    Transition,
    Nothing,
    Start,
    End,
}

impl Sign {
    /// Room of the sign before its text.
    fn indent(&self) -> f64 {
        match self {
            Sign::Location(_) => 24.0,
            Sign::Nothing => 0.0,
            Sign::Transition | Sign::Start | Sign::End => 12.0,
        }
    }
}

struct Key {
    pieces: Vec<(f64, f64, Sign, String)>,
    height: f64,
}

impl Key {
    fn new(locations: &[(u32, &str)], transitions: Option<(Sign, String)>, left: f64, right: f64) -> Self {
        let mut signs: Vec<(Sign, String)> =
            locations.iter().map(|&(location, name)| (Sign::Location(location), name.to_owned())).collect();
        signs.extend(transitions);
        signs.push((Sign::Start, "start".to_owned()));
        signs.push((Sign::End, "end".to_owned()));
        let (mut x, mut y) = (left, 0.0);
        let mut pieces = Vec::new();
        for (sign, text) in signs {
            let room = sign.indent() + width(&text, TEXT);
            if x > left && x + room > right {
                (x, y) = (left, y + 17.0);
            }
            pieces.push((x, y, sign, text));
            x += room + 14.0;
        }
        Key { pieces, height: y + 17.0 }
    }

    fn draw(&self, svg: &mut Svg, top: f64) {
        for (x, y, sign, text) in &self.pieces {
            let (y, middle) = (y + top, y + top - 4.0);
            match sign {
                Sign::Location(location) => {
                    let colour = palette::location(*location);
                    svg.line(
                        (*x, middle),
                        (x + 18.0, middle),
                        &format!("stroke=\"{colour}\" stroke-width=\"2\""),
                    );
                }
                Sign::Nothing => {}
                Sign::Transition => svg.circle((x + 4.0, middle), 2.2, DOT),
                Sign::Start => svg.circle((x + 4.0, middle), 4.0, HOLLOW),
                Sign::End => svg.rect((x + 0.5, middle - 3.5), (7.0, 7.0), HOLLOW),
            }
            svg.text((x + sign.indent(), y), Anchor::Start, TEXT, text);
        }
    }
}
