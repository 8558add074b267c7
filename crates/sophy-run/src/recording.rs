//! Rows are made beside the run: the run only writes its journal, a thread of its own turns that into rows.

use crate::recorder::Recorder;
use sophy_field::{Journal, Record};
use sophy_record::{Sink, SinkError};
use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, RecvError, SendError, Sender, channel};
use std::thread::{Builder, Scope, ScopedJoinHandle};

/// So many lines of the journal (3 MB) may wait to be made into rows; then the run waits for a slow sink. More of them
/// leave the caches, and then cost the run itself.
const MOST_WAITING: usize = 1 << 16;
/// Room in a new block; what is not used costs nothing.
const ROOM: usize = 1 << 15;

/// What makes rows, and where they go.
pub(crate) struct Rows<'a> {
    pub(crate) recorder: &'a mut Recorder,
    pub(crate) sinks: Vec<&'a mut dyn Sink>,
}

/// Where rows are made: here as long as a run is short, then in a thread beside it.
///
/// One thread at a time makes rows, in the order of the journal, so they do not depend on where they are made or on who
/// waits for whom. After an error of a sink no row is made; the next call gives the error.
pub(crate) enum Recording<'scope, 'a> {
    Here(Rows<'a>),
    Beside(Beside<'scope, 'a>),
}

/// The way to the thread that makes rows.
pub(crate) struct Beside<'scope, 'a> {
    orders: Sender<Order>,
    /// Blocks come back when their rows are made, and are used again: new memory costs the run more than old.
    done: Receiver<Vec<Record>>,
    spare: Vec<Vec<Record>>,
    /// Lines sent that have not come back.
    waiting: usize,
    /// Gives `None` only if it was given no rows to begin with.
    thread: ScopedJoinHandle<'scope, Option<Result<Rows<'a>, SinkError>>>,
}

enum Order {
    Consume(Vec<Record>),
    /// To make durable what was consumed, and to say so.
    Flush(Sender<()>),
}

impl<'scope, 'a: 'scope> Recording<'scope, 'a> {
    /// From now on beside the run. Where no thread can be had, rows are made here as before.
    pub(crate) fn beside(self, scope: &'scope Scope<'scope, '_>) -> Self {
        let Recording::Here(rows) = self else { return self };
        let (orders, ordered) = channel();
        let (send_back, done) = channel();
        // A thread that cannot start takes with it what it was given; so it gets the rows when it has started.
        let (hand, handed) = channel();
        let work = move || handed.recv().ok().map(|rows| make_rows(rows, &ordered, &send_back));
        let Ok(thread) = Builder::new().name("recording".to_owned()).spawn_scoped(scope, work) else {
            return Recording::Here(rows);
        };
        match hand.send(rows) {
            Ok(()) => Recording::Beside(Beside { orders, done, spare: Vec::new(), waiting: 0, thread }),
            Err(SendError(rows)) => Recording::Here(rows),
        }
    }

    /// Takes what stands in the journal, which is empty afterwards.
    pub(crate) fn consume(self, journal: &mut Journal) -> Result<Self, SinkError> {
        match self {
            Recording::Here(mut rows) => {
                rows.consume(journal.lines())?;
                journal.clear();
                Ok(Recording::Here(rows))
            }
            Recording::Beside(beside) => beside.consume(journal).map(Recording::Beside),
        }
    }

    /// Makes durable what was taken until now.
    pub(crate) fn flush(self) -> Result<Self, SinkError> {
        match self {
            Recording::Here(mut rows) => {
                rows.flush()?;
                Ok(Recording::Here(rows))
            }
            Recording::Beside(beside) => beside.flush().map(Recording::Beside),
        }
    }

    /// Gives the rows that complete the result at `end` (s), and the number of all.
    pub(crate) fn finish(self, end: f64) -> Result<u64, SinkError> {
        let Rows { recorder, mut sinks } = match self {
            Recording::Here(rows) => rows,
            Recording::Beside(beside) => beside.end()?,
        };
        recorder.finish(end, &mut sinks)?;
        Ok(recorder.rows())
    }
}

impl<'a> Beside<'_, 'a> {
    fn consume(mut self, journal: &mut Journal) -> Result<Self, SinkError> {
        let lines = journal.lines().len();
        while let Ok(block) = self.done.try_recv() {
            self.take_back(block);
        }
        while self.waiting > 0 && self.waiting + lines > MOST_WAITING {
            match self.done.recv() {
                Ok(block) => self.take_back(block),
                Err(RecvError) => return Err(self.why()),
            }
        }
        let spare = self.spare.pop().unwrap_or_else(|| Vec::with_capacity(lines.max(ROOM)));
        self.waiting += lines;
        match self.orders.send(Order::Consume(journal.exchange(spare))) {
            Ok(()) => Ok(self),
            Err(SendError(_)) => Err(self.why()),
        }
    }

    fn take_back(&mut self, mut block: Vec<Record>) {
        self.waiting -= block.len();
        block.clear();
        self.spare.push(block);
    }

    fn flush(self) -> Result<Self, SinkError> {
        let (say, said) = channel();
        // Where the order finds nobody, nobody says that it was done.
        let _ = self.orders.send(Order::Flush(say));
        match said.recv() {
            Ok(()) => Ok(self),
            Err(RecvError) => Err(self.why()),
        }
    }

    /// Why the thread has ended before it was asked to.
    fn why(self) -> SinkError {
        self.end().err().unwrap_or_else(unknown)
    }

    /// Waits until all rows are made.
    fn end(self) -> Result<Rows<'a>, SinkError> {
        drop(self.orders);
        match self.thread.join() {
            Ok(Some(made)) => made,
            Ok(None) => Err(unknown()),
            Err(panic) => resume_unwind(panic),
        }
    }
}

