//! Tables of planned and replayed paths in Markdown.

use super::row::{Planned, Row};
use crate::judge::replay::{DEEPEST, STEP};
use crate::shapes::Insertion;
use crate::tables::proportion::wilson;
use std::collections::BTreeMap;
use std::fmt::Write;

/// All tables. `opened` are the rows of enclosures with a way out.
pub fn tables(pairs: &[Row], closed: &[Row], opened: &[Row]) -> String {
    let told = |rows: &[Row], insertion: Insertion| -> Vec<Row> {
        rows.iter().filter(|row| row.insertion == Some(insertion)).cloned().collect()
    };
    let possible = told(pairs, Insertion::Possible);
    let mut text = format!(
        "The best pose that hangs in Bullet is planned from a start in front of everything, turned by up to 46°. Paths are \
         replayed in Bullet at steps of {} mm: a path passes if nothing is deeper than {} mm and the object holds when it is \
         let go at its end: that it came there freely shows that it is not wedged. Rates are in percent, with the 95 % interval \
         of Wilson; times are those of the plan alone.\n\n\
         Insertions that are possible by construction:\n\n",
        1000.0 * STEP,
        1000.0 * DEEPEST
    );
    text += &scenes(&possible, true);
    text += &cost(&possible);
    text += &failures(&possible);
    text += &replays(&possible);
    let none = pairs.iter().filter(|row| row.insertion.is_none()).count();
    let unknown: Vec<Row> = told(pairs, Insertion::Unknown);
    let found = unknown.iter().filter_map(|row| row.plan.as_ref()).filter(|plan| plan.is_found()).count();
    let _ = writeln!(
        text,
        "\nOf {} more, the construction does not tell whether an insertion is possible; {found} have a path. {none} have no \
         pose that hangs.\n",
        unknown.len()
    );
    let mut impossible = told(pairs, Insertion::Impossible);
    impossible.extend_from_slice(closed);
    if !impossible.is_empty() {
        text += "Insertions that are impossible by construction:\n\n";
        text += &impossibles(&impossible);
    }
    if !opened.is_empty() {
        text += "The same with a way out:\n\n";
        text += &scenes(opened, false);
        text += &failures(opened);
        text += &replays(opened);
    }
    text
}

/// Rows by a name, in the order in which the names come first.
fn by<'a>(rows: &'a [Row], name: impl Fn(&'a Row) -> &'a str) -> Vec<(&'a str, Vec<&'a Row>)> {
    let mut groups: Vec<(&str, Vec<&Row>)> = Vec::new();
    for row in rows {
        match groups.iter_mut().find(|group| group.0 == name(row)) {
            Some(group) => group.1.push(row),
            None => groups.push((name(row), vec![row])),
        }
    }
    groups
}

/// The value of this rank among sorted ones, from 0 to 1; `None` if there are none.
fn quantile(values: impl Iterator<Item = f64>, rank: f64) -> Option<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.get(((rank * values.len() as f64) as usize).min(values.len().max(1) - 1)).copied()
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".into(), |value| format!("{value:.digits$}"))
}

/// Median, 95th percentile and largest time, ms.
fn milliseconds<'a>(plans: impl Iterator<Item = &'a Planned> + Clone) -> String {
    let at = |rank| number(quantile(plans.clone().map(|plan| 1000.0 * plan.seconds), rank), 1);
    format!("{} | {} | {}", at(0.5), at(0.95), at(1.0))
}

fn scenes(rows: &[Row], has_total: bool) -> String {
    let mut text = String::from(
        "| scene | pairs | path found | of these pass the replay | median ms | p95 ms | max ms | median clearance, mm | memory, MiB | and scene, MiB |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    let mut line = |name: &str, rows: &[&Row]| {
        let plans = || rows.iter().filter_map(|row| row.plan.as_ref());
        let found = || plans().filter(|plan| plan.is_found());
        let pass = found().filter(|plan| plan.replay.is_some_and(|replay| replay.passes)).count();
        let clearance = quantile(found().map(|plan| 1000.0 * f64::from(plan.clearance)), 0.5);
        let mebibytes = |bytes: Option<usize>| bytes.unwrap_or_default() as f64 / 1024.0 / 1024.0;
        let scene = mebibytes(plans().map(|plan| plan.bytes[1]).max());
        let own = mebibytes(plans().map(|plan| plan.bytes[0] - plan.bytes[1]).max());
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {own:.1} | {scene:.1} |",
            plans().count(),
            wilson(found().count(), plans().count()),
            wilson(pass, found().count()),
            milliseconds(plans()),
            number(clearance, 1),
        );
    };
    for (name, rows) in by(rows, |row| &row.scene) {
        line(name, &rows);
    }
    if has_total {
        line("**all**", &rows.iter().collect::<Vec<_>>());
    }
    text + "\n" + &peers(rows)
}

/// What the tests of poses cost, beside the least that a path needs.
fn cost(rows: &[Row]) -> String {
    let found = || rows.iter().filter_map(|row| row.plan.as_ref()).filter(|plan| plan.is_found());
    let median = |value: &dyn Fn(&Planned) -> f64| quantile(found().map(value), 0.5).unwrap_or_default();
    let poses = median(&|plan| plan.poses as f64);
    let each = median(&|plan| 1e6 * plan.seconds / plan.poses.max(1) as f64);
    let waypoints = median(&|plan| plan.waypoints as f64);
    format!(
        "In the median a path takes {poses:.0} tests of poses at {each:.1} µs, everything else included. To test each of its \
         {waypoints:.0} waypoints once would take {:.2} ms: a planner that guesses right needs no less. VAMP (Thomason, Kingston and \
         Kavraki, ICRA 2024) publishes 0.035 ms for whole plans of an arm, with vectorised tests of spheres against primitives.\n\n",
        1e-3 * waypoints * each
    )
}

