//! A campaign: workers one after the other, and what to do when one of them finds something or dies.

use crate::corpus::Corpus;
use crate::minimise::minimise;
use crate::mutate::{broken, input};
use crate::tally::Tally;
use crate::target::Target;
use std::io::{self, BufRead, BufReader};
use std::ops::Range;
use std::path::PathBuf;
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// After this many finds a campaign ends: something is quite broken.
const MOST_FINDS: u64 = 1000;

/// What is asked for.
pub(crate) struct Campaign {
    pub(crate) seed: u64,
    pub(crate) indices: Range<u64>,
    pub(crate) time: Duration,
}

/// Inputs that broke something in the same way.
pub(crate) struct Find {
    /// The first of them.
    pub(crate) index: u64,
    pub(crate) cause: String,
    pub(crate) file: PathBuf,
    pub(crate) times: u64,
}

/// Throws the inputs at `target`; what breaks is written to `tests/fuzz`.
///
/// # Errors
/// The corpus, a process or a file cannot be had.
pub(crate) fn run(target: Target, campaign: &Campaign) -> io::Result<(Tally, Vec<Find>)> {
    let begin = Instant::now();
    let mut tally = Tally::default();
    let mut finds: Vec<Find> = Vec::new();
    // What was broken once, then the new.
    let known = broken(&Corpus::read(target.notation())?);
    let mut left = vec![campaign.indices.clone(), known];
    while finds.iter().map(|find| find.times).sum::<u64>() < MOST_FINDS {
        let Some(indices) = left.pop() else { break };
        let time = campaign.time.saturating_sub(begin.elapsed());
        if indices.is_empty() || time.is_zero() {
            continue;
        }
        let report = watch(target, campaign.seed, indices.clone(), time, false)?;
        tally.join(&report.tally.unwrap_or_default());
        let found = match report.found {
            Some(found) => Some(found),
            None if report.status.success() => None,
            // It died without a word: go on step by step from where it was heard last.
            None => {
                let again = watch(target, campaign.seed, report.at..indices.end, Duration::MAX, true)?;
                Some(again.found.unwrap_or((again.at, format!("crash: {}", again.status))))
            }
        };
        let Some((index, cause)) = found else { continue };
        left.push(index + 1..indices.end);
        match finds.iter_mut().find(|find| alike(&find.cause, &cause)) {
            Some(find) => find.times += 1,
            None => {
                let file = keep(target, campaign.seed, index)?;
                finds.push(Find { index, cause, file, times: 1 });
            }
        }
    }
    Ok((tally, finds))
}

/// Whether two causes differ in numbers only.
fn alike(one: &str, other: &str) -> bool {
    let words = |cause: &str| cause.replace(|c: char| c.is_ascii_digit() || c == '.', "");
    words(one) == words(other)
}

/// What a worker said.
struct Report {
    at: u64,
    found: Option<(u64, String)>,
    tally: Option<Tally>,
    status: ExitStatus,
}

fn watch(target: Target, seed: u64, indices: Range<u64>, time: Duration, trace: bool) -> io::Result<Report> {
    let mut worker = Command::new(std::env::current_exe()?)
        .args(["--worker", target.name()])
        .args(
            [seed, indices.start, indices.end, time.as_secs().max(1), u64::from(trace)]
                .map(|n| n.to_string()),
        )
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()?;
    let (mut at, mut found, mut tally) = (indices.start, None, None);
    for line in worker.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()) {
        let line = line?;
        let (word, rest) = line.split_once(' ').unwrap_or((&line, ""));
        match word {
            "at" => at = rest.parse().unwrap_or(at),
            "found" => {
                let (index, cause) = rest.split_once(' ').unwrap_or((rest, ""));
                found = index.parse().ok().map(|index| (index, cause.to_owned()));
            }
            "tally" => tally = rest.parse().ok(),
            _ => {}
        }
    }
    Ok(Report { at, found, tally, status: worker.wait()? })
}

/// Makes the input smaller and writes it to the corpus.
fn keep(target: Target, seed: u64, index: u64) -> io::Result<PathBuf> {
    let notation = target.notation();
    let corpus = Corpus::read(notation)?;
    let input = input(&corpus, seed, index);
    if let Some((file, _)) = corpus.broken.iter().find(|(_, text)| *text == input) {
        return Ok(file.clone());
    }
    let file = notation.folder().join(format!("{}-{seed}-{index}.{}", target.name(), notation.extension()));
    std::fs::write(&file, &input)?;
    let smaller = minimise(target, input)?;
    std::fs::write(&file, smaller)?;
    Ok(file)
}
