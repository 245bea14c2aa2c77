"""Does the tutorials in Blender's window, and puts the pictures that they take into docs/images/tutorials.

tools/tutorials.py [--suite sid] [NAME ...]      (all without NAME, which is as in tutorial_NAME.py; "session":
                                                 docs/sessions.md, "trace": docs/cad.md, "cube":
                                                 docs/first-chip.md; --suite: in the Blender
                                                 of a chroot of tools/blenders.py, for pictures of the newest)
"""

from __future__ import annotations

import argparse
import shutil

from shell import PYTHON, ROOT, StepError, main, run, say

PLACE = ROOT / "docs" / "images" / "tutorials"
ALSO = {
    "session": "window_pen",
    "trace": "window_trace",
    "cube": "window_cube",
}  # pictures that a test takes as it runs


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--suite")
    given = parser.parse_args()
    out = ROOT / "out" / "blender"
    program, taken = ["blender_tests/run.py", "--mode", "source"], out / "tutorials"
    if given.suite:
        program, taken = ["tools/blenders.py", given.suite], out / given.suite / "tutorials"
    PLACE.mkdir(parents=True, exist_ok=True)
    count = 0
    for name in given.names or ["", *ALSO]:
        shutil.rmtree(taken, ignore_errors=True)
        run(PYTHON, *program, "--no-headless", "--smooth", "--only", ALSO.get(name, f"tutorial_{name}"))
        for picture in sorted(taken.glob("*.png")):
            shutil.copy(picture, PLACE)
            count += 1
    if not count:
        raise StepError("no picture was taken: is there a Blender with a window here?")
    say(f"{count} pictures in {PLACE.relative_to(ROOT)}")


if __name__ == "__main__":
    main(entry)
