"""Tool libraries without Blender: tools read from files, errors of files, and pictures of tools."""

import json
import os

import numpy as np
import pytest
import riffler

from addon.common import presets
from addon.plan.pure import tool_library, tool_picture

BALL = {"name": "Six", "kind": "ball", "diameter": 6.0, "length": 30.0}
FLAT = {"name": "Three", "kind": "flat", "diameter": 3.0, "length": 12.0}
LONG = {**BALL, "name": "Long", "shank": [[30.0, 3.0, 50.0, 3.0]], "holder": [[50.0, 14.0, 80.0, 16.0]]}


def read(tmp_path, text, name="tools.json"):
    path = tmp_path / name
    path.write_text(text if isinstance(text, str) else json.dumps(text), encoding="utf-8")
    return tool_library.read(path, riffler.Tool.from_dict)


def tools(entries):
    return [e.tool for e in entries]


def test_the_presets_are_a_library():
    assert tools(tool_library.shipped()) == list(presets.presets())
    assert tool_library.find(tool_library.shipped(), "V-bit 90°").path is None


def test_a_file_has_one_tool_or_a_list(tmp_path):
    assert tools(read(tmp_path, BALL)) == [BALL]
    entries = read(tmp_path, [BALL, LONG])
    assert tools(entries) == [BALL, LONG] and {e.path for e in entries} == {tmp_path / "tools.json"}
    assert tool_library.find(entries, "Long").tool == LONG


def test_toml_has_one_tool_or_a_table_of_them(tmp_path):
    one = 'name = "Six"\nkind = "ball"\ndiameter = 6.0\nlength = 30.0\n'
    assert tools(read(tmp_path, one, "a.toml")) == [BALL]
    two = '[[tools]]\nname = "Six"\nkind = "ball"\ndiameter = 6.0\nlength = 30.0\n'
    more = '\n[[tools]] # wider\nname = "Three"\nkind = "flat"\ndiameter = 3.0\nlength = 12.0\n'
    assert tools(read(tmp_path, two + more, "b.toml")) == [BALL, FLAT]


def test_tools_that_riffler_writes_are_read(tmp_path):
    tool = riffler.Tool.from_dict(LONG)
    path = tool_library.write(tmp_path / "new" / "folder", tool.to_dict())
    assert path.name == "Long.json" and os.listdir(path.parent) == ["Long.json"]
    (entry,) = tool_library.read(path, riffler.Tool.from_dict)
    assert riffler.Tool.from_dict(entry.tool) == tool


def test_a_tool_without_a_name_has_its_files(tmp_path):
    (entry,) = read(tmp_path, {k: v for k, v in BALL.items() if k != "name"}, "ball six.json")
    assert entry.name == "ball six"


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.json", "", r"^a\.json, line 1: "),
        ("a.json", '[\n{"kind": "ball",\n"diameter" 6}]', r"^a\.json, line 3: Expecting ':'"),
        ("a.json", "[]", r"^a\.json: there is no tool in it$"),
        ("a.json", "[" * 100_000, r"^a\.json: "),
        ("a.json", '\n\n{"kind": "ball", "diameter": NaN, "length": 3}', r"^a\.json: NaN is not a number"),
        ("a.json", '[{"kind": "ball", "diameter": 6, "length": 30},\n\n 7]', r"^a\.json, line 3: a tool, a table"),
        ("a.json", '\n{"kind": "spoon"}', r'^a\.json, line 2: .*not "spoon"$'),
        (
            "a.json",
            '[\n{"kind": "ball", "diameter": 6, "length": 30},\n{"kind": "ball", "diameter": 6}]',
            r"^a\.json, line 3: tool: length is missing$",
        ),
        (
            "a.json",
            '[{"kind": "ball", "name": "] }, {",\n"diameter": 6, "length": 30},\n{"kind": "ball", "diameter": -1}]',
            r"^a\.json, line 3: ",
        ),
        ("a.json", '{"kind": "ball", "name": 3, "diameter": 6, "length": 3}', r"line 1: name: a text expected$"),
        ("a.json", '{"kind": "ball", "diameter": 6, "length": 3, "holder": [1]}', r"line 1: holder must be a list"),
        ("a.toml", 'kind = "ball"\ndiameter = \n', r"^a\.toml: .*line 2"),
        ("a.toml", "", r"^a\.toml: there is no tool in it$"),
        (
            "a.toml",
            '[[tools]]\nkind = "ball"\ndiameter = 6\nlength = 9\n[[tools]]\nkind = "ball"\n',
            r"^a\.toml, line 5: tool: diameter is missing$",
        ),
        ("a.toml", "tools = 3", r"^a\.toml, line 1: a tool, a table"),
    ],
)
def test_faults_of_a_file_are_named_with_their_line(tmp_path, name, text, message):
    with pytest.raises(ValueError, match=message):
        read(tmp_path, text, name)


def test_a_file_that_is_not_text_is_named(tmp_path):
    (tmp_path / "a.json").write_bytes(b'{"name": "\xff"}')
    with pytest.raises(ValueError, match=r"^a\.json: byte 10 is not UTF-8$"):
        tool_library.read(tmp_path / "a.json", riffler.Tool.from_dict)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"^gone\.json: cannot be opened: No such file or directory: choose"):
        tool_library.read(tmp_path / "gone.json", riffler.Tool.from_dict)


