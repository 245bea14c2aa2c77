"""Panels, buttons and fields that the documents name are those of the add-on, or Blender's own."""

import re

import pytest
from sources import ROOT, spoken

DOCS = ROOT / "docs"
PAGES = [
    "first-chip",
    "relief",
    "engrave",
    "connect-a-pen",
    "pencil-cut",
    "plan-by-feel",
    "planning",
    "sessions",
    "troubleshooting",
]
# What is Blender's own, and what objects are called in a tutorial.
BLENDERS = {
    *(
        "Add-ons",
        "All Transforms",
        "Alignment",
        "Cavity",
        "Circle",
        "Convert",
        "Cube",
        "Dimensions",
        "Displace",
        "Export",
        "Item",
    ),
    *(
        "Horizontal",
        "Measure",
        "Paragraph",
        "Plain Axes",
        "Recalculate Outside",
        "Rings",
        "Segments",
        "Select Box",
        "UV Sphere",
        "Vertical",
    ),
}
OURS = {"Clamp", "Sphere Stock", "Rot Point (mm) is not set"}  # the last is made of an option's name
LONGEST = 60  # of a label; what is longer is a sentence


@pytest.fixture(scope="module")
def addon():
    strategies = (ROOT / "native/python/riffler/plan/strategies").glob("*.py")
    paths = [*(ROOT / "addon").rglob("*.py"), *strategies, ROOT / "addon" / "common" / "presets.json"]
    return (
        "\n".join(spoken(path.read_text()) for path in paths)
        + (ROOT / "native/pen/simulated/simulated_device.hpp").read_text()
    )


def named(page):
    """What a page sets in italics or in bold, without code and pictures' captions; entries of menus one by one."""
    text = re.sub(r"```.*?```|`[^`\n]*`", "", (DOCS / f"{page}.md").read_text(), flags=re.DOTALL)
    for _, words in re.findall(r"(?<!\*)(\*{1,2})(?=[\w+])([^*]+?)\1(?!\*)", text):
        for label in re.split(r" \u203a |\u2026", re.sub(r"\s+", " ", words)):
            if label.strip(" .,:") and len(label) < LONGEST and not label.endswith("?"):
                yield label.strip(" .,:")


@pytest.mark.parametrize("page", PAGES)
def test_a_label_is_in_the_add_on(page, addon):
    unknown = [label for label in named(page) if label not in addon and label not in BLENDERS | OURS]
    assert not unknown, f"docs/{page}.md"


def test_labels_in_a_document_are_found():
    assert {"New Stock", "Carve", "Export STL", "Mirror"} <= set(named("first-chip"))
    assert {"Resolve", "Write NC", "Find Pencil Cuts"} <= set(named("planning"))


def test_a_label_that_the_add_on_lacks_is_reported(addon):
    assert "Gone to Lunch" not in addon
