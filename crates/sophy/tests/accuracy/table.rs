//! The tables of the book, from runs.

use crate::accuracy::cases::{Case, cases};
use crate::accuracy::measure::{Measured, measure};
use sophy::Method;

const TOLERANCES: [f64; 5] = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Errors of the default engine at all tolerances, and the worst quotient of error and tolerance of each engine, of the
/// cases with `part` in their names.
pub(crate) fn tables(part: &str) -> String {
    let mut errors =
        "| | 1e-2 | 1e-3 | 1e-4 | 1e-5 | 1e-6 | times, 1e-4 | same instants, 1e-4 | steps, 1e-4 |\n\
                      | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
            .to_owned();
    let mut quotients = "| | QSS2 | QSS3 | LIQSS2 | LIQSS3 | QSS1 | LIQSS1 |\n\
                         | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for case in cases().into_iter().filter(|case| case.name.contains(part)) {
        // A heavy model takes minutes at the smallest.
        let tolerances = &TOLERANCES[..if case.heavy { 4 } else { 5 }];
        let runs = |method: Method, tolerances: &[f64]| -> Vec<Measured> {
            tolerances.iter().map(|&tolerance| measure(&case, method, tolerance)).collect()
        };
        let default = runs(Method::Qss2, tolerances);
        errors += &format!("| {} | {} |\n", case.name, of_default(&case, &default).join(" | "));
        let mut cells = vec![worst(&default)];
        cells.extend(
            [Method::Qss3, Method::Liqss2, Method::Liqss3].map(|method| worst(&runs(method, tolerances))),
        );
        // A first order takes too many steps for a heavy model or a small tolerance.
        cells.extend(
            [Method::Qss1, Method::Liqss1].map(|method| {
                if case.heavy { "–".to_owned() } else { worst(&runs(method, &TOLERANCES[..2])) }
            }),
        );
        quotients += &format!("| {} | {} |\n", case.name, cells.join(" | "));
    }
    format!("{errors}\n{quotients}")
}

/// Errors, one for each tolerance; then what there is to say of the run at 1e-4.
fn of_default(case: &Case, runs: &[Measured]) -> Vec<String> {
    let usual = &runs[2];
    let mut cells: Vec<String> = runs.iter().map(|run| number(run, run.states)).collect();
    cells.resize(TOLERANCES.len(), "–".to_owned());
    let time = if case.events.is_empty() { "–".to_owned() } else { number(usual, usual.times) };
    cells.extend([time, number(usual, usual.instants), usual.steps.to_string()]);
    cells
}

/// The largest of error over tolerance, from 1e-2 on down.
fn worst(runs: &[Measured]) -> String {
    let quotients = runs.iter().zip(TOLERANCES).map(|(run, tolerance)| run.error() / tolerance);
    let worst = quotients.fold(0.0, f64::max);
    match worst {
        f64::INFINITY => "other events".to_owned(),
        worst if worst < 0.1 => "< 0.1".to_owned(),
        worst if worst < 10.0 => format!("{worst:.1}"),
        worst => format!("**{worst:.0}**"),
    }
}

fn number(run: &Measured, value: f64) -> String {
    match run.other {
        Some(count) => format!("{count} events"),
        None => format!("{value:.1e}"),
    }
}
