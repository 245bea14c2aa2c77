"""3MF files: units, items, components, transforms, damaged files; the tests put their files together themselves."""

import locale
import sys
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import riffler
from hypothesis import given, settings
from hypothesis import strategies as st
from riffler import cli
from riffler_bench import parts, scenes

TYPES = """<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>"""
RELATIONS = """<?xml version="1.0"?><Relationships
xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="r0"
Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"""


def model(resources: str, build: str, unit: str = 'unit="millimeter"') -> bytes:
    head = f'<?xml version="1.0"?><model {unit} xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">'
    return f"{head}<resources>{resources}</resources><build>{build}</build></model>".encode()


def box_object(number: int, size=(1, 2, 3), kind: str = "model") -> str:
    box = scenes.box_mesh([0, 0, 0], size)
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in box.vertices)
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in box.triangles)
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    return f'<object id="{number}" type="{kind}">{mesh}</object>'


def package(path: Path, content: bytes) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in (("[Content_Types].xml", TYPES), ("_rels/.rels", RELATIONS), ("3D/3dmodel.model", content)):
            archive.writestr(zipfile.ZipInfo(name), data)
    return path


def read(folder: Path, resources: str, build: str, **more: str) -> riffler.Mesh:
    return riffler.Mesh.read(package(folder / "part.3mf", model(resources, build, **more)))


def test_a_mesh_reads_back_in_mm(tmp_path):
    part = parts.organic(2_000)
    part.write(tmp_path / "part.3MF")
    back = riffler.Mesh.read(tmp_path / "part.3MF")
    assert np.array_equal(back.vertices, np.asarray(part.vertices).astype(np.float32))
    assert np.array_equal(back.triangles, part.triangles)
    with zipfile.ZipFile(tmp_path / "part.3MF") as archive:
        text = archive.read("3D/3dmodel.model").decode()
    assert 'unit="millimeter"' in text
    part.write(tmp_path / "again.3mf")
    assert (tmp_path / "part.3MF").read_bytes() == (tmp_path / "again.3mf").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["again.3mf", "part.3MF"]


@pytest.mark.parametrize(
    ("unit", "mm"),
    [("micron", 0.001), ("millimeter", 1), ("centimeter", 10), ("inch", 25.4), ("foot", 304.8), ("meter", 1000)],
)
def test_units_become_mm(tmp_path, unit, mm):
    mesh = read(tmp_path, box_object(1), '<item objectid="1"/>', unit=f'unit="{unit}"')
    np.testing.assert_allclose(mesh.bounds, [[0, 0, 0], [mm, 2 * mm, 3 * mm]], rtol=1e-12)


def test_a_file_without_a_unit_is_in_mm(tmp_path):
    assert read(tmp_path, box_object(1), '<item objectid="1"/>', unit="").volume == pytest.approx(6)


def test_transforms_of_items_and_components_are_applied(tmp_path):
    # A quarter turn about z and a shift; 3MF multiplies rows, the shift stands last.
    turn, shift, mirror = "0 1 0 -1 0 0 0 0 1 10 20 30", "1 0 0 0 1 0 0 0 1 5 0 0", "-1 0 0 0 1 0 0 0 1 0 0 0"
    resources = box_object(1) + box_object(2, (1, 1, 1))
    resources += (
        f'<object id="3"><components><component objectid="1" transform="{shift}"/>'
        f'<component objectid="2" transform="{mirror}"/></components></object>'
    )
    mesh = read(tmp_path, resources, f'<item objectid="3" transform="{turn}"/>')
    audit = mesh.audit()
    # The shifted box first moves to x = 5 … 6, then its x becomes y and its y becomes −x.
    np.testing.assert_allclose(mesh.bounds, [[8, 19, 30], [10, 26, 33]], atol=1e-9)
    assert mesh.volume == pytest.approx(6 + 1) and audit.open_edges == 0
    assert audit.components == 2
    both = read(tmp_path, box_object(1), f'<item objectid="1"/><item objectid="1" transform="{shift}"/>')
    assert len(both.triangles) == 24 and both.bounds[1][0] == 6
    touching = read(tmp_path, box_object(1), '<item objectid="1"/><item objectid="1"/>')
    assert len(touching.vertices) == 8, "equal vertices are one"


def test_support_is_left_out(tmp_path):
    resources = box_object(1) + box_object(2, (9, 9, 9), "support")
    mesh = read(tmp_path, resources, '<item objectid="1"/>')
    assert mesh.volume == pytest.approx(6)
    with pytest.raises(riffler.FormatError, match=r"part\.3mf: zero triangles; expected a build item with a mesh"):
        read(tmp_path, box_object(1), "")


