//! What may happen to a run from outside: a full disk, files that change while they are read, and a kill at any moment. The
//! result is whole or not there, and the exit status says which.
#![cfg(target_os = "linux")]

use super::*;
use std::os::unix::process::ExitStatusExt;
use std::process::{ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Signal of a process that writes more than it may.
const SIGXFSZ: i32 = 25;
const SIGKILL: i32 = 9;

/// The command in a shell, after `limits` of the shell.
fn limited(limits: &str, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    let script = format!("{limits}; exec \"$0\" \"$@\"");
    command.args(["-c", &script]).arg(env!("CARGO_BIN_EXE_hangpose")).args(arguments);
    command
}

/// The names in a folder.
fn names(folder: &Path) -> Vec<String> {
    let mut found: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    found.sort();
    found
}

/// Whether a file is a whole result.
fn is_whole(path: &Path) -> bool {
    let text = std::fs::read_to_string(path).unwrap();
    text.ends_with("}\n") && serde_json::from_str::<Value>(&text).is_ok_and(|value| value["schema"] == 2)
}

#[test]
fn a_disk_that_is_full_keeps_the_last_result() {
    let scene = Scene::new();
    let (ring, peg) = (scene.ring.to_str().unwrap(), scene.peg.to_str().unwrap());
    let folder = scene.path("results");
    std::fs::create_dir(&folder).unwrap();
    let out = folder.join("out.json");
    std::fs::write(&out, "precious").unwrap();
    let predict = ["predict", "--object", ring, "--supporter", peg, "--json", out.to_str().unwrap()];
    // A file may be half a kilobyte long. The write fails as on a full disk.
    let run = finish(&mut limited("trap '' XFSZ; ulimit -f 1", &predict));
    assert_eq!(run.status, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("out.json: cannot be written (file too large)"), "{}", run.stderr);
    assert_eq!(
        (std::fs::read_to_string(&out).unwrap().as_str(), names(&folder)),
        ("precious", vec!["out.json".into()])
    );
    // A file system ends the process instead.
    let status = limited("ulimit -f 1", &predict).stderr(Stdio::null()).status().unwrap();
    assert_eq!(
        (status.signal(), std::fs::read_to_string(&out).unwrap().as_str()),
        (Some(SIGXFSZ), "precious")
    );
    // A device that is full.
    let run = run!("predict", "--object", scene.ring, "--supporter", scene.peg, "--json", "/dev/full");
    assert_eq!(run.status, Some(1), "{}", run.stderr);
    assert!(run.stderr.contains("/dev/full"), "{}", run.stderr);
    // Other results are written in the same way.
    let (page, picture) = (scene.path("page.html"), scene.path("picture.png"));
    let [page, picture] = [&page, &picture].map(|path| path.to_str().unwrap());
    let shown = [&predict[..5], &["--view", page, "--png", picture]].concat();
    let run = finish(&mut limited("trap '' XFSZ; ulimit -f 1", &shown));
    assert_eq!(run.status, Some(1), "{}", run.stderr);
    assert!(!Path::new(page).exists() && !Path::new(picture).exists());
}

#[test]
fn a_kill_at_any_moment_leaves_a_whole_result_or_none() {
    let scene = Scene::new();
    let out = scene.path("out.json");
    let start = |json: &Path| {
        let mut command = command();
        command.args(["predict", "--object"]).arg(&scene.ring).arg("--supporter").arg(&scene.peg);
        command.arg("--json").arg(json).stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(start(&out).wait().unwrap().success());
    let whole = begun.elapsed();
    let mut kills = 0;
    const MOMENTS: u32 = 24;
    for moment in 0..MOMENTS {
        let _ = std::fs::remove_file(&out);
        let mut child = start(&out);
        if moment % 2 == 0 {
            std::thread::sleep(whole * moment / MOMENTS);
        } else {
            // As soon as there is a result, of which a part may be missing.
            while !out.exists() && child.try_wait().unwrap().is_none() {
                std::hint::spin_loop();
            }
        }
        child.kill().unwrap();
        let status: ExitStatus = child.wait().unwrap();
        let was_killed = status.signal() == Some(SIGKILL);
        kills += u32::from(was_killed);
        assert!(was_killed || status.success(), "{status}");
        assert!(was_killed || out.exists(), "a run that succeeded has a result");
        assert!(!out.exists() || is_whole(&out), "a part of a result");
    }
    assert!(kills > MOMENTS / 4, "{kills} of {MOMENTS} runs were killed");
}

/// What has changed between the look at a file and its reading: the kernel's own files say 4096 bytes or none and hold others.
#[test]
fn a_file_of_another_length_than_it_says_is_read_to_its_end() {
    let scene = Scene::new();
    for (name, kernel) in [("shorter.ply", "/sys/devices/system/cpu/online"), ("longer.ply", "/proc/version")]
    {
        let path = scene.path(name);
        std::os::unix::fs::symlink(kernel, &path).unwrap();
        let said = std::fs::metadata(&path).unwrap().len();
        assert_ne!(said, std::fs::read(&path).unwrap().len() as u64, "{kernel}");
        let run = run!("inspect", path);
        assert_eq!(run.status, Some(1), "{}", run.stderr);
        let is_named =
            run.stderr.contains(name) && run.stderr.contains("PLY") && !run.stderr.contains("empty");
        assert!(is_named && run.stdout.is_empty(), "{}", run.stderr);
    }
}

#[test]
fn a_file_that_changes_while_it_is_read_is_an_input_like_any_other() {
    let scene = Scene::new();
    let (whole, changing) = (std::fs::read(sample("hook.ply")).unwrap(), scene.path("changing.ply"));
    std::fs::write(&changing, &whole).unwrap();
    /// Ends the changes also when the test fails.
    struct Over<'a>(&'a AtomicBool);
    impl Drop for Over<'_> {
        fn drop(&mut self) {
            self.0.store(true, Ordering::Relaxed);
        }
    }
    let is_over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let _over = Over(&is_over);
        scope.spawn(|| {
            // It is cut to half and grows again, thousands of times a second.
            let file = std::fs::File::options().write(true).open(&changing).unwrap();
            while !is_over.load(Ordering::Relaxed) {
                file.set_len(whole.len() as u64 / 2).unwrap();
                std::fs::write(&changing, &whole).unwrap();
            }
        });
        let begun = Instant::now();
        let (mut runs, mut cut) = (0, 0);
        while runs < 20 || (cut == 0 && begun.elapsed() < Duration::from_secs(30)) {
            let run = run!("inspect", changing, "--as", "supporter", "--profile", "paper");
            runs += 1;
            match run.status {
                Some(0) => {}
                Some(1) => {
                    cut += 1;
                    let is_named = run.stderr.contains("changing.ply") && run.stderr.contains("error: ");
                    assert!(is_named && run.stdout.is_empty(), "{}", run.stderr);
                }
                other => panic!("{other:?}: {}", run.stderr),
            }
        }
        assert!(cut > 0, "no run met a file that was cut");
    });
}
