//! The source that was built.

/// The commit that was built and whether its files had been changed; `None`
/// when built outside a checkout.
pub fn commit() -> Option<String> {
    option_env!("HERTZCHAIN_COMMIT").map(str::to_owned)
}
