//! Destinations of the result and the previous content of files.

use super::*;
use std::process::Stdio;

#[track_caller]
fn assert_only(folder: &Path, names: &[&str]) {
    let mut found: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    found.sort();
    assert_eq!(found, names);
}

#[test]
fn a_dash_gives_nothing_but_json() {
    let scene = Scene::new();
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", "-");
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    assert!(run.stdout.starts_with('{') && run.stdout.ends_with("}\n"));
    assert_eq!(run.json()["schema"], 2);
}

#[test]
fn a_file_holds_what_a_dash_prints_and_the_table_is_shown() {
    let scene = Scene::new();
    let out = scene.path("out.json");
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", out);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("hangs with probability "));
    let written = serde_json::from_slice(&std::fs::read(&out).unwrap()).unwrap();
    assert_eq!(timeless(written), timeless(scene.predict(&[])));
    assert_only(scene.folder.path(), &["ball.obj", "out.json", "peg.xyz", "ring.obj"]);
}

#[test]
fn a_file_is_replaced_by_an_answer_and_kept_from_an_error() {
    let scene = Scene::new();
    let out = scene.write("out.json", "precious");
    let read = || std::fs::read_to_string(&out).unwrap();
    let bad = scene.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    let run = run!("predict", "--object", bad, "--supporter", scene.peg, "--json", out);
    assert_eq!((run.status, read().as_str()), (Some(1), "precious"));
    let run = run!("predict", "--object", scene.ball, "--supporter", scene.peg, "--json", out);
    assert_eq!(run.status, Some(3));
    assert!(read().contains("no_contact_points"), "a rejection is written, too");
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", out);
    assert_eq!(run.status, Some(0));
    assert!(read().contains("\"rejection\": null"));
    assert_only(scene.folder.path(), &["bad.obj", "ball.obj", "out.json", "peg.xyz", "ring.obj"]);
}

#[test]
fn an_input_is_not_written_over() {
    let scene = Scene::new();
    let before = std::fs::read(&scene.peg).unwrap();
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", scene.peg);
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("peg.xyz: is also an input") && run.stderr.contains("another file"));
    assert_eq!(std::fs::read(&scene.peg).unwrap(), before);
}

#[test]
fn a_place_that_cannot_be_written_is_found_before_the_work() {
    let scene = Scene::new();
    for out in
        [scene.path("none/out.json"), scene.folder.path().to_path_buf(), scene.path("peg.xyz/out.json")]
    {
        // The object is missing, which would be the error if the computation had begun.
        let run =
            run!("predict", "--object", scene.path("none.obj"), "--supporter", scene.peg, "--json", out);
        assert_eq!((run.status, run.stdout.as_str()), (Some(1), ""));
        assert!(run.stderr.contains(out.to_str().unwrap()), "{}", run.stderr);
        assert!(run.stderr.contains("cannot be written") && run.stderr.contains("give a file"));
        let after = run.stderr.split_once(out.to_str().unwrap()).unwrap().1;
        assert!(!after.contains(".tmp"), "the message names the temporary file: {}", run.stderr);
    }
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let scene = Scene::new();
    let ring = scene.ring.to_str().unwrap();
    let predict = ["predict", "--object", ring, "--supporter", scene.peg.to_str().unwrap()];
    for arguments in [vec!["inspect", ring], predict.to_vec(), [&predict[..], &["--json", "-"]].concat()] {
        let mut child =
            command().args(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let Output { status, stderr, .. } = child.wait_with_output().unwrap();
        assert_eq!((status.code(), stderr), (Some(0), vec![]), "{arguments:?}");
    }
}

#[test]
fn nobody_listening_to_notes_is_no_error() {
    let scene = Scene::new();
    let bare = scene.write("bare.xyz", shapes::xyz(&shapes::without_normals(&shapes::peg())));
    let mut child = command()
        .args(["inspect", bare.to_str().unwrap()])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stderr.take());
    let Output { status, stdout, .. } = child.wait_with_output().unwrap();
    assert_eq!(status.code(), Some(0));
    assert!(stdout.starts_with(b"supporter, "));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_the_file_is_still_written() {
    let scene = Scene::new();
    let out = scene.path("out.json");
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let mut command = command();
    command.args(["predict", "--object"]).arg(&scene.ring).arg("--supporter").arg(&scene.peg);
    let Output { status, stderr, .. } = command.arg("--json").arg(&out).stdout(full).output().unwrap();
    assert_eq!(status.code(), Some(1));
    assert!(String::from_utf8(stderr).unwrap().starts_with("error: standard output cannot be written"));
    assert!(out.exists());
}

#[cfg(unix)]
#[test]
fn pipes_and_links_stay_what_they_are() {
    use std::os::unix::fs::FileTypeExt;
    let scene = Scene::new();
    let pipe = scene.path("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || std::fs::read_to_string(pipe).unwrap()
    });
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", pipe);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    // Checked first: if the pipe had been replaced, the reader would block forever.
    assert!(std::fs::metadata(&pipe).unwrap().file_type().is_fifo());
    assert_eq!(
        timeless(serde_json::from_str(&reader.join().unwrap()).unwrap()),
        timeless(scene.predict(&[]))
    );

    let (target, link) = (scene.write("target.json", "old"), scene.path("link.json"));
    std::os::unix::fs::symlink(&target, &link).unwrap();
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", link);
    assert_eq!(run.status, Some(0), "{}", run.stderr);
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert!(std::fs::read_to_string(&target).unwrap().contains("\"schema\": 2"));
}
