"""The content of a file: each part once (prototype), with names and colours of its faces, and every place of each part
(instance). Lengths are in mm, as OpenCASCADE converts them."""

# Type checkers find no types for OCP.
# pyright: reportAttributeAccessIssue=false, reportMissingImports=false
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.collections import Sequence_TCollection_AsciiString, Sequence_TDF_Label
from OCP.gp import gp_Trsf
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color
from OCP.TCollection import TCollection_AsciiString, TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_Tool
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS_Compound, TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ColorTool, XCAFDoc_ColorType, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

# Units that files name, in mm.
UNITS = {
    "millimetre": 1.0, "mm": 1.0, "centimetre": 10.0, "cm": 10.0, "metre": 1000.0, "m": 1000.0,
    "inch": 25.4, "in": 25.4, "foot": 304.8, "ft": 304.8, "mile": 1609344.0, "mi": 1609344.0,
    "kilometre": 1e6, "km": 1e6, "mil": 0.0254,
    "micrometre": 1e-3, "um": 1e-3, "microinch": 2.54e-5, "uin": 2.54e-5, "micron": 1e-3,
}  # fmt: skip
PLAIN = {
    "mm": "mm", "millimetre": "mm", "centimetre": "cm", "metre": "m",
    "inch": "inch", "in": "inch", "foot": "foot", "ft": "foot",
}  # fmt: skip
DEEPEST = 200  # largest depth of assemblies within assemblies
MOST_INSTANCES = 1_000_000
COLORS = (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen)
Color = tuple[float, float, float]


class ContentError(Exception):
    """The file's content cannot be read. The message says what was expected."""


@dataclass
class Prototype:
    """A part in its own coordinates."""

    name: str
    shape: Any
    color: Color | None = None
    parts: list[tuple[Any, str, Color | None]] = field(default_factory=list)
    """Bodies and faces of the part that have a name or a colour: shape, name, colour."""


@dataclass(eq=False)
class Instance:
    """A part in one of its places."""

    prototype: int
    place: Any
    """Map from the part's coordinates to its place, a gp_Trsf."""
    parent: str
    """Names of the assemblies that contain the part, with "/" between them."""
    name: str
    """``parent`` followed by the part's own name."""
    color: Color | None

    @property
    def matrix(self) -> list[list[float]]:
        """(3, 4): maps a point, as a column with a 1 below it, to the placed point."""
        return [[self.place.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]


@dataclass
class Document:
    unit: str = "mm"
    unit_mm: float = 1.0
    schema: str = ""
    prototypes: list[Prototype] = field(default_factory=list)
    instances: list[Instance] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def copies(self, prototype: int) -> int:
        return sum(instance.prototype == prototype for instance in self.instances)


def read_document(path: str, kind: str, progress: Callable[[float], None]) -> Document:
    found = Document()
    {"step": _read_step, "iges": _read_iges, "brep": _read_brep}[kind](path, found, progress)
    _merge_sheets(found)
    if not any(has_faces(p.shape) for p in found.prototypes):
        raise ContentError(
            "it has no faces; expected a solid or surfaces. Wireframes, sketches and drawings have none: export the "
            "solid itself, as AP203, AP214 or AP242"
        )
    keep = [n for n, p in enumerate(found.prototypes) if has_faces(p.shape)]
    number = {old: new for new, old in enumerate(keep)}
    found.prototypes = [found.prototypes[n] for n in keep]
    found.instances = [
        Instance(number[i.prototype], i.place, i.parent, i.name, i.color)
        for i in found.instances
        if i.prototype in number
    ]
    return found


def _merge_sheets(found: Document) -> None:
    """Merges the parts of an assembly that have no solid and occur once into one prototype: surfaces that a file stores
    one by one may enclose a solid together."""
    groups: dict[str, list[Instance]] = {}
    for instance in found.instances:
        shape = found.prototypes[instance.prototype].shape
        once = found.copies(instance.prototype) == 1
        if once and has_faces(shape) and not TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_SOLID).More():
            groups.setdefault(instance.parent, []).append(instance)
    for parent, members in groups.items():
        if len(members) < 2:
            continue
        builder, whole = BRep_Builder(), TopoDS_Compound()
        builder.MakeCompound(whole)
        merged = Prototype(parent.rsplit("/", 1)[-1], whole)
        for member in members:
            old = found.prototypes[member.prototype]
            place = TopLoc_Location(member.place)
            builder.Add(whole, old.shape.Moved(place))
            merged.parts.append((old.shape.Moved(place), old.name, old.color or member.color))
            merged.parts += [(shape.Moved(place), name, color) for shape, name, color in old.parts]
        found.instances = [instance for instance in found.instances if instance not in members]
        found.instances.append(Instance(len(found.prototypes), gp_Trsf(), parent, parent, None))
        found.prototypes.append(merged)


def has_faces(shape: Any) -> bool:
    return not shape.IsNull() and TopExp_Explorer(shape, TopAbs_ShapeEnum.TopAbs_FACE).More()


# --- files ------------------------------------------------------------------------------------------------------------


def _read_step(path: str, found: Document, progress: Callable[[float], None]) -> None:
    from OCP.STEPCAFControl import STEPCAFControl_Reader

    reader = STEPCAFControl_Reader()
    Interface_Static.SetIVal_s("read.stepcaf.subshapes.name", 1)
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    for mode in (reader.SetLayerMode, reader.SetGDTMode, reader.SetMatMode, reader.SetPropsMode, reader.SetViewMode):
        mode(False)
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ContentError(
            "its data section cannot be read; expected ISO 10303-21 with ENDSEC; and END-ISO-10303-21; at the end"
        )
    progress(0.4)
    if reader.NbRootsForTransfer() == 0:
        raise ContentError("it has no product with a shape; expected at least one solid or surface")
    names = [Sequence_TCollection_AsciiString() for _ in range(3)]
    reader.ChangeReader().FileUnits(*names)
    _set_unit(found, sorted({names[0].Value(k).ToCString().strip().lower() for k in range(1, names[0].Length() + 1)}))
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    if not reader.Transfer(document):
        raise ContentError("none of its shapes could be converted")
    progress(0.9)
    _walk(document, found)


