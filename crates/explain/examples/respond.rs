//! Answers requests: reads one from each line of standard input, and writes one response to each line of
//! standard output. A request can name the mesh of an earlier one as `"last"`.

use std::io::{self, BufRead, Write};

use sixfold_explain::Engine;

fn main() -> io::Result<()> {
    let mut engine = Engine::new();
    let mut output = io::stdout().lock();
    for request in io::stdin().lock().lines() {
        writeln!(output, "{}", engine.respond(&request?))?;
    }
    Ok(())
}
