//! The fit, the renderer and the formats for browsers and for everything else that runs WebAssembly.
//!
//! In: pixels, as a browser decodes them. Out: scenes as JSON of version 3, and what is made of them. Everything works on memory and
//! runs to its end, so a page calls it from a worker.
//!
//! | file | holds |
//! |---|---|
//! | `picture.rs` | [`Picture`]: pixels, fitted, refined, compared |
//! | `drawing.rs` | [`Drawing`]: a scene, painted, written, measured |
//! | `error.rs` | [`WebError`]: why something failed, in words for people |
//!
//! Core and fit are compiled without std and for the vector instructions of WebAssembly: no fused multiply-adds, the mathematics of
//! `libm`. A build without std for another machine gives the same scenes bit for bit (`models/web/test/native.mjs`); the command `dvp`,
//! which takes the instructions and the mathematics of its machine, differs from them in the last digits.

mod drawing;
mod error;
mod picture;

pub use drawing::Drawing;
pub use error::WebError;
pub use picture::{Comparison, Picture};

use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console, js_name = error)]
    fn console_error(text: &str);
}

/// Reports panics on the console: a module that panics stops without a word, and must be loaded anew.
#[wasm_bindgen(start)]
pub fn start() {
    std::panic::set_hook(Box::new(|panic| console_error(&format!("dvp stopped, which is a defect: {panic}"))));
}

/// The version of dvp.
#[wasm_bindgen]
#[must_use]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
