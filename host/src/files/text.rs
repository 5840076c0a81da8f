//! Lines and numbers of text formats, in all the variants that exporters write.

use std::borrow::Cow;

/// The lines with their numbers, counted from 1. A line ends with LF, CR LF or CR. Bytes that are not UTF-8, such as a
/// material's name in an old code page, become replacement characters.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    bytes
        .split(move |&b| b == end)
        .enumerate()
        .map(|(i, line)| (i + 1, String::from_utf8_lossy(line.trim_ascii())))
}

/// The line up to its comment, which begins with `#`. The `#` of `1.#QNAN` does not begin one.
pub(super) fn before_comment(line: &str) -> &str {
    match line.match_indices('#').find(|(at, _)| !line[..*at].ends_with('.')) {
        Some((at, _)) => &line[..at],
        None => line,
    }
}

/// Parses a number. The spellings of NaN by C libraries (`-nan(ind)`, `1.#QNAN`) are accepted.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| {
        let bare = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
        (bare.starts_with("nan") || bare.starts_with("1.#")).then_some(f64::NAN)
    })
}

/// Parses the next three words as numbers; `Err` is the reason for an error message.
pub(super) fn three<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut out = [0.0; 3];
    for value in &mut out {
        let word = words.next().ok_or("expected three numbers")?;
        *value = number(word).ok_or_else(|| format!("expected a number, not \"{}\"", short(word)))?;
    }
    Ok(out)
}

/// A word of a file, shortened for an error message.
pub(super) fn short(word: &str) -> String {
    let mut cut: String = word.chars().take(24).map(|c| if c.is_control() { '?' } else { c }).collect();
    if word.chars().nth(24).is_some() {
        cut.push_str("...");
    }
    cut
}
