//! A better bank from pictures without mixed pixels: every pixel along the outlines of objects that are seen whole has a say.

use std::path::PathBuf;

use anyhow::Result;
use dvp_fit::Bank;
use dvp_fit::prototypes::{Decoder, Pool};

use super::{Arguments, each};

/// How well a prototype explains the objects that it is the shape of.
#[derive(Clone, Copy, Debug, Default)]
struct Record {
    pixels: usize,
    wrong: usize,
}

impl Record {
    /// Share of pixels that are wrong; of a prototype that no object shows all.
    fn share(self) -> f64 {
        if self.pixels == 0 { 1.0 } else { self.wrong as f64 / self.pixels as f64 }
    }
}

/// Lays the outlines of `bank` on all objects that are seen whole, as often as there are passes. Each prototype stays as it explained them
/// best.
pub(super) fn better_bank(arguments: &Arguments, paths: &[PathBuf], bank: Bank<f32>) -> Result<Bank<f32>> {
    let mut best: Vec<Option<(f64, _)>> = vec![None; bank.prototypes.len()];
    let mut tried = bank;
    for _ in 0..arguments.passes {
        let (records, next) = pass(arguments, paths, &tried)?;
        for ((best, record), prototype) in best.iter_mut().zip(records).zip(&tried.prototypes) {
            // Of two that explain as much, the one that more objects were asked for.
            if best.as_ref().is_none_or(|(share, _)| record.share() <= *share) {
                *best = Some((record.share(), prototype.clone()));
            }
        }
        tried = next;
    }
    Ok(Bank::new(best.into_iter().flatten().map(|(_, prototype)| prototype).collect()))
}

/// How well a bank explains the objects, and what they make of it.
fn pass(arguments: &Arguments, paths: &[PathBuf], bank: &Bank<f32>) -> Result<(Vec<Record>, Bank<f32>)> {
    let decoder = Decoder::new(bank)?;
    let found = each(arguments, paths, |image, _, _| Ok(decoder.whole_objects(&image)))?;
    let mut records = vec![Record::default(); bank.prototypes.len()];
    let mut pool = Pool::new(bank)?;
    // In the order of the pictures, whichever thread looked at them; those that failed were told of in the first pass.
    for object in found.into_iter().flatten().flatten() {
        if let Some(record) = records.get_mut(object.prototype) {
            record.pixels += object.pixels;
            record.wrong += object.wrong;
        }
        pool.add_whole(&object);
    }
    Ok((records, pool.bank()?))
}
