//! Crates that are published: complete, documented to the last feature, and built by the oldest Rust that they promise.

use alloc::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;

use crate::crates::cargo;

/// Crates that no registry of Rust gets: the tests, and the browser's module, which npm publishes.
const KEPT: [&str; 2] = ["dvp-tests", "dvp-wasm"];

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    #[serde(default)]
    version: String,
    manifest_path: String,
    /// None: it goes to any registry; an empty list: it goes to none.
    publish: Option<Vec<String>>,
    description: Option<String>,
    #[serde(default)]
    keywords: Vec<String>,
    #[serde(default)]
    categories: Vec<String>,
    #[serde(default)]
    features: BTreeMap<String, Vec<String>>,
    rust_version: Option<String>,
}

fn packages(arguments: &[&str]) -> Vec<Package> {
    let common = ["metadata", "--format-version", "1", "--locked", "--all-features"];
    let all: Vec<&str> = common.into_iter().chain(arguments.iter().copied()).collect();
    serde_json::from_str::<Metadata>(&cargo(&all)).unwrap().packages
}

/// What is missing in a crate that is published: what its page shows, its licenses, and the docs of its features. `read` is the
/// text of a file in its folder, nothing if there is none.
fn gaps(package: &Package, read: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let mut found = Vec::new();
    let mut ask = |is_there: bool, what: &str| {
        if !is_there {
            found.push(format!("{} has no {what}", package.name));
        }
    };
    ask(package.description.is_some(), "description");
    ask((1..=5).contains(&package.keywords.len()), "keywords, or more than five");
    ask(!package.categories.is_empty(), "categories");
    for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
        ask(read(license).is_some_and(|text| text.lines().count() > 10), license);
    }
    let docs = ["README.md", "src/lib.rs"].map(|file| read(file).unwrap_or_default());
    for feature in package.features.keys().filter(|feature| *feature != "default") {
        let named = format!("`{feature}`");
        ask(
            docs.iter().all(|text| text.contains(&named)),
            &format!("docs of the feature {feature} in README.md and src/lib.rs"),
        );
    }
    found
}

#[test]
fn published_crates_are_complete() {
    let all = packages(&["--no-deps"]);
    let (published, kept): (Vec<&Package>, Vec<&Package>) = all.iter().partition(|package| package.publish.is_none());
    let mut kept: Vec<&str> = kept.iter().map(|package| package.name.as_str()).collect();
    kept.sort_unstable();
    assert_eq!(kept, KEPT);
    let of = |package: &&Package| {
        let folder = Path::new(&package.manifest_path).parent().unwrap().to_owned();
        gaps(package, |file| fs::read_to_string(folder.join(file)).ok())
    };
    let found: Vec<String> = published.iter().flat_map(of).collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn a_made_up_crate_is_found_incomplete() {
    let json = r#"{"name":"x","manifest_path":"/x/Cargo.toml","dependencies":[],"features":{"default":[],"fast":[]}}"#;
    let package: Package = serde_json::from_str(json).unwrap();
    assert_eq!(gaps(&package, |_| None).len(), 6, "three fields, two licenses, one feature");
    let text = "`fast`\n".repeat(20);
    assert_eq!(gaps(&package, |_| Some(text.clone())).len(), 3, "the fields alone");
}

/// The numbers of a version: "1.89" and "1.89.0" are (1, 89).
fn minor(version: &str) -> (u32, u32) {
    let mut numbers = version.split('.').map(|number| number.parse().unwrap());
    (numbers.next().unwrap(), numbers.next().unwrap_or(0))
}

/// What is built of a crate, on any platform: its name, its features, and its dependencies as `name version`.
fn tree(name: &str, features: &str) -> Vec<String> {
    let kinds = ["-e", "normal,build", "--target", "all", "--prefix", "none"];
    let what = ["tree", "--locked", "-p", name, "--features", features];
    let all: Vec<&str> = what.into_iter().chain(kinds).collect();
    let line = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    cargo(&all).lines().map(line).collect()
}

/// What in a tree asks for a newer Rust than its root promises.
fn too_new(tree: &[String], packages: &[Package]) -> Vec<String> {
    let known = |line: &String| {
        packages
            .iter()
            .find(|package| *line == format!("{} v{}", package.name, package.version))?
            .rust_version
            .as_deref()
    };
    let promised = minor(known(&tree[0]).unwrap());
    let ask = |line: &&String| known(line).is_some_and(|version| minor(version) > promised);
    tree.iter().filter(ask).map(|line| format!("{line}, of which {} is built", tree[0])).collect()
}

#[test]
fn no_dependency_asks_for_a_newer_rust_than_we_promise() {
    let packages = packages(&[]);
    // burn asks for the newest Rust, so its adapter promises no more, and the feature `burn` of the command does not either.
    for (name, features) in [("dvp", "lab,candle,parquet"), ("dvp-burn", "")] {
        let tree = tree(name, features);
        assert!(tree.len() > 100, "{name}: the tree was read");
        let found = too_new(&tree, &packages);
        assert!(found.is_empty(), "{}", found.join("\n"));
    }
}

#[test]
fn made_up_trees_are_judged() {
    let package = |name: &str, rust: &str| {
        let json =
            format!(r#"{{"name":"{name}","version":"1.0.0","manifest_path":"/x/Cargo.toml","rust_version":"{rust}"}}"#);
        serde_json::from_str::<Package>(&json).unwrap()
    };
    let packages = [package("own", "1.89"), package("old", "1.9.1"), package("new", "1.90"), package("even", "1.89.2")];
    let tree = ["own v1.0.0", "old v1.0.0", "even v1.0.0", "new v1.0.0", "unknown v1.0.0"].map(str::to_owned);
    assert_eq!(too_new(&tree, &packages).len(), 1);
    assert!(too_new(&tree[..3], &packages).is_empty());
}

#[test]
fn versions_are_compared_by_number() {
    assert!(minor("1.9") < minor("1.89.0") && minor("1.89") == minor("1.89.1") && minor("2") > minor("1.89"));
}
