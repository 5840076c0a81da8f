//! `batch` and `merge`: the rows are what `predict` says, and their bytes do not depend on how they came about.

use super::*;
use std::f64::consts::TAU;
use std::fs::{self, File};
use std::time::{Duration, Instant};

/// A table of pairs of a ring in several sizes and a block, with options that differ.
const TABLE: &str = "id,object,supporter,object_scale,allow,here
ring,ring.obj,hook.ply,,,
\"large, ring\",ring.obj,hook.ply,1.1,,
block,block.obj,hook.ply,,,
out of reach,ring.obj,hook.ply,,,\"1,1,1,0.01\"
at the middle,ring.obj,hook.ply,,,\"0.05,0,0.004,0.03\"
,ring.obj,hook.ply,1.2,threaded,
";

/// Options for all pairs.
const OPTIONS: [&str; 4] = ["--top", "2", "--seed", "1"];

/// A folder with a ring of few triangles, a block that cannot hang, and the hook of the samples.
struct Pairs {
    folder: TempDir,
}

impl Pairs {
    fn new(table: impl AsRef<[u8]>) -> Self {
        let pairs = Self { folder: tempfile::tempdir().unwrap() };
        let ring = shapes::grid(24, 10, |u, v| {
            let (u, v) = (TAU * u, TAU * v);
            let r = 0.03 + 0.003 * v.cos();
            [r * u.cos(), 0.003 * v.sin(), r * u.sin()]
        });
        pairs.write("ring.obj", shapes::obj(&ring));
        pairs.write(
            "block.obj",
            "v 0 0 0\nv 0.04 0 0\nv 0 0.04 0\nv 0 0 0.04\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
        );
        fs::copy(sample("hook.ply"), pairs.path("hook.ply")).unwrap();
        pairs.write("pairs.csv", table);
        pairs
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

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
    let scene = Pairs::new(TABLE);
    let run = scene.batch("out.jsonl", &OPTIONS);
    assert_done(&run);
    assert_eq!(run.stderr, "", "no progress without a terminal");
    assert!(
        run.stdout.starts_with("out.jsonl: 6 pairs in ")
            && run.stdout.ends_with(": 4 hang, 2 do not, 0 with an error\n")
    );
    let rows = scene.rows("out.jsonl");
    for (number, (id, object, options)) in (1..).zip([
        ("ring", "ring.obj", vec![]),
        ("large, ring", "ring.obj", vec!["--object-scale", "1.1"]),
        ("block", "block.obj", vec![]),
        ("out of reach", "ring.obj", vec!["--here", "1,1,1,0.01"]),
        ("at the middle", "ring.obj", vec!["--here", "0.05,0,0.004,0.03"]),
        ("6", "ring.obj", vec!["--object-scale", "1.2", "--allow", "threaded"]),
    ]) {
        let mut command = command();
        command.current_dir(scene.folder.path());
        command.args(["predict", "--json", "-", "--object", object, "--supporter", "hook.ply"]);
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
    let scene = Pairs::new(TABLE);
    assert_done(&scene.batch("one.csv", &[&OPTIONS[..], &["--jobs", "1"]].concat()));
    let one = scene.bytes("one.csv");
    assert_done(&scene.batch("two.csv", &[&OPTIONS[..], &["--jobs", "2", "--memory", "0"]].concat()));
    assert!(one == scene.bytes("two.csv"), "two jobs");
    for (shard, output) in [("1/3", "1.csv"), ("2/3", "2.jsonl"), ("3/3", "3.parquet")] {
        assert_done(&scene.batch(output, &[&OPTIONS[..], &["--shard", shard]].concat()));
    }
    assert_done(&scene.merge("merged.csv", &["3.parquet", "1.csv", "2.jsonl"]));
    assert!(one == scene.bytes("merged.csv"), "merged");
    // Through the other formats and back.
    for format in ["merged.jsonl", "merged.parquet"] {
        assert_done(&scene.merge(format, &["one.csv"]));
        assert_done(&scene.merge("back.csv", &[format]));
        assert!(one == scene.bytes("back.csv"), "{format}");
    }

    let message = |shards: &[&str]| {
        let run = scene.merge("bad.csv", shards);
        assert_eq!(run.status, Some(1), "{}", run.stdout);
        assert!(!scene.path("bad.csv").exists());
        run.stderr
    };
    let text = message(&["1.csv", "3.parquet"]);
    assert!(text.contains("2 of 6 pairs have no row: 3, 4"), "{text}");
    let text = message(&["1.csv", "2.jsonl", "3.parquet", "one.csv"]);
    assert!(text.contains("pair 1 is in 1.csv and in one.csv: give each shard once"), "{text}");
    scene.write("pairs.csv", TABLE.replace("block.obj", "other.obj"));
    let text = message(&["one.csv"]);
    assert!(
        text.contains("pair 3 is block.obj on hook.ply in the rows, but other.obj on hook.ply"),
        "{text}"
    );
}

/// A table of as many pairs, each with an object of its own.
fn many(pairs: u32) -> String {
    let line = |i| format!("ring.obj,hook.ply,{}\n", 1.0 + f64::from(i) / 100.0);
    (0..pairs).map(line).fold("object,supporter,object_scale\n".into(), |all, line| all + &line)
}

#[test]
fn a_killed_run_goes_on_where_it_was() {
    let scene = Pairs::new(many(24));
    let constants = "samples = 900\n";
    scene.write("params.toml", constants);
    let options = ["--params", "params.toml", "--top", "1"];
    assert_done(&scene.batch("whole.parquet", &options));
    let journal = scene.path("out.parquet.partial");
    let lines = || fs::read(&journal).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count();
    let mut command = command();
    command.current_dir(scene.folder.path()).args(["batch", "pairs.csv", "-o", "out.parquet", "--jobs", "1"]);
    command.args(options);
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
    assert!((3..24).contains(&done) && !scene.path("out.parquet").exists());

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
    let again = |more: &[&'static str]| [&options[..], &["--resume"], more].concat();
    refused(&options, "an earlier run has ended before it was done; pass --resume");
    let other = ["--resume", "--params", "params.toml", "--top", "2"];
    refused(&other, "it had --top=1 --params=params.toml, now there are --top=2 --params=params.toml");
    refused(&again(&["--shard", "1/2"]), "its shard was pairs 1 to 24, now it is pairs 1 to 12");
    scene.write("params.toml", "samples = 901\n");
    refused(&again(&[]), "a file of constants has changed");
    scene.write("params.toml", constants);
    scene.write("pairs.csv", many(25));
    refused(&again(&[]), "the table of pairs has changed");
    scene.write("pairs.csv", many(24));
    let held = File::options().write(true).open(&journal).unwrap();
    held.lock().unwrap();
    refused(&again(&[]), "another run is writing it");
    drop(held);

    // The number of jobs changes no result, so that it may be another one.
    let run = scene.batch("out.parquet", &again(&["--jobs", "2"]));
    assert_done(&run);
    assert!(run.stdout.contains(&format!("24 pairs ({done} of them in an earlier run)")), "{}", run.stdout);
    assert!(scene.bytes("whole.parquet") == scene.bytes("out.parquet"));
    assert!(!journal.exists());

    // A run that is done is not repeated, and one of other pairs is not replaced.
    let run = scene.batch("out.parquet", &again(&[]));
    assert_eq!((run.status, run.stdout.as_str()), (Some(0), "out.parquet: is complete already\n"));
    scene.write("pairs.csv", many(25));
    let run = scene.batch("out.parquet", &again(&[]));
    assert!(run.status == Some(1) && run.stderr.contains("1 of 25 pairs have no row: 25"), "{}", run.stderr);
    assert!(scene.bytes("whole.parquet") == scene.bytes("out.parquet"));
}

#[test]
fn bad_files_are_errors_of_their_rows() {
    let scene = Pairs::new("");
    scene.write("broken.obj", "v 0 0 zero\n");
    scene.write("mm.obj", "v 0 0 0\nv 40 0 0\nv 0 40 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    scene.write(
        "pairs.csv",
        "object,supporter,scene,top\nmissing.obj,hook.ply,,1\nbroken.obj,hook.ply,,1\nhook.ply,hook.ply,,1\nring.obj,missing.ply,,1\nring.obj,hook.ply,missing.ply,1\nmm.obj,hook.ply,,1\nring.obj,hook.ply,,1\n",
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
        rows.iter().zip(["missing.obj", "broken.obj: line 1", "hook.ply", "missing.ply", "missing.ply"])
    {
        let error = row["error"].as_str().unwrap();
        assert!(error.contains(reason) && row["rank"].is_null() && row["rejection"].is_null(), "{error}");
    }
    assert!(rows[5]["warning"].as_str().unwrap().contains("pass --object-scale 0.001"));
    assert!(run.stderr.contains("warning: mm.obj: the object is "), "{}", run.stderr);
    assert_eq!((&rows[6]["rank"], &rows[6]["error"]), (&1.into(), &Value::Null));
}

#[test]
fn mistakes_in_the_table_name_their_line() {
    let scene = Pairs::new("");
    for (table, reason) in [
        ("", "line 1: the column object is missing"),
        ("object\nring.obj\n", "line 1: the column supporter is missing"),
        ("object,supporter\n", "there are no pairs"),
        (
            "object,supporter,colour\n",
            "line 1: the column \"colour\" is unknown; the columns are id, object, supporter, top, com",
        ),
        ("object,supporter,object\n", "line 1: the column \"object\" appears twice"),
        ("object,supporter\nring.obj,hook.ply\n,hook.ply\n", "line 3: the object is empty"),
        ("object,supporter\nring.obj,hook.ply\nring.obj\n", "line 3: it has 1 fields, but the header has 2"),
        ("object,supporter\n\nring.obj,hook.ply\nring.obj,hook.ply,1\n", "line 4: it has 3 fields"),
        (
            "object,supporter,object_up\nring.obj,hook.ply,\nring.obj,hook.ply,w\n",
            "line 3: invalid value 'w' for '--object-up <AXIS>': use x, y, z",
        ),
        (
            "object,supporter,com\nring.obj,hook.ply,\"1,2\"\n",
            "line 2: invalid value '1,2' for '--com <X,Y,Z>'",
        ),
        ("object,supporter,profile,allow\nring.obj,hook.ply,paper,hooked\n", "line 2: --allow has no effect"),
        (
            "object,supporter,by,by_box\nring.obj,hook.ply,\"0,0,0\",\"0,0,0,1,1,1\"\n",
            "line 2: the argument '--by <X,Y,Z[,R]>' cannot be used with",
        ),
        ("object,supporter,params\nring.obj,hook.ply,none.toml\n", "line 2: none.toml: cannot be read"),
    ] {
        scene.write("pairs.csv", table);
        let run = scene.batch("out.csv", &[]);
        assert_eq!(run.status, Some(1), "{table}");
        let place = if reason.starts_with("line") { "pairs.csv, " } else { "pairs.csv: " };
        assert!(run.stderr.contains(&format!("error: {place}{reason}")), "{reason} in {}", run.stderr);
        assert!(!scene.path("out.csv").exists() && !scene.path("out.csv.partial").exists());
    }
    scene.write("pairs.csv", b"object,supporter\nring.obj,hook.ply\n\xff.obj,hook.ply\n");
    assert!(scene.batch("out.csv", &[]).stderr.contains("pairs.csv, line 3: it is not UTF-8"));

    // What spreadsheets write: a byte order mark and other ends of lines.
    scene.write("pairs.csv", "\u{feff}object,supporter\r\nblock.obj,hook.ply\r\n");
    assert_done(&scene.batch("out.csv", &[]));
}

#[test]
fn wrong_options_have_the_status_of_usage_and_wrong_files_that_of_input() {
    let scene = Pairs::new(TABLE);
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

    let scene = Pairs::new(TABLE.replace("block.obj", "none.obj"));
    for output in ["out.jsonl", "out.parquet"] {
        assert_done(&scene.batch(output, &OPTIONS));
    }
    assert_done(&scene.merge("out.csv", &["out.jsonl"]));
    let rows = scene.rows("out.jsonl");
    // What a run writes is what a merge does.
    assert_done(&scene.merge("merged.parquet", &["out.jsonl"]));
    assert!(scene.bytes("out.parquet") == scene.bytes("merged.parquet"));
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
