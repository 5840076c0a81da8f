//! Options, help and the printed table.

use super::*;

#[test]
fn wrong_usage_has_its_own_status() {
    let scene = Scene::new();
    let (ring, peg) = (scene.ring.to_str().unwrap(), scene.peg.to_str().unwrap());
    let predict = ["predict", "--object", ring, "--supporter", peg];
    for options in [
        ["--top", "0"],
        ["--top", "many"],
        ["--threads", "0"],
        ["--seed", "1.5"],
        ["--com", "1,2"],
        ["--com", "1,2,inf"],
        ["--viewpoint", "here"],
        ["--object-scale", "0"],
        ["--supporter-scale", "nan"],
        ["--object-up", "w"],
        ["--supporter-points", "3"],
        ["--profile", "best"],
        ["--colour", "red"],
    ] {
        let run = finish(command().args(predict).args(options));
        assert_eq!((run.status, run.stdout.as_str()), (Some(2), ""), "{options:?}");
        assert!(run.stderr.contains(options[0]), "{}", run.stderr);
    }
    for arguments in
        [&[][..], &["hang"], &["predict", "--object", ring], &["inspect"], &["inspect", ring, peg]]
    {
        assert_eq!(finish(command().args(arguments)).status, Some(2), "{arguments:?}");
    }
}

#[test]
fn help_lists_every_option_and_status() {
    let run = run!("--help");
    assert_eq!(run.status, Some(0));
    assert!(
        ["predict", "plan", "inspect", "scan", "Example:\n  hangpose predict"]
            .iter()
            .all(|part| run.stdout.contains(part))
    );
    let help = run!("predict", "--help").stdout;
    for option in [
        "object",
        "supporter",
        "profile",
        "top",
        "count",
        "here",
        "by",
        "allow",
        "scene",
        "seed",
        "com",
        "json",
        "params",
        "threads",
        "viewpoint",
        "start",
        "gripper",
        "workspace",
        "path",
    ] {
        assert!(help.contains(&format!("--{option} <")), "{option}");
    }
    assert!(help.contains("--plan\n") && help.contains("--take-off"));
    let help_of_plan = run!("plan", "--help").stdout;
    for option in ["pose", "rank", "start", "gripper", "workspace", "plan-clearance", "scene", "path", "json"]
    {
        assert!(help_of_plan.contains(&format!("--{option} <")), "{option}");
    }
    assert!(help_of_plan.contains("Exit status: 0"));
    let help_of_scan = run!("scan", "--help").stdout;
    for option in ["depth", "camera", "poses", "mask", "label", "voxel", "crop", "depth-scale", "viewpoints"]
    {
        assert!(help_of_scan.contains(&format!("--{option} <")), "{option}");
    }
    assert!(help_of_scan.contains("Exit status: 0") && help_of_scan.contains("--world-to-camera"));
    assert!(help.contains("Exit status: 0") && run!("inspect", "--help").stdout.contains("Exit status: 0"));
    assert!(run!("--version").stdout.starts_with("hangpose "));
}

#[test]
fn the_table_says_what_was_read_and_agrees_with_the_json() {
    let scene = Scene::new();
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg);
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let document = scene.predict(&[]);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines[0], heading(&document, "contacts", ["contact candidates"; 2]));
    let poses = document["poses"].as_array().unwrap();
    assert_eq!(lines.len(), 1 + poses.len());
    for (line, pose) in lines[1..].iter().zip(poses) {
        let margin = &pose["margin"];
        let tilt = numbers::<8>(&margin["tilts"]).into_iter().fold(f64::INFINITY, f64::min);
        let at_least = if tilt >= 1.2 { "at least " } else { "" };
        let words = format!(
            "{:4}  {}: hangs with probability {:.1} %, tolerates a tilt of {at_least}{:.0} degrees or a knock of {:.1} m/s, sinks {:.1} mm after release, main contact at (",
            number(&pose["rank"]),
            pose["kind"].as_str().unwrap(),
            100.0 * number(&pose["probability"]),
            tilt.to_degrees(),
            number(&margin["knock_speed"]),
            1000.0 * number(&pose["sinking"]),
        );
        assert!(line.starts_with(&words) && line.ends_with(") mm"), "{line}\n{words}");
    }
}

