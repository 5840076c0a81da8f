//! Progress bars on standard error.

use hangpose::Monitor;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

/// Length of the bar in steps of progress.
const STEPS: u64 = 1000;

/// A bar of how many pairs are done and how long the rest takes, hidden if standard error is not a terminal.
pub(super) fn of_pairs(count: usize) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {human_pos} of {human_len} pairs, {eta} left");
    ProgressBar::new(count as u64).with_style(style.expect("the template is valid"))
}

/// Runs `work` and, if standard error is a terminal, shows the mean progress of `monitors` until it ends.
pub(super) fn show_while<T: Send>(monitors: &[&Monitor], work: impl FnOnce() -> T + Send) -> T {
    if !std::io::stderr().is_terminal() {
        return work();
    }
    std::thread::scope(|scope| {
        let worker = scope.spawn(work);
        let style = ProgressStyle::with_template("{bar:40} {percent:>3} %").expect("the template is valid");
        let bar = ProgressBar::new(STEPS).with_style(style);
        while !worker.is_finished() {
            let mean = monitors.iter().map(|m| m.progress()).sum::<f32>() / monitors.len() as f32;
            bar.set_position((mean * STEPS as f32) as u64);
            std::thread::sleep(Duration::from_millis(20));
        }
        bar.finish_and_clear();
        worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}
