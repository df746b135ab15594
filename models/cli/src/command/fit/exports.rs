//! What `dvp fit` writes beside scenes: measurements, masks, and files for other programs.

use alloc::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use dvp_core::{Image, ImageSize};
use dvp_fit::{Bank, Fit};

use super::report::Report;
use crate::export::{
    ExportError, Found, HAS_PARQUET, MeasuredPicture, Scale, coco, efd_csv, efd_nef, geojson, label_map, label_map_in,
    label_map_png, measure, roi_zip, table_csv, table_parquet, whole_png,
};
use crate::format::write_atomic;

/// What is written beside scenes. What names a file holds all pictures of the run; the others are a file per picture.
#[derive(Debug, Args)]
#[command(next_help_heading = "Measurements and files for other programs")]
pub(super) struct ExportArguments {
    /// Table of all objects, a row each, of all pictures: .csv or .parquet
    ///
    /// Columns that end in _sd tell standard deviations, from what the noise of the picture does to position, size and angle
    /// of the shape as it was found. Bounds and colors have none.
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Size of a pixel, 0.12mm/px or 8.5px/mm: the table tells lengths and areas in mm as well
    #[arg(long, value_name = "SCALE")]
    scale: Option<Scale>,
    /// Normalized elliptic Fourier descriptors of all objects of all pictures: .csv or .nef
    #[arg(long, value_name = "FILE")]
    efd: Option<PathBuf>,
    /// Harmonics of --efd
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    harmonics: u16,
    /// COCO data set of all pictures: polygons, masks where there are holes
    #[arg(long, value_name = "FILE")]
    coco: Option<PathBuf>,
    /// Write STEM.labels.png: 0 the background, k the pixels where object k is seen
    #[arg(long)]
    labels: bool,
    /// Write STEM.whole.png: the coverage of every object, hidden parts included, side by side; 2^28 pixels at most
    #[arg(long)]
    whole: bool,
    /// Write STEM.rois.zip: the outlines for the ROI Manager of ImageJ
    #[arg(long)]
    roi: bool,
    /// Write STEM.geojson: outlines in pixels, with what the table tells
    #[arg(long)]
    geojson: bool,
}

/// A file of a picture: what its name ends with, and its bytes.
pub(super) type PictureFile = (&'static str, Vec<u8>);

/// A scene, and what is known of it.
#[derive(Debug)]
pub(super) struct Measurable<'a> {
    pub(super) fit: &'a Fit<f32>,
    pub(super) bank: Option<&'a Bank<f32>>,
    pub(super) size: ImageSize,
    /// What it was read from; none: a label map.
    image: Option<&'a Image<f32>>,
    /// What its objects are called, one number per object; none: from 1 in the order of painting.
    numbers: Option<&'a [u32]>,
}

impl<'a> Measurable<'a> {
    pub(super) fn new(fit: &'a Fit<f32>, bank: Option<&'a Bank<f32>>, image: &'a Image<f32>) -> Self {
        Self { fit, bank, size: image.size(), image: Some(image), numbers: None }
    }

    /// The objects of label maps keep their labels.
    pub(super) fn of_labels(fit: &'a Fit<f32>, size: ImageSize, labels: &'a [u32]) -> Self {
        Self { fit, bank: None, size, image: None, numbers: Some(labels) }
    }

    pub(super) fn numbers(&self) -> Vec<u32> {
        let objects = self.fit.scene.objects.len();
        self.numbers.map_or_else(|| (1..).take(objects).collect(), <[u32]>::to_vec)
    }
}

impl ExportArguments {
    /// Refuses endings that no format has, before anything is fitted.
    pub(super) fn check(&self) -> Result<()> {
        let files = [("--table", &self.table, ["csv", "parquet"]), ("--efd", &self.efd, ["csv", "nef"])];
        for (option, path, endings) in files {
            if let Some(path) = path
                && !endings.iter().any(|ending| has_ending(path, ending))
            {
                bail!("{}: {option} takes a file that ends in .{} or .{}", path.display(), endings[0], endings[1]);
            }
        }
        if !HAS_PARQUET && self.table.as_ref().is_some_and(|path| has_ending(path, "parquet")) {
            bail!(ExportError::NoParquet);
        }
        Ok(())
    }

    /// Whether objects must be measured.
    fn measures(&self) -> bool {
        self.run_files().next().is_some() || self.roi || self.geojson
    }

    /// The files of all pictures together.
    pub(super) fn run_files(&self) -> impl Iterator<Item = &PathBuf> {
        [&self.table, &self.efd, &self.coco].into_iter().flatten()
    }

