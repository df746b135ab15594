//! Fits and scores the picture set: `cargo run --release -p dvp-tests --example any_picture -- [FILTER] [--keep FOLDER]`.
//!
//! Prints a row per case (those whose name contains FILTER) and the pictures that fall short. With `--keep` the pictures,
//! label maps and fits stay in FOLDER, a folder per case.

use core::error::Error;
use std::fs;
use std::io::Write as _;
use std::path::PathBuf;

use dvp_tests::picture_set::{CASES, score_case, table_head};

fn main() -> Result<(), Box<dyn Error>> {
    let (mut filter, mut keep) = (String::new(), None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--keep" {
            keep = Some(PathBuf::from(arguments.next().ok_or("--keep needs a folder")?));
        } else {
            filter = argument;
        }
    }
    let temporary = tempfile::tempdir()?;
    let root = keep.unwrap_or_else(|| temporary.path().to_path_buf());
    let mut out = std::io::stdout().lock();
    writeln!(out, "{}", table_head())?;
    let mut shortcomings = String::new();
    for case in CASES.iter().filter(|case| case.name.contains(&filter)) {
        let folder = root.join(case.name.replace(", ", "-").replace(' ', "-"));
        if folder.exists() {
            fs::remove_dir_all(&folder)?;
        }
        let score = score_case(case, &folder)?;
        writeln!(out, "{}", score.row())?;
        let worst = score.worst();
        if !worst.is_empty() {
            shortcomings.push_str(&format!("{}:\n{worst}", case.name));
        }
    }
    writeln!(out, "\n{shortcomings}")?;
    Ok(())
}
