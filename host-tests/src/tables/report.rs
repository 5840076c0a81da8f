//! Tables of the outcomes in Markdown.

use super::proportion::wilson;
use super::row::{Failure, Outcome, Row};
use super::{calibration, kinds};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The heading and an explanation of the terms.
pub fn heading(rows: &[Row]) -> String {
    format!(
        "# Results\n\nPrinted by `make tables` from {} rows of generated pairs, whose objects are in frames turned at random. \
         `host-tests/src/judge/verdict.rs` defines success, robust and the other terms. All rates are in percent, with the \
         95 % interval of Wilson. \"Top 5\" and \"top 10\" are the rates at which at least one of the best 5 or 10 poses \
         hangs. All verdicts are by Bullet unless ODE is named. `core/src/mechanics/kind.rs` defines the kinds in which \
         an object hangs; `host-tests/src/shapes/meant.rs` and `host-tests/src/judge/freedom.rs` judge them.\n\n",
        rows.len()
    )
}

/// A table that compares the profiles, and tables of how their best poses hang.
pub fn summary(rows: &[Row]) -> String {
    let (text, hanging) = comparison(rows);
    text + &hanging
}

fn comparison(rows: &[Row]) -> (String, String) {
    let mut profiles: Vec<&str> = rows.iter().map(|row| row.profile.as_str()).collect();
    profiles.dedup();
    let mut text = String::from(
        "| profile | pairs | found | success | robust | top 10 | rejected | seconds, median |\n|---|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    let (mut notes, mut hanging) = (String::new(), String::new());
    for profile in profiles {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.profile == profile).collect();
        let [fits, doubtful, rest] = by_fit(&rows);
        let count =
            |holds: &dyn Fn(&Row) -> bool| wilson(fits.iter().filter(|row| holds(row)).count(), fits.len());
        let rejected = rest.iter().filter(|row| row.rejection.is_some()).count();
        let [median, _] = median_and_slowest(fits.iter().map(|row| row.seconds)).unwrap_or_default();
        let _ = writeln!(
            text,
            "| {profile} | {} | {} | {} | {} | {} | {} | {median:.3} |",
            fits.len(),
            count(&|row| !row.outcomes.is_empty()),
            count(&|row| row.first().is_some_and(Outcome::success)),
            count(&|row| row.first().is_some_and(|outcome| outcome.success() && outcome.robust)),
            count(&|row| row.succeeds_within(10)),
            wilson(rejected, rest.len()),
        );
        hanging += &kinds::table(&fits);
        if !doubtful.is_empty() {
            let hang = doubtful.iter().filter(|row| row.first().is_some_and(Outcome::success)).count();
            let _ = writeln!(
                notes,
                "For {} more pairs a random search found no pose that hangs; {hang} of the best poses of `{profile}` do.\n",
                doubtful.len(),
            );
        }
    }
    (text + "\n" + &notes, hanging)
}

/// Splits the rows into pairs that fit, pairs that may fit, and pairs that cannot hang.
fn by_fit<'r>(rows: &[&'r Row]) -> [Vec<&'r Row>; 3] {
    let of = |fits, doubtful| {
        let rows = rows.iter().filter(|row| row.fits == fits && row.doubtful == doubtful);
        rows.copied().collect()
    };
    [of(true, false), of(false, true), of(false, false)]
}

/// All tables for one set of pairs.
pub fn tables(title: &str, rows: &[Row]) -> String {
    let mut text = format!("## {title}\n\n{}", comparison(rows).0);
    let mut profiles: Vec<&str> = rows.iter().map(|row| row.profile.as_str()).collect();
    profiles.dedup();
    for profile in profiles {
        let rows: Vec<&Row> = rows.iter().filter(|row| row.profile == profile).collect();
        let [fits, _, rest] = by_fit(&rows);
        let _ = writeln!(text, "### Profile `{profile}`\n");
        text += &by("object", &fits, |row| &row.object);
        text += &by("supporter", &fits, |row| &row.supporter);
        if !rest.is_empty() {
            let rejected = rest.iter().filter(|row| row.rejection.is_some()).count();
            let _ = writeln!(
                text,
                "Pairs that cannot hang: {}; rejected, %: {}.\n",
                rest.len(),
                wilson(rejected, rest.len())
            );
        }
        if let Some([median, slowest]) = median_and_slowest(rows.iter().map(|row| row.seconds)) {
            let _ = writeln!(
                text,
                "Seconds per prediction, one core, median: {median:.3}; slowest: {slowest:.3}.\n"
            );
        }
        let drops = rows.iter().flat_map(|row| &row.outcomes).filter(|o| o.clear).map(|o| o.seconds);
        if let Some([median, slowest]) = median_and_slowest(drops) {
            let _ = writeln!(
                text,
                "Seconds per judgement, one core, median: {median:.3}; slowest: {slowest:.3}.\n"
            );
        }
        text += &agreement(&fits);
        text += &kinds::table(&fits);
        text += &calibration::table(&fits);
        text += &failures(&fits);
    }
    text
}

