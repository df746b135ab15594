//! What was learned: JSON for programs, a table for people.

use core::time::Duration;

use comfy_table::{Table, presets};
use dvp_fit::Bank;
use serde::Serialize;

use super::Found;

/// Everything that was found.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    images: usize,
    /// Objects of the free fits.
    objects: usize,
    /// Those that show their whole shape.
    members: usize,
    /// Members that resemble no other, or a shape seen too rarely.
    outliers: usize,
    shapes: Vec<Shape>,
    /// Mean silhouette of 2, 3, ... shapes.
    silhouettes: Vec<f64>,
    harmonics: Vec<usize>,
    seconds: f64,
}

#[derive(Debug, Serialize)]
struct Shape {
    name: String,
    members: usize,
    mirrored: usize,
    /// 0: a disk.
    symmetry: usize,
    own_mirror_image: bool,
    /// Median distance of the members from the shape, in radii of the disk of the same area.
    spread: f64,
}

impl Report {
    pub(super) fn new(found: &Found, bank: &Bank<f32>, images: usize, time: Duration) -> Self {
        let shapes = (1..).zip(&found.learned.prototypes).map(|(number, prototype)| Shape {
            name: format!("shape {number}"),
            members: prototype.members.len(),
            mirrored: prototype.mirrored,
            symmetry: prototype.symmetry,
            own_mirror_image: prototype.own_mirror,
            spread: prototype.spread,
        });
        Self {
            images,
            objects: found.objects,
            members: found.members.len(),
            outliers: found.learned.outliers.len(),
            shapes: shapes.collect(),
            silhouettes: found.learned.silhouettes.iter().map(|value| value.mean).collect(),
            harmonics: bank.prototypes.iter().map(|(_, efd)| efd.harmonic_count()).collect(),
            seconds: time.as_secs_f64(),
        }
    }

    pub(super) fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(self)
    }

    pub(super) fn table(&self) -> String {
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(["shape", "members", "mirrored", "turns", "own mirror image", "spread %"]);
        for shape in &self.shapes {
            table.add_row([
                shape.name.clone(),
                shape.members.to_string(),
                shape.mirrored.to_string(),
                if shape.symmetry == 0 { "any".to_owned() } else { shape.symmetry.to_string() },
                if shape.own_mirror_image { "yes" } else { "no" }.to_owned(),
                format!("{:.2}", 100.0 * shape.spread),
            ]);
        }
        let silhouettes: Vec<String> =
            (2..).zip(&self.silhouettes).map(|(k, value)| format!("{k}: {value:.3}")).collect();
        format!(
            "{}\n{} of {} objects in {} pictures show their shape, {} resemble no other; {:.1} s\nsilhouette of {}",
            table.trim_fmt(),
            self.members,
            self.objects,
            self.images,
            self.outliers,
            self.seconds,
            silhouettes.join(", ")
        )
    }
}
