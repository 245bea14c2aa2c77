"""tools/check_docs.py compares what a document quotes, and runs its commands."""

import re

import pytest

import check_docs

DOCUMENT = """# A

<!-- file: code.cpp -->
```cpp
int b() {
  return 2;
}
```
"""


@pytest.mark.parametrize(
    ("code", "problems"),
    [
        ("int a();\n\nint b() {\n  return 2;\n}\n", []),
        ("int b() {\n  return 2;\n}\n", []),
        ("int b() {\n  return 3;\n}\n", ["a.md:4: this is not what stands in code.cpp"]),
        ("int b() {\n  return 2;\n}  // b\n", ["a.md:4: this is not what stands in code.cpp"]),
        (None, ["a.md:4: code.cpp: no such file"]),
    ],
)
def test_quotes_occur_in_their_file(tmp_path, monkeypatch, code, problems):
    monkeypatch.setattr(check_docs, "ROOT", tmp_path)
    (tmp_path / "a.md").write_text(DOCUMENT)
    if code is not None:
        (tmp_path / "code.cpp").write_text(code)
    assert check_docs.quote_problems(check_docs.read(tmp_path / "a.md")) == problems


def problems_of(path, monkeypatch, *lines):
    monkeypatch.setattr(check_docs, "ROOT", path)
    (path / "a.md").write_text("\n".join(["```sh", *lines, "```", ""]))
    return check_docs.example_problems(check_docs.read(path / "a.md"))


def test_commands_run_in_one_empty_folder(tmp_path, monkeypatch):
    """The second reads what the first has written, and what a third has not is missing."""
    pytest.importorskip("riffler")
    made = "riffler pen simulate --seconds 0.1 --journal 'a run.rjournal'"
    again = "riffler volume replay 'a run.rjournal' --out run.rvol"
    assert problems_of(tmp_path, monkeypatch, made, again) == []
    missing = problems_of(tmp_path, monkeypatch, again)
    assert missing[0].startswith(f"a.md:2: {again}: exit code ") and "a run.rjournal" in missing[0].splitlines()[-1]


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        ("raise ValueError('deep down')", "exit code 1\n(?s:.*)ValueError: deep down"),
        ("raise SystemExit(3)", "exit code 3\n$"),
        ("raise SystemExit('words')", "exit code 1\n"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "exit code -9\n$"),
        ("import time; time.sleep(60)", "exit code -14\n$"),
        ("print(argv); return 4", r"exit code 4\n\['a', 'b c'\]\n$"),
    ],
)
def test_a_command_that_fails_is_reported_with_its_output(tmp_path, monkeypatch, body, problem):
    cli = pytest.importorskip("riffler.cli")
    names = {}
    exec(f"def main(argv):\n    {body}", names)
    monkeypatch.setattr(cli, "main", names["main"])
    if "sleep" in body:
        monkeypatch.setattr(check_docs, "SECONDS", 1)
    (found,) = problems_of(tmp_path, monkeypatch, "riffler a 'b c'")
    assert re.match(r"a\.md:2: riffler a 'b c': " + problem, found), found
