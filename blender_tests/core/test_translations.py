"""Every fixed text of the add-on has its German: labels, tooltips, menu and enum entries, texts of panels, and reasons
for refusals. Found in the sources, so that the table cannot fall behind them."""

import ast
import json
import re
from pathlib import Path

import riffler

import addon
from addon.common import hand_tools
from addon.plan.pure import machine_fields

ADDON = Path(addon.__file__).parent
TABLE = json.loads((ADDON / "translations" / "de.json").read_text(encoding="utf-8"))
# Functions of ours that make a field or a line of a panel: the arguments that are shown.
FIELDS_OF = {"length": (0, 2), "angle": (0, 2), "_folder": (1, 2)}
MESSAGES = {"wrapped": (1,), "deny": (1,), "poll_message_set": (0,), "local": (0,), "ValueError": (0,), "report": (1,)}
SHOWN = {**FIELDS_OF, **MESSAGES}
NOT_SHOWN = {
    "package.py",  # makes the zips
    "blender/fallback.py",  # texts for a core that does not load, when there is no table either
}
FIELDS = {"name", "description"}
TABLES = {"STATES", "KINDS", "LOOK"}  # names of tables of texts
DRAWN = {"text", "heading"}
OF_BRUSH = ("label", "description", "tip")  # fields of a brush
SAID_BY = {"all_for", "description", "unfit", "missing", "refusal"}  # functions that return a shown text
ENTRY = re.compile(r"[A-Z][A-Z0-9_]*")  # identifier of an enum entry


def sources():
    for path in sorted(ADDON.rglob("*.py")):
        name = path.relative_to(ADDON).as_posix()
        if "_vendor" not in path.parts and name not in NOT_SHOWN:
            yield name, ast.parse(path.read_text(encoding="utf-8"))


def is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def texts(node, names=None):
    """The fixed texts that an expression may be. `names`: values of the source's variables."""
    if is_text(node):
        yield node.lineno, node.value
    elif isinstance(node, ast.IfExp):
        yield from texts(node.body, names)
        yield from texts(node.orelse, names)
    elif isinstance(node, ast.BoolOp):
        for value in node.values:
            yield from texts(value, names)
    elif isinstance(node, ast.Name):
        for value in (names or {}).get(node.id, ()):
            yield from texts(value)


def variables(tree):
    """{name: expressions assigned to it}"""
    names = {}
    for node in ast.walk(tree):
        for target in node.targets if isinstance(node, ast.Assign) else ():
            pairs = [(target, node.value)]
            if isinstance(target, ast.Tuple):
                values = [node.value.body, node.value.orelse] if isinstance(node.value, ast.IfExp) else [node.value]
                pairs = [p for v in values if isinstance(v, ast.Tuple) for p in zip(target.elts, v.elts, strict=False)]
            for name, value in pairs:
                if isinstance(name, ast.Name):
                    names.setdefault(name.id, []).append(value)
    return names


def name_of(call):
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def assigned(node):
    """(name, expression) of an assignment, and of each element of a tuple assignment."""
    for target in node.targets if isinstance(node, ast.Assign) else ():
        several = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
        pairs = zip(target.elts, node.value.elts, strict=True) if several else [(target, node.value)]
        yield from ((name.id, value) for name, value in pairs if isinstance(name, ast.Name))


def of_class(cls):
    own = {name: value for node in cls.body for name, value in assigned(node)}
    for key in ("bl_label", "bl_description", "doing", "cancelled", *(OF_BRUSH if "label" in own else ())):
        if key in own:
            yield from texts(own[key])
    is_operator = any(getattr(base, "attr", "") == "Operator" for base in cls.bases)
    if is_operator and "bl_description" not in own and ast.get_docstring(cls):
        yield cls.lineno, " ".join(ast.get_docstring(cls).split())


def of_call(call, names):
    name = name_of(call)
    places = SHOWN.get(name, ())
    if name == "lines":
        places = range(1, len(call.args))
    for k in places:
        if k < len(call.args):
            yield from texts(call.args[k], names)
    for keyword in call.keywords:
        of_field = keyword.arg in FIELDS and (name.endswith("Property") or name in FIELDS_OF)
        if of_field or (keyword.arg in DRAWN and isinstance(call.func, ast.Attribute)):
            yield from texts(keyword.value, names)


def of_entry(row):
    """(identifier, label, tooltip, …)"""
    if len(row.elts) < 3 or not all(map(is_text, row.elts[:3])):
        return
    key, *said = (node.value for node in row.elts[:3])
    if ENTRY.fullmatch(key) and not all(map(ENTRY.fullmatch, said)):
        yield from ((row.lineno, text) for text in said)


def of_table(node):
    """The texts of a table that begin with a capital."""
    if any(getattr(target, "id", "") in TABLES for target in node.targets):
        for inner in ast.walk(node.value):
            if is_text(inner) and re.match("[A-Z][a-z]", inner.value):
                yield inner.lineno, inner.value


def of_machines():
    """(where, text) of the fields that are made from the core's description of each machine."""
    for machine in riffler.machines():
        for fact in riffler.machine_options(machine):
            where = f"riffler.machine_options({machine!r}), {fact.name}"
            yield from ((where, text) for text in (machine_fields.label(fact), machine_fields.about(fact)))


