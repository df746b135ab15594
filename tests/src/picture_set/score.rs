//! Fits and scores cases with the command as it is shipped: `dvp fit`, then `dvp evaluate`.

use core::fmt::Write as _;
use std::fs;
use std::path::Path;

use dvp_core::Real;
use serde::Deserialize;

use super::cases::Case;

type Failure = Box<dyn core::error::Error>;

/// What came of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureScore {
    /// Name without ending.
    pub stem: String,
    /// Mean absolute error of the reconstruction against the picture.
    pub mae: f64,
    /// Of the foreground.
    pub iou: f64,
    /// Adjusted Rand index.
    pub ari: f64,
    /// Visible objects in truth.
    pub objects: usize,
    /// Visible objects found.
    pub found: usize,
    /// Processor time of the fit.
    pub ms: f64,
}

/// What came of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseScore {
    /// The case.
    pub case: Case,
    /// Its pictures, by name.
    pub pictures: Vec<PictureScore>,
    /// Complaints about pictures that were not fitted or not scored.
    pub failures: String,
}

/// Writes the pictures of a case to `folder/data`, fits them to `folder/out` and scores them.
///
/// # Errors
/// If pictures cannot be made or the command breaks; pictures that it refuses are in [`CaseScore::failures`].
pub fn score_case(case: &Case, folder: &Path) -> Result<CaseScore, Failure> {
    case.write(&folder.join("data"))?;
    let options = if case.bank { &["--bank", "mdshr"][..] } else { &[] };
    let (pictures, failures) = score_folder(folder, options)?;
    Ok(CaseScore { case: *case, pictures, failures })
}

/// Fits the data set `folder/data` to `folder/out` with `options` and scores it: its pictures by name, and complaints.
///
/// # Errors
/// If the command breaks.
pub fn score_folder(folder: &Path, options: &[&str]) -> Result<(Vec<PictureScore>, String), Failure> {
    #[derive(Deserialize)]
    struct Fits {
        images: Vec<Time>,
    }
    #[derive(Deserialize)]
    struct Time {
        stem: String,
        cpu_ms: Option<f64>,
    }
    let [data, out, csv] = ["data", "out", "scores.csv"].map(|name| folder.join(name).to_string_lossy().into_owned());
    let fit = ["fit", &data, "--out", &out, "--json", "--threads", "1"];
    let (json, mut failures) = command(fit.iter().chain(options))?;
    failures.push_str(&command(["evaluate", &out, &data, "--threads", "1", "--csv", &csv].iter())?.1);
    let fits: Fits = serde_json::from_str(&json)?;
    let mut pictures = Vec::new();
    for line in fs::read_to_string(csv)?.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [stem, mae, _mse, _ssim, iou, ari, objects, found, ..] = fields[..] else { continue };
        if mae.is_empty() {
            continue;
        }
        let ms = fits.images.iter().find(|time| time.stem == stem).and_then(|time| time.cpu_ms);
        pictures.push(PictureScore {
            stem: stem.to_owned(),
            mae: mae.parse()?,
            iou: iou.parse()?,
            ari: ari.parse()?,
            objects: objects.parse()?,
            found: found.parse()?,
            ms: ms.unwrap_or(f64::NAN),
        });
    }
    Ok((pictures, failures))
}

/// Runs `dvp` in this process; its two streams.
fn command<'a>(arguments: impl Iterator<Item = &'a &'a str>) -> Result<(String, String), Failure> {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let all = core::iter::once(&"dvp").chain(arguments).map(Into::into);
    // Whoever failed is in the second stream.
    let _ = dvp::command::run(all, &mut out, &mut err);
    Ok((String::from_utf8(out)?, String::from_utf8(err)?))
}

impl CaseScore {
    /// Mean over the pictures.
    #[must_use]
    pub fn ari(&self) -> f64 {
        self.mean(|picture| picture.ari)
    }

    /// Share of pictures with the right number of visible objects.
    #[must_use]
    pub fn exact(&self) -> f64 {
        self.mean(|picture| f64::from(u8::from(picture.objects == picture.found)))
    }

    /// Mean of a figure over the pictures; NaN without any.
    #[must_use]
    pub fn mean(&self, figure: impl Fn(&PictureScore) -> f64) -> f64 {
        self.pictures.iter().map(figure).sum::<f64>() / f64::of_usize(self.pictures.len())
    }

    /// Whether the case reaches what it must, and every picture was scored.
    #[must_use]
    pub fn holds(&self) -> bool {
        let reached = |value: f64, least: Option<f64>| least.is_none_or(|least| value >= least);
        self.failures.is_empty() && reached(self.ari(), self.case.ari) && reached(self.exact(), self.case.exact)
    }

    /// One line of the table under [`table_head`].
    #[must_use]
    pub fn row(&self) -> String {
        let least = |least: Option<f64>| least.map_or_else(|| "-".to_owned(), |least| least.to_string());
        let worst = self.pictures.iter().map(|picture| picture.ms).fold(0.0, f64::max);
        format!(
            "| {} | {} | {:.4} | {:.4} | {:.4} | {} | {:.3} | {} | {:.1}, {worst:.1} | {} |",
            self.case.name,
            self.pictures.len(),
            self.mean(|picture| picture.mae),
            self.mean(|picture| picture.iou),
            self.ari(),
            least(self.case.ari),
            self.exact(),
            least(self.case.exact),
            self.mean(|picture| picture.ms),
            if self.holds() { "yes" } else { "NO" },
        )
    }

    /// The pictures below what the case must reach on average, one per line, and what was refused.
    #[must_use]
    pub fn worst(&self) -> String {
        let mut text = self.failures.clone();
        for PictureScore { stem, mae, ari, objects, found, ms, .. } in &self.pictures {
            if objects != found || self.case.ari.is_some_and(|least| *ari < least) {
                let _ =
                    writeln!(text, "  {stem}: {found} of {objects} objects, ARI {ari:.3}, MAE {mae:.4}, {ms:.1} ms");
            }
        }
        text
    }
}

/// The head of the table of cases.
#[must_use]
pub fn table_head() -> &'static str {
    "| case | pictures | MAE | IoU | ARI | needs | exact count | needs | ms mean, most | holds |\n\
     |---|---|---|---|---|---|---|---|---|---|"
}
