"""The scripts under docs/gallery run: coarsely, without the pictures."""

import subprocess
import sys
from pathlib import Path

import pytest

GALLERY = Path(__file__).parents[3] / "docs" / "gallery"
SCRIPTS = ["mouse", "mouse_fixtures", "by_feel", "sole", "verify_map", "pen_frames", "pen_counts"]
SCRIPTS += ["concepts", "figure", "relief", "linocut", "characters"]


@pytest.mark.parametrize("script", SCRIPTS)
def test_a_gallery_script_plans_what_it_shows(script):
    command = [sys.executable, GALLERY / f"{script}.py", "--fast"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "mm" in done.stdout
