//! stub
/// v
#[derive(Debug, Clone, Copy)]
pub struct Animation;
