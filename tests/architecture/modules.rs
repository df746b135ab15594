//! Inside crates. Core: `real, dims, simd, optim -> sort -> geometry, diff_op -> tensor, image -> contour -> shape -> scene -> render, matching -> loss
//! -> metric`. Trace: `tuning -> noise, regions, ruler, sample, table -> outline -> stroke -> partition -> boundary -> layers -> ties -> scene`.

use crate::source::{code_lines, rust_sources};

/// Modules in the order in which they may use each other: only earlier rows, never their own.
type Order = &'static [&'static [&'static str]];

const CORE: Order = &[
    &["real", "dims", "simd", "optim"],
    &["sort"],
    &["geometry", "diff_op"],
    &["tensor", "image"],
    &["contour"],
    &["shape"],
    &["scene"],
    &["render", "matching"],
    &["loss"],
    &["metric"],
    &["instances"],
];

const TRACE: Order = &[
    &["tuning"],
    &["elimination", "noise", "regions", "ruler", "sample", "table"],
    &["outline"],
    &["stroke"],
    &["partition"],
    &["ramps", "boundary"],
    &["layers"],
    &["ties"],
    &["centers"],
    &["scene"],
    &["missed"],
];

fn row(order: Order, module: &str) -> Option<usize> {
    order.iter().position(|row| row.contains(&module))
}

/// Names that the crate root re-exports, with the module they come from: from lines like `pub use dims::ImageSize;`.
fn reexports(root: &str) -> Vec<(String, String)> {
    let uses = code_lines(root).filter_map(|(_, line)| line.trim().strip_prefix("pub use ")?.strip_suffix(';'));
    let mut found = Vec::new();
    for path in uses {
        let Some((module, names)) = path.split_once("::") else { continue };
        for name in names.trim_matches(['{', '}']).split(',') {
            found.push((name.trim().to_owned(), module.to_owned()));
        }
    }
    found
}

/// The names right after the crate root in a file's paths: `crate::x`, `crate::{x, y::z}`, and `super::..::x` that climbs
/// to the root. With their line numbers.
fn names_from_root(text: &str, depth: usize) -> Vec<(usize, String)> {
    // One string, so that a list over several lines is one path; the offset of each line gives its number back.
    let mut code = String::new();
    let mut starts = Vec::new();
    for (number, line) in code_lines(text) {
        starts.push((code.len(), number));
        code.push_str(line);
        code.push('\n');
    }
    let to_root = "super::".repeat(depth);
    let prefixes = if depth == 0 { vec!["crate::"] } else { vec!["crate::", to_root.as_str()] };
    let mut found = Vec::new();
    for prefix in prefixes {
        for (at, _) in code.match_indices(prefix) {
            let before = code[..at].chars().next_back();
            if before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':' || c == '$') {
                continue;
            }
            let line = starts.iter().rev().find(|(start, _)| *start <= at).map_or(0, |(_, number)| *number);
            let rest = &code[at + prefix.len()..];
            for name in heads(rest) {
                found.push((line, name));
            }
        }
    }
    found
}

/// The first names of a path or of each path of a list in braces.
fn heads(path: &str) -> Vec<String> {
    let name =
        |path: &str| path.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(list) = path.strip_prefix('{') else { return vec![name(path)] };
    let mut heads = vec![name(list)];
    let mut depth = 0;
    for (at, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => heads.push(name(&list[at + 1..])),
            _ => {}
        }
    }
    heads.retain(|head| !head.is_empty());
    heads
}

/// What is wrong with the paths of one file of a crate; `path` from its `src/`.
fn violations(order: Order, path: &str, text: &str, reexports: &[(String, String)]) -> Vec<String> {
    let parts: Vec<&str> = path.trim_end_matches(".rs").split('/').collect();
    let module = parts[0];
    // The root, and its tests, may use everything.
    if module == "lib" || module == "tests" {
        return Vec::new();
    }
    let Some(own) = row(order, module) else {
        return vec![format!("{path}: module {module} has no place in the order")];
    };
    let depth = if parts.last() == Some(&"mod") { parts.len() - 1 } else { parts.len() };
    let mut found = Vec::new();
    for (line, name) in names_from_root(text, depth) {
        let target = reexports.iter().find(|(export, _)| *export == name).map_or(name.as_str(), |(_, module)| module);
        let arrow = match row(order, target) {
            _ if target == module => continue,
            Some(row) if row < own => continue,
            Some(_) => "stands later or beside it",
            None => "has no place in the order",
        };
        found.push(format!("{path}:{line}: {module} uses {target}, which {arrow}"));
    }
    found
}

/// What is wrong in a crate, and how many paths were read.
fn violations_in(folder: &str, order: Order) -> (Vec<String>, usize) {
    let sources = rust_sources(folder);
    let root = sources.iter().find(|source| source.path == format!("{folder}/lib.rs")).unwrap();
    let reexports = reexports(&root.text);
    let strip = |path: &str| path[folder.len() + 1..].to_owned();
    let arrows = sources.iter().map(|source| names_from_root(&source.text, 99).len()).sum();
    let of = |source: &crate::source::Source| violations(order, &strip(&source.path), &source.text, &reexports);
    (sources.iter().flat_map(of).collect(), arrows)
}

#[test]
fn modules_use_only_earlier_ones() {
    for (folder, order, least) in [("core/src", CORE, 100), ("models/trace/src", TRACE, 50)] {
        let (found, arrows) = violations_in(folder, order);
        assert!(arrows > least, "only {arrows} paths of {folder} were read");
        assert!(found.is_empty(), "{folder}:\n{}", found.join("\n"));
    }
}

#[test]
fn made_up_arrows_are_judged() {
    let exports = reexports("pub use dims::ImageSize;\npub use scene::{Drawing, Scene};\n");
    let count = |path: &str, text: &str| violations(CORE, path, text, &exports).len();
    assert_eq!(count("scene/draw.rs", "use crate::shape::Efd;\nuse crate::{ImageSize, real::Real};"), 0);
    assert_eq!(count("scene/draw.rs", "use crate::render::Renderer;"), 1);
    assert_eq!(count("shape/efd.rs", "use crate::{ImageSize,\n    Scene};"), 1, "re-exports, over lines");
    assert_eq!(count("shape/efd.rs", "use crate::{real::{self, Real}, loss::Mae};"), 1, "nested lists");
    assert_eq!(count("shape/efd.rs", "fn f() { crate::metric::iou() }"), 1, "paths in code");
    assert_eq!(count("shape/efd.rs", "// crate::metric is later\n/// [`crate::metric`]"), 0, "comments");
    assert_eq!(count("shape/efd.rs", "use super::super::render::tile;"), 1, "climbing");
    assert_eq!(count("shape/mod.rs", "use super::render::tile;"), 1, "climbing from mod.rs");
    assert_eq!(count("shape/efd.rs", "use super::render;"), 0, "a module of its own");
    assert_eq!(count("render/contour/cover.rs", "use crate::matching::Hungarian;"), 1, "side by side");
    assert_eq!(count("helpers.rs", ""), 1, "a module without a place");
    assert_eq!(count("metric/mod.rs", "use crate::brand_new::Thing;"), 1, "use of a module without a place");
}
