//! A progress bar on standard error while work goes on.

use hangpose::Monitor;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::Duration;

const STEPS: u64 = 1000;

/// Runs `work` and shows the mean progress of `monitors` meanwhile, if standard error is a terminal.
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
