"""The block in the .blend, the cache, sizes in words, the diagnosis, the zips."""

import json

import numpy as np
import pytest

from addon.common import contents, diagnosis, json_object, presets, units
from addon.common.job import Cut
from addon.sculpt.pure import sculpt_payload
from addon.stock.pure import estimate

POSES = np.random.default_rng(3).normal(size=(5, 6))
CUTS = [Cut({"kind": "ball", "name": "Größe 6"}, POSES), Cut({"kind": "flat"}, POSES[:2], 0.001)]


def test_round_trip_to_the_bit():
    block = sculpt_payload.encode(b"\0volume\0", CUTS)
    volume, cuts, mask, shaped = sculpt_payload.decode(block, sculpt_payload.content_id(block))
    assert (volume, mask, shaped) == (b"\0volume\0", b"", False)
    assert [c.tool for c in cuts] == [c.tool for c in CUTS]
    assert [c.tolerance for c in cuts] == [0.01, 0.001]
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(cuts, CUTS, strict=True))
    assert sculpt_payload.decode(sculpt_payload.encode(b"", []))[1] == []


def test_masks_and_added_material_read_back_and_older_blocks_stay_readable():
    put = [*CUTS, Cut({"kind": "ball"}, POSES, 0.01, "add")]
    volume, cuts, mask, _ = sculpt_payload.decode(sculpt_payload.encode(b"volume", put, b"mask"))
    assert (volume, mask) == (b"volume", b"mask")
    assert [c.mode for c in cuts] == ["remove", "remove", "add"]
    assert all(np.array_equal(a.poses, b.poses) for a, b in zip(cuts, put, strict=True))
    assert (sculpt_payload.encode(b"volume", CUTS)[8], sculpt_payload.encode(b"volume", put)[8]) == (1, 2)


def test_masked_and_shaped_flags_read_back_and_older_blocks_have_none():
    beside = [CUTS[0], Cut({"kind": "ball"}, POSES, masked=True)]
    _, cuts, _, shaped = sculpt_payload.decode(sculpt_payload.encode(b"v", beside, shaped=True))
    assert [c.masked for c in cuts] == [False, True] and shaped
    assert sculpt_payload.encode(b"v", beside, shaped=True)[8] == 1  # older add-ons can read it
    assert b"masked" not in sculpt_payload.encode(b"v", CUTS) and b"shaped" not in sculpt_payload.encode(b"v", CUTS)


def test_equal_content_has_an_equal_id():
    assert sculpt_payload.encode(b"v", CUTS) == sculpt_payload.encode(b"v", CUTS)
    assert sculpt_payload.content_id(sculpt_payload.encode(b"v", CUTS)) != sculpt_payload.content_id(
        sculpt_payload.encode(b"w", CUTS)
    )


def test_damage_is_a_value_error():
    block = sculpt_payload.encode(b"volume", CUTS)
    key = sculpt_payload.content_id(block)
    rng = np.random.default_rng(1)
    for _ in range(300):
        bad = bytearray(block)
        bad[rng.integers(len(bad))] ^= 1 << rng.integers(8)
        with pytest.raises(ValueError, match="damaged"):
            sculpt_payload.decode(bytes(bad), key)
    for size in range(len(block)):
        with pytest.raises(ValueError, match="sculpt's data"):
            sculpt_payload.decode(block[:size])
    with pytest.raises(ValueError, match="newer"):
        sculpt_payload.decode(block[:8] + b"\x03" + block[9:])


def test_the_cache_forgets_the_oldest():
    class Volume:
        nbytes = 10

    c = contents.ContentCache(count=3, nbytes=1000)
    for k in "abc":
        c.put(k, contents.Content(Volume()))
    assert c.get("a")  # used: now b is the oldest
    c.put("d", contents.Content(Volume()))
    assert c.get("b") is None and c.get("a") and len(c) == 3
    small = contents.ContentCache(nbytes=15)
    small.put("a", contents.Content(Volume()))
    small.put("b", contents.Content(Volume()))
    assert small.get("a") is None and small.get("b")


def test_rays_are_counted_as_the_volume_counts_them():
    assert estimate.ray_count((100, 60, 30), 0.25, "z") == 400 * 240
    assert estimate.ray_count((100, 60, 30), 0.25, "xyz") == 400 * 240 + 240 * 120 + 120 * 400
    assert estimate.ray_count((0.1, 2.5, 1), 1, "z") == 1 * 3  # half rounds up, and never to 0
    for bad in ((0, 1, 1), (1, np.nan, 1)):
        with pytest.raises(ValueError, match="size"):
            estimate.ray_count(bad, 1, "z")
    with pytest.raises(ValueError, match="pitch"):
        estimate.ray_count((1, 1, 1), 0, "z")


def test_units_and_words():
    assert units.mm_per_unit(0.0010000000474974513) == 1
    assert units.mm_per_unit(0.30480000376701355) == 304.8
    assert units.format_size((100, 60.5, 29.999)) == "100 × 60.5 × 30 mm"
    assert units.format_count(1234567) == "1\u00a0234\u00a0567"
    assert [units.format_bytes(n) for n in (12, 1234, 4.2e6, 3.5e9, 7.28e12)] == [
        "12 bytes",
        "1.2 KB",
        "4.2 MB",
        "3.5 GB",
        "7.3 TB",
    ]
    assert [units.counted(n, "move") for n in (0, 1, 2)] == ["0 moves", "1 move", "2 moves"]
    assert units.trim(-0.0001) == "0"
    with pytest.raises(ValueError, match="scale_length"):
        units.mm_per_unit(0)


