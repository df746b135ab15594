//! Progress of work that takes longer than about a second, on terminals only.
//!
//! A bar where many things are to be done, a spinner where it is one; both name what is worked on.

#[cfg(test)]
mod tests;

use core::time::Duration;
use std::io::IsTerminal;
use std::thread;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Work that is done sooner shows nothing.
const DELAY: Duration = Duration::from_secs(1);
/// Time between two drawings where nothing else happens.
const TICK: Duration = Duration::from_millis(200);

/// Progress through `count` things, of which `done` are done, with room for a message; on standard error if that is a
/// terminal, and invisible otherwise.
#[must_use]
pub fn bar(count: u64, done: u64) -> ProgressBar {
    let bar = hidden(count);
    if std::io::stderr().is_terminal() {
        show_after(DELAY, &bar, ProgressDrawTarget::stderr);
    }
    bar.set_position(done);
    bar.reset_eta();
    bar
}

fn hidden(count: u64) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(count), ProgressDrawTarget::hidden());
    let template = if count == 1 { "{spinner} {elapsed} {wide_msg}" } else { "{bar:40} {pos}/{len} {eta} {wide_msg}" };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// Draws the bar on `target` from `delay` on, unless it is finished or gone by then.
fn show_after(delay: Duration, bar: &ProgressBar, target: impl FnOnce() -> ProgressDrawTarget + Send + 'static) {
    let bar = bar.downgrade();
    thread::spawn(move || {
        thread::sleep(delay);
        if let Some(bar) = bar.upgrade()
            && !bar.is_finished()
        {
            bar.set_draw_target(target());
            bar.enable_steady_tick(TICK);
        }
    });
}
