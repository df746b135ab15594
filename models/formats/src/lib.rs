//! Scenes as text, as vector graphics and as tables: everything that programs exchange and that needs no decoder of pictures.
//!
//! | module | comes in | goes out |
//! |---|---|---|
//! | [`mod@format`] | scene JSON, bank JSON, pixels as a decoder leaves them | scenes, banks, pictures with every number checked; and the way back |
//! | [`svg`] | a scene | SVG that people can edit |
//! | [`export`] | a scene and what its fit knows of it | measures, label maps, tables |
//!
//! The command `dvp` uses all of it and adds what reads and writes files of pictures; the browser uses it as it is, so it compiles for
//! `wasm32-unknown-unknown`. What takes paths reads files; everything else works on memory.
//!
//! # Features
//!
//! `parquet` brings tables as Apache Parquet.

extern crate alloc;

pub mod export;
pub mod format;
#[doc(hidden)]
pub mod instances;
pub mod svg;
