//! `resvg FILE.svg PIXELS`: draws an SVG with resvg, another program than ours, for the test of what the page exports.
//!
//! `PIXELS` gets red, green, blue, alpha per pixel, colors not multiplied by alpha, at the size that the SVG has.

use core::error::Error;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [svg, pixels] = &arguments[..] else { return Err("usage: resvg FILE.svg PIXELS".into()) };
    let tree = Tree::from_str(&std::fs::read_to_string(svg)?, &Options::default())?;
    let size = tree.size().to_int_size();
    let mut drawn = Pixmap::new(size.width(), size.height()).ok_or("the SVG has no size")?;
    resvg::render(&tree, Transform::identity(), &mut drawn.as_mut());
    let straight = drawn.pixels().iter().map(|pixel| pixel.demultiply());
    let bytes: Vec<u8> = straight.flat_map(|p| [p.red(), p.green(), p.blue(), p.alpha()]).collect();
    std::fs::write(pixels, bytes)?;
    Ok(())
}
