//! Random scenes like those of Tetrominoes.
//!
//! *Source*: `deepmind/multi_object_datasets`: 35 x 35 pixels, three tetrominoes of 17 turned shapes, six colors. What it does not say is
//! ours: cells of 5 pixels, pieces beside one another at any whole pixel, and which two of the 19 turned shapes are missing (S and Z
//! upright).

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{AnyShape, Polygon};
use dvp_core::{ImageSize, Object, Pose, Scene};

use super::chance::{Chance, below};

/// Columns, and rows, of a picture.
pub const TETROMINO_SIDE: usize = 35;
/// Pixels across a cell.
const CELL_PX: usize = 5;
/// Pieces in a picture.
const PIECES: usize = 3;
/// Draws of the place of a piece before the picture is begun anew.
const TRIES: usize = 50;

/// A piece: the cells (column, row) that it fills, and its corners.
pub(super) struct Piece {
    pub(super) cells: [[usize; 2]; 4],
    pub(super) corners: &'static [[u8; 2]],
}

/// The 17 turned shapes, by their classes.
pub(super) const TETROMINOES: [Piece; 17] = [
    // I
    Piece { cells: [[0, 0], [1, 0], [2, 0], [3, 0]], corners: &[[0, 0], [4, 0], [4, 1], [0, 1]] },
    Piece { cells: [[0, 0], [0, 1], [0, 2], [0, 3]], corners: &[[0, 0], [1, 0], [1, 4], [0, 4]] },
    // O
    Piece { cells: [[0, 0], [1, 0], [0, 1], [1, 1]], corners: &[[0, 0], [2, 0], [2, 2], [0, 2]] },
    // T
    Piece {
        cells: [[0, 0], [1, 0], [2, 0], [1, 1]],
        corners: &[[0, 0], [3, 0], [3, 1], [2, 1], [2, 2], [1, 2], [1, 1], [0, 1]],
    },
    Piece {
        cells: [[1, 0], [0, 1], [1, 1], [2, 1]],
        corners: &[[1, 0], [2, 0], [2, 1], [3, 1], [3, 2], [0, 2], [0, 1], [1, 1]],
    },
    Piece {
        cells: [[0, 0], [0, 1], [0, 2], [1, 1]],
        corners: &[[0, 0], [1, 0], [1, 1], [2, 1], [2, 2], [1, 2], [1, 3], [0, 3]],
    },
    Piece {
        cells: [[1, 0], [1, 1], [1, 2], [0, 1]],
        corners: &[[1, 0], [2, 0], [2, 3], [1, 3], [1, 2], [0, 2], [0, 1], [1, 1]],
    },
    // L
    Piece { cells: [[0, 0], [0, 1], [0, 2], [1, 2]], corners: &[[0, 0], [1, 0], [1, 2], [2, 2], [2, 3], [0, 3]] },
    Piece { cells: [[0, 0], [1, 0], [2, 0], [0, 1]], corners: &[[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2]] },
    Piece { cells: [[0, 0], [1, 0], [1, 1], [1, 2]], corners: &[[0, 0], [2, 0], [2, 3], [1, 3], [1, 1], [0, 1]] },
    Piece { cells: [[2, 0], [0, 1], [1, 1], [2, 1]], corners: &[[2, 0], [3, 0], [3, 2], [0, 2], [0, 1], [2, 1]] },
    // J
    Piece { cells: [[1, 0], [1, 1], [1, 2], [0, 2]], corners: &[[1, 0], [2, 0], [2, 3], [0, 3], [0, 2], [1, 2]] },
    Piece { cells: [[0, 0], [0, 1], [1, 1], [2, 1]], corners: &[[0, 0], [1, 0], [1, 1], [3, 1], [3, 2], [0, 2]] },
    Piece { cells: [[0, 0], [1, 0], [0, 1], [0, 2]], corners: &[[0, 0], [2, 0], [2, 1], [1, 1], [1, 3], [0, 3]] },
    Piece { cells: [[0, 0], [1, 0], [2, 0], [2, 1]], corners: &[[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [0, 1]] },
    // S and Z, lying
    Piece {
        cells: [[1, 0], [2, 0], [0, 1], [1, 1]],
        corners: &[[1, 0], [3, 0], [3, 1], [2, 1], [2, 2], [0, 2], [0, 1], [1, 1]],
    },
    Piece {
        cells: [[0, 0], [1, 0], [1, 1], [2, 1]],
        corners: &[[0, 0], [2, 0], [2, 1], [3, 1], [3, 2], [1, 2], [1, 1], [0, 1]],
    },
];

/// Red, green, blue, yellow, magenta, cyan.
const COLORS: [[f32; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];

impl Piece {
    /// Columns and rows of cells.
    fn extent(&self) -> [usize; 2] {
        [0, 1].map(|axis| 1 + self.cells.iter().map(|cell| cell[axis]).max().unwrap_or(0))
    }

    /// The pixels that the piece fills with its upper left corner at `at`, columns and rows.
    fn pixels(&self, at: [usize; 2]) -> impl Iterator<Item = usize> {
        let corners = self.cells.map(|cell| [0, 1].map(|axis| at[axis] + CELL_PX * cell[axis]));
        corners.into_iter().flat_map(|[x, y]| {
            (y..y + CELL_PX).flat_map(move |row| (x..x + CELL_PX).map(move |column| row * TETROMINO_SIDE + column))
        })
    }

    /// The piece as an object, in pictures of [`TETROMINO_SIDE`] pixels.
    fn object(&self, at: [usize; 2], color: [f32; 3]) -> Object<f32> {
        #[expect(clippy::cast_precision_loss, reason = "below 100")]
        let unit = |pixels: usize| pixels as f32 / TETROMINO_SIDE as f32;
        let middle = self.extent().map(|cells| unit(CELL_PX * cells) / 2.0);
        let corner = |corner: &[u8; 2]| [0, 1].map(|axis| unit(CELL_PX * usize::from(corner[axis])) - middle[axis]);
        let ring = self.corners.iter().map(corner).collect();
        let translation = [0, 1].map(|axis| unit(at[axis]) + middle[axis]);
        Object {
            shape: AnyShape::Polygon(Polygon { rings: vec![ring] }),
            pose: Pose { translation, scale: 1.0, rotation: 0.0 },
            paint: color.into(),
            confidence: 1.0,
        }
    }
}

/// Scene number `index` of the data set `seed`, for pictures of [`TETROMINO_SIDE`] pixels, and the class of each of its objects.
#[must_use]
pub fn sample_tetrominoes(seed: u64, index: u64) -> (Scene<f32>, Vec<u32>) {
    let mut rng = Chance::new(seed, index);
    let placed = loop {
        if let Some(placed) = place(&mut rng) {
            break placed;
        }
    };
    let objects =
        placed.iter().map(|&(class, at)| TETROMINOES[class].object(at, COLORS[below(&mut rng, COLORS.len())]));
    let scene = Scene {
        background: [0.0; 3],
        transparent: false,
        objects: objects.collect(),
        edge: hard_edge(),
        compositing: Compositing::Over,
    };
    (scene, placed.iter().map(|&(class, _)| u32::try_from(class).unwrap_or(0)).collect())
}

/// Pixels are inside or outside.
fn hard_edge() -> EdgeProfile<f32> {
    #[expect(clippy::cast_precision_loss, reason = "below 100")]
    let unit_px = ImageSize::new(TETROMINO_SIDE, TETROMINO_SIDE).map_or(1.0, |size| size.unit_px() as f32);
    EdgeProfile::hard(unit_px)
}

/// Pieces and their places, none on another; none if no place was found for one.
fn place(rng: &mut Chance) -> Option<Vec<(usize, [usize; 2])>> {
    let mut taken = [false; TETROMINO_SIDE * TETROMINO_SIDE];
    let mut placed = Vec::new();
    for _ in 0..PIECES {
        let class = below(rng, TETROMINOES.len());
        let piece = &TETROMINOES[class];
        let room = piece.extent().map(|cells| TETROMINO_SIDE - CELL_PX * cells + 1);
        let at = (0..TRIES).map(|_| room.map(|room| below(rng, room)));
        let at = { at }.find(|&at| piece.pixels(at).all(|pixel| !taken[pixel]))?;
        piece.pixels(at).for_each(|pixel| taken[pixel] = true);
        placed.push((class, at));
    }
    Some(placed)
}
