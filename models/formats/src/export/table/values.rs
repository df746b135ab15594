//! The table as columns of values: what data frames and Arrow take.

use super::{Cell, Kind, columns, rows};
use crate::export::{MeasuredPicture, Scale};

/// A column of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct TableColumn {
    /// Its name, with its unit.
    pub name: String,
    /// What stands in it.
    pub values: ColumnValues,
}

/// What stands in a column, a value per row; none where a cell is empty.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// Texts.
    Text(Vec<Option<String>>),
    /// Whole numbers.
    Count(Vec<Option<i64>>),
    /// Other numbers, in the unit that the name of the column ends with.
    Number(Vec<Option<f64>>),
}

/// The table of [`table_csv`](super::table_csv) by columns: a row per object, and one for each picture that failed.
#[must_use]
pub fn table_columns(pictures: &[MeasuredPicture], scale: Option<Scale>) -> Vec<TableColumn> {
    let rows = rows(pictures);
    let values = |column: super::Column| {
        let cells = rows.iter().map(|row| column.cell(row));
        let values = match column.kind {
            Kind::Text => ColumnValues::Text(cells.map(text).collect()),
            Kind::Count => ColumnValues::Count(cells.map(count).collect()),
            Kind::Number => ColumnValues::Number(cells.map(number).collect()),
        };
        TableColumn { name: column.name, values }
    };
    columns(scale).into_iter().map(values).collect()
}

fn text(cell: Cell) -> Option<String> {
    if let Cell::Text(text) = cell { Some(text) } else { None }
}

fn count(cell: Cell) -> Option<i64> {
    if let Cell::Count(count) = cell { Some(count) } else { None }
}

fn number(cell: Cell) -> Option<f64> {
    if let Cell::Number(number) = cell { Some(number) } else { None }
}