    /// What the names of the files of a picture end with.
    pub(super) fn endings(&self) -> impl Iterator<Item = &'static str> {
        let files =
            [(self.labels, "labels.png"), (self.whole, "whole.png"), (self.roi, "rois.zip"), (self.geojson, "geojson")];
        files.into_iter().filter_map(|(is_asked, ending)| is_asked.then_some(ending))
    }

    /// Adds the files of a picture; returns what the files of all pictures are to tell of it.
    pub(super) fn of_picture(
        &self,
        of: &Measurable<'_>,
        [picture, stem]: [&str; 2],
        files: &mut Vec<PictureFile>,
    ) -> Result<Option<MeasuredPicture>> {
        let Measurable { fit: Fit { scene, covariance, noise, .. }, bank, size, image, .. } = *of;
        let numbers = of.numbers();
        let measured = || -> Result<MeasuredPicture> {
            let found = Found { size, objects: measure(scene, covariance, bank, &numbers, size)? };
            Ok(MeasuredPicture::new(picture.to_owned(), stem.to_owned(), Ok(found)))
        };
        let measured = self.measures().then(measured).transpose()?;
        let labels = || match image {
            Some(image) => label_map_in(scene, &numbers, image.view(), *noise),
            None => label_map(scene, &numbers, size),
        };
        for ending in self.endings() {
            let bytes = match (ending, &measured) {
                ("labels.png", _) => label_map_png(&labels()?, size)?,
                ("whole.png", _) => whole_png(scene, size)?,
                ("rois.zip", Some(measured)) => roi_zip(measured.objects())?,
                ("geojson", Some(measured)) => geojson(measured, self.scale)?,
                _ => continue,
            };
            files.push((ending, bytes));
        }
        Ok(measured)
    }

    /// Writes the files of all pictures, as many as can be; tells which could not.
    pub(super) fn write_run(&self, pictures: &[MeasuredPicture]) -> Vec<String> {
        let table = self.table.as_ref().map(|path| {
            let write = if has_ending(path, "parquet") { table_parquet } else { table_csv };
            (path, write(pictures, self.scale))
        });
        let efd = self.efd.as_ref().map(|path| {
            let harmonics = usize::from(self.harmonics);
            let is_nef = has_ending(path, "nef");
            (path, if is_nef { Ok(efd_nef(pictures, harmonics)) } else { efd_csv(pictures, harmonics) })
        });
        let coco = self.coco.as_ref().map(|path| (path, coco(pictures)));
        let write = |(path, bytes): (&PathBuf, Result<Vec<u8>, ExportError>)| match bytes {
            Ok(bytes) => write_atomic(path, &bytes).err().map(|error| error.to_string()),
            Err(error) => Some(format!("{}: {error}", path.display())),
        };
        [table, efd, coco].into_iter().flatten().filter_map(write).collect()
    }
}

/// Refuses to write over what is kept, and to write two files of the run under one name.
pub(super) fn refuse_overwriting(
    kept: impl Iterator<Item = impl AsRef<Path>>,
    of_pictures: impl Iterator<Item = PathBuf>,
    of_run: impl Iterator<Item = impl AsRef<Path>>,
) -> Result<()> {
    let kept: BTreeSet<PathBuf> = kept.filter_map(|path| path.as_ref().canonicalize().ok()).collect();
    let mut written = BTreeSet::new();
    let targets = of_pictures.chain(of_run.map(|path| path.as_ref().to_path_buf()));
    for target in targets {
        if target.canonicalize().is_ok_and(|target| kept.contains(&target)) {
            bail!(
                "{} is a picture or a label map of the input and would be replaced; choose another --out, or leave this file away (the reconstruction: --no-png)",
                target.display()
            );
        }
        if !written.insert(std::path::absolute(&target).unwrap_or_else(|_| target.clone())) {
            bail!("{} would be written twice; choose different names", target.display());
        }
    }
    Ok(())
}

/// What the files of all pictures are to tell.
pub(super) fn measured(reports: &mut [Report]) -> Vec<MeasuredPicture> {
    let of = |report: &mut Report| {
        let found = report.found.as_mut().and_then(|found| found.measured.take());
        found.unwrap_or_else(|| {
            let error = report.error.clone().unwrap_or_default();
            MeasuredPicture::new(report.picture.clone(), report.stem.clone(), Err(error))
        })
    };
    reports.iter_mut().map(of).collect()
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}
