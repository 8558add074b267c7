//! The phase portrait: one variable over another, in the colours of the locations.

use std::collections::{BTreeMap, HashSet};
use std::fmt::Write;

use sophy_record::{ColumnKind, Table};

use super::PlotOptions;
use super::axis::{Axis, LARGEST, extent, range};
use super::content::{Content, column, value_before};
use super::palette;
use super::svg::{Anchor, INK, Svg, TEXT};
use super::text::{fitted, width};
use crate::FileError;

const DEFAULT_SIZE: f64 = 460.0;
/// Edges of the portrait that are kept, some 20 bytes each.
const MOST_EDGES: usize = 15_000;
const MOST_DOTS: usize = 2_000;

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
    let locations: Vec<(u32, &str)> = match content.bands.as_slice() {
        [band] => {
            let mut present: Vec<u32> = band.spans.iter().map(|span| span.1).collect();
            present.sort_unstable();
            present.dedup();
            present.iter().filter_map(|&l| Some((l, band.names.get(l as usize)?.as_str()))).collect()
        }
        _ => Vec::new(),
    };
    let side = sheet - left - 16.0;
    let key = Key::new(&locations, !content.marks.is_empty(), left, left + side);
    let height = top + side + 44.0 + key.height;
    let place = Place { left, top, side, x_axis, y_axis };

    let mut svg = Svg::new(sheet, height, title.unwrap_or("Phase portrait"));
    if let Some(title) = title {
        svg.text((0.5 * sheet, 20.0), Anchor::Middle, 14.0, &fitted(title, 14.0, sheet - 32.0));
    }
    place.draw_grid(&mut svg);
    draw_orbit(&mut svg, content, &place, across, up);
    draw_points(&mut svg, content, &place, across, up);
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

/// Edges drawn already are skipped: an orbit that repeats costs no more than its first round. If that is not
/// enough the grid of the points becomes coarser.
fn draw_orbit(svg: &mut Svg, content: &Content<'_>, place: &Place, across: &[f64], up: &[f64]) {
    let mut cell = 0.05;
    let orbit = loop {
        match orbit(content, place, across, up, cell) {
            Some(orbit) => break orbit,
            None => cell *= 2.0,
        }
    };
    svg.path(
        &orbit.jumps,
        &format!("stroke=\"{INK}\" stroke-opacity=\"0.6\" stroke-width=\"0.8\" stroke-dasharray=\"1.2 2\""),
    );
    for (location, line) in orbit.lines {
        let colour = location.map_or_else(|| palette::CURVES[0].to_owned(), palette::location);
        let style = "stroke-width=\"1.2\" stroke-linejoin=\"round\" stroke-linecap=\"round\"";
        svg.path(&line, &format!("stroke=\"{colour}\" {style}"));
    }
}

#[derive(Default)]
struct Orbit {
    lines: BTreeMap<Option<u32>, String>,
    jumps: String,
}

fn orbit(content: &Content<'_>, place: &Place, across: &[f64], up: &[f64], cell: f64) -> Option<Orbit> {
    let spans = match content.bands.as_slice() {
        [band] => band.spans.as_slice(),
        _ => &[],
    };
    let mut span = 0;
    let mut orbit = Orbit::default();
    let mut drawn: HashSet<[i32; 4]> = HashSet::new();
    let mut before: Option<(f64, [i32; 2])> = None;
    // Where the pen of each colour stands.
    let mut pens: BTreeMap<Option<u32>, [i32; 2]> = BTreeMap::new();
    for ((&t, &x), &y) in content.time.iter().zip(across).zip(up) {
        if x.is_nan() || y.is_nan() || x.abs() >= LARGEST || y.abs() >= LARGEST {
            before = None;
            continue;
        }
        let here = [place.x(x), place.y(y)].map(|v| libm::round(v / cell) as i32);
        let coordinate = |p: [i32; 2]| p.map(|v| super::curve::round(f64::from(v) * cell, 2));
        if let Some((old_time, old)) = before
            && old != here
            && drawn.insert([old[0], old[1], here[0], here[1]])
        {
            let ([x0, y0], [x1, y1]) = (coordinate(old), coordinate(here));
            if old_time == t {
                let _ = write!(orbit.jumps, "M{x0} {y0}L{x1} {y1}");
            } else {
                while spans.get(span + 1).is_some_and(|next| next.0 <= old_time) {
                    span += 1;
                }
                let location = spans.get(span).map(|span| span.1);
                let line = orbit.lines.entry(location).or_default();
                if pens.insert(location, here) != Some(old) {
                    let _ = write!(line, "M{x0} {y0}L");
                }
                let _ = write!(line, "{x1} {y1} ");
            }
            if drawn.len() > MOST_EDGES && cell < 4.0 {
                return None;
            }
        }
        before = Some((t, here));
    }
    Some(orbit)
}

/// A dot where each transition was taken, a ring at the start, a square at the end.
fn draw_points(svg: &mut Svg, content: &Content<'_>, place: &Place, across: &[f64], up: &[f64]) {
    let mut seen = HashSet::new();
    for &time in &content.marks {
        let (x, y) = (value_before(content.time, across, time), value_before(content.time, up, time));
        if x.is_finite() && y.is_finite() && seen.len() < MOST_DOTS {
            let (x, y) = (place.x(x), place.y(y));
            if seen.insert([x, y].map(|v| libm::round(v) as i64)) {
                svg.circle((x, y), 2.0, DOT);
            }
        }
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
    Start,
    End,
}

struct Key {
    pieces: Vec<(f64, f64, Sign, String)>,
    height: f64,
}

impl Key {
    fn new(locations: &[(u32, &str)], marks: bool, left: f64, right: f64) -> Self {
        let mut signs: Vec<(Sign, String)> =
            locations.iter().map(|&(location, name)| (Sign::Location(location), name.to_owned())).collect();
        if marks {
            signs.push((Sign::Transition, "transition".to_owned()));
        }
        signs.push((Sign::Start, "start".to_owned()));
        signs.push((Sign::End, "end".to_owned()));
        let (mut x, mut y) = (left, 0.0);
        let mut pieces = Vec::new();
        for (sign, text) in signs {
            let indent = if matches!(sign, Sign::Location(_)) { 24.0 } else { 12.0 };
            let room = indent + width(&text, TEXT);
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
            let mut indent = 12.0;
            match sign {
                Sign::Location(location) => {
                    let colour = palette::location(*location);
                    svg.line(
                        (*x, middle),
                        (x + 18.0, middle),
                        &format!("stroke=\"{colour}\" stroke-width=\"2\""),
                    );
                    indent = 24.0;
                }
                Sign::Transition => svg.circle((x + 4.0, middle), 2.2, DOT),
                Sign::Start => svg.circle((x + 4.0, middle), 4.0, HOLLOW),
                Sign::End => svg.rect((x + 0.5, middle - 3.5), (7.0, 7.0), HOLLOW),
            }
            svg.text((x + indent, y), Anchor::Start, TEXT, text);
        }
    }
}