/// First line of the table. `key` is `sites` or `contacts`.
fn heading(document: &Value, key: &str, [object, supporter]: [&str; 2]) -> String {
    let counts = &document["stats"][key];
    format!(
        "object: {} triangles, closed, 68 x 8 x 154 mm, {} {object}; supporter: {} points, 100 x 8 x 8 mm, {} {supporter}",
        shapes::weighted_ring().1.len(),
        counts["object"],
        shapes::peg().len(),
        counts["supporter"],
    )
}

#[test]
fn the_papers_table_agrees_with_the_json() {
    let scene = Scene::new();
    let options = [&PAPER[..], &["--top", "4"]].concat();
    let mut command = command();
    command.args(["predict", "--object"]).arg(&scene.ring).arg("--supporter").arg(&scene.peg).args(&options);
    let run = finish(&mut command);
    // There is no progress bar either, since standard error is not a terminal here.
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    let document = scene.predict(&options);
    let lines: Vec<&str> = run.stdout.lines().collect();
    assert_eq!(lines[0], heading(&document, "sites", ["hanging sites", "support sites"]));
    assert!(lines[1].trim_start().starts_with("rank    total"));
    let poses = document["poses"].as_array().unwrap();
    assert_eq!(lines.len(), 2 + poses.len());
    for (line, pose) in lines[2..].iter().zip(poses) {
        let row: Vec<f64> = line.split_whitespace().map(|word| word.parse().unwrap()).collect();
        let cost = &pose["cost"];
        let [x, y, z] = numbers::<3>(&pose["supporter_site"]["position"]).map(|x| 1000.0 * x);
        let [u, v, w] = numbers::<3>(&pose["object_site"]["position"]).map(|x| 1000.0 * x);
        let [total, collision, boundary, area] =
            ["total", "collision", "boundary", "contact_area"].map(|name| number(&cost[name]));
        let expected = [number(&pose["rank"]), total, collision, boundary, area, x, y, z, u, v, w];
        assert_eq!(row.len(), expected.len(), "{line}");
        // Within the rounding of the printed digits.
        assert!(row.iter().zip(expected).all(|(shown, value)| (shown - value).abs() < 0.051), "{line}");
    }
}

/// What a run with a bad option or a bad file writes to a terminal.
#[cfg(unix)]
fn on_a_terminal(arguments: &str, no_colour: &str) -> String {
    let line = format!("{} {arguments}", env!("CARGO_BIN_EXE_hangpose"));
    let mut command = Command::new("script");
    command
        .args(["--quiet", "--command", &line, "/dev/null"])
        .env("TERM", "xterm")
        .env("NO_COLOR", no_colour);
    finish(command.stdin(std::process::Stdio::null())).stdout
}

#[test]
#[cfg(unix)]
fn colours_are_for_terminals_only() {
    for (arguments, words) in
        [("inspect none.obj", "no such file"), ("inspect --colour", "unexpected argument")]
    {
        let shown = on_a_terminal(arguments, "");
        assert!(shown.contains(words) && shown.contains("\u{1b}[1m\u{1b}[31merror"), "{shown:?}");
        let plain = on_a_terminal(arguments, "1");
        assert!(plain.contains(words) && !plain.contains("\u{1b}[3"), "{plain:?}");
        let piped = finish(command().args(arguments.split(' '))).stderr;
        assert!(piped.contains(words) && !piped.contains('\u{1b}'), "{piped:?}");
    }
}

#[test]
#[cfg(unix)]
fn a_batch_shows_its_progress_on_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("out.csv");
    let shown =
        on_a_terminal(&format!("batch {} -o {}", sample("pairs.csv").display(), output.display()), "");
    assert!(
        shown.contains("of 4 pairs, ") && shown.contains(" left") && shown.contains("4 hang"),
        "{shown:?}"
    );
}
