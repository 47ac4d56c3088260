//! Text as outlines: a little TeX-like markup is laid out with an embedded
//! font and drawn as paths, so a picture looks the same everywhere.
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
