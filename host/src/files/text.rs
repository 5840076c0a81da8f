//! Lines and numbers, as exporters of every age write them.

use std::borrow::Cow;

/// The lines with their numbers, counted from 1. Ends of line may be LF, CR LF or CR; bytes that are not UTF-8 (a material's
/// name in an old code page, say) become replacement characters.
pub(super) fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    bytes
        .split(move |&b| b == end)
        .enumerate()
        .map(|(i, line)| (i + 1, String::from_utf8_lossy(line.trim_ascii())))
}

/// What stands before a `#`, unless it is the one in `1.#QNAN`.
pub(super) fn before_comment(line: &str) -> &str {
    match line.match_indices('#').find(|(at, _)| !line[..*at].ends_with('.')) {
        Some((at, _)) => &line[..at],
        None => line,
    }
}

/// A number, or `None` if the word is none. What C libraries print for NaN (`-nan(ind)`, `1.#QNAN`) is NaN.
pub(super) fn number(word: &str) -> Option<f32> {
    word.parse().ok().or_else(|| {
        let bare = word.trim_start_matches(['-', '+']).to_ascii_lowercase();
        (bare.starts_with("nan") || bare.starts_with("1.#")).then_some(f32::NAN)
    })
}

/// The next three words as numbers; `Err` says what stands in the way.
pub(super) fn three<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f32; 3], String> {
    let mut out = [0.0; 3];
    for value in &mut out {
        let word = words.next().ok_or("expected three numbers")?;
        *value = number(word).ok_or_else(|| format!("expected a number, not \"{}\"", short(word)))?;
    }
    Ok(out)
}

/// A word from a file, cut so that it fits into a message.
pub(super) fn short(word: &str) -> String {
    let mut cut: String = word.chars().take(24).map(|c| if c.is_control() { '?' } else { c }).collect();
    if word.chars().nth(24).is_some() {
        cut.push_str("...");
    }
    cut
}
