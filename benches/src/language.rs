//! `language`: from the text of a model to a run that is ready, stage by stage.

use crate::memory;
use sophy_analysis::{Root, analyse, read_hsml};
use sophy_codegen::{Parameters, compile};
use sophy_diagnostics::{MemoryWorld, Sources};
use sophy_ir::Model;
use sophy_passes::{PIPELINE, flatten};
use sophy_run::{Experiment, Quantum, QuantumRule, Run};
use sophy_testkit::cells::ring_text;
use std::fmt::Write;
use std::sync::Arc;
use std::time::Instant;

/// One row of the table.
#[derive(Clone, Debug)]
pub struct Told {
    /// What the text is of.
    pub text: &'static str,
    /// Its lines.
    pub lines: usize,
    /// States of the system; 0 if the text is only checked.
    pub states: usize,
    /// Each stage with its time, ms.
    pub stages: Vec<(&'static str, f64)>,
    /// Memory of the model, the system and the run that is ready, bytes.
    pub held: usize,
    /// The most memory that was needed at a time, bytes.
    pub peak: usize,
}

impl Told {
    /// All stages, ms.
    pub fn total_ms(&self) -> f64 {
        self.stages.iter().map(|(_, ms)| ms).sum()
    }

    /// What times are divided by: states, or lines where there are none.
    pub fn units(&self) -> usize {
        if self.states > 0 { self.states } else { self.lines }
    }
}

/// Texts that are checked, and texts that are made ready; all of them, or those of one kind.
pub fn bench(only: Option<&str>) -> Vec<Told> {
    let mut texts = Vec::new();
    texts.extend([200, 2000].map(|copies| ("varied components", varied(copies), false)));
    texts.extend([333, 3333, 33_333, 333_333].map(|cells| ("copies", ring_text(cells), true)));
    texts.push(("distinct equations", distinct(100_000), true));
    texts.retain(|(name, ..)| only.is_none_or(|only| name.starts_with(only)));
    texts.iter().map(|(name, text, ready)| median(name, text, *ready)).collect()
}

/// The median of five by the time in all; memory is counted in a run of its own.
fn median(name: &'static str, text: &str, ready: bool) -> Told {
    let mut told: Vec<Told> = (0..5).map(|_| tell(name, text, ready)).collect();
    told.sort_unstable_by(|a, b| a.total_ms().total_cmp(&b.total_ms()));
    let (Told { held, .. }, peak) = memory::peak_of(|| tell(name, text, ready));
    Told { held, peak, ..told.swap_remove(2) }
}

/// Takes `text` as far as it goes.
fn tell(name: &'static str, text: &str, ready: bool) -> Told {
    let mut stages = Vec::new();
    let model = model(text, &mut stages);
    let (states, held) = if ready { make_ready(&model, &mut stages) } else { (0, memory::held()) };
    Told { text: name, lines: text.lines().count(), states, stages, held, peak: 0 }
}

/// The model that a text says; what each stage took goes to `stages`.
pub fn model(text: &str, stages: &mut Vec<(&'static str, f64)>) -> Model {
    let mut sources = Sources::default();
    let reading = timed("read", stages, || read_hsml(&mut sources, "bench.hsml", text.as_bytes()));
    assert!(!reading.diagnostics.has_errors(), "{:?}", reading.diagnostics.iter().next());
    let world = MemoryWorld::default();
    let (model, mistakes) = timed("analyse", stages, || {
        analyse(&reading.declarations, Root::Implied, reading.source, &sources, &world)
    });
    assert!(!mistakes.has_errors(), "{:?}", mistakes.iter().next());
    model.expect("a model without mistakes")
}

/// The number of states, and the memory when the run is ready.
fn make_ready(model: &Model, stages: &mut Vec<(&'static str, f64)>) -> (usize, usize) {
    let mut system = timed("flatten", stages, || flatten(model)).expect("no loops");
    timed("lift", stages, || {
        for pass in PIPELINE {
            (pass.run)(&mut system);
        }
    });
    let system = Arc::new(system);
    timed("compile", stages, || compile(&system, &Parameters::default(), 2)).expect("finite parameters");
    let experiment = Experiment {
        quanta: vec![QuantumRule { pattern: "*".to_owned(), quantum: Quantum::absolute(1e-3) }],
        ..Experiment::default()
    };
    // Compiles a second time.
    let mut run = timed("start", stages, || Run::new(Arc::clone(&system), &experiment)).expect("it starts");
    run.journal.stop();
    let compile = stages.iter().find(|(stage, _)| *stage == "compile").map_or(0.0, |(_, ms)| *ms);
    if let Some((_, ms)) = stages.last_mut() {
        *ms = (*ms - compile).max(0.0);
    }
    (run.system().states.len(), memory::held())
}

fn timed<R>(name: &'static str, stages: &mut Vec<(&'static str, f64)>, stage: impl FnOnce() -> R) -> R {
    let begin = Instant::now();
    let result = stage();
    stages.push((name, 1e3 * begin.elapsed().as_secs_f64()));
    result
}

/// One component, each of whose equations has another form.
fn distinct(states: usize) -> String {
    let (mut declarations, mut equations) = (String::new(), String::new());
    let functions = ["sin", "cos", "tanh", "atan"];
    let operators = ["+", "-", "*"];
    for i in 1..=states {
        let (before, after) = ((i + states - 2) % states + 1, i % states + 1);
        writeln!(declarations, "    state x{i} := {}.5;", i % 7).expect("text");
        // The digits of the number choose the form.
        let mut right = format!("-{}*x{i}", i % 9 + 1);
        let mut rest = i;
        let mut argument = before;
        while rest > 0 {
            let (function, operator) = (functions[rest % 4], operators[rest / 4 % 3]);
            right = format!("{right} {operator} {function}(x{argument})");
            argument = if argument == before { after } else { i };
            rest /= 12;
        }
        writeln!(equations, "    der(x{i}) = {right};").expect("text");
    }
    format!(
        "CTC Distinct is\nbody\n  declarations\n{declarations}  end declarations;\n  dynamics\n{equations}  end \
         dynamics;\nend body;\n"
    )
}

/// Components of four kinds, with a system of one of each.
fn varied(copies: usize) -> String {
    let mut text = String::new();
    for i in 1..=copies {
        write!(
            text,
            "\
%% A tank with a valve at its bottom.
CTC Tank{i} is
interface
  input(inflow, signal, \"m3/s\");
  output(level, signal, (0, 10), \"m\");
  knob(area, (0, 5), \"m2\");
end interface;
body
  declarations
    state level := 1 \"m\";
    mode openings : integer := 0;
  end declarations;
  location Closed
    dynamics
      der(level) = inflow/area;
    end dynamics;
    transition full when level > high goto Open do openings := openings + 1; end transition;
  end location;
  location Open
    dynamics
      der(level) = (inflow - c*sqrt(max(level, 0)))/area;
    end dynamics;
    transition low_again when level < low goto Closed;
  end location;
  assignments
    area : 2 \"m2\";
    high : 3.{i} \"m\";
    low  : 0.5 \"m\";
    c    : 0.8;
  end assignments;
end body;

%% Measures and acts in steps.
DTC Controller{i} is
interface
  input(level, real, \"m\");
  output(command, real);
end interface;
body
  declarations
    state error_old := 0 \"m\";
    local slope;
    tsample every 0.1;
    priority {i};
  end declarations;
  update
    slope := (level - wanted - error_old)/Ts;
    error_old := level - wanted;
  end update;
  output
    command = -(K1*(level - wanted) + K2*slope);
  end output;
  assignments
    wanted : 2 \"m\";
    Ts : 0.1 \"s\";
    K1 : 4.{i} \"1/m\";
    K2 : 0.2 \"s/m\";
  end assignments;
end body;

%% Watches over it.
LBC Guard{i} is
interface
  input(alarm, boolean);
  output(status, string, {{\"idle\", \"busy\"}});
end interface;
body
  declarations
    mode m in {{\"idle\", \"busy\"}} := \"idle\";
  end declarations;
  rules
    when rises(alarm) and m = \"idle\" do m := \"busy\"; end when;
    when falls(alarm) do m := \"idle\"; end when;
  end rules;
  output
    status = m;
  end output;
end body;

"
        )
        .expect("text");
    }
    text + "\
CTC Rain is
interface
  output(rain, signal, \"m3/s\");
end interface;
body
  output
    rain = peak*(1 + sin(w*time));
  end output;
  assignments
    peak : 0.5 \"m3/s\";
    w : 0.1 \"rad/s\";
  end assignments;
end body;

SYSTEM Plant is
body
  components
    rain : Rain;
    tank : Tank1;
    control : Controller1;
  end components;
  connections
    rain.rain -> tank.inflow;
    tank.level -> control.level;
  end connections;
end body;
"
}
