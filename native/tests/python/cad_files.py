"""Writes the CAD files of test_cad.py with OpenCASCADE: ``python cad_files.py FOLDER``. It runs in a separate
process, so that the tests' process never imports OpenCASCADE."""

import sys
from pathlib import Path

import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_Copy,
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeVertex,
    BRepBuilderAPI_Transform,
)
from OCP.BRepExtrema import BRepExtrema_DistShapeShape
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepGProp import BRepGProp
from OCP.BRepPrimAPI import (
    BRepPrimAPI_MakeBox,
    BRepPrimAPI_MakeCone,
    BRepPrimAPI_MakeCylinder,
    BRepPrimAPI_MakeSphere,
    BRepPrimAPI_MakeTorus,
)
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Trsf, gp_Vec
from OCP.GProp import GProp_GProps
from OCP.IGESControl import IGESControl_Writer
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType, STEPControl_Writer
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp_Explorer
from OCP.TopLoc import TopLoc_Location
from OCP.TopoDS import TopoDS, TopoDS_Compound, TopoDS_Shell, TopoDS_Solid
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

AS_IS = STEPControl_StepModelType.STEPControl_AsIs


def explored(shape, kind):
    walk, found = TopExp_Explorer(shape, kind), []
    while walk.More():
        found.append(walk.Current())
        walk.Next()
    return found


def faces(shape):
    return explored(shape, TopAbs_ShapeEnum.TopAbs_FACE)


def step(shape, path, unit="MM"):
    writer = STEPControl_Writer()
    Interface_Static.SetCVal_s("write.step.unit", unit)
    writer.Transfer(shape, AS_IS)
    writer.Write(str(path))


def compound(shapes):
    builder, made = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(made)
    for shape in shapes:
        builder.Add(made, shape)
    return made


def shell(shapes):
    builder, made = BRep_Builder(), TopoDS_Shell()
    builder.MakeShell(made)
    for shape in shapes:
        builder.Add(made, shape)
    return made


def broken_solid(shapes):
    builder, made = BRep_Builder(), TopoDS_Solid()
    builder.MakeSolid(made)
    builder.Add(made, shell(shapes))
    return made


def loose(shape):
    """The shape's faces as separate faces, which share no edges."""
    return [BRepBuilderAPI_Copy(face).Shape() for face in faces(shape)]


def rounded_box():
    box = BRepPrimAPI_MakeBox(30, 20, 10).Shape()
    fillet = BRepFilletAPI_MakeFillet(box)
    for edge in explored(box, TopAbs_ShapeEnum.TopAbs_EDGE):
        fillet.Add(2, TopoDS.Edge(edge))
    return fillet.Shape()


def shift(x, y, z):
    made = gp_Trsf()
    made.SetTranslation(gp_Vec(x, y, z))
    return TopLoc_Location(made)


def height(face):
    """Height of the face's centre of area."""
    found = GProp_GProps()
    BRepGProp.SurfaceProperties_s(face, found)
    return found.CentreOfMass().Z()


def named(label, name):
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name, True))


