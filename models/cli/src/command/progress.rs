//! A progress bar for long work, on terminals only.

use std::io::IsTerminal;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Fewer items than this are done before anyone reads a bar.
const LONG: usize = 20;

/// A bar for `count` items on standard error; invisible for short work, and where standard error is no terminal.
pub(super) fn bar(count: usize) -> ProgressBar {
    if count < LONG || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    styled(count as u64, "{bar:40} {pos}/{len} {eta}")
}

/// A bar for `count` steps of which `done` are done, with room for a message; invisible where standard error is no
/// terminal.
pub(super) fn steps(count: u64, done: u64) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let bar = styled(count, "{bar:40} {pos}/{len} {eta} {msg}");
    bar.set_position(done);
    bar.reset_eta();
    bar
}

fn styled(count: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}
