"""The picture in docs/device.md is the one that its table gives."""

import subprocess
import sys
from pathlib import Path

DOCS = Path(__file__).parents[3] / "docs"


def test_the_picture_of_the_pens_states_is_drawn_from_the_table(tmp_path):
    subprocess.run([sys.executable, DOCS / "gallery" / "pen_states.py", "--out", tmp_path], check=True, timeout=60)
    assert (tmp_path / "pen-states.svg").read_text() == (DOCS / "images" / "pen-states.svg").read_text(), (
        "run python docs/gallery/pen_states.py"
    )