def assembly(path, unit):
    """A plate with two equal pins. The plate's top is red and has a name; the pins are blue."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    plate = BRepPrimAPI_MakeBox(40, 20, 5).Shape()
    pin = BRepPrimAPI_MakeCylinder(3, 12).Shape()
    plate_label, pin_label = shapes.AddShape(plate, False), shapes.AddShape(pin, False)
    named(plate_label, "Plate")
    named(pin_label, "Gehäusestift")
    top = max(faces(plate), key=height)
    top_label = shapes.AddSubShape(plate_label, top)
    named(top_label, "datum A")
    srgb = Quantity_TypeOfColor.Quantity_TOC_sRGB
    colors.SetColor(top_label, Quantity_Color(0.8, 0.2, 0.1, srgb), XCAFDoc_ColorType.XCAFDoc_ColorSurf)
    colors.SetColor(pin_label, Quantity_Color(0.1, 0.2, 0.9, srgb), XCAFDoc_ColorType.XCAFDoc_ColorSurf)
    whole = shapes.NewShape()
    named(whole, "Fixture")
    shapes.AddComponent(whole, plate_label, shift(0, 0, 0))
    shapes.AddComponent(whole, pin_label, shift(10, 10, 5))
    shapes.AddComponent(whole, pin_label, shift(30, 10, 5))
    shapes.UpdateAssemblies()
    Interface_Static.SetCVal_s("write.step.unit", unit)
    writer = STEPCAFControl_Writer()
    Interface_Static.SetIVal_s("write.stepcaf.subshapes.name", 1)
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    writer.Transfer(document, AS_IS)
    writer.Write(str(path))


def milled():
    """A block with a slanted bore, a torus cut across its edge, a corner cut by a ball, and fillets."""
    shape = BRepPrimAPI_MakeBox(40.0, 30.0, 20.0).Shape()
    for tool in (
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(20, 15, -1), gp_Dir(0.1, 0, 1)), 6.0, 40.0),
        BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 20), gp_Dir(0, 0, 1)), 12.0, 4.0),
        BRepPrimAPI_MakeSphere(gp_Pnt(40, 30, 20), 8.0),
    ):
        shape = BRepAlgoAPI_Cut(shape, tool.Shape()).Shape()
    return shape


def distances(shape, size, path):
    """Points around a shape with their distances from its surface by OpenCASCADE's extrema: (n, 4)."""
    surface, rows = compound(faces(shape)), []
    for x, y, z in np.random.default_rng(6).uniform(-0.3, 1.3, (60, 3)) * size:
        vertex = BRepBuilderAPI_MakeVertex(gp_Pnt(x, y, z)).Vertex()
        rows.append([x, y, z, BRepExtrema_DistShapeShape(vertex, surface).Value()])
    np.save(path, np.array(rows))


def main(folder):
    block = milled()
    step(block, folder / "milled.step")
    distances(block, (40, 30, 20), folder / "milled.npy")
    box = BRepPrimAPI_MakeBox(30, 20, 10).Shape()
    step(box, folder / "box.step")
    step(box, folder / "inch.stp", "INCH")
    step(BRepPrimAPI_MakeCylinder(5, 20).Shape(), folder / "cylinder.step")
    plate = BRepPrimAPI_MakeBox(gp_Pnt(-15, -15, -5), gp_Pnt(15, 15, 0)).Shape()
    boss = BRepAlgoAPI_Fuse(plate, BRepPrimAPI_MakeCylinder(8, 9).Shape()).Shape()
    step(boss, folder / "boss.step")
    step(BRepPrimAPI_MakeSphere(7).Shape(), folder / "sphere.step")
    step(BRepPrimAPI_MakeCone(7, 0, 9).Shape(), folder / "cone.step")
    step(BRepPrimAPI_MakeTorus(20, 8).Shape(), folder / "torus.step")
    rounded = rounded_box()
    step(rounded, folder / "rounded.step")
    BRepTools.Write_s(rounded, str(folder / "rounded.brep"))
    writer = IGESControl_Writer("INCH", 0)
    writer.AddShape(rounded)
    writer.ComputeModel()
    writer.Write(str(folder / "rounded.igs"))
    step(shell(faces(box)[:5]), folder / "open_shell.step")
    step(compound(loose(box)), folder / "loose.step")
    step(broken_solid(faces(box)[:5]), folder / "broken.step")
    BRepTools.Write_s(broken_solid(faces(box)[:5]), str(folder / "broken.brep"))
    wire = BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(1, 2, 3)).Edge()
    step(wire, folder / "wire.step")
    tiny = gp_Trsf()
    tiny.SetScale(gp_Pnt(0, 0, 0), 1e-3)
    step(BRepBuilderAPI_Transform(box, tiny, True).Shape(), folder / "tiny.step")
    assembly(folder / "assembly.step", "INCH")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
