//! `dvp-bind MODULE.wasm FOLDER`: binds the module of dvp-wasm to JavaScript, with types, for browsers and workers.
//!
//! What `wasm-bindgen --target web` does, by the same library, without installing that program.

use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [module, folder] = &arguments[..] else { bail!("usage: dvp-bind MODULE.wasm FOLDER") };
    let mut bindgen = Bindgen::new();
    bindgen.input_path(module).out_name("dvp_wasm").typescript(true).remove_name_section(true).remove_producers_section(true);
    bindgen.omit_default_module_path(false);
    bindgen.web(true).context("a module for browsers")?;
    bindgen.generate(folder).with_context(|| format!("{} is not bound", module.display()))
}
