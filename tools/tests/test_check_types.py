"""check_types.py refuses what does not agree with the stub, and only that."""

import json
import subprocess
from pathlib import Path

import pytest

import check_types
from shell import PYTHON, ROOT, StepError

CHECKER = ROOT / ".envs" / "types" / "bin" / "basedpyright"
RIGHT = """import riffler

volume = riffler.Volume.block((0, 0, 0), (4, 3, 2), 0.5)
mesh: riffler.Mesh = riffler.submit(volume.to_mesh).result()
edges: int = mesh.audit().open_edges
"""


# A line that is added to RIGHT, and the rule that it breaks.
LINES = {
    "right": ("", None),
    "argument": ("volume.carve(6.0, [[0, 0, 0, 0, 0, 1]])", "reportArgumentType"),
    "keyword": ("volume.to_mesh(tolerence=1)", "reportCallIssue"),
    "member": ('mesh.audit()["edges"] + 1', "reportOperatorIssue"),
    "method": ("volume.soften((0, 0, 0), 1)", "reportAttributeAccessIssue"),
}


@pytest.fixture(scope="module")
def errors(tmp_path_factory):
    """The rules that each script of LINES breaks. The checker reads the stub once for all of them."""
    if not CHECKER.exists():
        pytest.skip(".envs/types is not there: run `make lint` once")
    folder = tmp_path_factory.mktemp("scripts")
    for name, (line, _) in LINES.items():
        (folder / f"{name}.py").write_text(RIGHT + line + "\n")
    settings = {"typeCheckingMode": "standard", "include": ["."], "extraPaths": [str(ROOT / "native" / "python")]}
    (folder / "pyrightconfig.json").write_text(json.dumps(settings))
    command = [CHECKER, "--project", folder, "--pythonpath", PYTHON, "--outputjson"]
    report = json.loads(subprocess.run(command, capture_output=True, text=True, timeout=300).stdout)
    assert report["summary"]["filesAnalyzed"] == len(LINES)
    found = {name: [] for name in LINES}
    for finding in report["generalDiagnostics"]:
        if finding["severity"] == "error":
            found[Path(finding["file"]).stem].append(finding["rule"])
    return found


@pytest.mark.parametrize("name", LINES)
def test_a_script_is_checked_against_the_stub(errors, name):
    rule = LINES[name][1]
    assert errors[name] == ([rule] if rule else [])


def test_what_agreed_is_not_checked_again_until_something_changes(tmp_path, monkeypatch):
    package, runs = tmp_path / "examples", []
    for path, text in ((package / "a.py", "x = 1\n"), (tmp_path / "pyproject.toml", ""), (tmp_path / "types.txt", "")):
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    checker = tmp_path / "check_types.py"
    checker.write_text("")
    python = tmp_path / ".venv" / "bin" / "python"
    for name, value in {"ROOT": tmp_path, "REQUIREMENTS": tmp_path, "PYTHON": python, "__file__": checker}.items():
        monkeypatch.setattr(check_types, name, value)
    monkeypatch.setattr("shell.ROOT", tmp_path)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(check_types, "types_environment", lambda: tmp_path)

    def check(*command):
        runs.append(command)
        if "bad" in (package / "a.py").read_text():
            raise StepError("it does not agree")

    monkeypatch.setattr(check_types, "run", check)

    def checked():
        before = len(runs)
        check_types.entry()
        return len(runs) > before

    assert checked() and not checked()
    (package / "b.pyi").write_text("y: int\n")
    assert checked() and not checked()
    (tmp_path / "pyproject.toml").write_text("[tool.basedpyright]\n")
    assert checked() and not checked()
    (tmp_path / ".venv" / "lib" / "python3.11" / "site-packages" / "numpy-3.0.dist-info").mkdir(parents=True)
    assert checked() and not checked()
    (package / "a.py").write_text("bad\n")
    for _ in range(2):  # a failure is not remembered
        with pytest.raises(StepError):
            check_types.entry()
    (package / "a.py").write_text("x = 1\n")
    assert not checked()
