//! Banks of known shapes.
//!
//! Two layouts are read: ours, `{"version":1,"prototypes":[{"name":"heart","efd":[[a,b,c,d],...]},...]}`, and tables
//! `{"order":["heart",...],"heart":[[a,b,c,d],...],...}` as published with MDS-HR data.

use std::path::Path;

use dvp_core::Real;
use dvp_core::shape::{self, MDSHR_NAMES};
use dvp_fit::Bank;
use serde::{Deserialize, Serialize};

use super::error::{FormatError, Place};
use super::scene_json::{checked_efd, read_text};

/// Harmonics that the data of MDS-HR were drawn with.
const MDSHR_HARMONICS: usize = 64;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct BankJson {
    version: u64,
    prototypes: Vec<PrototypeJson>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PrototypeJson {
    name: String,
    efd: Vec<[f64; 4]>,
}

/// The built-in bank of MDS-HR: heart, square, ellipse.
#[must_use]
pub fn mdshr_bank<T: Real>() -> Bank<T> {
    let shapes = shape::mdshr_bank(MDSHR_HARMONICS);
    let names = MDSHR_NAMES.into_iter().map(str::to_owned);
    Bank::new(names.zip(shapes.prototypes().iter().cloned()).collect())
}

/// Reads a bank file in either layout.
///
/// # Errors
/// [`FormatError`] if the file cannot be read, is no bank, is empty or holds a bad number.
pub fn read_bank<T: Real>(path: &Path) -> Result<Bank<T>, FormatError> {
    parse_bank(&read_text(path)?, path)
}

/// The text of a bank in our layout, one prototype per line.
#[must_use]
pub fn bank_to_json<T: Real>(bank: &Bank<T>) -> String {
    let lines: Vec<String> = bank
        .prototypes
        .iter()
        .map(|(name, efd)| {
            let rows: Vec<String> = efd.rows().iter().map(|[a, b, c, d]| format!("[{a},{b},{c},{d}]")).collect();
            format!("{{\"name\":{},\"efd\":[{}]}}", serde_json::Value::from(name.as_str()), rows.join(","))
        })
        .collect();
    format!("{{\"version\":1,\"prototypes\":[\n{}\n]}}\n", lines.join(",\n"))
}

/// The bank of a text in either layout; errors call the text `path`.
///
/// # Errors
/// As [`read_bank`].
pub fn parse_bank<T: Real>(text: &[u8], path: &Path) -> Result<Bank<T>, FormatError> {
    let place = Place::file(path);
    let refused = |source| FormatError::Json { place: place.clone(), expected: "a bank of shapes", source };
    let is_table = serde_json::from_slice::<serde_json::Value>(text).is_ok_and(|json| json.get("order").is_some());
    let bank = if is_table { parse_table(text, &place)? } else { serde_json::from_slice(text).map_err(refused)? };
    if bank.version != 1 {
        return Err(FormatError::Version { place, version: bank.version });
    }
    if bank.prototypes.is_empty() {
        let problem = "is empty; a bank needs at least one shape".to_owned();
        return Err(FormatError::Field { place, field: "prototypes".to_owned(), problem });
    }
    let checked = bank.prototypes.into_iter().enumerate().map(|(k, prototype)| {
        let efd = checked_efd(&place, &format!("prototypes[{k}].efd"), &prototype.efd)?;
        Ok((prototype.name, efd))
    });
    Ok(Bank::new(checked.collect::<Result<_, FormatError>>()?))
}

fn parse_table(text: &[u8], place: &Place) -> Result<BankJson, FormatError> {
    #[derive(Deserialize)]
    struct Table {
        order: Vec<String>,
        #[serde(flatten)]
        rest: serde_json::Map<String, serde_json::Value>,
    }
    let refused = |source| FormatError::Json { place: place.clone(), expected: "a bank of shapes", source };
    let mut table: Table = serde_json::from_slice(text).map_err(refused)?;
    let prototypes = table.order.into_iter().map(|name| {
        let rows = table.rest.remove(&name).ok_or_else(|| FormatError::Field {
            place: place.clone(),
            field: name.clone(),
            problem: "is listed in `order` but has no rows".to_owned(),
        })?;
        Ok(PrototypeJson { name, efd: serde_json::from_value(rows).map_err(refused)? })
    });
    Ok(BankJson { version: 1, prototypes: prototypes.collect::<Result<_, FormatError>>()? })
}
