"""docs/operators.md describes every registered operator."""

import difflib
import importlib
import sys
from pathlib import Path

import bpy

from support import common


def tool():
    """tools/operators.py, which writes the page."""
    folder = str(Path(common.JOB["repo"]) / "tools")
    if folder not in sys.path:
        sys.path.append(folder)
    return importlib.import_module("operators")


def test_the_page_lists_the_registered_operators():
    made, kept = tool().page(), tool().PAGE.read_text()
    lines = difflib.unified_diff(kept.splitlines(), made.splitlines(), "checked in", "registered", n=0, lineterm="")
    assert made == kept, "docs/operators.md is of another add-on: `make operators`\n" + "\n".join(list(lines)[:20])


class RIFFLER_OT_test_forgotten(bpy.types.Operator):
    """In no topic"""

    bl_idname = "riffler.test_forgotten"
    bl_label = "Forgotten"


def test_a_forgotten_operator_is_named():
    operators = tool()
    bpy.utils.register_class(RIFFLER_OT_test_forgotten)
    try:
        operators.page()
    except operators.StepError as failure:
        assert "riffler.test_forgotten" in str(failure)
    else:
        raise AssertionError("no error was raised")
    finally:
        bpy.utils.unregister_class(RIFFLER_OT_test_forgotten)
