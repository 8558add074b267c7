//! Peers that are wheels of Python, each a script in `benches/peers` that answers one line of JSON with another.

use super::wheels::{WHEELS, python};
use super::{Outcome, PATIENCE, Solver};
use crate::measure::Time;
use crate::problem::Problem;
use serde_json::{Value, json};
use std::cell::RefCell;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::rc::Rc;

/// One method of a script; its methods share the process.
struct Peer {
    script: Rc<RefCell<Script>>,
    by: String,
    method: String,
    problems: Vec<String>,
}

/// A script that runs.
struct Script {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

/// All wheels that can be had; a note on the terminal for each that cannot.
pub fn all() -> Vec<Box<dyn Solver>> {
    let python = python();
    let mut all = Vec::new();
    for wheel in WHEELS {
        match start(&python, wheel) {
            Ok(peers) => all.extend(peers.into_iter().map(|peer| Box::new(peer) as Box<dyn Solver>)),
            Err(why) => eprintln!("left out: {wheel} ({why})"),
        }
    }
    all
}

fn start(python: &Path, wheel: &str) -> Result<Vec<Peer>, String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers").join(format!("{wheel}_peer.py"));
    let mut child = Command::new(python)
        .arg(script)
        // Problems this small gain nothing by threads, and one is what all others have.
        .env("OMP_NUM_THREADS", "1")
        .env("OPENBLAS_NUM_THREADS", "1")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(|error| format!("{}: {error}", python.display()))?;
    let (Some(requests), Some(answers)) = (child.stdin.take(), child.stdout.take()) else {
        return Err("it has no pipes".to_owned());
    };
    let mut script = Script { child, requests, answers: BufReader::new(answers) };
    let hello = script.answer().map_err(|_| format!("{} has no such wheel", python.display()))?;
    let by = format!("{wheel} {}", hello["version"].as_str().unwrap_or_default());
    let script = Rc::new(RefCell::new(script));
    let methods = hello["methods"].as_object().cloned().unwrap_or_default();
    let peer = |(method, problems): (String, Value)| Peer {
        script: Rc::clone(&script),
        by: by.clone(),
        method,
        problems: problems
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .map(str::to_owned)
            .collect(),
    };
    Ok(methods.into_iter().map(peer).collect())
}

impl Script {
    fn ask(&mut self, request: &Value) -> Result<Value, String> {
        writeln!(self.requests, "{request}").map_err(|error| error.to_string())?;
        self.answer()
    }

    fn answer(&mut self) -> Result<Value, String> {
        let mut line = String::new();
        match self.answers.read_line(&mut line) {
            Ok(0) => Err("it ended".to_owned()),
            Ok(_) => serde_json::from_str(&line).map_err(|error| error.to_string()),
            Err(error) => Err(error.to_string()),
        }
    }
}

impl Drop for Script {
    fn drop(&mut self) {
        // It has nothing to lose, and it ends anyway when its input does.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Solver for Peer {
    fn by(&self) -> String {
        self.by.clone()
    }

    fn method(&self) -> &str {
        &self.method
    }

    fn can(&self, problem: Problem) -> bool {
        self.problems.iter().any(|name| name == problem.name())
    }

    fn solve(&mut self, problem: Problem, stop: f64, setting: f64) -> Result<Outcome, String> {
        let answer = self.script.borrow_mut().ask(&json!({
            "problem": problem.name(),
            "method": self.method,
            "tolerance": setting,
            "stop": stop,
            "instants": problem.instants(),
            "patience": PATIENCE,
        }))?;
        if let Some(why) = answer["failure"].as_str() {
            return Err(why.to_owned());
        }
        let numbers = |value: &Value| -> Vec<f64> {
            // What is no number comes as null and must not pass for one.
            value.as_array().into_iter().flatten().map(|x| x.as_f64().unwrap_or(f64::NAN)).collect()
        };
        Ok(Outcome {
            states: answer["states"].as_array().into_iter().flatten().map(numbers).collect(),
            transitions: numbers(&answer["transitions"]),
            steps: answer["steps"].as_u64().unwrap_or_default(),
            time: Time {
                wall_ms: answer["wall_ms"].as_f64().unwrap_or(f64::NAN),
                cpu_ms: answer["cpu_ms"].as_f64().unwrap_or(f64::NAN),
            },
        })
    }
}
