//! Numbers as SVG files have them: decimal, rounded, without idle zeros.

use core::fmt::Write;

/// Decimals of numbers in pixels that are known: 0.001 px.
pub(super) const KNOWN: usize = 3;

/// Decimals of numbers in pixels that were fitted with a tolerance: 0.01 px.
pub(super) const FITTED: usize = 2;

/// Numbers below this have whole multiples of the last decimal that an i64 holds exactly.
const LARGEST: f64 = 1e9;

/// `value` rounded to `decimals`, as it is read back.
pub(super) fn rounded(value: f64, decimals: usize) -> f64 {
    let unit = unit(decimals);
    let rounded = (value * unit).round() / unit;
    // Minus zero is written as zero.
    if rounded == 0.0 { 0.0 } else { rounded }
}

fn unit(decimals: usize) -> f64 {
    (0..decimals).fold(1.0, |unit, _| unit * 10.0)
}

/// Appends `value` with at most `decimals` decimals: -.5, 12, .031.
#[expect(clippy::cast_possible_truncation, reason = "a whole number below 2^53")]
pub(super) fn push(text: &mut String, value: f64, decimals: usize) {
    let scaled = (value * unit(decimals)).round();
    // Writing to a String cannot fail.
    if value.abs() >= LARGEST || decimals > 6 {
        let _ = write!(text, "{}", rounded(value, decimals));
        return;
    }
    let (mut rest, mut decimals) = ((scaled as i64).unsigned_abs(), decimals);
    while decimals > 0 && rest % 10 == 0 {
        rest /= 10;
        decimals -= 1;
    }
    if scaled < 0.0 {
        text.push('-');
    }
    let power = 10_u64.pow(u32::try_from(decimals).unwrap_or(0));
    let (whole, part) = (rest / power, rest % power);
    if whole > 0 || decimals == 0 {
        let _ = write!(text, "{whole}");
    }
    if decimals > 0 {
        let _ = write!(text, ".{part:0decimals$}");
    }
}

/// `value` with at most `decimals` decimals.
pub(super) fn short(value: f64, decimals: usize) -> String {
    let mut text = String::new();
    push(&mut text, value, decimals);
    text
}

/// A color in hexadecimal digits: #rrggbb.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] before")]
pub(super) fn hex(color: [f64; 3]) -> String {
    let [r, g, b] = color.map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}
