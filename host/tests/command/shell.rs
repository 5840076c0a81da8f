//! Completions, man pages, and the examples of the help.

use super::*;
use std::fs;

/// Names of the subcommands, from the list in the help.
fn subcommands() -> Vec<String> {
    let help = run!("--help").stdout;
    let list = help.split_once("Commands:\n").unwrap().1.split_once("\n\n").unwrap().0;
    let names: Vec<_> =
        list.lines().map(|line| line.split_whitespace().next().unwrap().to_string()).collect();
    names.into_iter().filter(|name| name != "help").collect()
}

#[test]
fn every_shell_gets_a_script_that_knows_the_subcommands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let run = run!("completions", shell);
        assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""), "{shell}");
        for name in subcommands() {
            assert!(run.stdout.contains(&name), "{shell} does not know {name}");
        }
        assert!(run.stdout.contains("object-scale"), "{shell}");
    }
    assert_eq!(run!("completions", "dos").status, Some(2));
}

/// What bash offers for the last word of a line.
fn completed(script: &Path, words: &[&str]) -> String {
    let line = words.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(" ");
    let ask = format!(
        "source '{}'; COMP_WORDS=({line}); COMP_CWORD={}; _hangpose hangpose '{}' '{}'; echo \"${{COMPREPLY[*]}}\"",
        script.display(),
        words.len() - 1,
        words[words.len() - 1],
        words[words.len() - 2],
    );
    let run = finish(Command::new("bash").args(["--norc", "-c", &ask]));
    assert_eq!((run.status, run.stderr.as_str()), (Some(0), ""));
    run.stdout
}

#[test]
fn bash_completes_subcommands_options_and_values() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("hangpose.bash");
    fs::write(&script, run!("completions", "bash").stdout).unwrap();
    assert_eq!(completed(&script, &["hangpose", "insp"]), "inspect\n");
    assert_eq!(completed(&script, &["hangpose", "predict", "--object-sc"]), "--object-scale\n");
    assert_eq!(completed(&script, &["hangpose", "predict", "--profile", "p"]), "paper\n");
}

#[test]
fn each_subcommand_has_a_man_page() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("share/man1");
    let run = run!("man", pages);
    assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (Some(0), "", ""));
    let text = |name: &str| fs::read_to_string(pages.join(name)).unwrap();
    for name in subcommands() {
        let page = text(&format!("hangpose-{name}.1"));
        assert!(page.contains(&format!(".TH hangpose-{name} 1")), "{page}");
        for section in ["NAME", "SYNOPSIS", "DESCRIPTION", "EXAMPLES"] {
            assert!(page.contains(&format!(".SH {section}\n")), "{name} has no {section}");
        }
        assert!(text("hangpose.1").contains(&name.replace('-', "\\-")));
    }
    assert_eq!(fs::read_dir(&pages).unwrap().count(), 1 + subcommands().len());
    assert!(text("hangpose-predict.1").contains("object\\-scale"));

    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let run = run!("man", file.join("man1"));
    assert_eq!(run.status, Some(1));
    assert!(run.stderr.contains("give a folder with write permission"), "{}", run.stderr);
}

#[test]
fn every_example_of_every_help_works() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("samples")).unwrap();
    for entry in fs::read_dir(sample("")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), folder.path().join("samples").join(entry.file_name())).unwrap();
    }
    let binaries = Path::new(env!("CARGO_BIN_EXE_hangpose")).parent().unwrap();
    let path = format!("{}:{}", binaries.display(), std::env::var("PATH").unwrap());
    let helps = [vec!["--help".to_string()]].into_iter();
    let helps = helps.chain(subcommands().into_iter().map(|name| vec![name, "--help".into()]));
    let mut done = Vec::new();
    for arguments in helps {
        let help = finish(command().args(&arguments)).stdout;
        let examples =
            help.split_once("\nExample").unwrap_or_else(|| panic!("{arguments:?} has no example")).1;
        let examples: Vec<_> = examples.lines().filter(|line| line.starts_with("  hangpose ")).collect();
        assert!(!examples.is_empty(), "{arguments:?}");
        for example in examples {
            if done.contains(&example.to_string()) {
                continue;
            }
            let run =
                finish(Command::new("sh").args(["-c", example]).current_dir(&folder).env("PATH", &path));
            assert_eq!(run.status, Some(0), "{example}: {}", run.stderr);
            done.push(example.to_string());
        }
    }
    assert!(done.len() > subcommands().len());
}
