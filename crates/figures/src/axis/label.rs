//! Numbers as tick labels.

/// A number with a fixed count of decimals and a true minus sign; no "-0".
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let digits = text.trim_start_matches('-');
    let zero = digits.chars().all(|c| matches!(c, '0' | '.'));
    if zero || !text.starts_with('-') {
        digits.to_owned()
    } else {
        format!("−{digits}")
    }
}

/// `mantissa * 10^exponent` in plain decimals.
pub(crate) fn plain(mantissa: u32, exponent: i32) -> String {
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    fixed(f64::from(mantissa) * 10f64.powi(exponent), decimals)
}

/// `mantissa * 10^exponent` as a power of ten.
pub(crate) fn power(mantissa: u32, exponent: i32) -> String {
    match mantissa {
        1 => format!("$10^{{{exponent}}}$"),
        m => format!(r"${m}\times10^{{{exponent}}}$"),
    }
}

#[cfg(test)]
#[path = "tests/label.rs"]
mod tests;