def of_shapes():
    """(where, text) of the cutters' names and of the fields that are made from the core's table of shapes."""
    for shape in riffler.Tool.shapes():
        for of in (shape, *shape.sizes):
            where = f"riffler.Tool.shapes(), {shape.name}, {of.name}"
            yield from ((where, text) for text in (of.label, of.description))


def of_hand_tools():
    """(where, text) of the kinds of hand tools, their fields and their presets."""
    for of in (*hand_tools.KINDS.values(), *hand_tools.ALL.values()):
        yield from ((f"addon/common/hand_tools.py, {of.label}", text) for text in (of.label, of.description))
    yield from (("addon/common/hand_tools.json", tool["name"]) for tool in hand_tools.presets())


def of_strategies():
    """(where, text) of the strategies and of the fields that are made from their parameters."""
    for strategy in riffler.plan.STRATEGIES.values():
        where = f"riffler.plan.STRATEGIES, {strategy.id}"
        said = [strategy.label, strategy.action, strategy.description, strategy.missing]
        for p in strategy.parameters:
            said += [p.label, p.help, *(text for _, *both in p.choices for text in both)]
        yield from ((where, text) for text in said if text)


def shown(tree):
    """(line, text) of all texts that a source shows."""
    names = variables(tree)
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            yield from of_table(node)
        if isinstance(node, ast.ClassDef):
            yield from of_class(node)
        elif isinstance(node, ast.Call):
            yield from of_call(node, names)
        elif isinstance(node, ast.Tuple):
            yield from of_entry(node)
        elif isinstance(node, ast.FunctionDef) and node.name in SAID_BY:
            for inner in ast.walk(node):
                if isinstance(inner, ast.Return) and inner.value is not None:
                    yield from texts(inner.value)


def of_descriptions():
    for name, text in riffler.machines().items():
        yield f"riffler.machines()[{name!r}]", text


def found():
    """{text: its place}"""
    said = {}
    for where, text in (*of_shapes(), *of_hand_tools(), *of_strategies()):
        said.setdefault(text, where)
    for path, tree in sources():
        for line, text in shown(tree):
            if re.search(r"[A-Za-z]{2}", text):
                said.setdefault(text, f"addon/{path}:{line}")
    return said


def test_every_kind_of_fixed_text_is_found():
    example = """
class RIFFLER_OT_a(Mixin, bpy.types.Operator):
    '''The tooltip
    in two lines'''
    bl_label = "Label"
    size: length("Size", 0.0, "Its size")
    axis: EnumProperty(name="Axis", items=[("X", "Along x", "The first")], description="Which")

    def draw(self, context):
        lines(self.layout, "One", "Two" if context else "Three", f"{context} four")
        self.layout.operator("riffler.b", text="Five", icon="NONE")
        self.report({"INFO"}, "Six")
        deny(self, "Seven")
        said, icon = ("Eight", "NONE") if context else ("Nine", "NONE")
        self.layout.label(text=said, icon=icon)
        raise ValueError("Ten")

class Carve(Brush):
    id, label, tip = "carve", "Eleven", "Twelve"

    def refusal(self, volume):
        return "Thirteen"
"""
    said = {text for _, text in shown(ast.parse(example))}
    words = {
        "The tooltip in two lines",
        "Label",
        "Size",
        "Its size",
        "Axis",
        "Along x",
        "The first",
        "Which",
        "One",
        "Two",
    }
    assert said == words | {"Three", "Five", "Six", "Seven", "Eight", "Nine", "Ten", "Eleven", "Twelve", "Thirteen"}


def test_every_fixed_text_has_its_german():
    said = found()
    assert len(said) > 500
    without = [f"{where}: {text!r}" for text, where in said.items() if text not in TABLE]
    assert not without, "addon/translations/de.json lacks\n" + "\n".join(without)


def test_every_text_of_a_machine_has_its_german_in_the_machines_file_or_the_table():
    both = {**TABLE, **machine_fields.translations()["de"]}
    said = [*of_descriptions(), *of_machines()]
    assert len(said) > 100
    without = [f"{where}: {text!r}" for where, text in said if text not in both]
    assert not without, "[translations.de] of the machine's file lacks\n" + "\n".join(without)
    assert machine_fields.translations()["de"]["Pivot Length (mm)"] == "Pivotlänge (mm)"


def test_a_user_s_machine_brings_its_own_german(tmp_path, monkeypatch):
    monkeypatch.setenv("RIFFLER_MACHINES", str(tmp_path))
    (tmp_path / "broken.toml").write_text("description = 3")
    (tmp_path / "mill.toml").write_text(
        'description = "my mill"\n[options]\nrise = { value = 5, about = "height of the vice" }\n'
        '[translations.de]\ndescription = "Meine Fräse"\nrise = { name = "Höhe", about = "höhe des Schraubstocks" }\n'
    )
    table = machine_fields.translations()["de"]
    assert table["my mill"] == "Meine Fräse"
    assert (table["Rise (mm)"], table["Height of the vice"]) == ("Höhe (mm)", "Höhe des Schraubstocks")


def test_the_table_is_sorted_and_ends_sentences_as_the_original():
    assert list(TABLE) == sorted(TABLE)
    odd = [text for text, german in TABLE.items() if text.endswith(".") != german.endswith(".") or not german.strip()]
    assert not odd, odd
