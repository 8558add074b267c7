use crate::build::Built;
use crate::language::Told;
use crate::measure::Measured;
use crate::recording::Recorded;
use serde_json::json;

/// The table for people.
pub fn markdown(results: &[Measured]) -> String {
    let mut text = String::from(
        "| bench | engine | by | wall, ms | × real time | CPU, ms | steps | ns per step | transitions | error | error of | × floor |\n\
         | --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: |\n",
    );
    for r in results {
        let transitions = r.transitions.map_or_else(|| "–".to_owned(), |n| n.to_string());
        let ratio = r.ratio.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}"));
        text += &format!(
            "| {} | {} | {} | {:.3} | {:.0} | {:.3} | {} | {:.1} | {transitions} | {:.1e} | {} | {ratio} |\n",
            r.bench,
            r.method,
            r.by,
            r.time.wall_ms,
            real_time(r),
            r.time.cpu_ms,
            r.steps,
            per_step(r),
            r.error,
            r.error_of,
        );
    }
    text
}

/// From system to started run, for people.
pub fn built_markdown(built: &[Built]) -> String {
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
pub fn recorded_markdown(recorded: &[Recorded]) -> String {
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
pub fn told_markdown(told: &[Told]) -> String {
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

/// The same for machines.
pub fn json(results: &[Measured], built: &[Built], told: &[Told]) -> String {
    let told = told.iter().map(|t| {
        let stages: serde_json::Map<_, _> =
            t.stages.iter().map(|(stage, ms)| ((*stage).to_owned(), json!(ms))).collect();
        json!({
            "bench": "language",
            "text": t.text,
            "lines": t.lines,
            "states": t.states,
            "stages_ms": stages,
            "bytes": t.held,
            "peak_bytes": t.peak,
        })
    });
    let built = built.iter().map(|b| {
        json!({
            "bench": "build",
            "system": b.system,
            "states": b.states,
            "programs": b.programs,
            "lift_ns_per_state": b.per_state(b.lift_ms),
            "start_ns_per_state": b.per_state(b.start_ms),
            "bytes_per_state": b.bytes / b.states,
            "peak_bytes_per_state": b.peak / b.states,
        })
    });
    let rows: Vec<_> = results
        .iter()
        .map(|r| {
            json!({
                "bench": r.bench,
                "engine": r.method,
                "by": r.by,
                "wall_ms": r.time.wall_ms,
                "cpu_ms": r.time.cpu_ms,
                "real_time_factor": real_time(r),
                "steps": r.steps,
                "ns_per_step": per_step(r),
                "transitions": r.transitions,
                "error": r.error,
                "error_of": r.error_of,
                "ratio_to_floor": r.ratio,
            })
        })
        .chain(built)
        .chain(told)
        .collect();
    format!("{:#}\n", serde_json::Value::from(rows))
}

/// Simulated time over wall time.
fn real_time(r: &Measured) -> f64 {
    1e3 * r.simulated / r.time.wall_ms
}

/// CPU time per step, ns.
fn per_step(r: &Measured) -> f64 {
    1e6 * r.time.cpu_ms / r.steps as f64
}
