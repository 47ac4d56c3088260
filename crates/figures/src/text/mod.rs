//! Text: a little TeX-like markup is laid out with the metrics of an embedded font and
//! drawn as text, or as outlines that need no font.
//!
//! Inside `$...$` Latin letters are italic, `_x`, `_{...}`, `^x` and `^{...}`
//! make subscripts and superscripts, `\mathrm{...}` is upright, `\alpha`,
//! `\Delta`, `\times`, `\cdot`, `\leq` ... are single characters and `-` is a
//! minus sign. Outside, everything is literal; `\$` is a dollar sign.

mod font;
mod line;
mod markup;
mod wrap;

pub(crate) use font::GlyphId;
pub(crate) use line::{Anchor, LEAST_SIZE, TextLine};
pub(crate) use wrap::wrap;
