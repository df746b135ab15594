//! One table for all pictures: a row per object, and one for each picture that failed.
//!
//! | file | writes |
//! |---|---|
//! | `columns.rs` | which columns there are, and what stands in them |
//! | `csv.rs` | text |
//! | `parquet.rs` | Apache Parquet, with the feature of that name |
//! | `values.rs` | columns of values, for programs |

mod columns;
mod csv;
#[cfg(feature = "parquet")]
mod parquet;
mod values;

use columns::Kind;
pub(super) use columns::{Cell, Column, Row, columns};
pub use values::{ColumnValues, TableColumn, table_columns};

use super::{ExportError, MeasuredPicture, Scale};

/// Whether this program was built to write Parquet.
pub const HAS_PARQUET: bool = cfg!(feature = "parquet");

/// The table as CSV (RFC 4180, lines end with LF): the names of the columns, then the rows. Numbers have up to 9 digits.
///
/// # Errors
/// [`ExportError::Table`] if the encoder refuses.
pub fn table_csv(pictures: &[MeasuredPicture], scale: Option<Scale>) -> Result<Vec<u8>, ExportError> {
    csv::write(&columns(scale), &rows(pictures))
}

/// The same table as Parquet: texts are UTF-8 strings, whole numbers INT64, others DOUBLE; empty cells are null.
///
/// # Errors
/// [`ExportError::NoParquet`] if this program was built without, [`ExportError::Table`] if the encoder refuses.
pub fn table_parquet(pictures: &[MeasuredPicture], scale: Option<Scale>) -> Result<Vec<u8>, ExportError> {
    #[cfg(feature = "parquet")]
    {
        parquet::write(&columns(scale), &rows(pictures))
    }
    #[cfg(not(feature = "parquet"))]
    {
        let _ = (pictures, scale);
        Err(ExportError::NoParquet)
    }
}

fn rows(pictures: &[MeasuredPicture]) -> Vec<Row<'_>> {
    let mut rows = Vec::new();
    for picture in pictures {
        if picture.found.is_err() {
            rows.push(Row { picture, object: None });
        }
        rows.extend(picture.objects().iter().map(|object| Row { picture, object: Some(object) }));
    }
    rows
}
