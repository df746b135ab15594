//! A write that fails leaves nothing behind, and what was there before as it was.
//!
//! A full disk is played by the limit on file sizes (`ulimit -f`), which makes writes fail half-way; it holds for a whole
//! process, so the test runs itself again as a child.

use std::fs;
use std::io::Write;
use std::process::{Child, Command, Stdio};

use crate::runner::{dvp, dvp_done, names, text};

/// Separates the arguments that the child reads from its environment.
const SEPARATOR: char = '\n';
const VARIABLE: &str = "DVP_TEST_CHILD";

/// Runs `dvp` in a process whose files may hold at most `blocks` blocks of 512 or 1024 bytes; returns what it says.
fn limited(arguments: &[&str], blocks: u32) -> String {
    let test = std::env::current_exe().unwrap();
    // Without the trap the system would end the process instead of refusing the write.
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" --exact interrupted::child --nocapture");
    let child = Command::new("sh")
        .args(["-c", &script, text(&test)])
        .env(VARIABLE, arguments.join(&SEPARATOR.to_string()))
        .output()
        .unwrap();
    String::from_utf8(child.stdout).unwrap()
}

/// Runs `dvp` in a process of its own, which can be killed.
pub(crate) fn spawned(arguments: &[&str]) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "interrupted::child"])
        .env(VARIABLE, arguments.join(&SEPARATOR.to_string()))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Not a test of its own: what [`limited`] and [`spawned`] run.
#[test]
fn child() {
    if let Ok(arguments) = std::env::var(VARIABLE) {
        let run = dvp(arguments.split(SEPARATOR));
        write!(std::io::stdout(), "code {} {}", run.code, run.err).unwrap();
    }
}

#[test]
#[cfg_attr(not(unix), ignore = "ulimit is of Unix shells")]
fn a_full_disk_leaves_the_old_file_and_no_other() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    dvp_done(["generate", "--count", "1", "--out", text(&data)]);
    let scenes = data.join("scenes.jsonl");
    let pictures = folder.path().join("pictures");
    let target = pictures.join("large.png");
    // 1024 x 1024 pixels of soft edges do not fit into 2 blocks.
    let render = ["render", text(&scenes), "--index", "0", "--width", "1024", "-o", text(&target)];
    let said = limited(&render, 2);
    assert!(said.contains("code 1") && said.contains("large.png: cannot be written"), "{said}");
    assert!(names(&pictures).is_empty(), "{:?}", names(&pictures));
    fs::write(&target, b"old").unwrap();
    assert!(limited(&render, 2).contains("code 1"));
    assert_eq!((names(&pictures), fs::read(&target).unwrap()), (vec!["large.png".to_owned()], b"old".to_vec()));
    // The same process without the limit: the failure was the disk's.
    assert!(limited(&render, 100_000).contains("code 0"));
    assert!(fs::read(&target).unwrap().starts_with(b"\x89PNG"));
}

#[test]
#[cfg_attr(not(unix), ignore = "ulimit is of Unix shells")]
fn a_data_set_that_does_not_fit_has_no_scenes_file() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    // Pictures fit into 8 blocks, the bank of 13 kB does not (blocks are of 512 or 1024 bytes).
    let said = limited(&["generate", "--count", "2", "--width", "32", "--out", text(&data)], 8);
    assert!(said.contains("code 1") && said.contains("bank.json: cannot be written"), "{said}");
    assert_eq!(names(&data), ["00000.png", "00001.png"]);
}

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "/dev/full is of Linux")]
fn devices_are_written_to_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.json");
    fs::write(&scene, r#"{"background":[0,0,0],"objects":[]}"#).unwrap();
    let full = folder.path().join("full.png");
    std::os::unix::fs::symlink("/dev/full", &full).unwrap();
    let run = dvp(["render", text(&scene), "-o", text(&full)]);
    assert!(run.code == 1 && run.err.contains("No space left"), "{}", run.err);
    assert!(!fs::metadata("/dev/full").unwrap().is_file());
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, b"in the way").unwrap();
    let run = dvp(["generate", "--count", "1", "--out", text(&file.join("data"))]);
    assert!(run.code == 1 && run.err.contains("cannot be written"), "{}", run.err);
    assert_eq!(names(folder.path()), ["file"]);
}
