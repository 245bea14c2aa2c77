"""The add-on's layers: features in their order, and modules that know no Blender."""

import pytest

from addon_layers import problems, sections

REGISTRATION = """\
SECTIONS = (
    Section("", ("properties",)),
    Section("blender", ("views",)),
    Section("sculpt", ("panel",)),
    Section("plan", ("panel",)),
    Section("", ("toolbar",)),
)
"""
FILES = {
    "registration.py": REGISTRATION,
    "__init__.py": "VERSION = '1'",
    "toolbar.py": "from .sculpt import panel\nfrom .plan import panel as plan",
    "common/units.py": "from .. import VERSION\nimport riffler",
    "translations/__init__.py": "import bpy",
    "blender/views.py": "import bpy\nfrom ..common import units\nfrom ..translations import local",
    "sculpt/panel.py": "from ..blender import views\nfrom .pure import rays\nfrom ..translations import local",
    "sculpt/pure/rays.py": "from ...common import units\nfrom .other import x",
    "sculpt/pure/other.py": "x = 1",
    "sculpt/brushes/carve.py": "from ..pure import rays",
    "plan/panel.py": "from ..sculpt import panel\nfrom ..sculpt.pure.rays import x",
}


@pytest.fixture
def addon(tmp_path):
    def make(**changed):
        for name, text in {**FILES, **changed}.items():
            path = tmp_path / "addon" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return tmp_path

    return make


def test_the_order_is_that_of_registration(addon):
    assert sections(addon() / "addon") == ["sculpt", "plan"]


def test_a_feature_uses_what_is_before_it_only(addon):
    assert problems(addon()) == []


@pytest.mark.parametrize(
    ("file", "text", "said"),
    [
        ("sculpt/panel.py", "from ..plan import panel", "sculpt imports plan.panel"),
        (
            "sculpt/panel.py",
            "def f():\n    from ..plan.panel import x",
            "sculpt/panel.py:2: sculpt imports plan",
        ),
        ("sculpt/panel.py", "from .. import toolbar", "sculpt imports toolbar"),
        ("blender/views.py", "from ..sculpt import panel", "blender imports sculpt.panel"),
        ("common/units.py", "from ..blender import views", "common imports blender.views"),
        ("common/units.py", "import bpy", "a pure module imports bpy"),
        ("sculpt/pure/rays.py", "def f():\n    from mathutils import Vector", "a pure module imports mathutils"),
        ("sculpt/pure/rays.py", "import gpu_extras.batch", "a pure module imports gpu_extras.batch"),
        ("sculpt/pure/rays.py", "from .. import panel", "a pure module imports sculpt.panel, which is not pure"),
        ("sculpt/brushes/carve.py", "from ...blender import views", "a pure module imports blender.views"),
        ("plan/panel.py", "from ..sculpt.gone import x", "addon/plan/panel.py:1: sculpt.gone is not there"),
        ("other/thing.py", "x = 1", "addon/other is not a section"),
    ],
)
def test_imports_that_break_a_layer_are_named(addon, file, text, said):
    found = problems(addon(**{file: text}))
    assert len(found) == 1 and said in found[0], found
