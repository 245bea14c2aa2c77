"""check_types.py refuses what does not agree with the stub, and only that."""

import json
import subprocess

import pytest

from shell import PYTHON, ROOT

CHECKER = ROOT / ".envs" / "types" / "bin" / "basedpyright"
RIGHT = """import riffler

volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), 0.5)
mesh: riffler.Mesh = riffler.submit(volume.to_mesh).result()
edges: int = mesh.audit().open_edges
"""


@pytest.mark.skipif(not CHECKER.exists(), reason=".envs/types is not there: run `make lint` once")
@pytest.mark.parametrize(
    "line, rule",
    [
        ("", None),
        ("volume.carve(6.0, [[0, 0, 0, 0, 0, 1]])", "reportArgumentType"),
        ("volume.to_mesh(tolerence=1)", "reportCallIssue"),
        ('mesh.audit()["edges"] + 1', "reportOperatorIssue"),
        ("volume.soften((0, 0, 0), 1)", "reportAttributeAccessIssue"),
    ],
)
def test_a_script_is_checked_against_the_stub(tmp_path, line, rule):
    (tmp_path / "script.py").write_text(RIGHT + line + "\n")
    settings = {"typeCheckingMode": "standard", "include": ["."], "extraPaths": [str(ROOT / "native" / "python")]}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [CHECKER, "--project", tmp_path, "--pythonpath", PYTHON, "--outputjson"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    found = [d["rule"] for d in json.loads(done.stdout)["generalDiagnostics"] if d["severity"] == "error"]
    assert found == ([rule] if rule else [])
