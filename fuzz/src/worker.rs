//! One process that tries inputs until one breaks something, and says how far it has come.
//!
//! A line of its output is `at INDEX`, `found INDEX CAUSE` or, at the end, `tally …`. Whoever started it learns of
//! a stack overflow by its death.

use crate::corpus::Corpus;
use crate::mutate::input;
use crate::tally::Tally;
use crate::target::{Cost, MEMORY, Target};
use cpu_time::ProcessTime;
use std::io::{self, Write};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// A parser has to do with the stack of an ordinary thread.
const STACK: usize = 2 << 20;
/// No input may keep the process busy for longer …
const STUCK: Duration = Duration::from_secs(20);
/// … nor take more memory.
const TOO_MUCH: usize = 2 << 30;

/// Where the last panic was, and what it said.
static PANIC: Mutex<String> = Mutex::new(String::new());

/// Which inputs a worker tries.
pub(crate) struct Task {
    pub(crate) target: Target,
    pub(crate) seed: u64,
    pub(crate) indices: Range<u64>,
    pub(crate) time: Duration,
    /// Say `at` before each input.
    pub(crate) trace: bool,
}

/// Does the task; true if nothing broke.
///
/// # Errors
/// The corpus cannot be read.
pub(crate) fn work(task: Task) -> io::Result<bool> {
    let corpus = Corpus::read(task.target.notation())?;
    guarded(move |position| {
        let begin = Instant::now();
        let mut tally = Tally::default();
        let mut sound = true;
        let mut said = Instant::now();
        say(&format!("at {}", task.indices.start));
        for index in task.indices {
            position.store(index, Ordering::Relaxed);
            if task.trace || said.elapsed() > Duration::from_millis(500) {
                say(&format!("at {index}"));
                said = Instant::now();
            }
            if begin.elapsed() > task.time {
                break;
            }
            let input = input(&corpus, task.seed, index);
            match survives(task.target, &input) {
                Ok(cost) => tally.add(index, input.len(), cost),
                Err(cause) => {
                    say(&format!("found {index} {cause}"));
                    sound = false;
                    break;
                }
            }
        }
        tally.elapsed = begin.elapsed();
        say(&format!("tally {tally}"));
        sound
    })
}

/// Tries one input in a process of its own; true if nothing broke.
///
/// # Errors
/// There is no further thread.
pub(crate) fn check_one(target: Target, input: Vec<u8>) -> io::Result<bool> {
    guarded(move |_| match survives(target, &input) {
        Ok(cost) => {
            say(&format!("{} bytes, {cost:?}", input.len()));
            true
        }
        Err(cause) => {
            say(&format!("found 0 {cause}"));
            false
        }
    })
}

/// Runs `job` with a small stack, and ends the process if it hangs or takes all memory.
fn guarded(job: impl FnOnce(&AtomicU64) -> bool + Send + 'static) -> io::Result<bool> {
    static POSITION: AtomicU64 = AtomicU64::new(0);
    std::panic::set_hook(Box::new(|panic| {
        if let Ok(mut message) = PANIC.lock() {
            let place = panic.location().map(ToString::to_string).unwrap_or_default();
            let said: String = panic.payload_as_str().unwrap_or("").chars().take(120).collect();
            *message = format!("{place}: {}", said.replace('\n', " "));
        }
    }));
    let worker = thread::Builder::new().stack_size(STACK).spawn(|| job(&POSITION))?;
    let mut since = (0, ProcessTime::now());
    while !worker.is_finished() {
        thread::sleep(Duration::from_millis(20));
        let position = POSITION.load(Ordering::Relaxed);
        if position != since.0 {
            since = (position, ProcessTime::now());
        }
        let stuck = (since.1.elapsed() > STUCK).then_some("hang");
        let swollen = (MEMORY.current_usage() > TOO_MUCH).then_some("memory: more than 2 GiB");
        if let Some(cause) = stuck.or(swollen) {
            say(&format!("found {position} {cause}"));
            std::process::exit(1);
        }
    }
    Ok(worker.join().unwrap_or(false))
}

fn survives(target: Target, input: &[u8]) -> Result<Cost, String> {
    catch_unwind(AssertUnwindSafe(|| target.check(input))).unwrap_or_else(|_| {
        let message = PANIC.lock().map(|message| message.clone()).unwrap_or_default();
        Err(format!("panic at {message}"))
    })
}

fn say(line: &str) {
    // Nobody is left to tell if this fails.
    let mut out = io::stdout().lock();
    let _ = writeln!(out, "{line}");
    let _ = out.flush();
}
