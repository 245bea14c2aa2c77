"""3MF export, colours of distances, chained tasks."""

import zipfile
import zlib

import numpy as np
import pytest
import riffler
from riffler import threemf_writer

from addon.common import colours
from addon.common.job import ChainJob, run_through


def write(*mesh):
    for _ in threemf_writer.pieces(*mesh):
        pass


def part():
    volume = riffler.Volume.block((0, 0, 0), (20, 15, 10), 0.5, "xyz")
    volume.carve(riffler.Tool.ball(6, 30), [(5, 5, 8, 0, 0, 1), (15, 10, 8, 0, 0, 1)])
    return volume.to_mesh()


def test_a_written_mesh_reads_back_to_the_bit(tmp_path):
    pytest.importorskip("lib3mf", reason="lib3mf is not installed here")
    mesh = part()
    path = tmp_path / "größe & more.3mf"
    write(path, mesh.vertices, mesh.triangles, 'a <"part"> & more')
    again = riffler.Mesh.read(path)
    assert np.array_equal(np.asarray(again.vertices, np.float32), np.asarray(mesh.vertices, np.float32))
    assert np.array_equal(again.triangles, mesh.triangles)


def test_the_zip_is_made_at_the_quick_level(tmp_path):
    mesh, path = part(), tmp_path / "a.3mf"
    write(path, mesh.vertices, mesh.triangles)
    with zipfile.ZipFile(path) as archive:
        model, size = archive.read("3D/3dmodel.model"), archive.getinfo("3D/3dmodel.model").compress_size
    sizes = {level: len(zlib.compress(model, level, -zlib.MAX_WBITS)) for level in (1, 6)}
    assert sizes[6] < 0.95 * sizes[1] and abs(size - sizes[1]) < 0.01 * sizes[1], (size, sizes)


def test_the_file_follows_the_specification(tmp_path):
    from xml.etree import ElementTree

    mesh = part()
    path = tmp_path / "a.3mf"
    write(path, mesh.vertices, mesh.triangles, "a < b & c")
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
        assert archive.namelist() == ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"]
        model = ElementTree.fromstring(archive.read("3D/3dmodel.model"))
    core = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
    assert model.tag == core + "model" and model.get("unit") == "millimeter"
    (ob,) = model.iter(core + "object")
    assert ob.get("name") == "a < b & c"
    vertices = np.array([[float(v.get(k)) for k in "xyz"] for v in model.iter(core + "vertex")], np.float32)
    triangles = np.array([[int(t.get(k)) for k in ("v1", "v2", "v3")] for t in model.iter(core + "triangle")])
    assert np.array_equal(vertices, np.asarray(mesh.vertices, np.float32))
    assert np.array_equal(triangles, mesh.triangles)
    first = path.read_bytes()
    write(path, mesh.vertices, mesh.triangles, "a < b & c")
    assert path.read_bytes() == first


def test_a_failed_write_leaves_the_old_file(tmp_path):
    path = tmp_path / "a.3mf"
    path.write_text("before")
    mesh = part()
    with pytest.raises(ValueError, match="no triangles"):
        write(path, mesh.vertices, mesh.triangles[:0])
    with pytest.raises(ValueError, match="not finite"):
        write(path, np.asarray(mesh.vertices) * np.nan, mesh.triangles)
    assert path.read_text() == "before" and len(list(tmp_path.iterdir())) == 1
    with pytest.raises((OSError, RuntimeError)):
        write(tmp_path / "none" / "a.3mf", mesh.vertices, mesh.triangles)


def test_colours_distinguish_too_much_too_little_and_neither():
    c = colours.of_distance([0.0, 0.1, 1.0, -0.1, -5, np.nan], 0.1)
    assert c.dtype == np.float32 and np.allclose(c[0], 1) and np.allclose(c[:, 3], 1)
    assert np.array_equal(c[1], c[2]) and np.array_equal(c[3], c[4])
    assert c[1, 2] > c[1, 0] and c[3, 0] > c[3, 2] and np.allclose(c[5, :3], 0.5)
    bar = colours.legend(0.2)
    assert bar[0][0] == 0 and bar[-1][0] == 1 and np.allclose(bar[8][1], 1)
    assert bar[0][1][0] > bar[0][1][2]


def test_tasks_in_a_row_pass_on_their_results():
    volume = riffler.Volume.block((0, 0, 0), (20, 15, 10), 0.5, "xyz")
    shares = []
    job = ChainJob(
        lambda _: riffler.submit(volume.to_mesh),
        lambda mesh: riffler.submit(mesh.smooth),
        lambda mesh: riffler.submit(mesh.decimate, tolerance=0.01),
    )
    run_through(job, shares.append)
    assert len(job.result.triangles) == 12 and job.fraction == 1
    assert shares == sorted(shares) and all(0 <= s <= 1 for s in shares)

    endless = 2_000_000_000
    job = ChainJob(
        lambda _: riffler.submit(volume.to_mesh), lambda mesh: riffler.submit(mesh.smooth, iterations=endless)
    )
    while not job._done:
        job.step(0.01)
    job.step(0.01)
    job.cancel()
    with pytest.raises(riffler.Cancelled):
        run_through(job)
