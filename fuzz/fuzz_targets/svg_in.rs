//! Any text as SVG: an error, or a scene that renderers paint or refuse, and whose SVG is read or refused.
#![no_main]

use dvp::svg::{from_svg, to_svg};
use dvp_fuzz::paint;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let Ok(drawing) = from_svg(text) else { return };
    paint(&drawing.scene);
    if let Ok(written) = to_svg(&drawing.scene, drawing.size, None) {
        let _ = from_svg(&written);
    }
});
