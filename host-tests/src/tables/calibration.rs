//! Reliability of the predicted probabilities.

use super::proportion::wilson;
use super::row::{Outcome, Row, Said};
use std::fmt::Write;

/// Bounds of the bins of probability, narrower where most poses are.
const BINS: [f32; 8] = [0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.975, 1.0];

/// Reliability of the probabilities of the best poses, as a table and a plot; empty without probabilities. Further
/// poses are only simulated while none hangs, so they would be a biased sample.
pub(super) fn table(rows: &[&Row]) -> String {
    let poses: Vec<(Said, bool)> = rows
        .iter()
        .filter_map(|row| row.first())
        .filter_map(|outcome| Some((outcome.said?, Outcome::success(outcome))))
        .collect();
    if poses.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "Predicted probability and success rate of the best poses:\n\n| predicted, % | poses | predicted mean, % | success, % |\n|---|--:|--:|--:|\n",
    );
    let (mut said_means, mut shares) = (Vec::new(), Vec::new());
    for bounds in BINS.windows(2) {
        let is_in = |p: f32| (bounds[0]..bounds[1]).contains(&p) || (p == 1.0 && bounds[1] == 1.0);
        let bin: Vec<_> = poses.iter().filter(|(said, _)| is_in(said.probability)).collect();
        if bin.is_empty() {
            continue;
        }
        let mean = 100.0 * bin.iter().map(|(said, _)| said.probability).sum::<f32>() / bin.len() as f32;
        let hang = bin.iter().filter(|(_, hangs)| *hangs).count();
        let _ = writeln!(
            text,
            "| {:.1} to {:.1} | {} | {mean:.0} | {} |",
            100.0 * bounds[0],
            100.0 * bounds[1],
            bin.len(),
            wilson(hang, bin.len())
        );
        said_means.push(format!("{mean:.0}"));
        shares.push(format!("{:.0}", 100.0 * hang as f32 / bin.len() as f32));
    }
    let brier: f32 =
        poses.iter().map(|(said, hangs)| (said.probability - f32::from(u8::from(*hangs))).powi(2)).sum();
    let _ = writeln!(
        text,
        "\nBrier score {:.3}.\n\n```mermaid\nxychart-beta\n  title \"Reliability: predicted (bars) and observed (line), %\"\n  \
         x-axis \"predicted mean of the bin, %\" [{}]\n  y-axis \"%\" 0 --> 100\n  bar [{}]\n  line [{}]\n```\n",
        brier / poses.len() as f32,
        said_means.join(", "),
        said_means.join(", "),
        shares.join(", ")
    );
    text
}
