"""The panel that stands in for the add-on where the native core does not load."""

import sys
import tempfile
from pathlib import Path

import bpy

from support import common, harness

INSTALL = False


def steps(screen):
    folder = Path(tempfile.mkdtemp())
    (folder / "riffler").mkdir()
    message = "/lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.38' not found (required by riffler/_core.so)"
    (folder / "riffler" / "__init__.py").write_text(f"raise ImportError({message!r})")
    sys.path.insert(0, str(folder))
    if harness.job["mode"] == "legacy":  # that zip has a core in it, which loads
        harness.job["mode"] = "source"
    common.MODULE = harness.install()
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    cut = harness.load(Path(__file__).with_name("window_cut.py"))
    yield from cut.open_tab(screen, "RIFFLER_PT_fallback")
    screen.to_view()
    yield 1.0
    yield from screen.picture("07-fallback")
    with screen.override():
        assert bpy.ops.riffler.copy_report() == {"FINISHED"}
    assert "GLIBC_2.38" in bpy.context.window_manager.clipboard
