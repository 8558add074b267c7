mod check;
mod convert;
mod flags;
mod info;
mod plot;
mod run;

use crate::arguments::{Arguments, Command};
use crate::exit::Exit;
use crate::terminal::Terminal;

/// Does what was asked for.
pub(crate) fn execute(arguments: Arguments) -> Exit {
    let terminal = Terminal::new(&arguments.output);
    match arguments.command {
        Command::Run(run) => run::run(&run, &terminal),
        Command::Check(check) => check::check(&check, &terminal),
        Command::Info(info) => info::info(&info, &terminal),
        Command::Convert(convert) => convert::convert(&convert, &terminal),
        Command::Plot(plot) => plot::plot(&plot, &terminal),
    }
}
