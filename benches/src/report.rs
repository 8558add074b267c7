use crate::build::Built;
use crate::measure::Measured;
use serde_json::json;

/// The table for people.
pub fn markdown(results: &[Measured]) -> String {
    let mut text = String::from(
        "| bench | by | wall, ms | × real time | CPU, ms | steps | ns per step | transitions | error | error of | × floor |\n\
         | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: |\n",
    );
    for r in results {
        let transitions = r.transitions.map_or_else(|| "–".to_owned(), |n| n.to_string());
        text += &format!(
            "| {} | {} | {:.3} | {:.0} | {:.3} | {} | {:.1} | {transitions} | {:.1e} | {} | {:.2} |\n",
            r.bench,
            r.by,
            r.time.wall_ms,
            real_time(r),
            r.time.cpu_ms,
            r.steps,
            per_step(r),
            r.error,
            r.error_of,
            r.ratio,
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

/// The same for machines.
pub fn json(results: &[Measured], built: &[Built]) -> String {
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
