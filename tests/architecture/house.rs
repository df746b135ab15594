//! The house rules that no lint knows: lengths, names, lints in every manifest, nothing unsafe, nothing private.

use crate::source::{Source, code_lines, rust_sources, sources};

/// Most lines of a file of core and models.
const MOST_LINES: usize = 400;

/// Names that say nothing.
const EMPTY_NAMES: [&str; 5] = ["utils", "util", "common", "misc", "helpers"];

/// The crates' own code.
const CODE: [&str; 2] = ["core", "models"];

fn too_long(source: &Source) -> Option<String> {
    let lines = source.text.lines().count();
    (lines > MOST_LINES).then(|| format!("{}: {lines} lines, at most {MOST_LINES}", source.path))
}

fn empty_name(source: &Source) -> Option<String> {
    let mut parts = source.path.trim_end_matches(".rs").split('/');
    let part = parts.find(|part| EMPTY_NAMES.contains(part))?;
    Some(format!("{}: \"{part}\" says nothing", source.path))
}

/// The word `unsafe` outside comments.
fn unsafe_word(source: &Source) -> Option<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let (line, _) =
        code_lines(&source.text).find(|(_, code)| code.split(|c| !is_name(c)).any(|word| word == "unsafe"))?;
    Some(format!("{}:{line}: unsafe", source.path))
}

/// Folders of somebody's machine.
fn private_path(source: &Source) -> Option<String> {
    // In two pieces, so that this file does not find itself.
    let starts = ["work", "home", "root", "Users"].map(|folder| format!("/{folder}/"));
    let mut lines = (1..).zip(source.text.lines());
    let (line, start) = lines
        .find_map(|(number, line)| starts.iter().find(|start| is_absolute(line, start)).map(|start| (number, start)))?;
    Some(format!("{}:{line}: mentions a folder under {start}", source.path))
}

/// Whether `start` occurs in `line` as the beginning of a path, not inside one or in a web address.
fn is_absolute(line: &str, start: &str) -> bool {
    line.match_indices(start)
        .any(|(at, _)| !line[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || "._-/$}~".contains(c)))
}

/// A `*_vjp.rs` without the forward step beside it.
fn lone_vjp(source: &Source, all: &[Source]) -> Option<String> {
    let forward = format!("{}.rs", source.path.strip_suffix("_vjp.rs")?);
    (!all.iter().any(|other| other.path == forward)).then(|| format!("{}: no {forward} beside it", source.path))
}

/// Whether `[lints] workspace = true` stands in a manifest.
fn shares_lints(manifest: &str) -> bool {
    let mut lines = manifest.lines().map(str::trim).skip_while(|line| *line != "[lints]").skip(1);
    lines.any(|line| line == "workspace = true")
}

fn assert_none(found: impl Iterator<Item = String>) {
    let found: Vec<String> = found.collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

fn code() -> Vec<Source> {
    CODE.iter().flat_map(|folder| rust_sources(folder)).collect()
}

#[test]
fn files_are_short_and_have_names() {
    let code = code();
    assert_none(code.iter().filter_map(too_long).chain(code.iter().filter_map(empty_name)));
}

#[test]
fn every_vjp_has_its_forward_step_beside_it() {
    let code = code();
    assert!(code.iter().any(|source| source.path.ends_with("_vjp.rs")), "there are some");
    assert_none(code.iter().filter_map(|source| lone_vjp(source, &code)));
}

#[test]
fn nothing_is_unsafe_but_the_allocator_of_the_no_std_proof() {
    let mut code = code();
    code.extend(rust_sources("tests").into_iter().filter(|source| !source.path.starts_with("tests/no_std/")));
    code.retain(|source| source.path != "tests/architecture/house.rs");
    assert_none(code.iter().filter_map(unsafe_word));
}

#[test]
fn every_crate_takes_the_lints_of_the_workspace() {
    let workspace = sources("").into_iter().find(|source| source.path == "Cargo.toml").unwrap();
    assert!(workspace.text.lines().any(|line| line == "unsafe_code = \"forbid\""), "unsafe code is forbidden");
    for folder in [
        "core",
        "models/trace",
        "models/fit",
        "models/double",
        "models/net",
        "models/formats",
        "models/web",
        "models/cli",
        "models/lab",
        "models/dvp",
        "backends/burn",
        "backends/candle",
        "tests",
    ] {
        let manifest = format!("{folder}/Cargo.toml");
        let source = sources(folder).into_iter().find(|source| source.path == manifest).unwrap();
        assert!(shares_lints(&source.text), "{manifest}: needs [lints] workspace = true");
    }
}

#[test]
fn no_file_mentions_folders_of_a_machine() {
    assert_none(sources("").iter().filter_map(private_path));
}

#[test]
fn made_up_files_are_judged() {
    let source = |path: &str, text: &str| Source { path: path.to_owned(), text: text.to_owned() };
    assert!(too_long(&source("core/src/a.rs", &"\n".repeat(401))).is_some());
    assert!(too_long(&source("core/src/a.rs", &"\n".repeat(400))).is_none());
    assert!(empty_name(&source("core/src/utils/mod.rs", "")).is_some());
    assert!(empty_name(&source("core/src/helpers.rs", "")).is_some());
    assert!(empty_name(&source("core/src/commonplace.rs", "")).is_none());
    assert!(unsafe_word(&source("a.rs", "let x = unsafe { y };")).is_some());
    assert!(unsafe_word(&source("a.rs", "// unsafe\n#![forbid(unsafe_code)]")).is_none());
    assert!(private_path(&source("a.rs", &format!("open(\"/{}/x\")", "work"))).is_some());
    assert!(private_path(&source("a.md", &format!("../{0}/x and https://a.b/{0}/x", "home"))).is_none());
    assert!(lone_vjp(&source("a/b_vjp.rs", ""), &[source("a/c.rs", "")]).is_some());
    assert!(lone_vjp(&source("a/b_vjp.rs", ""), &[source("a/b.rs", "")]).is_none());
    assert!(shares_lints("[lints]\nworkspace = true\n"));
    assert!(!shares_lints("[package]\nversion.workspace = true\n[lints.rust]\n"));
}
