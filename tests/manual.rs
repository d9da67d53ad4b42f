//! Shell completions and man pages are complete.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use crate::common::program::run;

fn stdout(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The subcommands, as `--help` lists them.
fn subcommands() -> Vec<String> {
    let help = stdout(&["--help"]);
    let list = help.split("Commands:\n").nth(1).unwrap();
    let lines = list.lines().take_while(|line| line.starts_with("  "));
    let names = lines.filter_map(|line| Some(line.split_whitespace().next()?.to_owned()));
    names.filter(|name| name != "help").collect()
}

#[test]
fn completions_of_every_shell_have_all_commands_and_some_options() {
    let names = subcommands();
    assert!(names.len() > 12, "{names:?}");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = stdout(&["generate", shell]);
        for name in &names {
            assert!(script.contains(name.as_str()), "{shell}: {name}");
        }
        for option in ["trajectory-fps", "debug-region", "preset"] {
            assert!(script.contains(option), "{shell}: {option}");
        }
    }
}

#[cfg(unix)]
#[test]
fn bash_completes_a_command_and_an_option() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sandbox.bash");
    fs::write(&file, stdout(&["generate", "bash"])).unwrap();
    let completed = |words: &str, last: usize| {
        let ask = format!(
            r#"source "$1"; COMP_WORDS=(sandbox {words}); COMP_CWORD={last}
               _sandbox sandbox "${{COMP_WORDS[{last}]}}" "${{COMP_WORDS[{last}-1]}}"
               echo "${{COMPREPLY[@]}}""#
        );
        let mut bash = Command::new("bash");
        let output = bash.args(["-c", &ask, "bash"]).arg(&file).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    assert_eq!(completed("evac", 1), "evacuation\n");
    assert_eq!(
        completed("plaza --traj", 2),
        "--trajectory --trajectory-fps\n"
    );
    assert_eq!(completed("plaza --preset acc", 3), "accurate\n");
}

#[test]
fn the_program_and_every_command_have_a_man_page() {
    let names = subcommands();
    let page = stdout(&["generate", "man"]);
    assert!(page.contains(".TH sandbox 1"), "{page}");
    for name in &names {
        assert!(page.contains(&format!("sandbox\\-{name}(1)")), "{name}");
    }
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("share/man1");
    assert_eq!(
        stdout(&["generate", "man", "--out", out.to_str().unwrap()]),
        ""
    );
    let text = |file: &str| fs::read_to_string(out.join(file)).unwrap();
    assert_eq!(text("sandbox.1"), page);
    let mut expected = BTreeSet::from(["sandbox.1".to_owned()]);
    for name in &names {
        let file = format!("sandbox-{name}.1");
        let page = text(&file);
        assert!(page.contains(&format!(".TH sandbox-{name} 1")), "{page}");
        assert!(page.contains("Example"), "{name}");
        expected.insert(file);
    }
    let files = fs::read_dir(&out).unwrap();
    let written = files.map(|file| file.unwrap().file_name().into_string().unwrap());
    assert_eq!(written.collect::<BTreeSet<_>>(), expected);
}

#[test]
fn old_spellings_say_the_same_and_name_the_new_ones() {
    for (old, new, called) in [
        (
            &["completions", "zsh"][..],
            &["generate", "zsh"][..],
            "generate SHELL",
        ),
        (&["man"], &["generate", "man"], "generate man"),
        (&["schema"], &["list", "--schema"], "list --schema"),
    ] {
        assert_eq!(stdout(old), stdout(new));
        let said = String::from_utf8(run(old).stderr).unwrap();
        assert!(
            said.contains(&format!("is `sandbox {called}` now")),
            "{said}"
        );
        assert!(run(new).stderr.is_empty());
    }
    let known = subcommands();
    for old in ["completions", "man", "schema", "page"] {
        assert!(!known.iter().any(|name| name == old), "{old}");
    }
}
