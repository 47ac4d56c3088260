//! From markup to runs of characters with a style and a script level.

use std::iter::Peekable;
use std::str::Chars;

use super::font::Face;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Script {
    Base,
    Sub,
    Super,
}

/// Characters of one style at one script level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct TextRun {
    pub(crate) text: String,
    pub(crate) style: Face,
    pub(crate) script: Script,
}

/// `\name` and the character it stands for.
#[rustfmt::skip]
pub(crate) const SYMBOLS: &[(&str, char)] = &[
    ("alpha", 'α'), ("beta", 'β'), ("gamma", 'γ'), ("delta", 'δ'), ("epsilon", 'ε'), ("eta", 'η'),
    ("theta", 'θ'), ("kappa", 'κ'), ("lambda", 'λ'), ("mu", 'μ'), ("nu", 'ν'), ("xi", 'ξ'),
    ("pi", 'π'), ("rho", 'ρ'), ("sigma", 'σ'), ("tau", 'τ'), ("phi", 'φ'), ("chi", 'χ'),
    ("psi", 'ψ'), ("omega", 'ω'), ("Gamma", 'Γ'), ("Delta", 'Δ'), ("Theta", 'Θ'), ("Lambda", 'Λ'),
    ("Sigma", 'Σ'), ("Phi", 'Φ'), ("Psi", 'Ψ'), ("Omega", 'Ω'), ("times", '×'), ("cdot", '·'),
    ("pm", '±'), ("leq", '≤'), ("geq", '≥'), ("approx", '≈'), ("neq", '≠'), ("infty", '∞'),
    ("partial", '∂'), ("sum", '∑'), ("sqrt", '√'), ("degree", '°'), ("prime", '′'), ("ell", 'ℓ'),
];

/// Splits markup into runs; malformed markup is shown as it was typed.
pub(crate) fn parse(source: &str) -> Vec<TextRun> {
    let mut parser =
        Parser { rest: source.chars().peekable(), math: false, upright: false, runs: Vec::new() };
    while let Some(c) = parser.rest.next() {
        parser.take(c, Script::Base);
    }
    parser.runs
}

struct Parser<'a> {
    rest: Peekable<Chars<'a>>,
    math: bool,
    upright: bool,
    runs: Vec<TextRun>,
}

impl Parser<'_> {
    fn take(&mut self, c: char, script: Script) {
        match c {
            '$' => self.math = !self.math,
            '\\' => self.command(script),
            '_' if self.math => self.script(Script::Sub),
            '^' if self.math => self.script(Script::Super),
            '-' if self.math => self.push('−', script),
            '{' | '}' if self.math => {}
            _ => self.push(c, script),
        }
    }

    fn push(&mut self, c: char, script: Script) {
        let italic = self.math && !self.upright && is_variable(c);
        let style = if italic { Face::Italic } else { Face::Regular };
        match self.runs.last_mut() {
            Some(run) if run.style == style && run.script == script => run.text.push(c),
            _ => self.runs.push(TextRun { text: c.to_string(), style, script }),
        }
    }

    /// The argument of `_` or `^`: one character, one command or a group.
    fn script(&mut self, script: Script) {
        match self.rest.next() {
            Some('{') => self.group(script),
            Some(c) => self.take(c, script),
            None => {}
        }
    }

    fn group(&mut self, script: Script) {
        while let Some(c) = self.rest.next() {
            if c == '}' {
                return;
            }
            self.take(c, script);
        }
    }

    fn command(&mut self, script: Script) {
        if let Some(c) = self.rest.next_if(|c| !c.is_ascii_alphabetic()) {
            // A thin space inside numbers with units, or an escaped character.
            return self.push(if c == ',' { '\u{2009}' } else { c }, script);
        }
        let mut name = String::new();
        while let Some(c) = self.rest.next_if(char::is_ascii_alphabetic) {
            name.push(c);
        }
        // As in TeX, a space only ends the name: `\mu s` is a microsecond.
        self.rest.next_if_eq(&' ');
        if name == "mathrm" {
            return self.roman_group(script);
        }
        match SYMBOLS.iter().find(|(n, _)| *n == name) {
            Some((_, symbol)) => self.push(*symbol, script),
            None => format!("\\{name}").chars().for_each(|c| self.push(c, script)),
        }
    }

    fn roman_group(&mut self, script: Script) {
        if self.rest.next_if_eq(&'{').is_none() {
            return;
        }
        let before = std::mem::replace(&mut self.upright, true);
        self.group(script);
        self.upright = before;
    }
}

/// Latin and small Greek letters are variables, set in italics.
fn is_variable(c: char) -> bool {
    c.is_ascii_alphabetic() || ('α'..='ω').contains(&c)
}

#[cfg(test)]
#[path = "tests/markup.rs"]
mod tests;
