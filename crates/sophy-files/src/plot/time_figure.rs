//! Curves over time: panels above one another, strips of locations under them, one time axis.

use std::fmt::Write;

use super::PlotOptions;
use super::axis::Axis;
use super::content::{Band, Content, Panel};
use super::curve::{points, strokes, thin};
use super::palette;
use super::svg::{Anchor, INK, Svg, TEXT};
use super::text::{fitted, width};

/// More marks than this are drawn as ticks above the strips only.
const MOST_LINES: usize = 200;
/// With more spans of locations than this, colours behind the curves are noise.
const MOST_SHADES: usize = 150;
/// All curves together have about this many points at most, some 12 bytes each, unless that were less than one
/// column for each pixel.
const MOST_POINTS: usize = 24_000;

const DEFAULT_WIDTH: f64 = 720.0;
const SMALL: f64 = 10.0;
const RIGHT: f64 = 16.0;
const LEGEND_ROW: f64 = 17.0;
const STRIP: f64 = 15.0;
const STRIP_GAP: f64 = 4.0;
const PANEL_GAP: f64 = 12.0;
const THINNEST_PANEL: f64 = 40.0;

/// Draws the curves, the locations and the marks of `content`.
pub(super) fn time_figure(content: &Content<'_>, options: &PlotOptions, title: Option<&str>) -> String {
    let layout = Layout::new(content, options, title);
    let mut svg = Svg::new(layout.width, layout.height, title.unwrap_or("Simulation result"));
    if let Some(title) = title {
        let size = 14.0;
        let shown = fitted(title, size, layout.width - 2.0 * RIGHT);
        svg.text((0.5 * layout.width, 20.0), Anchor::Middle, size, &shown);
    }
    for (index, (panel, place)) in content.panels.iter().zip(&layout.panels).enumerate() {
        draw_panel(&mut svg, content, &layout, panel, place, index);
    }
    for (band, top) in content.bands.iter().zip(&layout.bands) {
        draw_band(&mut svg, &layout, band, *top);
    }
    draw_marks(&mut svg, content, &layout);
    draw_time_axis(&mut svg, content, &layout);
    draw_key(&mut svg, &layout);
    svg.finish()
}

struct Layout {
    width: f64,
    height: f64,
    left: f64,
    right: f64,
    time: Axis,
    panels: Vec<Place>,
    /// Upper edge of each strip.
    bands: Vec<f64>,
    /// Where the time axis runs.
    bottom: f64,
    /// Rows of the key under the axis: pieces and their places.
    key: Vec<(f64, f64, Key)>,
    note: Option<(f64, String)>,
}

/// A panel on the sheet.
struct Place {
    top: f64,
    bottom: f64,
    axis: Axis,
    /// Names of its curves, above it: x, base line, curve.
    legend: Vec<(f64, f64, usize)>,
}

#[derive(Clone, PartialEq)]
enum Key {
    /// Colour and name.
    Location(String, String),
    Fast,
    Mark(usize),
    Unmarked(usize),
}

