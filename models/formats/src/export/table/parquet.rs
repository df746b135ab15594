//! The table as Apache Parquet: one row group, not compressed.

use alloc::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use super::columns::Kind;
use super::{Cell, Column, Row};
use crate::export::ExportError;

pub(super) fn write(columns: &[Column], rows: &[Row<'_>]) -> Result<Vec<u8>, ExportError> {
    try_write(columns, rows).map_err(|error| ExportError::Table(error.to_string()))
}

fn try_write(columns: &[Column], rows: &[Row<'_>]) -> Result<Vec<u8>, ParquetError> {
    let fields = columns.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder("objects").with_fields(fields).build()?;
    let properties = Arc::new(WriterProperties::builder().build());
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), properties)?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        let cells: Vec<Cell> = rows.iter().map(|row| column.cell(row)).collect();
        match column.kind {
            Kind::Text => write_column::<ByteArrayType, _>(&mut group, &cells, |cell| match cell {
                Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                _ => None,
            })?,
            Kind::Count => write_column::<Int64Type, _>(&mut group, &cells, |cell| match cell {
                Cell::Count(count) => Some(*count),
                _ => None,
            })?,
            Kind::Number => write_column::<DoubleType, _>(&mut group, &cells, |cell| match cell {
                Cell::Number(number) => Some(*number),
                _ => None,
            })?,
        }
    }
    group.close()?;
    writer.into_inner()
}

/// A column whose cells may be empty.
fn field(column: &Column) -> Result<TypePtr, ParquetError> {
    let (physical, logical) = match column.kind {
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        Kind::Count => (Physical::INT64, None),
        Kind::Number => (Physical::DOUBLE, None),
    };
    let field = Type::primitive_type_builder(&column.name, physical);
    Ok(Arc::new(field.with_repetition(Repetition::OPTIONAL).with_logical_type(logical).build()?))
}

fn write_column<D: parquet::data_type::DataType, F: Fn(&Cell) -> Option<D::T>>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    cells: &[Cell],
    value: F,
) -> Result<(), ParquetError> {
    // What is empty has the level 0 and no value.
    let values: Vec<Option<D::T>> = cells.iter().map(value).collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    let values: Vec<D::T> = values.into_iter().flatten().collect();
    if let Some(mut column) = group.next_column()? {
        column.typed::<D>().write_batch(&values, Some(&levels), None)?;
        column.close()?;
    }
    Ok(())
}
