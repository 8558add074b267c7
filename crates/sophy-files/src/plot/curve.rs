//! Rows to points on paper: jumps, gaps, and as few points as the eye needs.

use std::fmt::Write;

use super::axis::LARGEST;

/// How the pen comes to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pen {
    /// Drawing a line.
    Line,
    /// At one time from one value to another.
    Jump,
    /// Lifted.
    Gap,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) pen: Pen,
}

/// The points of a curve, in pixels. A value that is no number leaves a gap.
pub(super) fn points(
    time: &[f64],
    values: &[f64],
    to_x: impl Fn(f64) -> f64,
    to_y: impl Fn(f64) -> f64,
) -> Vec<Point> {
    let mut points = Vec::with_capacity(values.len());
    let mut last: Option<(f64, f64)> = None;
    for (&t, &value) in time.iter().zip(values) {
        if value.is_nan() || value.abs() >= LARGEST {
            last = None;
            continue;
        }
        let pen = match last {
            None => Pen::Gap,
            Some((before, old)) if before == t && old != value => Pen::Jump,
            Some(_) => Pen::Line,
        };
        last = Some((t, value));
        points.push(Point { x: to_x(t), y: to_y(value), pen });
    }
    points
}

/// Positions of the points to keep so that a picture with columns `column` pixels wide looks the same: of each
/// column the first, the lowest, the highest and the last (M4, Jugel et al., VLDB 2014). No peak is lost.
pub(super) fn thinned(xs: impl Iterator<Item = (f64, f64)>, column: f64) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut current: Option<(f64, [(usize, f64); 4])> = None;
    let keep = |kept: &mut Vec<usize>, [first, low, high, last]: [(usize, f64); 4]| {
        let mut these = [first.0, low.0, high.0, last.0];
        these.sort_unstable();
        for index in these {
            if kept.last() != Some(&index) {
                kept.push(index);
            }
        }
    };
    for (i, (x, y)) in xs.enumerate() {
        let number = libm::floor(x / column);
        match &mut current {
            Some((at, [_, low, high, last])) if *at == number => {
                *last = (i, y);
                if y < low.1 || low.1.is_nan() {
                    *low = (i, y);
                }
                if y > high.1 || high.1.is_nan() {
                    *high = (i, y);
                }
            }
            _ => {
                if let Some((_, these)) = current.take() {
                    keep(&mut kept, these);
                }
                current = Some((number, [(i, y); 4]));
            }
        }
    }
    if let Some((_, these)) = current {
        keep(&mut kept, these);
    }
    kept
}

/// Thins points out to about four for each column; jumps and gaps inside a column are not seen anyway.
pub(super) fn thin(points: Vec<Point>, column: f64) -> Vec<Point> {
    let kept = thinned(points.iter().map(|p| (p.x, p.y)), column);
    let mut before = None;
    let mut out = Vec::with_capacity(kept.len());
    for index in kept {
        let point = points[index];
        let follows = before.is_some_and(|before: usize| before + 1 == index);
        let same_column = before
            .is_some_and(|before| libm::floor(points[before].x / column) == libm::floor(point.x / column));
        let pen = if follows || !same_column { point.pen } else { Pen::Line };
        out.push(Point { pen, ..point });
        before = Some(index);
    }
    out
}

/// A curve as SVG path data: the line itself, the dotted strokes of its jumps, and points that stand alone.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Strokes {
    pub(super) line: String,
    pub(super) jumps: String,
    pub(super) dots: Vec<(f64, f64)>,
}

/// Jumps shorter than this many pixels are drawn through.
const VISIBLE_JUMP: f64 = 0.4;

/// A curve of more jumps than this is a staircase (a held sample), and all of them are drawn through.
const MOST_JUMPS: usize = 60;

