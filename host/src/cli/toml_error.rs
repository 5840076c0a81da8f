//! What is wrong with a TOML file, in lines of a terminal's width.

/// Greatest length of a line, characters. The parser quotes the line of the file, which may be megabytes long.
const WIDTH: usize = 200;

/// The message of the parser, with its long lines cut.
pub(super) fn text(error: &toml::de::Error) -> String {
    let cut = |line: &str| match line.char_indices().nth(WIDTH) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line.to_string(),
    };
    error.to_string().trim_end().lines().map(cut).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_cut() {
        let long = format!("a = {}", "[".repeat(1_000_000));
        let error = toml::from_str::<toml::Table>(&long).unwrap_err();
        let said = text(&error);
        assert!(said.len() < 1000 && said.contains("a = [[[") && said.contains("line 1"), "{said}");
        let short = toml::from_str::<toml::Table>("a = ").unwrap_err();
        assert_eq!(text(&short), short.to_string().trim_end());
    }
}
