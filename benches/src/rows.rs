//! What was measured, for machines: rows of JSON, each with the name of its bench.

use crate::report::{Results, per_step, real_time};
use crate::stamp::Stamp;
use serde_json::{Value, json};

pub fn json(stamp: &Stamp, results: &Results) -> String {
    let rows: Vec<Value> =
        [runs(results), points(results), scaled(results), built(results), told(results), recorded(results)]
            .concat();
    let all = json!({ "date": stamp.date, "machine": stamp.machine, "commit": stamp.commit, "rows": rows });
    format!("{all:#}\n")
}

fn runs(results: &Results) -> Vec<Value> {
    let row = |r: &crate::measure::Measured| {
        json!({
            "bench": r.bench,
            "wanted": r.wanted,
            "by": r.by,
            "engine": r.method,
            "setting": r.setting,
            "wall_ms": r.time.wall_ms,
            "cpu_ms": r.time.cpu_ms,
            "real_time_factor": real_time(r),
            "steps": r.steps,
            "ns_per_step": per_step(r),
            "transitions": r.transitions,
            "error": r.error,
            "error_of": r.error_of,
            "ratio_to_floor": r.to_floor,
            "ratio_to_ours": r.to_ours,
        })
    };
    results.runs.iter().map(row).collect()
}

fn points(results: &Results) -> Vec<Value> {
    let row = |p: &crate::precision::Point| {
        json!({
            "bench": "precision",
            "problem": p.problem.name(),
            "engine": p.method.name(),
            "quantum": p.quantum,
            "error": p.error,
            "error_of": p.problem.error_of(),
            "steps": p.steps,
            "cpu_ms": p.cpu_ms,
        })
    };
    results.points.iter().map(row).collect()
}

fn scaled(results: &Results) -> Vec<Value> {
    let row = |s: &crate::scale::Scaled| {
        json!({
            "bench": "scale",
            "system": s.system,
            "engine": s.method.name(),
            "states": s.states,
            "fronts": s.fronts,
            "steps": s.steps,
            "cpu_ms": s.cpu_ms,
            "ns_per_step": s.ns_per_step(),
            "bytes_per_state": s.bytes_per_state(),
        })
    };
    results.scaled.iter().map(row).collect()
}

fn built(results: &Results) -> Vec<Value> {
    let row = |b: &crate::build::Built| {
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
    };
    results.built.iter().map(row).collect()
}

fn told(results: &Results) -> Vec<Value> {
    let row = |t: &crate::language::Told| {
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
    };
    results.told.iter().map(row).collect()
}

fn recorded(results: &Results) -> Vec<Value> {
    let row = |r: &crate::recording::Recorded| {
        json!({
            "bench": "recording",
            "into": r.into,
            "rows": r.rows,
            "wall_ms": r.run.wall_ms,
            "engine_thread_cpu_ms": r.run.cpu_ms,
            "all_threads_cpu_ms": r.all_ms,
            "finish_wall_ms": r.finish.wall_ms,
            "wall_ratio": r.wall_ratio,
            "engine_thread_cpu_ratio": r.cpu_ratio,
            "all_threads_cpu_ratio": r.all_ratio,
        })
    };
    results.recorded.iter().map(row).collect()
}
