"""A single-line font for a pen: every letter is a few strokes, each a chain of cubic Bézier curves.

Cap height is 1, the baseline is y = 0, x runs to the right; a stroke is written in the order and direction in which
a hand draws it. Only the letters that the demonstration writes are here.
"""

from __future__ import annotations

import re

import numpy as np

STEM = "M0 1 C.03 .72 .03 .3 0 0"
TOP_BAR = "M-.1 .96 C.08 1.03 .3 .93 .5 1.01"
MIDDLE_BAR = "M-.02 .52 C.14 .57 .25 .48 .4 .54"
HEEL = "M0 1 C.03 .7 0 .36 .01 .17 C.02 -.02 .12 -.01 .22 .01 C.33 .03 .42 .01 .52 .1"
BOWL = "M-.12 .94 C.06 1.03 .56 1.1 .56 .75 C.56 .5 .26 .47 .04 .5"
LEG = "M.2 .5 C.36 .4 .44 .08 .7 0"
# The last leg runs out into a flourish that comes back below the whole word.
FLOURISH = (
    "M.2 .5 C.36 .4 .44 .1 .68 .02 C.9 -.05 1.0 -.12 .84 -.19 C.5 -.33 -.4 -.14 -1.4 -.16 "
    "C-2.1 -.175 -2.6 -.16 -3 -.175 "
    "C-3.2 -.185 -3.3 -.27 -3.5 -.27 C-3.74 -.27 -3.76 -.1 -3.58 -.1 C-3.46 -.1 -3.44 -.2 -3.54 -.22"
)

#: letter: (advance width, strokes)
LETTERS = {
    "R": (0.66, (STEM, BOWL, LEG)),
    "I": (0.06, (STEM,)),
    "F": (0.46, (STEM, TOP_BAR, MIDDLE_BAR)),
    "L": (0.48, (HEEL,)),
    "E": (0.50, (HEEL, TOP_BAR, MIDDLE_BAR)),
    "R~": (0.66, (STEM, BOWL, FLOURISH)),
}
SPACE = 0.30


def curve(path: str, steps: int = 200) -> np.ndarray:
    """Points (n, 2) along a path of one M and any number of C commands, `steps` to a segment."""
    numbers = [float(word) for word in re.findall(r"-?[\d.]+", path)]
    knots = np.array(numbers).reshape(-1, 2)
    if (len(knots) - 1) % 3 or path.count("C") * 3 + 1 != len(knots):
        raise ValueError(f"path {path!r}: expected M x y and cubic segments C x1 y1 x2 y2 x y")
    t = np.linspace(0.0, 1.0, steps + 1)[:, None]
    rows = [knots[:1]]
    for start in range(0, len(knots) - 1, 3):
        a, b, c, d = knots[start : start + 4]
        rows.append((((1 - t) ** 3) * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d)[1:])
    return np.concatenate(rows)


def write(letters: list[str]) -> list[tuple[str, np.ndarray]]:
    """Strokes (name, points) of a word, centred on x = 0, in writing order."""
    widths = [LETTERS[letter][0] for letter in letters]
    pen = -0.5 * (sum(widths) + SPACE * (len(letters) - 1))
    strokes = []
    for place, (letter, width) in enumerate(zip(letters, widths, strict=True), start=1):
        for part, path in enumerate(LETTERS[letter][1], start=1):
            strokes.append((f"{place}{letter[0]}.{part}", curve(path) + np.array([pen, 0.0])))
        pen += width + SPACE
    return strokes
