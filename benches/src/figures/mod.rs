//! `figures`: the pictures of the book, drawn from what was measured just now.

mod chart;

use crate::precision::{self, METHODS, PROBLEMS, Point};
use crate::problem::Problem;
use crate::scale::{self, CELLS, Scaled};
use chart::{Axis, Curve, Line, Panel, Scale, draw};
use sophy_run::Method;
use std::io;
use std::path::Path;

/// Draws them into a folder.
pub fn draw_all(folder: &Path, points: &[Point], sizes: &[Scaled], activity: &[Scaled]) -> io::Result<()> {
    std::fs::create_dir_all(folder)?;
    draw(&folder.join("work-precision.svg"), &work_precision(points))?;
    draw(&folder.join("cost-and-size.svg"), &cost_and_size(sizes))?;
    draw(&folder.join("cost-and-activity.svg"), &cost_and_activity(activity))
}

/// Engines of one order share a colour; the implicit ones are dashed.
fn line_of(method: Method) -> Line {
    let order = match method {
        Method::Qss1 | Method::Liqss1 => 0,
        Method::Qss3 | Method::Liqss3 => 2,
        _ => 1,
    };
    let implicit = [Method::Liqss1, Method::Liqss2, Method::Liqss3].contains(&method);
    Line { colour: order, dashed: implicit }
}

/// Error against run time, a panel for each problem.
fn work_precision(points: &[Point]) -> Vec<Panel> {
    let panel = |problem: Problem| {
        let curve = |method: Method| {
            let of = |point: &&Point| {
                point.problem == problem && point.method == method && point.error.is_finite()
            };
            let points = points.iter().filter(of).map(|point| (point.cpu_ms, point.error)).collect();
            Curve { name: method.name().to_owned(), line: line_of(method), points }
        };
        Panel {
            title: format!("{}, {} s", problem.name(), problem.judged()),
            x: Axis { label: "CPU time (ms)".to_owned(), scale: Scale::Powers(10) },
            y: Axis { label: error_label(problem), scale: Scale::Powers(10) },
            curves: METHODS.into_iter().map(curve).collect(),
        }
    };
    PROBLEMS.into_iter().map(panel).collect()
}

fn error_label(problem: Problem) -> String {
    match problem {
        Problem::Hopper => "error of transition times (s)",
        _ => "largest error of a state (1)",
    }
    .to_owned()
}

/// Time and memory against the number of states.
fn cost_and_size(sizes: &[Scaled]) -> Vec<Panel> {
    let panel = |title: &str, label: &str, value: fn(&Scaled) -> f64| {
        let systems = [scale::LINE, scale::BUSY_LINE, scale::FRONT, scale::NEURONS];
        let curve = |(colour, system): (usize, &str)| {
            let of = |row: &&Scaled| row.system == system;
            let method = sizes.iter().find(of).map_or("", |row| row.method.name());
            let points = sizes.iter().filter(of).map(|row| (row.states as f64, value(row))).collect();
            Curve { name: format!("{system} ({method})"), line: Line { colour, dashed: false }, points }
        };
        Panel {
            title: title.to_owned(),
            x: Axis { label: "states".to_owned(), scale: Scale::Powers(10) },
            y: Axis { label: label.to_owned(), scale: Scale::FromZero },
            curves: systems.into_iter().enumerate().map(curve).collect(),
        }
    };
    vec![
        panel("time", "CPU time per step (ns)", Scaled::ns_per_step),
        panel("memory", "memory per state (bytes)", Scaled::bytes_per_state),
    ]
}

/// Run time against the number of fronts, beside the line of proportion.
fn cost_and_activity(activity: &[Scaled]) -> Vec<Panel> {
    let measured: Vec<_> = activity.iter().map(|row| (row.fronts.unwrap_or(1) as f64, row.cpu_ms)).collect();
    let mut shares: Vec<f64> = measured.iter().map(|(fronts, ms)| ms / fronts).collect();
    shares.sort_unstable_by(f64::total_cmp);
    let each = shares.get(shares.len() / 2).copied().unwrap_or(0.0);
    let proportional = measured.iter().map(|(fronts, _)| (*fronts, each * fronts)).collect();
    let method = activity.first().map_or("", |row| row.method.name());
    vec![Panel {
        title: format!("{} 000 cells, {method}, 0.5 s", CELLS / 1000),
        x: Axis { label: "fronts that travel".to_owned(), scale: Scale::Powers(2) },
        y: Axis { label: "CPU time (ms)".to_owned(), scale: Scale::Powers(2) },
        curves: vec![
            Curve {
                name: "proportional".to_owned(),
                line: Line { colour: 3, dashed: true },
                points: proportional,
            },
            Curve { name: "measured".to_owned(), line: Line { colour: 0, dashed: false }, points: measured },
        ],
    }]
}

/// What the pictures show; measuring takes some minutes.
pub fn measure() -> (Vec<Point>, Vec<Scaled>, Vec<Scaled>) {
    (precision::bench(), scale::sizes(), scale::activity())
}
