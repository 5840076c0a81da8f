//! Tables of the outcomes on scans in Markdown.

use super::loss::Loss;
use super::proportion::wilson;
use super::row::{Outcome, Row};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Probability from which a pose counts as said to hang.
const SURE: f32 = 0.95;
/// Bounds of the bins of probability.
const BINS: [f32; 4] = [0.5, 0.8, 0.95, 1.0];

/// The three tables: success on each scan under each profile, causes of loss, and reliability of the probabilities.
pub fn tables(rows: &[Row]) -> String {
    let mut methods: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        methods.entry(name(row)).or_default().push(row);
    }
    [summary(&methods), losses(&methods), reliability(&methods)].join("\n") + "\n"
}

/// Name of the scan and the profile.
fn name(row: &Row) -> String {
    format!("{} | {}", row.scan.as_deref().unwrap_or("exact"), row.profile)
}

fn fitting<'r>(rows: &[&'r Row]) -> Vec<&'r Row> {
    rows.iter().copied().filter(|row| row.fits).collect()
}

fn is_sure(outcome: &Outcome) -> bool {
    outcome.said.is_some_and(|said| said.probability >= SURE)
}

fn summary(methods: &BTreeMap<String, Vec<&Row>>) -> String {
    let mut text = String::from(
        "| scan | profile | pairs | found | success | robust | said 95 % and hangs | said 95 % but fails | top 10 | \
         rejected | seconds, median |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for (name, rows) in methods {
        let fits = fitting(rows);
        let count = |holds: &dyn Fn(&Outcome) -> bool| {
            wilson(fits.iter().filter(|row| row.first().is_some_and(holds)).count(), fits.len())
        };
        let within = fits.iter().filter(|row| row.succeeds_within(10)).count();
        let rest: Vec<_> = rows.iter().filter(|row| !row.fits && !row.doubtful).collect();
        let rejected = rest.iter().filter(|row| row.rejection.is_some()).count();
        let mut seconds: Vec<f64> = fits.iter().map(|row| row.seconds).collect();
        seconds.sort_by(f64::total_cmp);
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {:.3} |",
            fits.len(),
            count(&|_| true),
            count(&Outcome::success),
            count(&|outcome| outcome.success() && outcome.robust),
            count(&|outcome| outcome.success() && is_sure(outcome)),
            count(&|outcome| !outcome.success() && is_sure(outcome)),
            wilson(within, fits.len()),
            wilson(rejected, rest.len()),
            seconds.get(seconds.len() / 2).copied().unwrap_or_default(),
        );
    }
    text
}

/// Pairs that fit, by the cause for which their best pose fails.
fn losses(methods: &BTreeMap<String, Vec<&Row>>) -> String {
    let names: Vec<&str> = Loss::ALL.into_iter().map(Loss::name).collect();
    let mut text = format!(
        "| scan | profile | pairs | success | {} |\n|---|---|--:|--:|{}\n",
        names.join(" | "),
        "--:|".repeat(names.len())
    );
    for (name, rows) in methods {
        let fits = fitting(rows);
        let of = |loss: Option<Loss>| fits.iter().filter(|row| row.loss == loss).count();
        let causes: Vec<String> = Loss::ALL.into_iter().map(|loss| of(Some(loss)).to_string()).collect();
        let _ = writeln!(text, "| {name} | {} | {} | {} |", fits.len(), of(None), causes.join(" | "));
    }
    text
}

/// Share of the best poses that hang, by what they said.
fn reliability(methods: &BTreeMap<String, Vec<&Row>>) -> String {
    let mut text = String::from(
        "| scan | profile | said 50 to 80 %: hang | said 80 to 95 %: hang | said 95 % or more: hang |\n\
         |---|---|--:|--:|--:|\n",
    );
    for (name, rows) in methods {
        let best: Vec<&Outcome> = rows.iter().filter_map(|row| row.first()).collect();
        let cells = BINS.windows(2).map(|bounds| {
            let is_in = |p: f32| (bounds[0]..bounds[1]).contains(&p) || (p == 1.0 && bounds[1] == 1.0);
            let of = best.iter().filter(|outcome| outcome.said.is_some_and(|said| is_in(said.probability)));
            let (hang, all) =
                of.fold((0, 0), |(hang, all), outcome| (hang + usize::from(outcome.success()), all + 1));
            format!("{hang} of {all}: {}", wilson(hang, all))
        });
        let _ = writeln!(text, "| {name} | {} |", cells.collect::<Vec<_>>().join(" | "));
    }
    text
}
