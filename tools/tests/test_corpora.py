"""tools/corpora.py counts what is read and says why the rest is not."""

import corpora


def test_files_are_counted_by_what_stops_them(tmp_path, monkeypatch, capsys):
    for name, text in {
        "iso/straight.nc": "%\nO1\nG21 G90\nG0 X1\nG1 X2 F100\nM30\n%\n",
        "iso/turning.nc": "G0 X1 A10\nG1 X2 A20 F100\n",
        "iso/probing.nc": "G0 X1\nG38.2 Z-10 F50\n",
        "iso/tilted.nc": "G0 X1\nG68.2 X0 Y0 Z0\n",
        "iso/SOURCE.txt": "not a program",
        "apt/one.apt": "PARTNO/1\nRAPID\nGOTO/1,2,3\nFINI\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr("sys.argv", ["corpora.py", str(tmp_path)])
    corpora.entry()
    said = capsys.readouterr().out
    assert "apt: 1 of 1 read" in said and "iso: 2 of 4 read" in said
    assert "   1 probing" in said and "a tilted plane" in said
