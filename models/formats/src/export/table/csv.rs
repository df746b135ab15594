//! The table as text.

use super::{Cell, Column, Row};
use crate::export::ExportError;

pub(super) fn write(columns: &[Column], rows: &[Row<'_>]) -> Result<Vec<u8>, ExportError> {
    let refused = |error: csv::Error| ExportError::Table(error.to_string());
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns.iter().map(|column| &column.name)).map_err(refused)?;
    for row in rows {
        writer.write_record(columns.iter().map(|column| text(column.cell(row)))).map_err(refused)?;
    }
    writer.into_inner().map_err(|error| ExportError::Table(error.to_string()))
}

/// The shortest text that reads back as the same number.
fn text(cell: Cell) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Text(text) => text,
        Cell::Count(count) => count.to_string(),
        Cell::Number(number) => number.to_string(),
    }
}