impl Layout {
    fn new(content: &Content<'_>, options: &PlotOptions, title: Option<&str>) -> Self {
        let width = options.size.map_or(DEFAULT_WIDTH, |size| f64::from(size.0).clamp(200.0, 20_000.0));
        let wanted = match content.panels.len() {
            0 | 1 => 230.0,
            2 => 170.0,
            3 => 140.0,
            _ => 115.0,
        };
        let top = if title.is_some() { 34.0 } else { 10.0 };
        let axes = |height: f64| -> Vec<Axis> {
            let ticks = (height / 28.0).clamp(2.0, 8.0);
            content.panels.iter().map(|panel| Axis::new(panel.range(), ticks)).collect()
        };
        let left_of = |axes: &[Axis]| {
            let labels = axes.iter().flat_map(|axis| &axis.ticks).map(|tick| self::width(&tick.1, TEXT));
            let names = content.bands.iter().map(|band| self::width(band.name, TEXT).min(110.0) - 22.0);
            40.0 + labels.chain(names).fold(18.0, f64::max)
        };

        let mut axes_at = axes(wanted);
        let left = left_of(&axes_at);
        let right = width - RIGHT;
        let legends: Vec<Vec<(f64, f64, usize)>> =
            content.panels.iter().map(|panel| legend(panel, left, right)).collect();
        let rows = |legend: &Vec<(f64, f64, usize)>| legend.last().map_or(0.0, |last| last.1 + LEGEND_ROW);
        let above: f64 = legends.iter().map(rows).sum();
        let strips = content.bands.len() as f64 * (STRIP + STRIP_GAP)
            + if content.bands.is_empty() { 0.0 } else { 4.0 };
        let mut key = key(content, left, right);
        let key_rows = key.last().map_or(0.0, |last| last.1 + LEGEND_ROW);
        let note = content.note().map(|names| format!("not shown: {names}"));
        let below = strips + 42.0 + key_rows + if note.is_some() { 16.0 } else { 0.0 };
        let gaps = content.panels.len().saturating_sub(1) as f64 * PANEL_GAP;
        let mut height_of_panel = wanted;
        if let Some((_, height)) = options.size
            && !content.panels.is_empty()
        {
            let room = f64::from(height) - top - above - gaps - below;
            height_of_panel = (room / content.panels.len() as f64).max(THINNEST_PANEL);
            axes_at = axes(height_of_panel);
        }

        let mut y = top;
        let mut panels = Vec::new();
        for (axis, mut legend) in axes_at.into_iter().zip(legends) {
            let legend_height = rows(&legend);
            legend.iter_mut().for_each(|entry| entry.1 += y + 9.0);
            let top = y + legend_height;
            panels.push(Place { top, bottom: top + height_of_panel, axis, legend });
            y = top + height_of_panel + PANEL_GAP;
        }
        let mut bottom = panels.last().map_or(top, |place| place.bottom);
        let bands = (0..content.bands.len())
            .map(|i| bottom + 6.0 + i as f64 * (STRIP + STRIP_GAP))
            .collect::<Vec<f64>>();
        if let Some(last) = bands.last() {
            bottom = last + STRIP + 2.0;
        }
        let time = Axis::new(content.time_range, ((right - left) / 85.0).clamp(2.0, 12.0));
        key.iter_mut().for_each(|entry| entry.1 += bottom + 56.0);
        let note = note.map(|note| (bottom + 40.0 + key_rows + 10.0, fitted(&note, SMALL, right - left)));
        let height = bottom + 42.0 + key_rows + if note.is_some() { 16.0 } else { 0.0 };
        Layout { width, height, left, right, time, panels, bands, bottom, key, note }
    }

    fn x(&self, time: f64) -> f64 {
        self.left + self.time.fraction(time) * (self.right - self.left)
    }
}

impl Place {
    fn y(&self, value: f64) -> f64 {
        self.bottom - self.axis.fraction(value) * (self.bottom - self.top)
    }
}

/// Places pieces of the given widths in rows between two edges; y counts from the first row.
fn rows(widths: impl Iterator<Item = f64>, left: f64, right: f64) -> Vec<(f64, f64)> {
    let (mut x, mut y) = (left, 0.0);
    let mut places = Vec::new();
    for width in widths {
        if x > left && x + width > right {
            (x, y) = (left, y + LEGEND_ROW);
        }
        places.push((x, y));
        x += width + 16.0;
    }
    places
}

/// A single curve has its name at the axis already.
fn legend(panel: &Panel<'_>, left: f64, right: f64) -> Vec<(f64, f64, usize)> {
    if panel.curves.len() < 2 {
        return Vec::new();
    }
    let widths = panel.curves.iter().map(|curve| 26.0 + width(curve.name, TEXT));
    rows(widths, left, right).into_iter().enumerate().map(|(i, (x, y))| (x, y, i)).collect()
}

