//! Tables as reports write them.

use std::fs;
use std::path::Path;

/// The lines of a CSV by their header.
pub(crate) fn rows(path: &Path) -> Vec<Vec<(String, String)>> {
    let csv = fs::read_to_string(path).unwrap();
    let mut lines = csv.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
    let header = lines.next().unwrap();
    lines
        .map(|line| {
            assert_eq!(line.len(), header.len(), "{line:?}");
            header.iter().cloned().zip(line).collect()
        })
        .collect()
}

/// The text of a column.
pub(crate) fn cell<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(column, _)| column == name).unwrap().1
}

/// The number of a column.
pub(crate) fn number(row: &[(String, String)], name: &str) -> f64 {
    cell(row, name).parse().unwrap_or_else(|_| panic!("{name}: {row:?}"))
}
