//! Between crates: `core -> backends/*`, `core -> models/trace -> models/fit -> models/net, models/formats -> models/web, models/cli -> models/lab
//! -> models/dvp -> tests`, a tensor framework in
//! its own adapter only, and none in what a newcomer builds.

use std::process::Command;

use serde::Deserialize;

use crate::source::root;

/// Every crate of the workspace, its folder, and the crates of the workspace that it may use.
const PLAN: [(&str, &str, &[&str]); 13] = [
    ("dvp-core", "core", &[]),
    ("dvp-burn", "backends/burn", &["dvp-core"]),
    ("dvp-candle", "backends/candle", &["dvp-core"]),
    ("dvp-trace", "models/trace", &["dvp-core"]),
    ("dvp-fit", "models/fit", &["dvp-core", "dvp-trace"]),
    ("dvp-double", "models/double", &["dvp-core", "dvp-fit"]),
    ("dvp-net", "models/net", &["dvp-core", "dvp-fit"]),
    ("dvp-formats", "models/formats", &["dvp-core", "dvp-fit"]),
    ("dvp-wasm", "models/web", &["dvp-core", "dvp-fit", "dvp-formats"]),
    // The adapters behind features that the default build leaves out, as another test here shows.
    (
        "dvp-cli",
        "models/cli",
        &["dvp-core", "dvp-burn", "dvp-candle", "dvp-trace", "dvp-fit", "dvp-double", "dvp-net", "dvp-formats"],
    ),
    ("dvp-lab", "models/lab", &["dvp-core", "dvp-burn", "dvp-candle", "dvp-fit", "dvp-net", "dvp-cli"]),
    ("dvp", "models/dvp", &["dvp-cli", "dvp-lab"]),
    (
        "dvp-tests",
        "tests",
        &["dvp-core", "dvp-burn", "dvp-candle", "dvp-trace", "dvp-fit", "dvp-double", "dvp-net", "dvp-lab", "dvp"],
    ),
];

/// How names of tensor frameworks, and of the compilers and drivers below them, begin.
const FRAMEWORKS: [&str; 11] =
    ["burn", "candle", "tch", "torch", "tensorflow", "ort", "tract", "dfdx", "cubecl", "cudarc", "wgpu"];

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    manifest_path: String,
    dependencies: Vec<Dependency>,
}

#[derive(Deserialize)]
struct Dependency {
    name: String,
}

pub(crate) fn cargo(arguments: &[&str]) -> String {
    let run = Command::new(env!("CARGO")).args(arguments).current_dir(root()).output().unwrap();
    assert!(run.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8(run.stdout).unwrap()
}

/// The adapters, and how the names of their framework's crates begin.
const ADAPTERS: [(&str, &str); 2] = [("dvp-burn", "burn"), ("dvp-candle", "candle")];

fn is_adapter_of(name: &str, framework: &str) -> bool {
    ADAPTERS.iter().any(|(adapter, own)| *adapter == name && framework.starts_with(own))
}

fn is_framework(name: &str) -> bool {
    FRAMEWORKS.iter().any(|framework| {
        name.strip_prefix(framework).is_some_and(|rest| rest.is_empty() || rest.starts_with(['-', '_']))
    })
}

/// What is wrong with the dependencies of the workspace's crates, of every kind and behind every feature.
fn violations(metadata: &Metadata) -> Vec<String> {
    let mut found = Vec::new();
    for package in &metadata.packages {
        let name = &package.name;
        let Some((_, folder, allowed)) = PLAN.iter().find(|(crate_name, ..)| crate_name == name) else {
            found.push(format!("{name} has no place in the plan"));
            continue;
        };
        if !package.manifest_path.replace('\\', "/").ends_with(&format!("/{folder}/Cargo.toml")) {
            found.push(format!("{name} lives in {}, not in {folder}", package.manifest_path));
        }
        for dependency in &package.dependencies {
            let used = dependency.name.as_str();
            if PLAN.iter().any(|(crate_name, ..)| *crate_name == used) && !allowed.contains(&used) {
                found.push(format!("{name} uses {used}, which stands later"));
            }
            if is_framework(used) && !is_adapter_of(name, used) {
                found.push(format!("{name} uses the framework {used}"));
            }
        }
    }
    found
}

#[test]
fn crates_use_only_earlier_ones_and_frameworks_only_their_adapters() {
    let metadata: Metadata =
        serde_json::from_str(&cargo(&["metadata", "--format-version", "1", "--no-deps", "--locked"])).unwrap();
    assert_eq!(metadata.packages.len(), PLAN.len(), "every crate of the plan is there");
    let found = violations(&metadata);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// The first framework in the output of `cargo tree --prefix none`.
fn framework_in(tree: &str) -> Option<&str> {
    tree.lines().filter_map(|line| line.split_whitespace().next()).find(|name| is_framework(name))
}

#[test]
fn no_framework_below_the_default_build_of_the_command() {
    let tree = cargo(&["tree", "--locked", "-p", "dvp", "-e", "normal,build", "--prefix", "none"]);
    assert!(tree.lines().any(|line| line.starts_with("dvp-core ")), "the tree was read");
    assert_eq!(framework_in(&tree), None);
}

#[test]
fn no_framework_below_core_behind_any_feature() {
    let tree =
        cargo(&["tree", "--locked", "-p", "dvp-core", "--all-features", "-e", "normal,build", "--prefix", "none"]);
    assert!(tree.lines().any(|line| line.starts_with("glam ")), "the tree was read");
    assert_eq!(framework_in(&tree), None);
}

#[test]
fn made_up_manifests_are_judged() {
    let count = |name: &str, folder: &str, dependency: &str| {
        let json = format!(
            r#"{{"packages":[{{"name":"{name}","manifest_path":"/x/{folder}/Cargo.toml","dependencies":[{{"name":"{dependency}"}}]}}]}}"#
        );
        violations(&serde_json::from_str(&json).unwrap()).len()
    };
    assert_eq!(count("dvp-fit", "models/fit", "dvp-core"), 0);
    assert_eq!(count("dvp-core", "core", "dvp-fit"), 1, "an arrow back");
    assert_eq!(count("dvp", "models/dvp", "dvp-tests"), 1, "an arrow back");
    assert_eq!(count("dvp-core", "core", "candle-core"), 1, "a framework");
    assert_eq!(count("dvp-burn", "backends/burn", "burn"), 0, "the adapter of a framework");
    assert_eq!(count("dvp-burn", "backends/burn", "candle-core"), 1, "the adapter of another framework");
    assert_eq!(count("dvp-core", "elsewhere", "glam"), 1, "a moved crate");
    assert_eq!(count("dvp-new", "models/new", "glam"), 1, "a crate without a place");
    assert_eq!(framework_in("serde v1\nburn-tensor v0.22.1 (*)"), Some("burn-tensor"));
    assert_eq!(framework_in("burnish v1\northogonal v2\nportable-atomic v1"), None, "only whole names");
}