fn unknown() -> SinkError {
    SinkError { sink: "the result".to_owned(), source: "its thread has ended".into() }
}

/// The work of the thread, until no order can come.
fn make_rows<'a>(
    mut rows: Rows<'a>,
    ordered: &Receiver<Order>,
    send_back: &Sender<Vec<Record>>,
) -> Result<Rows<'a>, SinkError> {
    for order in ordered {
        match order {
            Order::Consume(block) => {
                rows.consume(&block)?;
                // Nobody takes blocks back any more when the run is over.
                let _ = send_back.send(block);
            }
            Order::Flush(say) => {
                rows.flush()?;
                let _ = say.send(());
            }
        }
    }
    Ok(rows)
}

impl Rows<'_> {
    fn consume(&mut self, lines: &[Record]) -> Result<(), SinkError> {
        self.recorder.consume(lines, &mut self.sinks)
    }

    fn flush(&mut self) -> Result<(), SinkError> {
        self.sinks.iter_mut().try_for_each(|sink| sink.flush())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::expect_used, clippy::unwrap_used)] // a test may panic

    use super::*;
    use crate::{Experiment, Run};
    use sophy_field::StateIndex;
    use sophy_record::{Metadata, Row};
    use sophy_testkit::problems::oscillator;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
    use std::time::Duration;

    /// Does not take its first row before it is allowed to.
    struct Gate {
        open: Receiver<()>,
        rows: usize,
        safe: usize,
    }

    impl Sink for Gate {
        fn row(&mut self, _: Row<'_>) -> Result<(), SinkError> {
            if self.rows == 0 {
                self.open.recv().expect("it is opened");
            }
            self.rows += 1;
            Ok(())
        }

        fn flush(&mut self) -> Result<(), SinkError> {
            self.safe = self.rows;
            Ok(())
        }

        fn finish(&mut self, _: &Metadata) -> Result<(), SinkError> {
            Ok(())
        }
    }

    const PARTS: usize = 4;
    const BLOCKS: usize = 3 * PARTS;

    /// Steps of one state, each at its own time.
    fn write(journal: &mut Journal, block: usize) {
        let lines = MOST_WAITING / PARTS;
        for k in 0..lines {
            let time = (block * lines + k + 1) as f64;
            journal.push(Record::Step { time, state: StateIndex(0) });
        }
    }

    #[test]
    fn a_run_waits_for_a_slow_sink_and_nothing_is_lost() {
        let experiment = Experiment { stop: 1e9, ..Experiment::default() };
        let system = Arc::new(sophy_passes::lower(&oscillator()).expect("lowers"));
        let run = Run::new(system, &experiment).expect("starts");
        let mut recorder = Recorder::new(&run, &experiment).expect("records");
        let (open, opened) = channel();
        let mut gate = Gate { open: opened, rows: 0, safe: 0 };
        let sent = AtomicUsize::new(0);
        let (rows, ahead) = std::thread::scope(|scope| {
            let watch = scope.spawn(|| {
                // As far as it gets; a little later it is no farther.
                while sent.load(SeqCst) < PARTS {
                    std::thread::sleep(Duration::from_millis(5));
                }
                std::thread::sleep(Duration::from_millis(100));
                let ahead = sent.load(SeqCst);
                open.send(()).expect("the sink waits");
                ahead
            });
            let rows = Rows { recorder: &mut recorder, sinks: vec![&mut gate] };
            let mut recording = Recording::Here(rows).beside(scope);
            assert!(matches!(recording, Recording::Beside(_)));
            let mut journal = Journal::wanted();
            for block in 0..BLOCKS {
                write(&mut journal, block);
                recording = recording.consume(&mut journal).expect("it is taken");
                assert!(journal.is_empty());
                sent.fetch_add(1, SeqCst);
            }
            recording = recording.flush().expect("it is flushed");
            let rows = recording.finish((BLOCKS * MOST_WAITING) as f64).expect("it is whole");
            (rows, watch.join().expect("it ends"))
        });
        assert_eq!(ahead, PARTS, "blocks that were sent while the sink took none");
        assert_eq!(rows as usize, gate.rows);
        // One for the start, and one for the end.
        assert_eq!(gate.rows, BLOCKS * MOST_WAITING / PARTS + 2);
        // The instant of the last line is complete only when something later comes.
        assert_eq!(gate.safe, gate.rows - 2);
    }
}
