#!/usr/bin/env python3
"""Writes glyphs.txt from Noto Sans: make_glyphs.py REGULAR.ttf ITALIC.ttf BOLD.ttf (needs fonttools)

The present ones are of version 1.04, copyright 2012 Google Inc., under the Apache licence 2.0.

One glyph a line: face (r, i or b) and code point, advance width, and the outline: numbers and behind
them M, L, Q or Z as in a path of SVG, in font units of 1/2048 em, y upward. Code point 0 stands for characters that a face does not have.
"""

import sys
from math import copysign, floor
from pathlib import Path

from fontTools.pens.basePen import BasePen
from fontTools.ttLib import TTFont


class PathPen(BasePen):
    """Collects an outline as text; composite glyphs are taken apart."""

    def __init__(self, glyphs):
        super().__init__(glyphs)
        self.path = ""

    def add(self, command, *points):
        numbers = (int(copysign(floor(abs(n) + 0.5), n)) for point in points for n in point)
        self.path += " ".join(map(str, numbers)) + command

    def _moveTo(self, point):
        self.add("M", point)

    def _lineTo(self, point):
        self.add("L", point)

    def _qCurveToOne(self, control, point):
        self.add("Q", control, point)

    def _closePath(self):
        self.path += "Z"


def face_lines(face, file):
    font = TTFont(file)
    assert font["head"].unitsPerEm == 2048
    glyphs = font.getGlyphSet()
    for code, name in sorted({**font.getBestCmap(), 0: font.getGlyphOrder()[0]}.items()):
        pen = PathPen(glyphs)
        glyphs[name].draw(pen)
        yield f"{face}{code} {glyphs[name].width} {pen.path}\n"


if __name__ == "__main__":
    lines = [line for face, file in zip("rib", sys.argv[1:], strict=True) for line in face_lines(face, file)]
    Path(__file__).with_name("glyphs.txt").write_text("".join(lines))
