"""Draws the states of a pen's firmware from the table in docs/device.md, which a test compares with the code.

python docs/gallery/pen_states.py [--out FOLDER]
"""

from __future__ import annotations

import argparse
from pathlib import Path

DOCS = Path(__file__).resolve().parents[1]
WIDTH, HEIGHT = 760, 330
BOX = (104, 44)
# Middle of each state, its fill and what it says below its name.
STATES = {
    "boot": (90, 90, "#e8eaed", "motors off"),
    "idle": (270, 90, "#e8eaed", "motors free"),
    "ramp": (450, 90, "#fde7c3", "force grows"),
    "active": (650, 90, "#d5ead2", "force"),
    "fault": (370, 270, "#f6d0cc", "no force, brake"),
}
# Where an arrow leaves and arrives, as offsets from the middles, and where its word stands.
ROUTES = {
    ("boot", "idle"): ((52, 0), (-52, 0), (180, 82)),
    ("idle", "ramp"): ((52, 0), (-52, 0), (360, 82)),
    ("ramp", "active"): ((52, 0), (-52, 0), (550, 82)),
    ("fault", "idle"): ((-30, -22), (20, 22), (272, 190)),
}
ARCS = {  # over the top: height of the arc's control point
    ("ramp", "idle"): (18, (0, -22), (20, -22), (372, 61)),
    ("active", "idle"): (-30, (0, -22), (-20, -22), (560, 22)),
}


def transitions(text: str) -> list[tuple[str, str, str]]:
    """Rows (from, to, on) of the table of states."""
    section = text.split("\n## States\n", 1)[1].split("\n## ", 1)[0]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in section.splitlines() if line[:1] == "|"]
    return [(row[0], row[1], row[2]) for row in rows[2:]]


def arrow(path: str) -> str:
    return f'<path d="{path}" fill="none" stroke="#444" stroke-width="1.6" marker-end="url(#head)"/>'


def word(x: float, y: float, text: str, *, size: int = 13, weight: str = "normal", fill: str = "#222") -> str:
    style = f'font-size="{size}" font-weight="{weight}" fill="{fill}" text-anchor="middle"'
    return f'<text x="{x}" y="{y}" {style}>{text}</text>'


def drawing(rows: list[tuple[str, str, str]]) -> str:
    parts = []
    for start, end, event in rows:
        if start == "any":
            continue
        (x0, y0), (x1, y1) = STATES[start][:2], STATES[end][:2]
        if (start, end) in ARCS:
            top, (dx0, dy0), (dx1, dy1), (tx, ty) = ARCS[start, end]
            middle = (x0 + x1) / 2
            parts.append(arrow(f"M{x0 + dx0} {y0 + dy0}Q{middle} {top} {x1 + dx1} {y1 + dy1}"))
        else:
            (dx0, dy0), (dx1, dy1), (tx, ty) = ROUTES[start, end]
            parts.append(arrow(f"M{x0 + dx0} {y0 + dy0}L{x1 + dx1} {y1 + dy1}"))
        parts.append(word(tx, ty, event, fill="#444"))
    for start, end, event in rows:
        if start != "any":
            continue
        # From a line under all states that a fault may leave.
        x, y = STATES[end][:2]
        parts.append('<path d="M38 136H702" stroke="#b3433a" stroke-width="1.6" stroke-dasharray="6 4"/>')
        parts.append(arrow(f"M{x + 20} 136L{x + 20} {y - BOX[1] // 2}").replace("#444", "#b3433a"))
        parts.append(word(x + 80, 190, f"{event}, from any", fill="#b3433a"))
    for name, (x, y, fill, below) in STATES.items():
        w, h = BOX
        parts.append(
            f'<rect x="{x - w // 2}" y="{y - h // 2}" width="{w}" height="{h}" rx="9" fill="{fill}" stroke="#444"/>'
        )
        parts.append(word(x, y - 2, name, size=15, weight="bold"))
        parts.append(word(x, y + 14, below, size=11, fill="#555"))
    head = '<marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
    head += '<path d="M0 0L8 4L0 8z" fill="#444"/></marker>'
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif">',
            f"<defs>{head}</defs>",
            f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
            *parts,
            "</svg>\n",
        ]
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=DOCS / "images", help="folder of the picture")
    picture = parser.parse_args().out / "pen-states.svg"
    picture.write_text(drawing(transitions((DOCS / "device.md").read_text())))
    print(picture)


if __name__ == "__main__":
    main()