def test_a_bad_file_does_not_spoil_the_others(tmp_path):
    for name, tool in (("b.json", BALL), ("a.json", LONG)):
        read(tmp_path, tool, name)
    (tmp_path / "c.json").write_text("{")
    (tmp_path / "notes.txt").write_text("no tool")
    (tmp_path / ".hidden.json").write_text("{")
    entries, problems = tool_library.scan(tmp_path, riffler.Tool.from_dict)
    assert [e.name for e in entries] == ["Long", "Six"]
    assert len(problems) == 1 and problems[0].startswith("c.json, line 1: ")
    entries, problems = tool_library.scan(tmp_path / "gone", riffler.Tool.from_dict)
    assert entries == [] and problems == [f"{tmp_path / 'gone'}: No such file or directory"]


def test_the_error_of_an_unknown_name_lists_the_known_ones(tmp_path):
    with pytest.raises(ValueError, match=r"^tools\.json: there is no tool 'X', only Six, Long$"):
        tool_library.find(read(tmp_path, [BALL, LONG]), "X")


def test_a_file_is_overwritten_only_for_the_same_tool(tmp_path):
    path = tool_library.write(tmp_path, BALL)
    tool_library.write(tmp_path, {**BALL, "length": 40.0})
    assert json.loads(path.read_text())["length"] == 40.0
    path.write_text(json.dumps([BALL, LONG]))
    with pytest.raises(ValueError, match="is there already: give the tool another name"):
        tool_library.write(tmp_path, BALL)
    assert json.loads(path.read_text()) == [BALL, LONG] and os.listdir(tmp_path) == ["Six.json"]


def test_names_of_tools_become_names_of_files():
    assert tool_library.file_name("V-bit 60°") == "V-bit 60°"
    assert tool_library.file_name("../a/b:c\\d") == "_a_b_c_d"
    assert tool_library.file_name("...") == "tool"


def read_only(tmp_path):
    """A folder that even root cannot write into, and a file in place of a folder."""
    (tmp_path / "file").write_text("")
    return [tmp_path / "file" / "tools", "/proc/riffler"] if os.path.isdir("/proc/self") else [tmp_path / "file" / "x"]


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    for folder in read_only(tmp_path):
        with pytest.raises(ValueError, match="choose a folder that can be written") as caught:
            tool_library.write(folder, BALL)
        assert str(caught.value).startswith(str(folder))


def test_a_full_disk_leaves_the_old_file(tmp_path, monkeypatch):
    path = tool_library.write(tmp_path, BALL)

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tool_library.files, "write", full)
    with pytest.raises(ValueError, match="No space left on device"):
        tool_library.write(tmp_path, {**BALL, "length": 40.0})
    assert os.listdir(tmp_path) == ["Six.json"] and json.loads(path.read_text()) == BALL


# ---- pictures


def covered(tool, size=256):
    """Area of the shape in a picture, mm², and the picture."""
    pixels = tool_picture.profile(tool.outline(tolerance=0.001), size)
    low, high = 0.0, max(line[:, 1].max() for _, line in tool.outline())
    wide = max(line[:, 0].max() for _, line in tool.outline())
    side = max(high - low, 2 * wide) / (1 - 2 * tool_picture.MARGIN)
    return pixels[..., 3].sum() * (side / size) ** 2, pixels


@pytest.mark.parametrize(
    ("tool", "area"),
    [
        (riffler.Tool.ball(6, 30), np.pi * 9 / 2 + 6 * 27),
        (riffler.Tool.flat(6, 30), 180),
        (riffler.Tool.fillet(10, 2, 40), 400 - 2 * (4 - np.pi)),
        (riffler.Tool.cone_end(np.pi / 4, 1, np.pi / 4, 6, 12), 9 + 6 * 9),
        (riffler.Tool.from_dict(LONG), np.pi * 9 / 2 + 6 * 27 + 6 * 20 + 30 * 30),
    ],
)
def test_a_picture_shows_the_profile_in_proportion(tool, area):
    shown, pixels = covered(tool)
    assert abs(shown / area - 1) < 0.01
    assert pixels.shape == (256, 256, 4) and pixels.dtype == np.float32 and 0 <= pixels.min() <= pixels.max() <= 1
    assert np.array_equal(pixels, pixels[:, ::-1]), "both halves"
    rim = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    assert not rim.any(), "all of the tool is in the picture"


def test_a_picture_has_the_tip_below_and_a_colour_for_each_piece():
    _, pixels = covered(riffler.Tool.from_dict(LONG))
    column = pixels[:, 128]
    height = ((np.arange(256) + 0.5) / 256 - tool_picture.MARGIN) * 80 / (1 - 2 * tool_picture.MARGIN)
    for piece, low, high in (("cutter", 1, 29), ("shank", 31, 49), ("holder", 51, 79)):
        rows = column[(height > low) & (height < high)]
        assert len(rows) > 10 and (rows[:, 3] == 1).all()
        assert np.allclose(rows[:, :3], tool_picture.COLOURS[piece], atol=0.01), "in the middle it is not shaded"