/// Explains what the strips cannot say themselves: names that fit in no span, and the marks.
fn key(content: &Content<'_>, left: f64, right: f64) -> Vec<(f64, f64, Key)> {
    let scale = (right - left) / (content.time_range.1 - content.time_range.0);
    let mut pieces = Vec::new();
    for band in &content.bands {
        let spans = pixel_spans(band, content.time_range.1, |time| (time - content.time_range.0) * scale);
        let unsaid = |location: u32| {
            !spans.iter().any(|span| span.location == Some(location) && span.fits(name_of(band, location)))
        };
        let mut present: Vec<u32> = spans.iter().filter_map(|span| span.location).collect();
        present.sort_unstable();
        present.dedup();
        if present.iter().any(|&location| unsaid(location)) {
            for location in present {
                let piece = Key::Location(band.colour(location), name_of(band, location).to_owned());
                if !pieces.contains(&piece) {
                    pieces.push(piece);
                }
            }
        }
        if spans.iter().any(|span| span.location.is_none()) && !pieces.iter().any(|p| matches!(p, Key::Fast))
        {
            pieces.push(Key::Fast);
        }
    }
    if !content.marks.is_empty() {
        let count = content.transitions;
        pieces.push(if too_many(content, right - left) { Key::Unmarked(count) } else { Key::Mark(count) });
    }
    let widths: Vec<f64> = pieces.iter().map(|piece| piece.indent() + width(&piece.text(), TEXT)).collect();
    rows(widths.into_iter(), left, right)
        .into_iter()
        .zip(pieces)
        .map(|((x, y), piece)| (x, y, piece))
        .collect()
}

impl Key {
    /// Room of its sign.
    fn indent(&self) -> f64 {
        if matches!(self, Key::Unmarked(_)) { 0.0 } else { 19.0 }
    }

    fn text(&self) -> String {
        match self {
            Key::Location(_, name) => name.clone(),
            Key::Fast => "changes too fast to show".to_owned(),
            Key::Mark(1) => "transition".to_owned(),
            Key::Mark(count) => format!("{count} transitions"),
            Key::Unmarked(count) => format!("{count} transitions, too many to mark"),
        }
    }
}

fn name_of<'a>(band: &Band<'a>, location: u32) -> &'a str {
    band.names.get(location as usize).map_or("", String::as_str)
}

/// A span of one location on the sheet; `None` where they change within less than a pixel.
#[derive(Clone, Copy)]
struct PixelSpan {
    from: f64,
    to: f64,
    location: Option<u32>,
}

impl PixelSpan {
    fn fits(&self, name: &str) -> bool {
        width(name, SMALL) + 6.0 <= self.to - self.from
    }
}

/// Runs of at least this many spans, each less than a pixel wide, are a blur.
const BLUR: usize = 4;

fn pixel_spans(band: &Band<'_>, end: f64, to_x: impl Fn(f64) -> f64) -> Vec<PixelSpan> {
    let ends = band.spans.iter().skip(1).map(|next| next.0).chain([end]);
    let all: Vec<PixelSpan> = band
        .spans
        .iter()
        .zip(ends)
        .map(|(&(start, location), end)| PixelSpan {
            from: to_x(start),
            to: to_x(end),
            location: Some(location),
        })
        .collect();
    let narrow = |span: &PixelSpan| span.to - span.from < 1.0;
    let mut spans = Vec::new();
    for run in all.chunk_by(|a, b| narrow(a) && narrow(b)) {
        match run {
            [first, .., last] if run.len() >= BLUR => {
                spans.push(PixelSpan { from: first.from, to: last.to, location: None });
            }
            _ => spans.extend_from_slice(run),
        }
    }
    spans
}