def _read_iges(path: str, found: Document, progress: Callable[[float], None]) -> None:
    from OCP.IGESCAFControl import IGESCAFControl_Reader

    reader = IGESCAFControl_Reader()
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ContentError("its entities cannot be read; expected IGES 5.x with the sections S, G, D, P and T")
    progress(0.4)
    section = reader.IGESModel().GlobalSection()
    name = section.UnitName()
    _set_unit(found, [name.ToCString().strip().lower()] if name is not None else [], section.UnitValue())
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    if not reader.Transfer(document):
        raise ContentError("none of its entities could be converted")
    found.schema = "IGES"
    progress(0.9)
    _walk(document, found)


def _read_brep(path: str, found: Document, progress: Callable[[float], None]) -> None:
    shape = TopoDS_Shape()
    with open(path, "rb") as stream:
        start = stream.read(200)
    if b"Open CASCADE" in start and b"\n(" not in start[:100] and start.lstrip()[:4] == b"Open":
        from OCP.BinTools import BinTools

        good = BinTools.Read_s(shape, path)
    else:
        good = BRepTools.Read_s(shape, path, BRep_Builder())
    if not good or shape.IsNull():
        raise ContentError("its shapes cannot be read; expected OpenCASCADE's text or binary BREP")
    found.schema = "BREP"
    found.notes.append("a BREP file states no unit: its lengths are taken as mm")
    found.prototypes.append(Prototype("", shape))
    found.instances.append(Instance(0, gp_Trsf(), "", "", None))
    progress(0.9)


def _set_unit(found: Document, names: list[str], value: float | None = None) -> None:
    """Notes the unit of the file's lengths. OpenCASCADE has converted the lengths already, each from its own unit."""
    if not names and value is None:
        found.notes.append(
            "it states no unit of length: its lengths are taken as mm; unit= of riffler.cad.read sets it"
        )
        return
    if len(names) > 1:
        found.notes.append(f"it has several units of length, each converted to mm: {', '.join(names)}")
    name = names[0] if names else ""
    found.unit = PLAIN.get(name, name)
    found.unit_mm = UNITS.get(name, value or 1.0)
    if name not in UNITS and value is None:
        found.notes.append(f"the unit of length {name!r} is not a usual one; unit= of riffler.cad.read sets another")


# --- the document's labels --------------------------------------------------------------------------------------------


def _walk(document: Any, found: Document) -> None:
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    roots = Sequence_TDF_Label()
    shapes.GetFreeShapes(roots)
    seen: dict[str, int] = {}
    for k in range(1, roots.Length() + 1):
        _place(roots.Value(k), gp_Trsf(), [], None, found, seen, 0)


def _place(
    label: Any, place: Any, path: list[str], color: Color | None, found: Document, seen: dict[str, int], depth: int
) -> None:
    if depth > DEEPEST:
        raise ContentError(f"assemblies within assemblies, more than {DEEPEST} deep; expected no loop")
    if XCAFDoc_ShapeTool.IsReference_s(label):
        target = TDF_Label()
        if not XCAFDoc_ShapeTool.GetReferredShape_s(label, target):
            return
        here = place.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label).Transformation())
        _place(target, here, path, _color(label) or color, found, seen, depth + 1)
        return
    name = _name(label)
    if XCAFDoc_ShapeTool.IsAssembly_s(label):
        components = Sequence_TDF_Label()
        XCAFDoc_ShapeTool.GetComponents_s(label, components, False)
        for k in range(1, components.Length() + 1):
            _place(components.Value(k), place, [*path, name], _color(label) or color, found, seen, depth + 1)
        return
    entry = TCollection_AsciiString()
    TDF_Tool.Entry_s(label, entry)
    key = entry.ToCString()
    if key not in seen:
        seen[key] = len(found.prototypes)
        found.prototypes.append(_prototype(label, name))
    if len(found.instances) >= MOST_INSTANCES:
        raise ContentError(f"more than {MOST_INSTANCES:,} placed parts")
    parent = "/".join(p for p in path if p)
    found.instances.append(Instance(seen[key], place, parent, "/".join(p for p in (parent, name) if p), color))


def _prototype(label: Any, name: str) -> Prototype:
    made = Prototype(name, XCAFDoc_ShapeTool.GetShape_s(label), _color(label))
    inside = Sequence_TDF_Label()
    XCAFDoc_ShapeTool.GetSubShapes_s(label, inside)
    for k in range(1, inside.Length() + 1):
        part = inside.Value(k)
        shape = XCAFDoc_ShapeTool.GetShape_s(part)
        if not shape.IsNull():
            made.parts.append((shape, _name(part), _color(part)))
    return made


def _name(label: Any) -> str:
    if not label.IsAttribute(TDataStd_Name.GetID_s()):  # FindAttribute crashes if there is no such attribute
        return ""
    attribute = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
    return attribute.Get().ToExtString().strip()


def _color(label: Any) -> Color | None:
    """The colour that the file states (sRGB). OpenCASCADE stores colours as linear values."""
    color = Quantity_Color()
    for kind in COLORS:
        if XCAFDoc_ColorTool.GetColor_s(label, kind, color):
            return (_srgb(color.Red()), _srgb(color.Green()), _srgb(color.Blue()))
    return None


def _srgb(x: float) -> float:
    return round(12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055, 6)