/// OMPL beside the planner, on the same problems.
fn peers(rows: &[Row]) -> String {
    let both: Vec<_> = rows.iter().filter_map(|row| Some((row.plan.as_ref()?, row.peer?))).collect();
    if both.is_empty() {
        return String::new();
    }
    let solved = both.iter().filter(|(_, peer)| peer.is_solved).count();
    let at = |rank| number(quantile(both.iter().map(|(_, peer)| 1000.0 * peer.seconds), rank), 1);
    let found = both.iter().filter(|(plan, _)| plan.is_found()).count();
    let ours = milliseconds(both.iter().map(|(plan, _)| *plan));
    format!(
        "OMPL's RRT-Connect on the same problems, 2 s at most, with the planner's own test of poses, \
         `motion::Clearance`, as its collision checker; its paths are neither shortened nor replayed:\n\n\
         | planner | problems | path found | median ms | p95 ms | max ms |\n|---|--:|--:|--:|--:|--:|\n\
         | hangpose | {0} | {1} | {ours} |\n| OMPL RRTConnect | {0} | {2} | {3} | {4} | {5} |\n\n",
        both.len(),
        wilson(found, both.len()),
        wilson(solved, both.len()),
        at(0.5),
        at(0.95),
        at(1.0)
    )
}

/// Why there is no path, by scene and by kind of supporter.
fn failures(rows: &[Row]) -> String {
    let failed: Vec<Row> =
        rows.iter().filter(|row| row.plan.as_ref().is_some_and(|plan| !plan.is_found())).cloned().collect();
    if failed.is_empty() {
        return String::new();
    }
    let answer = |row: &Row| row.plan.as_ref().map_or_else(String::new, |plan| plan.answer.clone());
    let mut reasons: Vec<String> = failed.iter().map(answer).collect();
    reasons.sort();
    reasons.dedup();
    let mut text = String::from("No path, by reason:\n\n");
    for (title, name) in
        [("scene", (|row| &row.scene) as fn(&Row) -> &String), ("supporter", |row| &row.supporter)]
    {
        let _ =
            writeln!(text, "| {title} | {} |\n|---|{}", reasons.join(" | "), "--:|".repeat(reasons.len()));
        for (group, rows) in by(&failed, |row| name(row)) {
            let counts =
                reasons.iter().map(|reason| rows.iter().filter(|row| answer(row) == *reason).count());
            let counts: Vec<String> = counts.map(|count| count.to_string()).collect();
            let _ = writeln!(text, "| {group} | {} |", counts.join(" | "));
        }
        text += "\n";
    }
    text
}

/// The paths that fail the replay.
fn replays(rows: &[Row]) -> String {
    let failed =
        |row: &&Row| row.plan.as_ref().and_then(|plan| plan.replay).is_some_and(|replay| !replay.passes);
    let mut text = String::new();
    let caught = |row: &&Row| {
        row.plan
            .as_ref()
            .and_then(|plan| plan.replay)
            .is_some_and(|replay| replay.passes && replay.hangs == Some(true) && !replay.comes_free)
    };
    let caught = rows.iter().filter(caught).count();
    if caught > 0 {
        let _ = writeln!(
            text,
            "After {caught} of the paths that pass, the object does not come free within 1.5 s of reversed gravity, 2 mm away.\n"
        );
    }
    for (index, row) in rows.iter().filter(failed).enumerate() {
        if index == 0 {
            text += "Paths that fail the replay:\n\n";
        }
        let Some(replay) = row.plan.as_ref().and_then(|plan| plan.replay) else { continue };
        let named = [
            ("object on the way", replay.way),
            ("object lowered", replay.lowering),
            ("gripper that holds", replay.held),
            ("gripper that leaves", replay.leaving),
        ];
        let deep = named.iter().filter(|(_, [depth, _])| *depth > DEEPEST);
        let mut what: Vec<String> = deep
            .map(|(name, [depth, at])| format!("{name} {:.1} mm deep at waypoint {at:.2}", 1000.0 * depth))
            .collect();
        if replay.hangs == Some(false) {
            what.push("does not hold".into());
        }
        let _ = writeln!(text, "- {}, {}: {}", row.pair, row.scene, what.join(", "));
    }
    if !text.is_empty() {
        text += "\n";
    }
    text
}

fn impossibles(rows: &[Row]) -> String {
    let mut text = String::from(
        "| scene | pairs | no path | by reason | median ms | p95 ms | max ms |\n|---|--:|--:|---|--:|--:|--:|\n",
    );
    for (name, rows) in by(rows, |row| &row.scene) {
        let plans = || rows.iter().filter_map(|row| row.plan.as_ref());
        let none = plans().filter(|plan| !plan.is_found()).count();
        let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
        for plan in plans().filter(|plan| !plan.is_found()) {
            *reasons.entry(&plan.answer).or_default() += 1;
        }
        let reasons: Vec<String> =
            reasons.iter().map(|(reason, count)| format!("{reason} {count}")).collect();
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} |",
            plans().count(),
            wilson(none, plans().count()),
            reasons.join(", "),
            milliseconds(plans())
        );
    }
    text + "\n"
}