fn draw_panel(
    svg: &mut Svg,
    content: &Content<'_>,
    layout: &Layout,
    panel: &Panel<'_>,
    place: &Place,
    index: usize,
) {
    let size = (layout.right - layout.left, place.bottom - place.top);
    shade(svg, content, layout, place);
    for (value, _) in &place.axis.ticks {
        let y = place.y(*value);
        svg.line(
            (layout.left, y),
            (layout.right, y),
            "stroke=\"#000\" stroke-opacity=\"0.1\" stroke-width=\"0.6\"",
        );
    }
    for (time, _) in &layout.time.ticks {
        let x = layout.x(*time);
        svg.line(
            (x, place.top),
            (x, place.bottom),
            "stroke=\"#000\" stroke-opacity=\"0.1\" stroke-width=\"0.6\"",
        );
    }
    if content.marks.len() <= MOST_LINES {
        let mut data = String::new();
        for &time in &content.marks {
            let _ = write!(data, "M{:.2} {:.2}V{:.2}", layout.x(time), place.top, place.bottom);
        }
        svg.path(&data, "stroke=\"#000\" stroke-opacity=\"0.22\" stroke-width=\"0.5\"");
    }

    svg.clip(&format!("panel{index}"), (layout.left, place.top - 1.0), (size.0 + 1.0, size.1 + 2.0));
    let all_curves: usize = content.panels.iter().map(|panel| panel.curves.len()).sum();
    let columns = (MOST_POINTS as f64 / 4.0 / all_curves.max(1) as f64).clamp(size.0, 2.0 * size.0);
    for (n, curve) in panel.curves.iter().enumerate().rev() {
        let (colour, dashes) = palette::curve(n);
        let mut points = points(content.time, curve.values, |t| layout.x(t), |v| place.y(v));
        if points.len() as f64 > 4.0 * columns {
            points = thin(points, size.0 / columns);
        }
        let strokes = strokes(&points);
        let dotted = "stroke-width=\"0.8\" stroke-dasharray=\"1.2 2\"";
        svg.path(&strokes.jumps, &format!("stroke=\"{colour}\" {dotted}"));
        let dashes = if dashes.is_empty() { String::new() } else { format!("stroke-dasharray=\"{dashes}\"") };
        let style = "stroke-width=\"1.3\" stroke-linejoin=\"round\"";
        svg.path(&strokes.line, &format!("stroke=\"{colour}\" {style} {dashes}"));
        for dot in strokes.dots {
            svg.circle(dot, 1.8, &format!("fill=\"{colour}\""));
        }
    }
    svg.unclip();

    let frame = format!("stroke=\"{INK}\" stroke-width=\"0.8\"");
    svg.line((layout.left, place.top), (layout.left, place.bottom), &frame);
    svg.line((layout.left, place.bottom), (layout.right, place.bottom), &frame);
    for (value, label) in &place.axis.ticks {
        let y = place.y(*value);
        svg.line((layout.left - 4.0, y), (layout.left, y), &frame);
        svg.text((layout.left - 7.0, y + 0.36 * TEXT), Anchor::End, TEXT, label);
    }
    let title = place.axis.title(panel.name(), panel.unit);
    let room = size.1 + 8.0;
    let middle = 0.5 * (place.top + place.bottom);
    if width(&title, TEXT) <= room || panel.name().is_empty() {
        svg.upright_text((16.0, middle), TEXT, &title);
    } else {
        // The unit is what the numbers need; the name gives way.
        let unit = place.axis.title("", panel.unit);
        let name = fitted(panel.name(), TEXT, room - width(&unit, TEXT) - 4.0);
        svg.upright_text((16.0, middle), TEXT, &place.axis.title(&name, panel.unit));
    }
    for &(x, y, n) in &place.legend {
        let (colour, dashes) = palette::curve(n);
        let style = format!("stroke=\"{colour}\" stroke-width=\"1.8\" stroke-dasharray=\"{dashes}\"");
        svg.line((x, y - 3.5), (x + 20.0, y - 3.5), style.trim_end_matches(" stroke-dasharray=\"\""));
        svg.text((x + 25.0, y), Anchor::Start, TEXT, panel.curves[n].name);
    }
}

