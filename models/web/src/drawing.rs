//! A scene: painted, written, measured.

use std::path::Path;

use dvp_core::{ImageSize, Scene};
use dvp_fit::Bank;
use dvp_fit::paint::Canvas;
use dvp_formats::export::{self, ColumnValues, Found, MeasuredPicture};
use dvp_formats::format::{Place, SceneJson, mdshr_bank, parse_bank, to_byte};
use dvp_formats::svg::to_svg;
use serde_json::{Map, Value};
use wasm_bindgen::prelude::*;

use crate::WebError;
use crate::picture::MOST_PIXELS;

/// A scene and the size of its image.
#[wasm_bindgen]
#[derive(Clone, Debug)]
pub struct Drawing {
    pub(crate) scene: Scene<f32>,
    pub(crate) size: ImageSize,
    bank: Option<Bank<f32>>,
}

/// What errors call the text of a scene.
pub(crate) fn place() -> Place {
    Place::file(Path::new("scene"))
}

/// The known shapes that an option names: `mdshr`, or the text of a bank; none for an empty text.
pub(crate) fn bank_of(text: &str) -> Result<Option<Bank<f32>>, WebError> {
    match text {
        "" => Ok(None),
        "mdshr" => Ok(Some(mdshr_bank())),
        text => Ok(Some(parse_bank(text.as_bytes(), Path::new("bank"))?)),
    }
}

pub(crate) fn size_of(width: u32, height: u32) -> Result<ImageSize, WebError> {
    let size = ImageSize::new(width as usize, height as usize)?;
    if size.pixels() > MOST_PIXELS {
        return Err(WebError::Pixels { width, height, limit: MOST_PIXELS });
    }
    Ok(size)
}

#[wasm_bindgen]
impl Drawing {
    /// Reads the JSON of a scene, of any version, with every number checked. `bank` is `mdshr` or the text of a bank, for scenes with
    /// prototypes; else empty.
    ///
    /// # Errors
    /// [`WebError::Format`] names the field and what it must be; [`WebError::NoSize`], [`WebError::Pixels`].
    #[wasm_bindgen(constructor)]
    pub fn new(json: &str, bank: &str) -> Result<Self, WebError> {
        let bank = bank_of(bank)?;
        let parsed = SceneJson::parse(json.as_bytes(), &place())?;
        let scene = parsed.to_scene(bank.as_ref(), &place())?;
        let (Some(width), Some(height)) = (parsed.width, parsed.height) else { return Err(WebError::NoSize) };
        let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
        Ok(Self { scene, size: size_of(side(width), side(height))?, bank })
    }

    /// The scene as JSON of version 3, without what a fit knew of it.
    ///
    /// # Errors
    /// [`WebError::Format`] if a number is not finite.
    #[wasm_bindgen(js_name = toJson)]
    pub fn to_json(&self) -> Result<String, WebError> {
        Ok(SceneJson::from_scene(&self.scene, self.size)?.to_line(&place())?)
    }

    /// The scene as SVG: an element per object, with the ids `object-1`, `object-2` and so on, in pixels.
    ///
    /// # Errors
    /// [`WebError::Shape`] if an object has no outline.
    #[wasm_bindgen(js_name = toSvg)]
    pub fn to_svg(&self) -> Result<String, WebError> {
        Ok(to_svg(&self.scene, self.size, self.bank.as_ref())?)
    }

    /// The scene painted, red, green, blue, alpha per pixel, colors not multiplied by alpha: what `ImageData` takes.
    ///
    /// # Errors
    /// [`WebError::Fit`] if it cannot be painted, [`WebError::Pixels`] if that is too large.
    pub fn paint(&self, width: u32, height: u32) -> Result<Vec<u8>, WebError> {
        let size = size_of(width, height)?;
        let mut canvas = Canvas::default();
        if self.scene.transparent {
            let image = canvas.paint_rgba(&self.scene, size)?;
            return Ok(image.to_straight().into_iter().map(to_byte).collect());
        }
        let (image, _) = canvas.paint(&self.scene, size)?;
        let [red, green, blue] = [0, 1, 2].map(|channel| image.view().channel(channel));
        let pixels = red.iter().zip(green).zip(blue);
        Ok(pixels.flat_map(|((&r, &g), &b)| [to_byte(r), to_byte(g), to_byte(b), 255]).collect())
    }

    /// The table of measures as CSV, the same as `dvp fit --table` writes. `covariance` is that of the fit: 25 numbers per object,
    /// NaN where nothing is known; or empty.
    ///
    /// # Errors
    /// [`WebError::Export`], [`WebError::Covariance`].
    #[wasm_bindgen(js_name = toCsv)]
    pub fn to_csv(&self, name: &str, covariance: &[f32]) -> Result<String, WebError> {
        let bytes = export::table_csv(&[self.measured(name, covariance)?], None)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The same table as JSON: a list of objects whose fields are the columns; empty cells are missing.
    ///
    /// # Errors
    /// As [`Self::to_csv`].
    pub fn measures(&self, covariance: &[f32]) -> Result<String, WebError> {
        let columns = export::table_columns(&[self.measured("", covariance)?], None);
        let mut rows = vec![Map::new(); self.scene.objects.len()];
        for column in columns {
            let cells: Vec<Option<Value>> = match column.values {
                ColumnValues::Text(cells) => cells.into_iter().map(|cell| cell.map(Value::from)).collect(),
                ColumnValues::Count(cells) => cells.into_iter().map(|cell| cell.map(Value::from)).collect(),
                ColumnValues::Number(cells) => cells.into_iter().map(|cell| cell.map(Value::from)).collect(),
            };
            for (row, cell) in rows.iter_mut().zip(cells) {
                if let Some(cell) = cell {
                    row.insert(column.name.clone(), cell);
                }
            }
        }
        Ok(serde_json::to_string(&rows)?)
    }

    /// The objects as a GeoJSON collection, in pixels.
    ///
    /// # Errors
    /// As [`Self::to_csv`].
    #[wasm_bindgen(js_name = toGeoJson)]
    pub fn to_geo_json(&self, name: &str) -> Result<String, WebError> {
        let bytes = export::geojson(&self.measured(name, &[])?, None)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The object that is seen in each pixel, row by row: 0 for the background, else its number, from 1.
    ///
    /// # Errors
    /// [`WebError::Export`] if the scene cannot be drawn.
    #[wasm_bindgen(js_name = labelMap)]
    pub fn label_map(&self) -> Result<Vec<u32>, WebError> {
        Ok(export::label_map(&self.scene, &self.numbers(), self.size)?)
    }
}

impl Drawing {
    fn numbers(&self) -> Vec<u32> {
        (1..).take(self.scene.objects.len()).collect()
    }

    fn measured(&self, name: &str, covariance: &[f32]) -> Result<MeasuredPicture, WebError> {
        let (blocks, rest) = covariance.as_chunks::<25>();
        let objects = self.scene.objects.len();
        if !rest.is_empty() || !(blocks.is_empty() || blocks.len() == objects) {
            return Err(WebError::Covariance { len: covariance.len(), objects });
        }
        let objects = export::measure(&self.scene, blocks, self.bank.as_ref(), &self.numbers(), self.size)?;
        let stem = Path::new(name).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        Ok(MeasuredPicture::new(name.to_owned(), stem, Ok(Found { size: self.size, objects })))
    }
}