def test_errors_of_bad_files_name_what_was_expected(tmp_path):
    for content in (b"", b"PK", b"solid part\n" * 20, b"\x00" * 5000):
        (tmp_path / "bad.3mf").write_bytes(content)
        with pytest.raises(riffler.FormatError, match=r"bad\.3mf: expected a 3MF package with a model"):
            riffler.Mesh.read(tmp_path / "bad.3mf")
    with pytest.raises(riffler.FormatError, match=r"none\.3mf"):
        riffler.Mesh.read(tmp_path / "none.3mf")
    for wrong in ("99", "-1", "x", ""):
        with pytest.raises(riffler.FormatError, match=r"part\.3mf"):
            read(tmp_path, box_object(1).replace('v1="0"', f'v1="{wrong}"', 1), '<item objectid="1"/>')
    for wrong in ("nan", "inf", "1e39", ""):
        with pytest.raises(riffler.FormatError, match=r"part\.3mf"):
            read(tmp_path, box_object(1).replace('x="1.0"', f'x="{wrong}"', 1), '<item objectid="1"/>')
    for wrong in (box_object(1).replace("<triangle ", "<trixngle ", 1), box_object(1) + "<object>"):
        with pytest.raises(riffler.FormatError, match=r"part\.3mf"):
            read(tmp_path, wrong, '<item objectid="1"/>')
    with pytest.raises(riffler.FormatError, match=r"part\.3mf: Invalid Model Unit"):
        read(tmp_path, box_object(1), '<item objectid="1"/>', unit='unit="furlong"')
    own = 'unit="inch" xmlns:s="http://slicer.example/2017" s:version="1"'
    assert read(tmp_path, box_object(1), '<item objectid="1"/>', unit=own).volume == pytest.approx(6 * 25.4**3)


def test_an_empty_mesh_and_a_missing_folder_are_refused(tmp_path):
    riffler.Mesh([], []).write(tmp_path / "empty.3mf")
    with pytest.raises(riffler.FormatError, match=r"empty\.3mf: zero triangles"):
        riffler.Mesh.read(tmp_path / "empty.3mf")
    with pytest.raises(RuntimeError, match=r"part\.3mf: cannot be written"):
        parts.organic(200).write(tmp_path / "nowhere" / "part.3mf")


@settings(max_examples=300, deadline=None, derandomize=True)
@given(st.data())
def test_damaged_3mf_is_a_format_error_or_a_valid_mesh(tmp_path_factory, data):
    folder = tmp_path_factory.getbasetemp()
    whole = model(box_object(1) + box_object(2), '<item objectid="1"/><item objectid="2"/>')
    in_archive = data.draw(st.booleans())
    content = bytearray(package(folder / "good.3mf", whole).read_bytes() if in_archive else whole)
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    content = content[: data.draw(st.sampled_from([len(content), len(content) - 1, len(content) // 2, 10]))]
    path = folder / "bad.3mf"
    if in_archive:
        path.write_bytes(content)
    else:
        package(path, bytes(content))
    try:
        mesh = riffler.Mesh.read(path)
    except riffler.FormatError as error:
        assert "bad.3mf" in str(error)
    else:
        # An element whose name was damaged belongs to another namespace.
        assert 0 < len(mesh.triangles) <= 24 and np.isfinite(mesh.vertices).all()
        assert mesh.triangles.max() < len(mesh.vertices)


def test_the_process_keeps_its_locale(tmp_path):
    found = locale.setlocale(locale.LC_ALL)
    try:
        locale.setlocale(locale.LC_CTYPE, "C.UTF-8")
        before = locale.setlocale(locale.LC_ALL)
        scenes.box_mesh([0, 0, 0], [4, 5, 6]).write(tmp_path / "box.3mf")
        riffler.Mesh.read(tmp_path / "box.3mf")
        assert locale.setlocale(locale.LC_ALL) == before != "C"
        # Threads that are in it at once leave it as the first one met it.
        box = scenes.box_mesh([0, 0, 0], [4, 5, 6])
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda k: box.write(tmp_path / f"box{k % 4}.3mf"), range(60)))
        assert locale.setlocale(locale.LC_ALL) == before
    finally:
        locale.setlocale(locale.LC_ALL, found)


def test_the_error_without_lib3mf_asks_for_the_package(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "lib3mf", None)
    parts.organic(200).write(tmp_path / "x.3mf")  # writing needs no package
    with pytest.raises(ValueError, match=r"pip install riffler\[3mf\]"):
        riffler.Mesh.read(tmp_path / "x.3mf")


def test_the_command_line_takes_3mf(tmp_path, capsys):
    scenes.box_mesh([0, 0, 0], [4, 5, 6]).write(tmp_path / "box.3mf")
    assert cli.main(["mesh", "audit", str(tmp_path / "box.3mf")]) == 0
    volume, out = str(tmp_path / "box.rvol"), str(tmp_path / "out.3mf")
    assert cli.main(["volume", "from-mesh", str(tmp_path / "box.3mf"), "--pitch", "0.5", "--out", volume]) == 0
    assert cli.main(["volume", "to-mesh", volume, "--out", out]) == 0
    assert riffler.Mesh.read(out).volume == pytest.approx(120, rel=1e-3)


def levels(count: int, copies: int) -> str:
    """Components of components: copies to the power of count of one box."""
    objects = [box_object(1)]
    for k in range(1, count + 1):
        parts = f'<component objectid="{k}"/>' * copies
        objects.append(f'<object id="{k + 1}"><components>{parts}</components></object>')
    return "".join(objects)


@pytest.mark.parametrize(
    ("resources", "build", "what"),
    [
        (levels(40, 2), '<item objectid="41"/>', "meshes and components"),
        (levels(1, 300_000), '<item objectid="2"/>', "meshes and components"),
        (box_object(1), '<item objectid="1"/>' * 150_000, "meshes and components"),
    ],
    ids=["levels", "components", "items"],
)
def test_endless_copies_are_refused_before_they_are_made(tmp_path, resources, build, what):
    """Files of 1 to 15 kB, packed, that took all time and memory there was."""
    with pytest.raises(riffler.FormatError, match=what):
        read(tmp_path, resources, build)


def test_copies_within_bounds_are_made(tmp_path):
    assert len(read(tmp_path, levels(1, 1000), '<item objectid="2"/>').triangles) == 12_000
