//! `batch` and `merge`: the rows are what `predict` says, and their bytes do not depend on how they came about.

use super::*;
use std::fs::{self, File};
use std::time::{Duration, Instant};

/// A table of pairs of the scene: the ring in several sizes, the ball, and an option that leaves nothing.
const TABLE: &str = "id,object,supporter,object_scale,allow,here
ring,ring.obj,peg.xyz,,,
\"large, ring\",ring.obj,peg.xyz,1.1,,
ball,ball.obj,peg.xyz,,,
nothing allowed,ring.obj,peg.xyz,,balanced,
at the middle,ring.obj,peg.xyz,,,\"0.05,0,0,0.03\"
,ring.obj,peg.xyz,1.2,threaded,
";

/// Options for all pairs.
const OPTIONS: [&str; 4] = ["--top", "2", "--seed", "1"];

impl Scene {
    fn batch(&self, output: &str, options: &[&str]) -> Run {
        let mut command = command();
        command.current_dir(self.folder.path()).args(["batch", "pairs.csv", "-o", output]);
        finish(command.args(options))
    }

    fn merge(&self, output: &str, shards: &[&str]) -> Run {
        let mut command = command();
        command.current_dir(self.folder.path()).args(["merge", "pairs.csv", "-o", output]);
        finish(command.args(shards))
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// The rows of a result in JSON lines.
    fn rows(&self, name: &str) -> Vec<Value> {
        let text = String::from_utf8(self.bytes(name)).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

#[track_caller]
fn assert_done(run: &Run) {
    assert_eq!(run.status, Some(0), "{}{}", run.stdout, run.stderr);
}

#[test]
fn rows_are_what_predict_says() {
    let scene = Scene::new();
    scene.write("pairs.csv", TABLE);
    let run = scene.batch("out.jsonl", &OPTIONS);
    assert_done(&run);
    assert_eq!(run.stderr, "", "no progress without a terminal");
    assert!(
        run.stdout.starts_with("out.jsonl: 6 pairs in ")
            && run.stdout.ends_with(": 4 hang, 2 do not, 0 with an error\n")
    );
    let rows = scene.rows("out.jsonl");
    for (number, (id, object, options)) in (1..).zip([
        ("ring", &scene.ring, vec![]),
        ("large, ring", &scene.ring, vec!["--object-scale", "1.1"]),
        ("ball", &scene.ball, vec![]),
        ("nothing allowed", &scene.ring, vec!["--allow", "balanced"]),
        ("at the middle", &scene.ring, vec!["--here", "0.05,0,0,0.03"]),
        ("6", &scene.ring, vec!["--object-scale", "1.2", "--allow", "threaded"]),
    ]) {
        let mut command = command();
        command.args(["predict", "--json", "-", "--object"]).arg(object).arg("--supporter").arg(&scene.peg);
        let single = finish(command.args(OPTIONS).args(options)).json();
        let of_pair: Vec<_> = rows.iter().filter(|row| row["pair"] == number).collect();
        assert!(of_pair.iter().all(|row| row["id"] == id && row["error"].is_null()), "{id}");
        let poses = single["poses"].as_array().unwrap();
        if poses.is_empty() {
            assert_eq!(of_pair.len(), 1);
            assert_eq!(of_pair[0]["rejection"], single["rejection"]["stage"], "{id}");
            assert_eq!(of_pair[0]["reason"], single["rejection"]["reason"]);
            assert!(of_pair[0]["rank"].is_null() && of_pair[0]["x"].is_null());
            continue;
        }
        assert_eq!(of_pair.len(), poses.len(), "{id}");
        for (row, pose) in of_pair.into_iter().zip(poses) {
            assert_eq!(["x", "y", "z"].map(|name| number_of(row, name)), numbers(&pose["position"]), "{id}");
            let quaternion = ["qx", "qy", "qz", "qw"].map(|name| number_of(row, name));
            assert_eq!(quaternion, numbers(&pose["quaternion_xyzw"]));
            let rest = numbers::<16>(&pose["rest_pose"]);
            assert_eq!(
                ["rest_x", "rest_y", "rest_z"].map(|name| number_of(row, name)),
                [rest[3], rest[7], rest[11]]
            );
            let tilts = numbers::<8>(&pose["margin"]["tilts"]);
            assert_eq!(number_of(row, "tilt"), tilts.into_iter().fold(f64::INFINITY, f64::min));
            for (name, value) in [
                ("rank", &pose["rank"]),
                ("kind", &pose["kind"]),
                ("probability", &pose["probability"]),
                ("robustness", &pose["robustness"]),
                ("tolerance_position", &pose["tolerance"]["position"]),
                ("tolerance_rotation", &pose["tolerance"]["rotation"]),
                ("sinking", &pose["sinking"]),
                ("clearance", &pose["clearance"]),
                ("knock_speed", &pose["margin"]["knock_speed"]),
                ("jolt_time", &pose["margin"]["jolt_time"]),
                ("escape_rise", &pose["margin"]["escape_rise"]),
                ("unseen_object", &pose["unseen"]["object"]),
                ("unseen_shadow", &pose["unseen"]["shadow"]),
                ("unseen_supporter", &pose["unseen"]["supporter"]),
                ("cost", &pose["cost"]),
            ] {
                assert_eq!(&row[name], value, "{id}: {name}");
            }
            // The rotation of the rest pose is a matrix in JSON.
            let q = ["rest_qx", "rest_qy", "rest_qz", "rest_qw"].map(|name| number_of(row, name));
            let zz = 1.0 - 2.0 * (q[0] * q[0] + q[1] * q[1]);
            assert!((zz - rest[10]).abs() < 1e-5, "{id}");
        }
    }
}

fn number_of(row: &Value, name: &str) -> f64 {
    number(&row[name])
}

#[test]
fn jobs_shards_and_memory_do_not_change_a_byte() {
    let scene = Scene::new();
    scene.write("pairs.csv", TABLE);
    for format in ["csv", "jsonl", "parquet"] {
        let name = |stem: &str| format!("{stem}.{format}");
        assert_done(&scene.batch(&name("one"), &[&OPTIONS[..], &["--jobs", "1"]].concat()));
        let one = scene.bytes(&name("one"));
        assert_done(&scene.batch(&name("two"), &[&OPTIONS[..], &["--jobs", "2", "--memory", "0"]].concat()));
        assert!(one == scene.bytes(&name("two")), "{format}: two jobs");
        if format != "csv" {
            // Its shards are those of the CSV, since all formats hold the same.
            assert_done(&scene.merge(&name("merged"), &["3.csv", "1.csv", "2.csv"]));
            assert!(one == scene.bytes(&name("merged")), "{format}: merged from CSV");
            continue;
        }
        for shard in ["1", "2", "3"] {
            let options = ["--shard", &format!("{shard}/3")];
            assert_done(&scene.batch(&name(shard), &[&OPTIONS[..], &options].concat()));
        }
        assert_done(&scene.merge("merged.csv", &["1.csv", "2.csv", "3.csv"]));
        assert!(one == scene.bytes("merged.csv"), "merged");
    }
    // Back from the other formats.
    for format in ["one.jsonl", "one.parquet"] {
        assert_done(&scene.merge("back.csv", &[format]));
        assert!(scene.bytes("one.csv") == scene.bytes("back.csv"), "{format}");
    }

    let message = |shards: &[&str]| {
        let run = scene.merge("bad.csv", shards);
        assert_eq!(run.status, Some(1), "{}", run.stdout);
        assert!(!scene.path("bad.csv").exists());
        run.stderr
    };
    let text = message(&["1.csv", "3.csv"]);
    assert!(text.contains("2 of 6 pairs have no row: 3, 4"), "{text}");
    let text = message(&["1.csv", "2.csv", "3.csv", "one.jsonl"]);
    assert!(text.contains("pair 1 is in 1.csv and in one.jsonl: give each shard once"), "{text}");
    scene.write("pairs.csv", TABLE.replace("ball.obj", "other.obj"));
    let text = message(&["one.csv"]);
    assert!(text.contains("pair 3 is ball.obj on peg.xyz in the rows, but other.obj on peg.xyz"), "{text}");
}

/// A table of as many pairs, each with an object of its own.
fn many(pairs: u32) -> String {
    let line = |i| format!("ring.obj,peg.xyz,{}\n", 1.0 + f64::from(i) / 100.0);
    (0..pairs).map(line).fold("object,supporter,object_scale\n".into(), |all, line| all + &line)
}

#[test]
fn a_killed_run_goes_on_where_it_was() {
    let scene = Scene::new();
    scene.write("pairs.csv", many(12));
    let options = ["--top", "1", "--jobs", "1"];
    assert_done(&scene.batch("whole.parquet", &options));
    let journal = scene.path("out.parquet.partial");
    let lines = || fs::read(&journal).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count();
    let mut command = command();
    command.current_dir(scene.folder.path()).args(["batch", "pairs.csv", "-o", "out.parquet"]).args(options);
    let mut child = command.spawn().unwrap();
    let start = Instant::now();
    while lines() < 4 {
        assert!(start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none());
        std::thread::sleep(Duration::from_millis(2));
    }
    // SIGKILL on Unix.
    child.kill().unwrap();
    child.wait().unwrap();
    let done = lines() - 1;
    assert!((3..12).contains(&done) && !scene.path("out.parquet").exists());

    // What a write that was cut off leaves.
    let mut torn = fs::read(&journal).unwrap();
    torn.extend(b"{\"pair\":9,\"rows\":[{\"pa");
    fs::write(&journal, &torn).unwrap();

    let refused = |options: &[&str], reason: &str| {
        let run = scene.batch("out.parquet", options);
        assert_eq!(run.status, Some(1), "{}", run.stdout);
        assert!(run.stderr.contains(reason), "{reason} in {}", run.stderr);
        assert!(fs::read(&journal).unwrap() == torn, "nothing is lost");
    };
    refused(&options, "an earlier run has ended before it was done; pass --resume");
    refused(&["--resume", "--top", "2"], "it had --top=1, now there are --top=2");
    refused(
        &["--resume", "--top", "1", "--shard", "1/2"],
        "its shard was pairs 1 to 12, now it is pairs 1 to 6",
    );
    scene.write("pairs.csv", many(13));
    refused(&["--resume", "--top", "1"], "the table of pairs has changed");
    scene.write("pairs.csv", many(12));
    let held = File::options().write(true).open(&journal).unwrap();
    held.lock().unwrap();
    refused(&["--resume", "--top", "1"], "another run is writing it");
    drop(held);

    // The number of jobs changes no result, so that it may be another one.
    let run = scene.batch("out.parquet", &["--resume", "--top", "1", "--jobs", "2"]);
    assert_done(&run);
    assert!(run.stdout.contains(&format!("12 pairs ({done} of them in an earlier run)")), "{}", run.stdout);
    assert!(scene.bytes("whole.parquet") == scene.bytes("out.parquet"));
    assert!(!journal.exists());

    // A run that is done is not repeated, and one of other pairs is not replaced.
    let run = scene.batch("out.parquet", &["--resume", "--top", "1"]);
    assert_eq!((run.status, run.stdout.as_str()), (Some(0), "out.parquet: is complete already\n"));
    scene.write("pairs.csv", many(13));
    let run = scene.batch("out.parquet", &["--resume", "--top", "1"]);
    assert!(run.status == Some(1) && run.stderr.contains("1 of 13 pairs have no row: 13"), "{}", run.stderr);
    assert!(scene.bytes("whole.parquet") == scene.bytes("out.parquet"));
}

#[test]
fn a_changed_file_of_constants_is_another_run() {
    let scene = Scene::new();
    scene.write("pairs.csv", "object,supporter\nball.obj,peg.xyz\n");
    scene.write("params.toml", "samples = 900\n");
    let options = ["--params", "params.toml"];
    assert_done(&scene.batch("out.csv", &options));
    // The journal of a run that was ended before its first row.
    let mut command = command();
    command.current_dir(scene.folder.path()).args(["batch", "pairs.csv", "-o", "new.csv"]).args(options);
    let mut child = command.spawn().unwrap();
    while !scene.path("new.csv.partial").exists() && child.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    let _ = child.kill();
    child.wait().unwrap();
    if !fs::read(scene.path("new.csv.partial")).unwrap_or_default().contains(&b'\n') {
        // It was done, or killed before it wrote which run it is.
        return;
    }
    scene.write("params.toml", "samples = 901\n");
    let run = scene.batch("new.csv", &["--params", "params.toml", "--resume"]);
    assert!(
        run.status == Some(1) && run.stderr.contains("a file of constants has changed"),
        "{}",
        run.stderr
    );
}

#[test]
fn bad_files_are_errors_of_their_rows() {
    let scene = Scene::new();
    scene.write("broken.obj", "v 0 0 zero\n");
    let (mut vertices, triangles) = shapes::weighted_ring();
    vertices.iter_mut().flatten().for_each(|x| *x *= 1000.0);
    scene.write("mm.obj", shapes::obj(&(vertices, triangles)));
    scene.write(
        "pairs.csv",
        "object,supporter,scene,top\nmissing.obj,peg.xyz,,1\nbroken.obj,peg.xyz,,1\npeg.xyz,peg.xyz,,1\nring.obj,missing.ply,,1\nring.obj,peg.xyz,missing.ply,1\nmm.obj,peg.xyz,,1\nring.obj,peg.xyz,,1\n",
    );
    let run = scene.batch("out.jsonl", &["--jobs", "2"]);
    assert_done(&run);
    assert!(run.stdout.contains("7 pairs in "), "{}", run.stdout);
    assert!(
        run.stdout.ends_with("1 hang, 1 do not, 5 with an error: see the column error\n"),
        "{}",
        run.stdout
    );
    let rows = scene.rows("out.jsonl");
    assert_eq!(rows.len(), 7);
    for (row, reason) in
        rows.iter().zip(["missing.obj", "broken.obj: line 1", "peg.xyz", "missing.ply", "missing.ply"])
    {
        let error = row["error"].as_str().unwrap();
        assert!(error.contains(reason) && row["rank"].is_null() && row["rejection"].is_null(), "{error}");
    }
    assert!(
        rows[5]["warning"]
            .as_str()
            .unwrap()
            .contains("if its unit is millimetres, pass --object-scale 0.001")
    );
    assert!(run.stderr.contains("warning: mm.obj: the object is "), "{}", run.stderr);
    assert_eq!((&rows[6]["rank"], &rows[6]["error"]), (&1.into(), &Value::Null));
}

#[test]
fn mistakes_in_the_table_name_their_line() {
    let scene = Scene::new();
    for (table, reason) in [
        ("", "line 1: the column object is missing"),
        ("object\nring.obj\n", "line 1: the column supporter is missing"),
        ("object,supporter\n", "there are no pairs"),
        (
            "object,supporter,colour\n",
            "line 1: the column \"colour\" is unknown; the columns are id, object, supporter, top, com",
        ),
        ("object,supporter,object\n", "line 1: the column \"object\" appears twice"),
        ("object,supporter\nring.obj,peg.xyz\n,peg.xyz\n", "line 3: the object is empty"),
        ("object,supporter\nring.obj,peg.xyz\nring.obj\n", "line 3: it has 1 fields, but the header has 2"),
        ("object,supporter\n\nring.obj,peg.xyz\nring.obj,peg.xyz,1\n", "line 4: it has 3 fields"),
        (
            "object,supporter,object_up\nring.obj,peg.xyz,\nring.obj,peg.xyz,w\n",
            "line 3: invalid value 'w' for '--object-up <AXIS>': use x, y, z",
        ),
        (
            "object,supporter,com\nring.obj,peg.xyz,\"1,2\"\n",
            "line 2: invalid value '1,2' for '--com <X,Y,Z>'",
        ),
        ("object,supporter,profile,allow\nring.obj,peg.xyz,paper,hooked\n", "line 2: --allow has no effect"),
        (
            "object,supporter,by,by_box\nring.obj,peg.xyz,\"0,0,0\",\"0,0,0,1,1,1\"\n",
            "line 2: the argument '--by <X,Y,Z[,R]>' cannot be used with",
        ),
        ("object,supporter,params\nring.obj,peg.xyz,none.toml\n", "line 2: none.toml: cannot be read"),
    ] {
        scene.write("pairs.csv", table);
        let run = scene.batch("out.csv", &[]);
        assert_eq!(run.status, Some(1), "{table}");
        let place = if reason.starts_with("line") { "pairs.csv, " } else { "pairs.csv: " };
        assert!(run.stderr.contains(&format!("error: {place}{reason}")), "{reason} in {}", run.stderr);
        assert!(!scene.path("out.csv").exists() && !scene.path("out.csv.partial").exists());
    }
    scene.write("pairs.csv", b"object,supporter\nring.obj,peg.xyz\n\xff.obj,peg.xyz\n");
    assert!(scene.batch("out.csv", &[]).stderr.contains("pairs.csv, line 3: it is not UTF-8"));

    // What spreadsheets write: a byte order mark and other ends of lines.
    scene.write("pairs.csv", "\u{feff}object,supporter\r\nball.obj,peg.xyz\r\n");
    assert_done(&scene.batch("out.csv", &[]));
}

#[test]
fn wrong_options_have_the_status_of_usage_and_wrong_files_that_of_input() {
    let scene = Scene::new();
    scene.write("pairs.csv", TABLE);
    for options in
        [&["--shard", "3/2"][..], &["--jobs", "0"], &["--object-up", "w"], &["--object", "ring.obj"]]
    {
        let run = scene.batch("out.csv", options);
        assert!(run.status == Some(2) && run.stderr.contains(options[0]), "{}", run.stderr);
    }
    for (output, options, reason) in [
        ("out.txt", &[][..], "give a file that ends in .parquet, .csv or .jsonl"),
        ("-", &[], "give a file that ends in"),
        ("none/out.csv", &[], "existing folder"),
        ("pairs.csv", &[], "is also an input"),
        ("out.csv", &["--params", "none.toml"], "none.toml: cannot be read"),
        ("out.csv", &["--profile", "paper", "--allow", "hooked"], "--allow has no effect"),
    ] {
        let run = scene.batch(output, options);
        assert!(run.status == Some(1) && run.stderr.contains(reason), "{reason} in {}", run.stderr);
    }
    let run = run!("batch", scene.path("none.csv"), "-o", scene.path("out.csv"));
    assert!(run.status == Some(1) && run.stderr.contains("none.csv: cannot be read"), "{}", run.stderr);
}

#[test]
fn the_formats_hold_the_same_and_parquet_has_types() {
    use parquet::basic::{LogicalType, Type};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;

    let scene = Scene::new();
    scene.write("pairs.csv", TABLE.replace("ball.obj", "none.obj"));
    for output in ["out.csv", "out.jsonl", "out.parquet"] {
        assert_done(&scene.batch(output, &OPTIONS));
    }
    let rows = scene.rows("out.jsonl");
    let mut csv = csv::Reader::from_path(scene.path("out.csv")).unwrap();
    let names: Vec<String> = csv.headers().unwrap().iter().map(Into::into).collect();
    let records: Vec<_> = csv.records().map(Result::unwrap).collect();
    let reader = SerializedFileReader::new(File::open(scene.path("out.parquet")).unwrap()).unwrap();
    let schema = reader.metadata().file_metadata().schema_descr();
    assert_eq!(schema.columns().iter().map(|column| column.name()).collect::<Vec<_>>(), names);
    for column in schema.columns() {
        let is_text = column.logical_type_ref() == Some(&LogicalType::String);
        match column.name() {
            "pair" | "rank" => assert_eq!(column.physical_type(), Type::INT64),
            "id" | "object" | "supporter" | "kind" | "rejection" | "reason" | "warning" | "error" => {
                assert!(is_text, "{}", column.name());
            }
            _ => assert_eq!(column.physical_type(), Type::DOUBLE, "{}", column.name()),
        }
    }
    let parquet: Vec<_> = reader.get_row_iter(None).unwrap().map(Result::unwrap).collect();
    assert_eq!((records.len(), parquet.len()), (rows.len(), rows.len()));
    for ((row, record), parquet) in rows.iter().zip(&records).zip(&parquet) {
        for (place, (name, field)) in parquet.get_column_iter().enumerate() {
            let (json, csv) = (&row[name], &record[place]);
            match field {
                Field::Null => assert!(json.is_null() && csv.is_empty(), "{name}"),
                Field::Long(value) => assert!(json == value && csv.parse() == Ok(*value), "{name}"),
                Field::Double(value) => assert!(json == value && csv.parse() == Ok(*value), "{name}"),
                Field::Str(value) => assert!(json == value && csv == value, "{name}"),
                other => panic!("{name} is {other}"),
            }
        }
    }
}