pub(super) fn strokes(points: &[Point]) -> Strokes {
    let mut strokes = Strokes::default();
    let decimals = if points.len() > 4000 { 1 } else { 2 };
    let mut previous: Option<Point> = None;
    let staircase = points.iter().filter(|point| point.pen == Pen::Jump).count() > MOST_JUMPS;
    for (i, &point) in points.iter().enumerate() {
        let jump = point.pen == Pen::Jump
            && !staircase
            && previous.is_some_and(|before| (point.y - before.y).abs() >= VISIBLE_JUMP);
        let starts = point.pen == Pen::Gap || jump || previous.is_none();
        let ends = points
            .get(i + 1)
            .is_none_or(|next| next.pen == Pen::Gap || (next.pen == Pen::Jump && !staircase));
        if let (true, Some(before)) = (jump, previous) {
            let _ = write!(
                strokes.jumps,
                "M{} {}V{}",
                round(before.x, decimals),
                round(before.y, decimals),
                round(point.y, decimals)
            );
        }
        if starts && ends && !jump && points.get(i + 1).is_none_or(|next| next.pen == Pen::Gap) {
            strokes.dots.push((point.x, point.y));
        } else {
            let (x, y) = (round(point.x, decimals), round(point.y, decimals));
            let same = previous.is_some_and(|p| (round(p.x, decimals), round(p.y, decimals)) == (x, y));
            if starts {
                let _ = write!(strokes.line, "M{x} {y}L");
            } else if !same {
                let _ = write!(strokes.line, "{x} {y} ");
            }
        }
        previous = Some(point);
    }
    // A move without a line draws nothing and needs no "L".
    strokes.line = strokes.line.replace("LM", "M").trim_end_matches(['L', ' ']).to_owned();
    strokes
}

/// A coordinate with `decimals` digits after the point.
pub(super) fn round(value: f64, decimals: u32) -> f64 {
    let scale = if decimals == 1 { 10.0 } else { 100.0 };
    let rounded = libm::round(value * scale) / scale;
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drawn(time: &[f64], values: &[f64]) -> Strokes {
        strokes(&points(time, values, |t| t, |v| v))
    }

    #[test]
    fn a_jump_breaks_the_line_and_is_dotted() {
        let strokes = drawn(&[0.0, 1.0, 1.0, 2.0], &[0.0, 5.0, 2.0, 3.0]);
        assert_eq!(strokes.line, "M0 0L1 5 M1 2L2 3");
        assert_eq!(strokes.jumps, "M1 5V2");
    }

    #[test]
    fn a_continuous_variable_is_not_broken_at_an_event() {
        let strokes = drawn(&[0.0, 1.0, 1.0, 2.0], &[0.0, 5.0, 5.0, 3.0]);
        assert_eq!(strokes.line, "M0 0L1 5 2 3");
        assert_eq!(strokes.jumps, "");
    }

    #[test]
    fn what_is_no_number_leaves_a_gap() {
        let strokes = drawn(&[0.0, 1.0, 2.0, 3.0, 4.0], &[0.0, 1.0, f64::NAN, 1.0, 2.0]);
        assert_eq!(strokes.line, "M0 0L1 1 M3 1L4 2");
    }

    #[test]
    fn a_lonely_point_is_a_dot() {
        assert_eq!(drawn(&[1.0], &[2.0]).dots, [(1.0, 2.0)]);
        assert_eq!(drawn(&[0.0, 1.0, 2.0], &[f64::NAN, 7.0, f64::INFINITY]).dots, [(1.0, 7.0)]);
    }

    proptest! {
        #[test]
        fn no_peak_is_lost(values in prop::collection::vec(-1e3..1e3f64, 1..2000), columns in 1..50usize) {
            let time: Vec<f64> = (0..values.len()).map(|i| i as f64).collect();
            let column = values.len() as f64 / columns as f64;
            let all = points(&time, &values, |t| t, |v| v);
            let few = thin(all.clone(), column);
            prop_assert!(few.len() <= 4 * (columns + 1));
            let ends = |points: &[Point], c: f64| {
                let inside = points.iter().filter(|p| libm::floor(p.x / column) == c).map(|p| p.y);
                inside.fold((f64::INFINITY, f64::NEG_INFINITY), |e, y| (e.0.min(y), e.1.max(y)))
            };
            for c in 0..columns {
                prop_assert_eq!(ends(&all, c as f64), ends(&few, c as f64));
            }
        }
    }
}
