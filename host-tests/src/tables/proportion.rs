//! Success rates with confidence intervals.

/// `successes` of `trials` in percent with the 95 % interval of Wilson (1927), as text.
pub fn wilson(successes: usize, trials: usize) -> String {
    if trials == 0 {
        return "–".into();
    }
    let [low, high] = wilson_interval(successes, trials).map(|p| 100.0 * p);
    format!("{:.0} ({low:.0}–{high:.0})", 100.0 * successes as f64 / trials as f64)
}

fn wilson_interval(successes: usize, trials: usize) -> [f64; 2] {
    let z = 1.959_964;
    let (n, p) = (trials as f64, successes as f64 / trials as f64);
    let middle = p + z * z / (2.0 * n);
    let reach = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    [middle - reach, middle + reach].map(|bound| (bound / (1.0 + z * z / n)).clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilson_intervals_as_published() {
        // Newcombe 1998, "Two-sided confidence intervals for the single proportion", table I, method 3.
        for (successes, trials, low, high) in [
            (81, 263, 0.2553, 0.3662),
            (15, 148, 0.0624, 0.1605),
            (0, 20, 0.0, 0.1611),
            (1, 29, 0.0061, 0.1718),
        ] {
            let [l, h] = wilson_interval(successes, trials);
            assert!((l - low).abs() < 1e-4 && (h - high).abs() < 1e-4, "{successes}/{trials}: {l} {h}");
        }
    }
}
