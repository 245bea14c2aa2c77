"""Fuzzes one of the readers written in Python, by mutation:

tools/fuzz_python.py TARGET [--seconds 600] [--seed 1] [--found build/fuzz/found] [--again FILE]

See fuzz.py.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import random
import signal
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FUZZ = ROOT / "native" / "fuzz"
SLOWEST = 10  # s of one input
MOST = 1 << 16  # bytes of one input

WORDS = [
    *(b"null", b"true", b"[]", b"{}", b'""', b"-1", b"0", b"1e999", b"1e308", b"-0.0", b"NaN", b"Infinity"),
    *(b"9" * 30, b"9" * 5000, b'"\\ud800"', b"[" * 40, b'{"a":' * 40, b'"tool"', b'"kind"', b'"rows"', b'"volume"'),
    *(b'<component objectid="1"/>', b'<item objectid="1"/>', b'<triangle v1="0" v2="1" v3="2"/>', b"[[tools]]\n"),
]


class BrokenError(Exception):
    """A reader accepted input that it must refuse."""


def seed_plan() -> bytes:
    import numpy as np
    import riffler
    from riffler import plan

    centres = np.array([[0.0, 0, 3], [1, 0, 3], [2, 0, 3]])
    contacts = np.stack([centres - [0, 0, 3], centres - [3, 0, 0]], axis=1)
    normals = np.broadcast_to([[[0, 0, 1.0], [1.0, 0, 0]]], (3, 2, 3))
    path = plan.PencilPath(3, centres, contacts, normals).orient({0: [0, 0, 1]})
    cl = np.column_stack([centres, np.tile([0.0, 0, 1], (3, 1))])
    part = {"name": "part", "sha256": "0" * 64}
    tool, depths = riffler.Tool.ball(6, 40), {1: 0.25}
    return plan.dumps(plan.Plan([path, path], tool, [cl, None], part=part, tolerance=0.01, depths=depths))


def read_plan(data: bytes) -> None:
    from riffler import plan

    plan.dumps(plan.loads(data, name="fuzz"))


def seed_curves() -> bytes:
    """Lines of all kinds of files with curves. Each reader accepts its own lines and refuses the others."""
    return b"v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nl 2 3\nl -1 1\n\n0 0 0\n1, 2, 3 # a point\n\n[[[0, 0, 0], [1, 2, 3]]]\n"


def read_curves(data: bytes) -> None:
    """Reads the curves as each kind of file, without most lines of the other kinds."""
    import numpy as np
    import riffler
    from riffler import plan

    rows = data.splitlines(keepends=True)
    kinds = {
        ".obj": data,
        ".txt": b"".join(row for row in rows if row[:1] not in b"vl["),
        ".json": data[data.find(b"[") :],
    }
    with tempfile.TemporaryDirectory() as folder:
        for suffix, text in kinds.items():
            path = Path(folder) / f"fuzz{suffix}"
            path.write_bytes(text)
            try:
                curves = plan.read_curves(path)
            except riffler.FormatError:
                continue
            if not all(c.ndim == 2 and c.shape[1] == 3 and len(c) > 1 and np.isfinite(c).all() for c in curves):
                raise BrokenError("invalid curves were accepted")


def seed_record() -> bytes:
    import numpy as np

    from addon.common.job import Cut
    from addon.sculpt.pure import sculpt_payload

    poses = np.arange(12.0).reshape(2, 6)
    cuts = [Cut({"kind": "ball", "name": "a"}, poses), Cut({"kind": "flat"}, poses, 0.001, "add")]
    return sculpt_payload.encode(b"volume", cuts, b"mask")


def read_record(data: bytes) -> None:
    from addon.sculpt.pure import sculpt_payload

    _, cuts, _, _ = sculpt_payload.decode(data)
    if not all(isinstance(cut.tool, dict) and cut.poses.shape[1] == 6 for cut in cuts):
        raise BrokenError("an invalid cut was accepted")


def seed_tools() -> bytes:
    import riffler

    tools = [
        riffler.Tool.ball(6, 40),
        riffler.Tool.taper(0.5, 0.1, 4, 30),
        riffler.Tool.profile([(1, 0), (2, 3, 0, 2)], 9),
    ]
    return json.dumps([{**tool.to_dict(), "name": f"tool {k}"} for k, tool in enumerate(tools)]).encode()


def read_tools(data: bytes) -> None:
    import riffler

    from addon.plan.pure import tool_library

    for suffix in (".json", ".toml"):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"fuzz{suffix}"
            path.write_bytes(data)
            try:
                tool_library.read(path, riffler.Tool.from_dict)
            except ValueError:
                continue


MODEL = b"""<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>
<object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/><vertex x="0" y="0" z="1"/></vertices><triangles><triangle v1="0" v2="2" v3="1"/>
<triangle v1="0" v2="1" v3="3"/><triangle v1="0" v2="3" v3="2"/><triangle v1="1" v2="2" v3="3"/></triangles></mesh>
</object><object id="2" type="model"><components>
<component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/><component objectid="1"/></components></object></resources>
<build><item objectid="2"/><item objectid="1"/></build></model>"""


def packed(model: bytes) -> bytes:
    from riffler.threemf_writer import RELATIONS, TYPES

    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", TYPES)
        archive.writestr("_rels/.rels", RELATIONS)
        archive.writestr("3D/3dmodel.model", model)
    return out.getvalue()


def read_threemf(data: bytes) -> None:
    """Reads the bytes as the model in a valid package, or as a whole package if they are a zip file."""
    import riffler

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "fuzz.3mf"
        path.write_bytes(data if data.startswith(b"PK") else packed(data))
        mesh = riffler.Mesh.read(path)
    if not len(mesh.triangles):
        raise BrokenError("a mesh without triangles was accepted")


@dataclass(frozen=True)
class Target:
    run: Callable[[bytes], None]
    seed: Callable[[], bytes]


TARGETS = {
    "plan": Target(read_plan, seed_plan),
    "curves": Target(read_curves, seed_curves),
    "record": Target(read_record, seed_record),
    "tools": Target(read_tools, seed_tools),
    "threemf": Target(read_threemf, lambda: MODEL),
}


def beginnings(name: str) -> Iterator[tuple[str, bytes]]:
    yield "the seed", TARGETS[name].seed()
    for kind in ("seeds", "kept"):
        for path in sorted((FUZZ / kind / name).glob("[!.]*")):
            yield str(path), path.read_bytes()


def mutated(data: bytes, other: bytes, choose: random.Random) -> bytes:
    out = bytearray(data)
    for _ in range(choose.choice((1, 1, 2, 4, 8))):
        at = choose.randrange(len(out) + 1)
        length = min(len(out) - at, choose.randrange(1, choose.choice((4, 16, 128))))
        match choose.randrange(8):
            case 0:
                out[at : at + 1] = bytes([choose.randrange(256)])
            case 1:
                del out[at : at + length]
            case 2:
                out[at:at] = out[at : at + length] * choose.choice((1, 1, 1, 50))
            case 3:
                start = choose.randrange(len(other) + 1)
                out[at:at] = other[start : start + choose.randrange(256)]
            case 4:
                del out[at:]
            case 5 | 6:
                out[at : at + choose.choice((0, 1, length))] = choose.choice(WORDS)
            case _:
                digits = [k for k in range(at, min(len(out), at + 64)) if 48 <= out[k] <= 57]
                if digits:
                    out[digits[0]] = choose.randrange(48, 58)
    return bytes(out[:MOST])


def check(name: str, data: bytes) -> None:
    """Runs a reader. A ValueError, such as FormatError, is a refusal; any other error or a long run is a fault."""

    def late(*_):
        raise BrokenError(f"an input took more than {SLOWEST} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(SLOWEST)
    try:
        TARGETS[name].run(data)
    except ValueError:
        pass
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def entry() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("target", choices=TARGETS)
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--found", type=Path, default=ROOT / "build" / "fuzz" / "found")
    parser.add_argument("--again", type=Path)
    given = parser.parse_args()
    if given.again:
        check(given.target, given.again.read_bytes())
        return
    choose = random.Random(given.seed)
    inputs = [data for _, data in beginnings(given.target)]
    given.found.mkdir(parents=True, exist_ok=True)
    running = given.found / f"{given.target}-{os.getpid()}"  # remains if a library ends the process
    end, runs = time.monotonic() + given.seconds, 0
    while time.monotonic() < end:
        data = mutated(choose.choice(inputs), choose.choice(inputs), choose)
        running.write_bytes(data)
        try:
            check(given.target, data)
        except BaseException as error:
            print(f"{type(error).__name__}: {error}\nthe input: {running}", file=sys.stderr)
            raise
        runs += 1
    running.unlink(missing_ok=True)
    print(f"{given.target}: {runs} runs in {given.seconds:.0f} s from {len(inputs)} inputs")


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    entry()
