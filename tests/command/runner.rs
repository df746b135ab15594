//! Runs the command inside the test process.

use std::path::Path;

/// What a run left behind on its streams.
pub(crate) struct Run {
    pub(crate) code: u8,
    pub(crate) out: String,
    pub(crate) err: String,
}

/// Runs `dvp` with the arguments.
pub(crate) fn dvp<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Run {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let all = core::iter::once("dvp").chain(arguments).map(Into::into);
    let code = dvp::command::run(all, &mut out, &mut err);
    Run { code, out: String::from_utf8(out).unwrap(), err: String::from_utf8(err).unwrap() }
}

/// Runs `dvp` and expects it to do all.
pub(crate) fn dvp_done<'a>(arguments: impl IntoIterator<Item = &'a str>) -> String {
    let run = dvp(arguments);
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    run.out
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The names in a folder, sorted; none if there is no folder.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
