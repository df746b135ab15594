//! What others report on MDS-HR: marks of other hardware.

/// A row of a published table.
pub(super) struct Published {
    pub(super) name: &'static str,
    pub(super) mae: f64,
    pub(super) mse: f64,
    pub(super) ssim: f64,
    pub(super) iou: f64,
    pub(super) ari: f64,
    /// Milliseconds per image of the published implementation on one core of another machine, where that was measured.
    pub(super) ms: Option<f64>,
}

const fn row(name: &'static str, [mae, mse, ssim, iou, ari]: [f64; 5], ms: Option<f64>) -> Published {
    Published { name, mae, mse, ssim, iou, ari, ms }
}

/// The paper's table on its test split; it was made on a GPU (NVIDIA RTX 3090) and gives no times.
///
/// The times are of the published implementations on one core of another machine (Zen 5, 2.6 GHz), the reference's renderer
/// first cut down to the pixels that objects cover: Opt-Iter 128 images, Rand-OptP 16, LIVE 8 (its 5 paths, 500 steps
/// each).
pub(super) const PUBLISHED: [Published; 13] = [
    row("TI", [0.1115, 0.0404, 0.8154, 0.0870, 0.0], None),
    row("GP", [0.0637, 0.0107, 0.8540, 0.8452, 0.8235], None),
    row("GI", [0.4964, 0.3287, 0.0202, 0.0, 0.0], None),
    row("TP", [0.4895, 0.3216, 0.4224, 0.0653, 0.0838], None),
    row("TI+", [0.0444, 0.0050, 0.9148, 0.9341, 0.2275], None),
    row("TI-TP", [0.0482, 0.0068, 0.8878, 0.8884, 0.8693], None),
    row("TI-TP-OptP", [0.0023, 0.0002, 0.9947, 0.9831, 0.9780], None),
    row("TI-TP-OptZ", [0.0015, 0.0001, 0.9961, 0.9927, 0.9820], None),
    row("MONet", [0.0126, 0.0013, 0.9676, 0.9312, 0.9137], None),
    row("LIVE", [0.0098, 0.0010, 0.9850, 0.6767, 0.6740], Some(467e3)),
    row("Opt-Iter", [0.0012, 0.0002, 0.9941, 0.9625, 0.9414], Some(11.8e3)),
    row("Rand-OptP", [0.0409, 0.0178, 0.8976, 0.2399, 0.3046], Some(2.8e3)),
    row("Rand-OptZ", [0.0502, 0.0217, 0.8610, 0.2532, 0.1983], None),
];
