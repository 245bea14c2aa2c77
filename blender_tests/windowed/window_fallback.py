"""The panel that replaces the add-on if the native core does not load: the C library is too old, or there is no
numpy."""

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
    yield from without_numpy(screen, folder / "riffler" / "__init__.py")


def without_numpy(screen, core):
    """Debian's Blender without python3-numpy: the panel names that one package."""
    bpy.ops.preferences.addon_disable(module=common.MODULE)
    core.write_text("import numpy")
    for name in [n for n in sys.modules if n.partition(".")[0] == "riffler"]:
        del sys.modules[name]
    numpy = {name: sys.modules.pop(name) for name in list(sys.modules) if name.partition(".")[0] == "numpy"}
    sys.modules["numpy"] = None
    try:
        bpy.ops.preferences.addon_enable(module=common.MODULE)
        yield 1.0
    finally:
        del sys.modules["numpy"]
        sys.modules.update(numpy)
    with screen.override():
        assert bpy.ops.riffler.copy_report() == {"FINISHED"}
    report = bpy.context.window_manager.clipboard
    assert "No module named 'numpy'" in report or "numpy" in report.splitlines()[1], report
    remedy = report.partition("How to fix it:\n")[2]
    own = sys.prefix not in ("/usr", "/usr/local")
    words = ["Blender from blender.org"] if own else ["sudo apt install python3-numpy\n", "restart Blender"]
    assert all(word in remedy for word in words), remedy
    assert own or ("blender.org" not in remedy and "zip" not in remedy), remedy
    yield from screen.shot("08-without-numpy")
