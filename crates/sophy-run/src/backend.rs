use sophy_codegen::{Compiled, native};
use std::sync::Arc;

/// How equations are evaluated. The bits of a run do not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// By the interpreter first; a run that turns out to be long goes on in native code, which is made beside it.
    #[default]
    Auto,
    /// By the interpreter.
    Interpreter,
    /// By native code from the first step on.
    Native,
}

/// So many steps show that a run is worth native code.
const LONG: u64 = 20_000;

/// What a run has decided.
#[derive(Debug)]
pub(crate) struct Evaluation {
    /// Native code was made, is being made, or is not wanted.
    asked: bool,
}

impl Backend {
    /// All names that [`Backend::named`] knows.
    pub const NAMES: [&str; 3] = ["auto", "interpreter", "native"];

    /// The back end called `name`.
    pub fn named(name: &str) -> Option<Backend> {
        match name {
            "auto" => Some(Backend::Auto),
            "interpreter" => Some(Backend::Interpreter),
            "native" => Some(Backend::Native),
            _ => None,
        }
    }
}

impl Evaluation {
    /// Native code is made here and now if it is wanted from the start.
    pub(crate) fn new(backend: Backend, compiled: &Compiled) -> Self {
        if backend == Backend::Native {
            make(compiled);
        }
        Evaluation { asked: backend != Backend::Auto }
    }

    /// Called now and then with the number of steps done.
    pub(crate) fn consider(&mut self, steps: u64, compiled: &Arc<Compiled>) {
        if self.asked || steps < LONG {
            return;
        }
        self.asked = true;
        let compiled = Arc::clone(compiled);
        // Whether it is ready sooner or later, or never, changes no bit; so nobody waits for it.
        let _ = std::thread::Builder::new().name("native code".to_owned()).spawn(move || make(&compiled));
    }

    /// How many steps of `budget` may go by until it is considered again.
    pub(crate) fn burst(&self, budget: u64) -> u64 {
        if self.asked { budget } else { budget.min(LONG) }
    }
}

/// Where there is no native code, the interpreter goes on.
fn make(compiled: &Compiled) {
    if let Ok(kernels) = native(&compiled.equations, &compiled.logic) {
        // Only one is made per run.
        let _ = compiled.equations.kernels.set(kernels);
    }
}
