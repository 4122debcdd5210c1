//! Answers requests: reads one from each line of standard input, and writes one response to each line of
//! standard output.

use std::io::{self, BufRead, Write};

fn main() -> io::Result<()> {
    let mut output = io::stdout().lock();
    for request in io::stdin().lock().lines() {
        writeln!(output, "{}", sixfold_explain::respond(&request?))?;
    }
    Ok(())
}
