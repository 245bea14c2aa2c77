"""What tools/check_docs.py says of files that a document quotes."""

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
