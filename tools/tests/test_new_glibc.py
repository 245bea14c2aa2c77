"""auditwheel's knowledge of a newer glibc, from libraries of our own making."""

import json

import pytest

import new_glibc

LINUX = {"name": "linux", "aliases": [], "priority": 0, "symbol_versions": {}, "lib_whitelist": [], "blacklist": {}}
KNOWN = {"name": "manylinux_2_41", "aliases": [], "priority": 51, "lib_whitelist": ["libc.so.6"], "blacklist": {},
         "symbol_versions": {"x86_64": {"GLIBC": ["2.2.5", "2.41"], "ZLIB": ["1.2.9"]}}}  # fmt: skip


@pytest.fixture
def system(tmp_path):
    (tmp_path / "auditwheel" / "policy").mkdir(parents=True)
    (tmp_path / "auditwheel" / new_glibc.POLICIES).write_text(json.dumps([LINUX, KNOWN]))

    def libraries(glibc):
        texts = dict.fromkeys(new_glibc.LIBRARIES, b"\x00GCC_3.0\x00")
        texts["libc.so.6"] = b"\0GLIBC_2.2.5\0GLIBC_" + glibc + b"\0GLIBC_PRIVATE\0xGLIBC_2.99\0"
        texts["libstdc++.so.6"] = b"\0GLIBCXX_3.4.35\0"
        for name, text in texts.items():
            (tmp_path / name).write_bytes(b"ELF" + text)
        return tmp_path

    return libraries


def test_a_newer_glibc_becomes_a_policy_of_its_name(system):
    place = system(b"2.43")
    assert new_glibc.teach(place / "auditwheel", place) == "manylinux_2_43"
    _, known, new = json.loads((place / "auditwheel" / new_glibc.POLICIES).read_text())
    assert known == KNOWN and 0 < new["priority"] < known["priority"] and new["lib_whitelist"] == known["lib_whitelist"]
    assert new["symbol_versions"] == {
        "x86_64": {"GLIBC": ["2.2.5", "2.41", "2.43"], "ZLIB": ["1.2.9"], "GLIBCXX": ["3.4.35"], "GCC": ["3.0"]}
    }
    assert new_glibc.teach(place / "auditwheel", place) == "", "it is known now"


def test_a_known_glibc_changes_nothing(system):
    place = system(b"2.41")
    assert new_glibc.teach(place / "auditwheel", place) == ""
    assert json.loads((place / "auditwheel" / new_glibc.POLICIES).read_text()) == [LINUX, KNOWN]
