//! Why a drawing was not read.

/// Why a text was not read as SVG.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SvgError {
    /// More bytes than are read.
    #[error("the SVG has {bytes} bytes, more than {limit}")]
    TooLong {
        /// How many there are.
        bytes: usize,
        /// How many are read.
        limit: usize,
    },
    /// Entities that may become more text than is read.
    #[error("the entities of the SVG may stand for more than {limit} bytes; write them out")]
    Entities {
        /// Most bytes.
        limit: usize,
    },
    /// Not XML.
    #[error("not XML: {0}")]
    Xml(#[from] usvg::roxmltree::Error),
    /// XML, but no drawing that can be read.
    #[error("not a readable SVG: {0}")]
    Svg(#[from] usvg::Error),
    /// An element that is, by way of others, a part of itself.
    #[error("the <{tag}> in line {line} of the SVG uses itself")]
    Recursive {
        /// Name of the element.
        tag: String,
        /// Where it stands.
        line: u32,
    },
    /// Elements in elements, or used by elements that are used by others, too deep.
    #[error("elements of the SVG are nested {limit} deep or deeper in line {line}")]
    TooDeep {
        /// The first depth that is refused.
        limit: usize,
        /// Where it is reached.
        line: u32,
    },
    /// More elements than are read, each counted as often as it is used.
    #[error("the SVG draws more than {limit} elements, each counted as often as it is used")]
    TooManyElements {
        /// Most elements.
        limit: usize,
    },
    /// A style sheet with so many rules for so many elements that applying it would take too long.
    #[error("the style sheet of the SVG has {rules} rules for {elements} elements; write styles into the elements")]
    Styles {
        /// How many rules there are.
        rules: usize,
        /// How many elements there are.
        elements: usize,
    },
    /// More lines and curves, and stops of gradients in all that is painted with them, than are read.
    #[error("the SVG has more than {limit} lines and curves, or stops of gradients")]
    TooManySegments {
        /// Most of all of them.
        limit: usize,
    },
    /// A width or height of no pixel, or of too many.
    #[error("the SVG is {width} x {height} px; each side must be above 0 and at most {limit}")]
    Size {
        /// Pixels.
        width: f32,
        /// Pixels.
        height: f32,
        /// Longest side, pixels.
        limit: f32,
    },
    /// A number that is too large to be drawn.
    #[error("the <{tag}> in line {line} of the SVG has the number {value}, beyond {limit}")]
    TooLarge {
        /// Name of the element.
        tag: String,
        /// Where it stands.
        line: u32,
        /// The number.
        value: f64,
        /// Largest number.
        limit: f64,
    },
    /// Lengths in units of a font, which drawings do not have here.
    #[error("the <{tag}> in line {line} of the SVG has lengths in em or ex; write pixels")]
    FontUnits {
        /// Name of the element.
        tag: String,
        /// Where it stands.
        line: u32,
    },
    /// A place far outside of the picture.
    #[error("the SVG draws {distance} px from its upper left corner, beyond {limit} px")]
    TooFar {
        /// Pixels.
        distance: f32,
        /// Farthest place, pixels.
        limit: f32,
    },
    /// A shape that the scene refuses.
    #[error("the SVG has a shape that cannot be drawn: {0}")]
    Shape(#[from] dvp_core::shape::ShapeError),
}
