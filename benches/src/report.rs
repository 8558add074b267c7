//! Tables for people; `rows` has the same for machines.

use crate::build::Built;
use crate::language::Told;
use crate::measure::Measured;
use crate::precision::Point;
use crate::recording::Recorded;
use crate::scale::Scaled;
use crate::stamp::Stamp;

/// Everything that was measured.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Engines beside floors and peers.
    pub runs: Vec<Measured>,
    pub built: Vec<Built>,
    pub told: Vec<Told>,
    pub recorded: Vec<Recorded>,
    pub points: Vec<Point>,
    pub scaled: Vec<Scaled>,
}

/// For people: the tables of what was measured.
pub fn markdown(stamp: &Stamp, results: &Results) -> String {
    let Stamp { date, machine, commit } = stamp;
    let mut text = format!(
        "{date}, {machine}, {commit}. Medians; machines are noisy: read ratios, and no speed without its error.\n"
    );
    let tables = [
        (results.runs.is_empty(), runs_markdown(&results.runs)),
        (results.scaled.is_empty(), scaled_markdown(&results.scaled)),
        (results.built.is_empty(), built_markdown(&results.built)),
        (results.told.is_empty(), told_markdown(&results.told)),
        (results.recorded.is_empty(), recorded_markdown(&results.recorded)),
    ];
    for (_, table) in tables.iter().filter(|(empty, _)| !empty) {
        text.push('\n');
        text.push_str(table);
    }
    text
}

fn runs_markdown(runs: &[Measured]) -> String {
    let mut text = String::from(
        "| bench | to | by | engine | quantum or tolerance | wall, ms | × real time | CPU, ms | steps | ns per step | transitions | error | error of | × floor | × ours |\n\
         | --- | ---: | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |\n",
    );
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    for r in runs {
        text += &format!(
            "| {} | {} | {} | {} | {:.1e} | {:.3} | {:.0} | {:.3} | {} | {:.1} | {} | {:.1e} | {} | {} | {} |\n",
            r.bench,
            or_dash(r.wanted.map(|wanted| format!("{wanted:.0e}"))),
            r.by,
            r.method,
            r.setting,
            r.time.wall_ms,
            real_time(r),
            r.time.cpu_ms,
            r.steps,
            per_step(r),
            or_dash(r.transitions.map(|count| count.to_string())),
            r.error,
            r.error_of,
            or_dash(r.to_floor.map(|ratio| format!("{ratio:.2}"))),
            or_dash(r.to_ours.map(|ratio| format!("{ratio:.2}"))),
        );
    }
    text
}

fn scaled_markdown(scaled: &[Scaled]) -> String {
    let mut text = String::from(
        "| scale | engine | states | fronts | steps | CPU, ms | ns per step | B per state |\n\
         | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for s in scaled {
        text += &format!(
            "| {} | {} | {} | {} | {} | {:.2} | {:.1} | {:.0} |\n",
            s.system,
            s.method.name(),
            s.states,
            s.fronts.map_or_else(|| "–".to_owned(), |fronts| fronts.to_string()),
            s.steps,
            s.cpu_ms,
            s.ns_per_step(),
            s.bytes_per_state(),
        );
    }
    text
}

/// From system to started run, for people.
fn built_markdown(built: &[Built]) -> String {
    let mut text = String::from(
        "| build | states | programs | lift, ns per state | start, ns per state | in all, s | B per state | peak, B per state |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for b in built {
        text += &format!(
            "| {} | {} | {} | {:.0} | {:.0} | {:.2} | {} | {} |\n",
            b.system,
            b.states,
            b.programs,
            b.per_state(b.lift_ms),
            b.per_state(b.start_ms),
            1e-3 * (b.lift_ms + b.start_ms),
            b.bytes / b.states,
            b.peak / b.states,
        );
    }
    text
}

/// Recording, for people.
fn recorded_markdown(recorded: &[Recorded]) -> String {
    let mut text = String::from(
        "| recording | rows | thread of the run, CPU, ms | all threads, CPU, ms | wall, ms | completing the file, ms | × thread | × all | × wall |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    for r in recorded {
        text += &format!(
            "| {} | {} | {:.1} | {:.1} | {:.1} | {:.1} | {:.2} | {:.2} | {:.2} |\n",
            r.into,
            r.rows,
            r.run.cpu_ms,
            r.all_ms,
            r.run.wall_ms,
            r.finish.wall_ms,
            r.cpu_ratio,
            r.all_ratio,
            r.wall_ratio,
        );
    }
    text
}

/// From text to started run, for people.
fn told_markdown(told: &[Told]) -> String {
    let mut text = String::from(
        "| language | lines | states | lines per s | in all, s | ns per state or line | of which | B per state or line | at the peak |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |\n",
    );
    for t in told {
        let each = |ms: f64| 1e6 * ms / t.units() as f64;
        let stages: Vec<String> =
            t.stages.iter().map(|(stage, ms)| format!("{stage} {:.0}", each(*ms))).collect();
        text += &format!(
            "| {} | {} | {} | {:.0} | {:.3} | {:.0} | {} | {} | {} |\n",
            t.text,
            t.lines,
            t.states,
            1e3 * t.lines as f64 / t.total_ms(),
            1e-3 * t.total_ms(),
            each(t.total_ms()),
            stages.join(", "),
            t.held / t.units(),
            t.peak / t.units(),
        );
    }
    text
}

/// Simulated time over wall time.
pub fn real_time(r: &Measured) -> f64 {
    1e3 * r.simulated / r.time.wall_ms
}

/// CPU time per step, ns.
pub fn per_step(r: &Measured) -> f64 {
    1e6 * r.time.cpu_ms / r.steps as f64
}
