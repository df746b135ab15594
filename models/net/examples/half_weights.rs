//! Stores weights in half the space: matrices and kernels as F16, without the optimizer.
//!
//! `cargo run --release -p dvp-net --example half_weights -- run/best.safetensors half.safetensors`
//!
//! The file is taken wherever `dvp` takes weights; only `dvp train --resume` needs the checkpoints of its run, which stay f32.

use core::error::Error;
use std::fs;

use dvp_net::train::WeightsFile;

fn main() -> Result<(), Box<dyn Error>> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let [from, to] = &paths[..] else { return Err("usage: half_weights WEIGHTS OUT".into()) };
    // Of whatever kind of network: its sizes go through as they are.
    let bytes = fs::read(from)?;
    let half = WeightsFile::<serde_json::Value>::from_bytes(&bytes)?.to_half_bytes()?;
    fs::write(to, &half)?;
    eprintln!("{from}: {} bytes, {to}: {}", bytes.len(), half.len());
    Ok(())
}