fn median_and_slowest(seconds: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let mut seconds: Vec<f64> = seconds.collect();
    seconds.sort_by(f64::total_cmp);
    Some([*seconds.get(seconds.len() / 2)?, *seconds.last()?])
}

/// A table with one line per value of `key` and one for all rows.
fn by<'r>(name: &str, rows: &[&'r Row], key: impl Fn(&'r Row) -> &'r String) -> String {
    let mut groups: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        groups.entry(key(row)).or_default().push(row);
    }
    let mut text = format!(
        "| {name} | pairs | found | success | robust | top 5 | top 10 |\n|---|--:|--:|--:|--:|--:|--:|\n"
    );
    for (name, rows) in groups.into_iter().chain([("**all**", rows.to_vec())]) {
        let count = |holds: &dyn Fn(&Row) -> bool| rows.iter().filter(|row| holds(row)).count();
        let first = |row: &Row, holds: fn(&Outcome) -> bool| row.first().is_some_and(holds);
        let columns = [
            count(&|row| !row.outcomes.is_empty()),
            count(&|row| first(row, Outcome::success)),
            count(&|row| first(row, |outcome| outcome.success() && outcome.robust)),
            count(&|row| row.succeeds_within(5)),
            count(&|row| row.succeeds_within(10)),
        ];
        let cells: Vec<String> = columns.iter().map(|&k| wilson(k, rows.len())).collect();
        let _ = writeln!(text, "| {name} | {} | {} |", rows.len(), cells.join(" | "));
    }
    text + "\n"
}

fn agreement(rows: &[&Row]) -> String {
    let both: Vec<(&Outcome, &Outcome)> =
        rows.iter().filter_map(|row| Some((row.first()?, row.second.as_ref()?))).collect();
    if both.is_empty() {
        return String::new();
    }
    let agree = both.iter().filter(|(a, b)| a.success() == b.success()).count();
    let ode = both.iter().filter(|(_, b)| b.success()).count();
    let bullet = both.iter().filter(|(a, _)| a.success()).count();
    format!(
        "Bullet and ODE both judged {} best poses and agree on {} % of them; success in Bullet {} %, in ODE {} %.\n\n",
        both.len(),
        wilson(agree, both.len()),
        wilson(bullet, both.len()),
        wilson(ode, both.len()),
    )
}

/// Tables of the causes of failure of best poses and of the pairs of kinds with most failures.
fn failures(rows: &[&Row]) -> String {
    let mut causes: BTreeMap<Failure, usize> = BTreeMap::new();
    let mut places: BTreeMap<(Failure, &str, &str), usize> = BTreeMap::new();
    for row in rows {
        if let Some(cause) = row.failure() {
            *causes.entry(cause).or_default() += 1;
            *places.entry((cause, &row.object, &row.supporter)).or_default() += 1;
        }
    }
    let mut text = String::from("| cause of failure | pairs | possible remedy |\n|---|--:|---|\n");
    for (cause, count) in &causes {
        let _ = writeln!(text, "| {} | {count} | {} |", cause.name(), cause.remedy());
    }
    let mut places: Vec<_> = places.into_iter().collect();
    places.sort_by_key(|(place, count)| (std::cmp::Reverse(*count), *place));
    text +=
        "\nThe twenty most frequent failures:\n\n| cause | object | supporter | pairs |\n|---|---|---|--:|\n";
    for ((cause, object, supporter), count) in places.into_iter().take(20) {
        let _ = writeln!(text, "| {} | {object} | {supporter} | {count} |", cause.name());
    }
    text + "\n"
}