/// Light colours behind the curves, for one automaton whose spans are wide enough to see.
fn shade(svg: &mut Svg, content: &Content<'_>, layout: &Layout, place: &Place) {
    let Some(band) = content.automaton() else { return };
    if band.spans.len() > MOST_SHADES {
        return;
    }
    for span in pixel_spans(band, content.time_range.1, |t| layout.x(t)) {
        if let Some(location) = span.location {
            let fill = format!("fill=\"{}\"", palette::location_shade(location));
            svg.rect((span.from, place.top), (span.to - span.from, place.bottom - place.top), &fill);
        }
    }
}

fn draw_band(svg: &mut Svg, layout: &Layout, band: &Band<'_>, top: f64) {
    let name = fitted(band.name, TEXT, layout.left - 12.0);
    svg.text((layout.left - 7.0, top + 0.5 * STRIP + 0.36 * TEXT), Anchor::End, TEXT, &name);
    for span in pixel_spans(band, layout.time.high, |t| layout.x(t)) {
        let fill = span.location.map_or_else(|| palette::FAST.to_owned(), |location| band.colour(location));
        svg.rect((span.from, top), (span.to - span.from, STRIP), &format!("fill=\"{fill}\""));
        let Some(location) = span.location else { continue };
        let name = name_of(band, location);
        if span.fits(name) {
            let middle = 0.5 * (span.from + span.to);
            svg.text((middle, top + 0.5 * STRIP + 0.36 * SMALL), Anchor::Middle, SMALL, name);
        }
    }
}

/// Small ticks on the strips.
fn draw_marks(svg: &mut Svg, content: &Content<'_>, layout: &Layout) {
    let Some(edge) = layout.panels.last().map(|place| place.bottom).or(layout.bands.first().copied()) else {
        return;
    };
    if too_many(content, layout.right - layout.left) {
        return;
    }
    let mut data = String::new();
    for &time in &content.marks {
        let _ = write!(data, "M{:.2} {edge:.2}v4.5", layout.x(time));
    }
    svg.path(&data, "stroke=\"#000\" stroke-opacity=\"0.6\" stroke-width=\"0.6\"");
}

/// Whether the marks would run together.
fn too_many(content: &Content<'_>, width: f64) -> bool {
    content.marks.len() as f64 > 0.5 * width
}

fn draw_time_axis(svg: &mut Svg, content: &Content<'_>, layout: &Layout) {
    let frame = format!("stroke=\"{INK}\" stroke-width=\"0.8\"");
    if !content.bands.is_empty() {
        svg.line((layout.left, layout.bottom), (layout.right, layout.bottom), &frame);
    }
    for (time, label) in &layout.time.ticks {
        let x = layout.x(*time);
        svg.line((x, layout.bottom), (x, layout.bottom + 4.0), &frame);
        svg.text((x, layout.bottom + 16.0), Anchor::Middle, TEXT, label);
    }
    let title = layout.time.title("time", Some("s"));
    svg.text((0.5 * (layout.left + layout.right), layout.bottom + 33.0), Anchor::Middle, TEXT, &title);
}

fn draw_key(svg: &mut Svg, layout: &Layout) {
    for (x, y, piece) in &layout.key {
        match piece {
            Key::Location(colour, _) => svg.rect((*x, y - 9.0), (14.0, 10.5), &format!("fill=\"{colour}\"")),
            Key::Fast => svg.rect((*x, y - 9.0), (14.0, 10.5), &format!("fill=\"{}\"", palette::FAST)),
            Key::Unmarked(_) => {}
            Key::Mark(_) => {
                let style = "stroke=\"#000\" stroke-opacity=\"0.6\" stroke-width=\"0.8\"";
                svg.line((x + 7.0, y - 9.5), (x + 7.0, y + 2.0), style);
            }
        }
        svg.text((x + piece.indent(), *y), Anchor::Start, TEXT, &piece.text());
    }
    if let Some((y, note)) = &layout.note {
        svg.text((layout.left, *y), Anchor::Start, SMALL, note);
    }
}