def test_every_preset_has_the_sizes_of_its_kind():
    for tool in presets.presets():
        sizes = set(presets.SIZES[tool["kind"]]) - {"flat_tip"}
        assert set(tool) - {"name", "kind", "flat_tip"} == sizes, tool
    with pytest.raises(ValueError, match="spoon"):
        presets.tool_dict("spoon", {})


MACHINE = diagnosis.Machine("Linux", "6.1", "x86_64", "3.11.2", "4.5.0")


@pytest.mark.parametrize(
    ("error", "found", "words"),
    [
        (ImportError("version `GLIBC_2.38' not found"), [], "C library is older"),
        (ModuleNotFoundError("No module named 'numpy'"), [], "numpy is missing"),
        (ImportError("cannot import"), ["_core.cpython-313-x86_64-linux-gnu.so"], "another Python"),
        (ModuleNotFoundError("No module named 'riffler'"), [], "source folder has no native core"),
    ],
)
def test_the_first_step_fits_the_error(error, found, words):
    assert words in diagnosis.mend(error, MACHINE, found)[0]


@pytest.mark.parametrize(
    ("distribution", "words"),
    [
        (["debian"], "sudo apt install python3-numpy"),
        (["linuxmint", "ubuntu", "debian"], "sudo apt install python3-numpy"),
        (["fedora"], "sudo dnf install python3-numpy"),
        (["arch"], "sudo pacman -S python-numpy"),
        (["none"], "its package of numpy"),
    ],
)
def test_a_blender_on_the_systems_python_names_the_one_package(distribution, words):
    machine = diagnosis.Machine("Linux", "6.1", "x86_64", "3.11.2", "3.4.1", True, distribution)
    steps = diagnosis.mend(ModuleNotFoundError("No module named 'numpy'"), machine, [])
    assert words in steps[0] and "blender.org" not in " ".join(steps) and "zip" not in " ".join(steps)
    own = diagnosis.Machine("Linux", "6.1", "x86_64", "3.11.2", "4.5.0", False, distribution)
    assert "blender.org" in diagnosis.mend(ModuleNotFoundError("No module named 'numpy'"), own, [])[0]


def test_the_distribution_is_read_from_the_os_release(monkeypatch):
    read = {"ID": "ubuntu", "ID_LIKE": "debian x"}
    monkeypatch.setattr(diagnosis.platform, "freedesktop_os_release", lambda: read)
    assert diagnosis.distribution() == ["ubuntu", "debian", "x"]

    def nothing():
        raise OSError

    monkeypatch.setattr(diagnosis.platform, "freedesktop_os_release", nothing)
    assert diagnosis.distribution() == []


def test_other_processors_are_named():
    arm = diagnosis.Machine("Linux", "6.1", "aarch64", "3.11.2", "4.5.0")
    assert any("aarch64" in step for step in diagnosis.mend(OSError("x"), arm, []))


def test_a_module_for_this_python_is_not_blamed():
    steps = diagnosis.mend(OSError("boom"), MACHINE, ["_core.cpython-311-x86_64-linux-gnu.so"])
    assert not any("another Python" in s for s in steps)


def test_lines_fit_the_panel():
    text = "ImportError: /a/very/long/path/without/any/blank/in/it/at/all.so: undefined symbol and some more words"
    lines = diagnosis.wrap(text, 30)
    assert all(len(line) <= 30 for line in lines)
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")


def test_a_header_of_any_kind_is_a_value_error():
    """A .blend may come from any source, and its checksum with it."""
    cut = {"tool": {}, "tolerance": 0.01, "rows": 0}
    headers = [
        "[]",
        "null",
        "3",
        '"a"',
        "[" * 100_000,
        '{"a":' * 100_000,
        "{}",
        '{"volume": 0}',
        '{"volume": 0, "cuts": null}',
    ]
    headers += [json.dumps({"volume": volume, "cuts": []}) for volume in (None, "0", -1, 0.0, True, 2**70)]
    headers += [json.dumps({"volume": 0, "cuts": [], "mask": mask}) for mask in (None, [], -1)]
    headers += [json.dumps({"volume": 48, "cuts": [{**cut, "rows": -1}]})]
    wrong = {"tool": None, "tolerance": "fine", "rows": "0", "mode": {}}
    headers += [json.dumps({"volume": 0, "cuts": [{**cut, key: value}]}) for key, value in wrong.items()]
    headers += [json.dumps({"volume": 0, "cuts": [cut]}).replace("0.01", "1" * 5000)]
    for header in headers:
        text = header.encode()
        block = sculpt_payload.MAGIC + (2).to_bytes(4, "little") + len(text).to_bytes(4, "little") + text
        with pytest.raises(ValueError, match="sculpt's data"):
            sculpt_payload.decode(block)
    sound = json.dumps({"volume": 0, "cuts": [cut]}).encode()
    block = sculpt_payload.MAGIC + (2).to_bytes(4, "little") + len(sound).to_bytes(4, "little") + sound
    assert len(sculpt_payload.decode(block)[1]) == 1


def test_json_from_a_blend_is_an_object_or_a_value_error():
    assert json_object.loads('{"a": 1}', "tool") == {"a": 1}
    for text in ("[]", "null", "{", "[" * 100_000, b"\xff", "1" * 5000):
        with pytest.raises(ValueError, match=r"^tool: "):
            json_object.loads(text, "tool")
