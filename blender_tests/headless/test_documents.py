"""What the documents call from a script is there: operators, their settings, and what those may be."""

import ast
import re
from pathlib import Path

import bpy

import support

DOCS = Path(support.__file__).resolve().parent.parent / "docs"


def calls():
    """(page, the call's text, operator, settings) of each bpy.ops.riffler.… in the Python examples."""
    for page in sorted(DOCS.glob("*.md")):
        for block in re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL):
            if "bpy.ops.riffler." not in block:
                continue
            for node in ast.walk(ast.parse(block)):
                if isinstance(node, ast.Call) and ast.unparse(node.func).startswith("bpy.ops.riffler."):
                    yield page.name, ast.unparse(node), node.func.attr, node.keywords


def test_operators_of_the_examples_take_what_they_are_given():
    found = list(calls())
    assert len(found) > 12
    for page, text, name, given in found:
        where = f"docs/{page}: {text}"
        assert name in dir(bpy.ops.riffler), where
        fields = getattr(bpy.ops.riffler, name).get_rna_type().properties
        for keyword in given:
            assert keyword.arg in fields, f"{where}: {keyword.arg}"
            field = fields[keyword.arg]
            if field.type == "ENUM" and isinstance(keyword.value, ast.Constant):
                assert keyword.value.value in field.enum_items, f"{where}: {keyword.arg}"


def test_a_call_that_is_not_there_is_found():
    assert "gone_to_lunch" not in dir(bpy.ops.riffler)
