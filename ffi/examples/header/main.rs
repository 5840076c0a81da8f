//! Writes include/hangpose.h from the crate's source and its size queries. With `--check` it fails if the file differs.

mod sizes;

use cbindgen::{Builder, Config, DocumentationStyle, Language, Style};
use std::path::Path;
use std::process::ExitCode;

/// The source files in the order of the header.
const SOURCES: [&str; 27] = [
    "version",
    "status",
    "detail",
    "params",
    "mesh",
    "cloud",
    "limits",
    "monitor",
    "threads",
    "object",
    "supporter",
    "kind",
    "region",
    "request",
    "pose",
    "predict",
    "many",
    "motion",
    "waypoint",
    "plan_failure",
    "plan",
    "reachable",
    "sample",
    "depth_image",
    "volume_settings",
    "volume",
    "depth_points",
];

fn main() -> ExitCode {
    let ffi = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = ffi.join("../include/hangpose.h");
    let wanted = header(ffi);
    if std::env::args().nth(1).as_deref() != Some("--check") {
        std::fs::write(&path, wanted).expect("include/ can be written");
        return ExitCode::SUCCESS;
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    if found == wanted {
        return ExitCode::SUCCESS;
    }
    let line = 1 + found.lines().zip(wanted.lines()).take_while(|(a, b)| a == b).count();
    eprintln!("include/hangpose.h differs from ffi/src in line {line}: regenerate it with `make header`");
    ExitCode::FAILURE
}

fn header(ffi: &Path) -> String {
    let config = Config {
        language: Language::C,
        cpp_compat: true,
        style: Style::Both,
        documentation_style: DocumentationStyle::C99,
        include_guard: Some("HANGPOSE_H".into()),
        no_includes: true,
        sys_includes: vec!["stddef.h".into(), "stdint.h".into()],
        usize_is_size_t: true,
        line_length: 100,
        header: Some(include_str!("top.txt").trim_end().into()),
        after_includes: Some(format!("\n{}{}", include_str!("sizes.txt"), sizes::defines().trim_end())),
        ..Config::default()
    };
    let mut builder = Builder::new().with_config(config);
    for source in SOURCES {
        builder = builder.with_src(ffi.join(format!("src/{source}.rs")));
    }
    let bindings = builder.generate().expect("cbindgen reads the crate's source");
    let mut header = Vec::new();
    bindings.write(&mut header);
    let header = String::from_utf8(header).expect("the source is UTF-8");
    // A negative number in a macro needs parentheses.
    let lines = header.lines().map(|line| match line.split_once(" -") {
        Some((name, digits)) if line.starts_with("#define ") => format!("{name} (-{digits})\n"),
        _ => format!("{line}\n"),
    });
    lines.collect()
}
