//! stub
use crate::draw::{Rect, Svg};
/// v
#[derive(Debug, Clone, Copy)]
pub enum FarEnd {}
/// m
#[derive(Debug, Clone)]
pub struct RigDrawing;
impl RigDrawing {
    pub(crate) fn draw(&self, _: &mut Svg, _: &Rect) {}
}
