//! `scene PIXELS WIDTH HEIGHT CODED`: what [`Picture::fit`] gives on this machine, for the test that compares it with WebAssembly.
//!
//! `PIXELS` is a file of red, green, blue, alpha per pixel; `CODED` is `true` for pixels of a JPEG. The JSON goes to the standard output,
//! the milliseconds of the fit to the standard error.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program")]

use core::error::Error;
use std::time::Instant;

use dvp_wasm::Picture;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [pixels, width, height, coded] = &arguments[..] else {
        return Err("usage: scene PIXELS WIDTH HEIGHT CODED".into());
    };
    let picture = Picture::new(&std::fs::read(pixels)?, width.parse()?, height.parse()?, coded.parse()?)?;
    let start = Instant::now();
    let json = picture.fit(256, "")?;
    eprintln!("{:.3}", start.elapsed().as_secs_f64() * 1e3);
    println!("{json}");
    Ok(())
}
