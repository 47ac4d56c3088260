//! Compact numbers for a script: sampled evenly, quantised, base64.

use std::fmt::Write as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

/// Linear interpolation of `(times, values)` at the ascending times of `grid`.
/// Values that are not finite are passed over.
pub(super) fn resampled(times: &[f64], values: &[f64], grid: &[f64]) -> Vec<f64> {
    let known: Vec<(f64, f64)> = times
        .iter()
        .copied()
        .zip(values.iter().copied())
        .filter(|(t, v)| t.is_finite() && v.is_finite())
        .collect();
    let at = |t: f64| {
        let next = known.partition_point(|(known_t, _)| *known_t < t);
        match (
            next.checked_sub(1).and_then(|i| known.get(i)),
            known.get(next),
        ) {
            (Some((t0, v0)), Some((t1, v1))) if t1 > t0 => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
            (_, Some((_, v))) | (Some((_, v)), None) => *v,
            (None, None) => 0.0,
        }
    };
    grid.iter().map(|t| at(*t)).collect()
}

/// All values as shares of their common range in sixteen bits, row after row,
/// and that range.
pub(super) fn quantised(rows: &[Vec<f64>]) -> (Vec<u16>, (f64, f64)) {
    let all = || rows.iter().flatten().copied();
    let (lo, hi) = all().fold((0.0_f64, 0.0_f64), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let step = (hi - lo) / f64::from(u16::MAX);
    let level = |v: f64| {
        if step > 0.0 {
            ((v - lo) / step).round() as u16
        } else {
            0
        }
    };
    (all().map(level).collect(), (lo, hi))
}

/// Little-endian bytes as a quoted base64 text.
pub(super) fn base64_u16(values: &[u16]) -> String {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    format!("\"{}\"", STANDARD.encode(bytes))
}

/// Single precision, little-endian, as a quoted base64 text.
pub(super) fn base64_f32(values: &[f64]) -> String {
    let bytes: Vec<u8> = values
        .iter()
        .flat_map(|v| (*v as f32).to_le_bytes())
        .collect();
    format!("\"{}\"", STANDARD.encode(bytes))
}

/// A quoted JSON text that is safe inside a script element.
pub(super) fn json_text(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() || matches!(c, '<' | '>' | '&' | '\u{2028}' | '\u{2029}') => {
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
#[path = "tests/encode.rs"]
mod tests;
