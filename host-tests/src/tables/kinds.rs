//! How the best poses hang: what the predictor says of them, what the judges see, and what a person means.

use super::proportion::wilson;
use super::row::{Outcome, Row};
use crate::shapes::is_daily;
use hangpose::mechanics::Kind;
use std::fmt::Write;

/// Tables of how the best poses hang; empty if the predictor says nothing about it.
pub(super) fn table(rows: &[&Row]) -> String {
    let best: Vec<(&Row, &Outcome, Kind)> = rows
        .iter()
        .filter_map(|row| row.first().and_then(|outcome| Some((*row, outcome, outcome.said?.kind))))
        .collect();
    if best.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "How the best poses hang, by the predictor:\n\n| kind | poses | success | robust |\n|---|--:|--:|--:|\n",
    );
    for kind in Kind::ALL {
        let of: Vec<&Outcome> = best.iter().filter(|best| best.2 == kind).map(|best| best.1).collect();
        let count =
            |holds: &dyn Fn(&Outcome) -> bool| wilson(of.iter().filter(|o| holds(o)).count(), of.len());
        let robust = count(&|outcome| outcome.success() && outcome.robust);
        let _ = writeln!(text, "| {kind} | {} | {} | {robust} |", of.len(), count(&Outcome::success));
    }
    text += "\n";
    let hang = || best.iter().filter(|(_, outcome, _)| outcome.success());
    let pairs = |judge: fn(&Outcome) -> Option<Kind>| -> Vec<[Kind; 2]> {
        hang().filter_map(|(_, outcome, said)| Some([*said, judge(outcome)?])).collect()
    };
    text += &confusion("by construction", &pairs(|outcome| outcome.joined));
    text += &confusion("by the motions that free it", &pairs(|outcome| outcome.freed));
    let meant: Vec<(&Row, [Kind; 2])> =
        hang().filter_map(|(row, outcome, _)| Some((*row, [row.meant?, outcome.joined?]))).collect();
    text + &as_meant(&meant)
}

/// How the predictor's kinds agree with those of a judge, for best poses that hang.
fn confusion(judge: &str, pairs: &[[Kind; 2]]) -> String {
    if pairs.is_empty() {
        return String::new();
    }
    let right = pairs.iter().filter(|[said, seen]| said == seen).count();
    let names = Kind::ALL.map(Kind::name).join(" | ");
    let mut text = format!(
        "Of {} best poses that hang, {} % are of the kind that the predictor says, {judge}:\n\n\
         | predictor | {names} |\n|---|--:|--:|--:|--:|\n",
        pairs.len(),
        wilson(right, pairs.len())
    );
    for kind in Kind::ALL {
        let counts = Kind::ALL.map(|seen| pairs.iter().filter(|pair| **pair == [kind, seen]).count());
        let _ = writeln!(text, "| {kind} | {} |", counts.map(|count| count.to_string()).join(" | "));
    }
    text + "\n"
}

/// How many best poses that hang are of the kind that a person means. A pose of the other of the first two kinds is not,
/// although it may be as good: that is counted by itself.
fn as_meant(pairs: &[(&Row, [Kind; 2])]) -> String {
    if pairs.is_empty() {
        return String::new();
    }
    let mut text = String::from(
        "Best poses that hang, by the kind that a person means; as meant is strict, by construction:\n\n\
         | meant | poses | as meant, % | threaded or hooked, % |\n|---|--:|--:|--:|\n",
    );
    let is_first = |kind: Kind| matches!(kind, Kind::Threaded | Kind::Hooked);
    let mut line = |name: &str, of: &[&[Kind; 2]]| {
        let strict = of.iter().filter(|[meant, seen]| meant == seen).count();
        let first = of.iter().filter(|[_, seen]| is_first(*seen)).count();
        let (strict, first) = (wilson(strict, of.len()), wilson(first, of.len()));
        let _ = writeln!(text, "| {name} | {} | {strict} | {first} |", of.len());
    };
    let of = |is_of: &dyn Fn(&Row, Kind) -> bool| -> Vec<&[Kind; 2]> {
        pairs.iter().filter(|(row, [meant, _])| is_of(row, *meant)).map(|(_, kinds)| kinds).collect()
    };
    for kind in Kind::ALL {
        let of = of(&|_, meant| meant == kind);
        if !of.is_empty() {
            line(kind.name(), &of);
        }
    }
    line("threaded or hooked", &of(&|_, meant| is_first(meant)));
    let daily = of(&|row, _| is_daily(&row.object, &row.supporter));
    if !daily.is_empty() {
        line("daily things on hooks, trees and pegs", &daily);
    }
    line("**all**", &of(&|_, _| true));
    text + "\n"
}
