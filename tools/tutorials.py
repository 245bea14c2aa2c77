"""Does the tutorials in Blender's window, and puts the pictures that they take into docs/images/tutorials.

tools/tutorials.py [NAME ...]      (all without arguments; NAME as in tutorial_NAME.py; "session": docs/sessions.md,
                                   "cube": docs/first-chip.md)
"""

from __future__ import annotations

import shutil
import sys

from shell import PYTHON, ROOT, StepError, main, run, say

TAKEN = ROOT / "out" / "blender" / "tutorials"
PLACE = ROOT / "docs" / "images" / "tutorials"
ALSO = {"session": "window_pen", "cube": "window_cube"}  # pictures that a test takes on its way


def entry() -> None:
    shutil.rmtree(TAKEN, ignore_errors=True)
    for name in sys.argv[1:] or ["", *ALSO]:
        only = ALSO.get(name, f"tutorial_{name}")
        run(PYTHON, "blender_tests/run.py", "--mode", "source", "--no-headless", "--only", only)
    taken = sorted(TAKEN.glob("*.png"))
    if not taken:
        raise StepError("no picture was taken: is there a Blender with a window here?")
    PLACE.mkdir(parents=True, exist_ok=True)
    for picture in taken:
        shutil.copy(picture, PLACE)
    say(f"{len(taken)} pictures in {PLACE.relative_to(ROOT)}")


if __name__ == "__main__":
    main(entry)
