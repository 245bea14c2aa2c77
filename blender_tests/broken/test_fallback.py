"""A native core that does not load: a panel gives the reason and the remedy, and nothing else is registered."""

import sys
import tempfile
from pathlib import Path

import bpy

from support import common


def enable_with(source):
    """Enables the add-on while `import riffler` runs `source`; returns what is registered for it."""
    folder = tempfile.mkdtemp()
    (Path(folder) / "riffler").mkdir()
    (Path(folder) / "riffler" / "__init__.py").write_text(source)
    for name in [n for n in sys.modules if n == "riffler" or n.startswith(("riffler.", "riffler_addon"))]:
        del sys.modules[name]
    sys.path.insert(0, folder)
    try:
        scripts = Path(bpy.utils.user_resource("SCRIPTS", path="addons", create=True))
        if not (scripts / "riffler_addon").exists():
            (scripts / "riffler_addon").symlink_to(Path(common.JOB["repo"]) / "addon", target_is_directory=True)
        common.MODULE = "riffler_addon"
        bpy.ops.preferences.addon_enable(module="riffler_addon")
        assert "riffler_addon" in bpy.context.preferences.addons
        return {n for n in dir(bpy.types) if n.startswith("RIFFLER_")}
    finally:
        sys.path.remove(folder)


def disable():
    bpy.ops.preferences.addon_disable(module="riffler_addon")
    assert not [n for n in dir(bpy.types) if n.startswith("RIFFLER_")]


def check(source, *words):
    assert enable_with(source) == {"RIFFLER_PT_fallback", "RIFFLER_OT_copy_report"}
    assert not hasattr(bpy.types.Scene, "riffler")
    text = common.part("blender.fallback").text()
    for word in (*words, bpy.app.version_string, sys.version.split()[0], "How to fix it"):
        assert word in text, (word, text)
    assert bpy.ops.riffler.copy_report() == {"FINISHED"}
    disable()


def test_a_library_that_is_too_old_is_reported():
    check('raise ImportError("/lib/libc.so.6: version `GLIBC_2.38\' not found")', "GLIBC_2.38", "C library is older")


def test_a_broken_binary_is_reported():
    check("raise OSError('invalid ELF header')", "OSError: invalid ELF header")


def _of_the_system():
    """The text in a Blender of Debian, which uses the system's Python."""
    debian = sys.prefix == "/usr" and Path("/etc/debian_version").exists()
    return ["sudo apt install python3-numpy", "Then restart Blender"] if debian else []


def test_a_missing_numpy_is_reported():
    """The core and most of the add-on need it; the panel does not."""
    kept = {name: sys.modules.pop(name) for name in list(sys.modules) if name.partition(".")[0] == "numpy"}
    sys.modules["numpy"] = None
    try:
        check("import numpy", "ModuleNotFoundError", "numpy is missing", *_of_the_system())
    finally:
        del sys.modules["numpy"]
        sys.modules.update(kept)


def test_another_package_of_that_name_is_reported():
    check("x = 1", "lacks Tool", "Another package named riffler")


def test_a_core_of_another_version_is_reported():
    check(
        "__version__ = '9'",
        "riffler 9 is in use, this add-on is",
        "Restart Blender: it still uses the core from before",
    )


def test_a_missing_package_is_reported():
    check("raise ModuleNotFoundError(\"No module named 'riffler._core'\")", "riffler._core")


def test_the_add_on_works_once_mended_without_a_restart():
    enable_with("raise ImportError('not yet')")
    disable()
    for name in [n for n in sys.modules if n.startswith("riffler_addon")]:
        del sys.modules[name]
    bpy.ops.preferences.addon_enable(module="riffler_addon")
    assert hasattr(bpy.types, "RIFFLER_PT_stock")
    disable()
