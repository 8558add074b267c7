//! Panels beside one another with one legend, as SVG. Faces, ink and colours are those of `sophy-files`.

use plotters::coord::Shift;
use plotters::element::{Circle, PathElement, Text};
use plotters::prelude::*;
use std::io;
use std::path::Path;

/// Curves that share axes.
#[derive(Clone, Debug)]
pub struct Panel {
    pub title: String,
    pub x: Axis,
    pub y: Axis,
    pub curves: Vec<Curve>,
}

#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    pub scale: Scale,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Logarithmic, with ticks at powers of this number.
    Powers(u32),
    /// Linear, from zero.
    FromZero,
}

#[derive(Clone, Debug)]
pub struct Curve {
    pub name: String,
    pub line: Line,
    pub points: Vec<(f64, f64)>,
}

#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Position among the colours.
    pub colour: usize,
    pub dashed: bool,
}

const PANEL: (u32, u32) = (340, 320);
const LEGEND: u32 = 26;
const FAMILY: &str = "Roboto, Helvetica, Arial, sans-serif";
const TEXT: f64 = 11.0;
const INK: RGBColor = RGBColor(0x22, 0x22, 0x22);
const GRID: RGBColor = RGBColor(0xe4, 0xe4, 0xe4);
const COLOURS: [RGBColor; 4] = [
    RGBColor(0x00, 0x72, 0xb2),
    RGBColor(0xd5, 0x5e, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0x80, 0x80, 0x80),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn<T> = Result<T, Box<dyn std::error::Error>>;

/// Draws panels that show the same curves.
pub fn draw(path: &Path, panels: &[Panel]) -> io::Result<()> {
    let mut text = String::new();
    drawn(&mut text, panels).map_err(|error| io::Error::other(error.to_string()))?;
    std::fs::write(path, text)
}

fn drawn(text: &mut String, panels: &[Panel]) -> Drawn<()> {
    let width = PANEL.0 * panels.len() as u32;
    let sheet = SVGBackend::with_string(text, (width, PANEL.1 + LEGEND)).into_drawing_area();
    sheet.fill(&WHITE)?;
    let (top, rest) = sheet.split_vertically(LEGEND);
    if let Some(first) = panels.first() {
        draw_legend(&top, &first.curves)?;
    }
    for (area, panel) in rest.split_evenly((1, panels.len())).iter().zip(panels) {
        draw_panel(area, panel)?;
    }
    sheet.present()?;
    Ok(())
}

/// Samples of all lines, each with its name, spread over the width.
fn draw_legend(area: &Area<'_>, curves: &[Curve]) -> Drawn<()> {
    let (width, _) = area.dim_in_pixel();
    let letters: usize = curves.iter().map(|curve| curve.name.chars().count() + 9).sum();
    let mut at = 16.0;
    // Names get room by their length.
    let each = f64::min(6.5, (f64::from(width) - 2.0 * at) / letters as f64);
    for curve in curves {
        let (x, y) = (at as i32, 16);
        sample(area, curve.line, (x, y))?;
        area.draw(&Text::new(curve.name.clone(), (x + 34, y - 5), (FAMILY, TEXT).into_font().color(&INK)))?;
        at += each * (curve.name.chars().count() + 9) as f64;
    }
    Ok(())
}

fn sample(area: &Area<'_>, line: Line, (x, y): (i32, i32)) -> Drawn<()> {
    let colour = COLOURS[line.colour];
    let dashes: &[(i32, i32)] = if line.dashed { &[(0, 6), (9, 15), (18, 24)] } else { &[(0, 28)] };
    for (begin, end) in dashes {
        area.draw(&PathElement::new([(x + begin, y), (x + end, y)], colour.stroke_width(2)))?;
    }
    for dot in dots(line, (x + 14, y)) {
        area.draw(&dot)?;
    }
    Ok(())
}

/// A full point, or a ring where the line is dashed.
fn dots<C>(line: Line, at: C) -> Vec<Circle<C, i32>>
where
    C: Copy,
{
    let colour = COLOURS[line.colour];
    if line.dashed {
        vec![Circle::new(at, 3, WHITE.filled()), Circle::new(at, 3, colour.stroke_width(1))]
    } else {
        vec![Circle::new(at, 3, colour.filled())]
    }
}

fn draw_panel(area: &Area<'_>, panel: &Panel) -> Drawn<()> {
    let values =
        |pick: fn(&(f64, f64)) -> f64| panel.curves.iter().flat_map(move |c| c.points.iter().map(pick));
    let (x, y) = (Span::new(panel.x.scale, values(|p| p.0)), Span::new(panel.y.scale, values(|p| p.1)));
    let font = || (FAMILY, TEXT).into_font().color(&INK);
    let mut chart = ChartBuilder::on(area)
        .margin_right(16)
        .margin_left(6)
        .margin_bottom(4)
        .caption(&panel.title, (FAMILY, TEXT + 1.0, FontStyle::Bold).into_font().color(&INK))
        .set_label_area_size(LabelAreaPosition::Left, 56)
        .set_label_area_size(LabelAreaPosition::Bottom, 40)
        .build_cartesian_2d(x.low..x.high, y.low..y.high)?;
    chart
        .configure_mesh()
        .x_labels(x.ticks)
        .y_labels(y.ticks)
        .max_light_lines(0)
        .bold_line_style(GRID)
        .axis_style(INK)
        .label_style(font())
        .x_desc(&panel.x.label)
        .y_desc(&panel.y.label)
        .x_label_formatter(&|at| x.label(*at))
        .y_label_formatter(&|at| y.label(*at))
        .draw()?;
    for curve in &panel.curves {
        let points: Vec<_> = curve.points.iter().map(|point| (x.place(point.0), y.place(point.1))).collect();
        let stroke = COLOURS[curve.line.colour].stroke_width(2);
        if curve.line.dashed {
            chart.draw_series(DashedLineSeries::new(points.iter().copied(), 6, 3, stroke))?;
        } else {
            chart.draw_series(LineSeries::new(points.iter().copied(), stroke))?;
        }
        chart.draw_series(points.iter().flat_map(|&point| dots(curve.line, point)))?;
    }
    Ok(())
}

/// The stretch of an axis; of a logarithmic one in powers.
struct Span {
    scale: Scale,
    low: f64,
    high: f64,
    ticks: usize,
}

impl Span {
    fn new(scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let mut span = Span { scale, low: 0.0, high: 1.0, ticks: 6 };
        let placed = values.map(|value| span.place(value)).filter(|value| value.is_finite());
        let ends = placed.fold(None, |ends: Option<(f64, f64)>, at| {
            Some(ends.map_or((at, at), |(low, high)| (low.min(at), high.max(at))))
        });
        let Some((low, high)) = ends else { return span };
        match scale {
            Scale::FromZero => span.high = 1.1 * high,
            Scale::Powers(_) => {
                // Some room for points at the border; ticks at whole powers only, at every second one if there are many.
                let room = 0.3_f64.max(0.05 * (high - low));
                (span.low, span.high) = (low - room, high + room);
                let powers = (libm::floor(span.high) - libm::ceil(span.low)) as usize;
                span.ticks = if powers > 8 { powers / 2 + 1 } else { powers + 1 };
            }
        }
        span
    }

    fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::FromZero => value,
            Scale::Powers(base) => libm::log(value) / libm::log(f64::from(base)),
        }
    }

    fn label(&self, at: f64) -> String {
        match self.scale {
            Scale::FromZero => format!("{at:.0}"),
            Scale::Powers(10) => format!("10{}", superscript(at)),
            Scale::Powers(base) => libm::pow(f64::from(base), at).to_string(),
        }
    }
}

fn superscript(power: f64) -> String {
    let raised = |c| match c {
        '-' => '⁻',
        '0'..='9' => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][c as usize - '0' as usize],
        other => other,
    };
    format!("{power:.0}").chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_powers_have_whole_powers_for_ticks() {
        let span = Span::new(Scale::Powers(10), [0.01, 300.0].into_iter());
        assert_eq!(span.ticks, 5, "10⁻² … 10²");
        assert_eq!(span.label(-2.0), "10⁻²");
        assert_eq!(Span::new(Scale::Powers(2), [1.0, 16.0].into_iter()).label(3.0), "8");
    }
}
