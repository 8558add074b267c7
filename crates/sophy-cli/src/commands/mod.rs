mod check;
mod convert;
mod explain;
mod flags;
mod fmt;
mod info;
mod new;
mod plot;
mod run;

use crate::arguments::{Arguments, Command};
use crate::exit::Exit;
use crate::terminal::Terminal;
use sophy::Root;

/// What was asked to be run: the component said, or the one that is implied.
fn root(system: Option<&str>) -> Root<'_> {
    system.map_or(Root::Implied, Root::Named)
}

/// Does what was asked for.
pub(crate) fn execute(arguments: Arguments) -> Exit {
    let terminal = Terminal::new(&arguments.output);
    match arguments.command {
        Command::Run(run) => run::run(&run, &terminal),
        Command::Check(check) => check::check(&check, &terminal),
        Command::Info(info) => info::info(&info, &terminal),
        Command::New(new) => new::new(&new, &terminal),
        Command::Explain(explain) => explain::explain(&explain, &terminal),
        Command::Fmt(fmt) => fmt::fmt(&fmt, &terminal),
        Command::Convert(convert) => convert::convert(&convert, &terminal),
        Command::Plot(plot) => plot::plot(&plot, &terminal),
    }
}
