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
    let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {eta}") {
        bar.set_style(style);
    }
    bar
}
