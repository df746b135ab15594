//! The columns of the table.

use crate::export::{MeasuredObject, MeasuredPicture, Scale};

/// What a row is about.
#[derive(Clone, Copy, Debug)]
pub(in crate::export) struct Row<'a> {
    pub(in crate::export) picture: &'a MeasuredPicture,
    /// None if the picture failed.
    pub(in crate::export) object: Option<&'a MeasuredObject>,
}

/// What stands in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::export) enum Kind {
    Text,
    Count,
    Number,
}

/// What stands in a cell.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::export) enum Cell {
    Empty,
    Text(String),
    Count(i64),
    Number(f64),
}

/// A column.
#[derive(Clone, Debug)]
pub(in crate::export) struct Column {
    pub(in crate::export) name: String,
    pub(in crate::export) kind: Kind,
    /// What numbers are multiplied by.
    factor: f64,
    value: fn(&Row<'_>) -> Cell,
}

/// What a number is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    /// Nothing that a scale changes.
    None,
    Length,
    Area,
}

impl Unit {
    /// What follows the name, in pixels and in mm.
    fn endings(self) -> Option<[&'static str; 2]> {
        match self {
            Self::None => None,
            Self::Length => Some(["px", "mm"]),
            Self::Area => Some(["px2", "mm2"]),
        }
    }

    /// Such units in mm per such unit in pixels.
    fn factor(self, scale: Scale) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Length => scale.mm_per_px,
            Self::Area => scale.mm_per_px * scale.mm_per_px,
        }
    }
}

/// Name without its unit, what stands there, unit, and the value.
type Field = (&'static str, Kind, Unit, fn(&Row<'_>) -> Cell);

/// What is told of every object; what has a length or an area is told once more in mm if the scale is known.
const FIELDS: [Field; 30] = [
    ("picture", Kind::Text, Unit::None, |row| Cell::Text(row.picture.picture.clone())),
    ("stem", Kind::Text, Unit::None, |row| Cell::Text(row.picture.stem.clone())),
    ("object", Kind::Count, Unit::None, |row| row.of(|object| Some(Cell::Count(object.number.into())))),
    ("kind", Kind::Text, Unit::None, |row| row.of(|object| Some(Cell::Text(object.kind.to_owned())))),
    ("prototype", Kind::Text, Unit::None, |row| row.of(|object| object.prototype.clone().map(Cell::Text))),
    ("centroid_x", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.moments?.centroid[0]))),
    ("centroid_y", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.moments?.centroid[1]))),
    ("area", Kind::Number, Unit::Area, |row| row.number(|object| Some(object.moments.map_or(0.0, |m| m.area)))),
    ("perimeter", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.perimeter))),
    ("circularity", Kind::Number, Unit::None, |row| row.number(MeasuredObject::circularity)),
    ("major_axis", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.axes?.major))),
    ("minor_axis", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.axes?.minor))),
    ("angle_deg", Kind::Number, Unit::None, |row| row.number(|object| object.angle)),
    ("bounds_x", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.bounds?.min.x))),
    ("bounds_y", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.bounds?.min.y))),
    ("bounds_width", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.bounds?.size().x))),
    ("bounds_height", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.bounds?.size().y))),
    ("red", Kind::Count, Unit::None, |row| row.of(|object| Some(Cell::Count(object.color[0].into())))),
    ("green", Kind::Count, Unit::None, |row| row.of(|object| Some(Cell::Count(object.color[1].into())))),
    ("blue", Kind::Count, Unit::None, |row| row.of(|object| Some(Cell::Count(object.color[2].into())))),
    ("color", Kind::Text, Unit::None, |row| {
        row.of(|MeasuredObject { color: [r, g, b], .. }| Some(Cell::Text(format!("#{r:02x}{g:02x}{b:02x}"))))
    }),
    ("confidence", Kind::Number, Unit::None, |row| row.number(|object| Some(object.confidence))),
    ("visible", Kind::Number, Unit::None, |row| row.number(|object| Some(object.visible))),
    ("centroid_x_sd", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.deviations?.centroid[0]))),
    ("centroid_y_sd", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.deviations?.centroid[1]))),
    ("area_sd", Kind::Number, Unit::Area, |row| row.number(|object| Some(object.deviations?.area))),
    ("perimeter_sd", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.deviations?.perimeter))),
    ("major_axis_sd", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.deviations?.axes[0]))),
    ("minor_axis_sd", Kind::Number, Unit::Length, |row| row.number(|object| Some(object.deviations?.axes[1]))),
    ("angle_sd_deg", Kind::Number, Unit::None, |row| {
        row.number(|object| object.angle.and(object.deviations).map(|deviations| deviations.angle))
    }),
];

/// The last column: why a picture failed.
const ERROR: Field =
    ("error", Kind::Text, Unit::None, |row| row.picture.found.as_ref().err().cloned().map_or(Cell::Empty, Cell::Text));

/// The columns: those in pixels, those in mm if the scale is known, the error.
pub(in crate::export) fn columns(scale: Option<Scale>) -> Vec<Column> {
    let column = |&(name, kind, unit, value): &Field| {
        let name = unit.endings().map_or_else(|| name.to_owned(), |[px, _]| format!("{name}_{px}"));
        Column { name, kind, factor: 1.0, value }
    };
    let scaled = scale.into_iter().flat_map(|scale| {
        FIELDS.iter().filter_map(move |&(name, kind, unit, value)| {
            let [_, mm] = unit.endings()?;
            Some(Column { name: format!("{name}_{mm}"), kind, factor: unit.factor(scale), value })
        })
    });
    FIELDS.iter().map(column).chain(scaled).chain([column(&ERROR)]).collect()
}

impl Column {
    /// What stands in a row; numbers to nine digits and nine decimals, more than any fit knows.
    pub(in crate::export) fn cell(&self, row: &Row<'_>) -> Cell {
        match (self.value)(row) {
            Cell::Number(value) => Cell::Number(nine_digits(value * self.factor)),
            other => other,
        }
    }
}

fn nine_digits(value: f64) -> f64 {
    if value.abs() < 5e-10 { 0.0 } else { format!("{value:.8e}").parse().unwrap_or(value) }
}

impl Row<'_> {
    fn of(&self, value: impl FnOnce(&MeasuredObject) -> Option<Cell>) -> Cell {
        self.object.and_then(value).unwrap_or(Cell::Empty)
    }

    fn number(&self, value: impl FnOnce(&MeasuredObject) -> Option<f64>) -> Cell {
        self.of(|object| value(object).filter(|value| value.is_finite()).map(Cell::Number))
    }
}
