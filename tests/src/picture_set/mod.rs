//! Pictures of our own that no renderer of ours drew: SVGs drawn by resvg with the label maps that go with them, random
//! families; the noise, blur and JPEG that happen to pictures on their way are those of `dvp::spoil`.
//!
//! ```text
//! tests/pictures/*/*.svg | random -> drawn -> spoil -> dvp fit -> dvp evaluate -> a table of cases
//! ```
//!
//! | file | does |
//! |---|---|
//! | `drawn.rs` | SVG to pixels and label map |
//! | `random.rs` | crowds, MDS-HR, twins, cropped objects |
//! | `cases.rs` | the cases with their thresholds, written as data sets |
//! | `score.rs` | fits and scores them |
//! | `shortfall.rs` | what known failures reach, as recorded |
//!
//! **Truth.** Every object is one SVG element with an `id`; the topmost element that holds a pixel's center owns the pixel,
//! translucent or not. A ring is drawn as a disk of the background's color on a disk, and counts as these two: a picture
//! cannot tell it from a ring with a hole, and our scenes know disks, not rings. Objects that nothing is seen of do not
//! count.
//!
//! The suite `tests/pictures` asserts what holds; the example `any_picture` prints the table.

mod cases;
mod drawn;
mod random;
mod score;
mod shortfall;

pub use cases::{CASES, Case, Finish, Source};
pub use drawn::{Drawn, draw_enlarged, draw_with_labels};
pub use random::{cropped, crowd, mds_hr, paint_mds_hr, twins};
pub use score::{CaseScore, PictureScore, score_case, score_folder, table_head};
pub use shortfall::{ARI_TOLERANCE, Shortfall};
