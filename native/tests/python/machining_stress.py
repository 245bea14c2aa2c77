"""Stress of operations: random parts, stocks and tools, every operation, judged by machining_judge.py.

    python native/tests/python/machining_stress.py --parts 200 --seed 1

prints each fault with the number of its part, and ends with their count; ``--only N`` runs one part again.
"""

import argparse
import math
import os
import sys
import time
from dataclasses import dataclass, field

import numpy as np
import riffler
from finish_judge import Judge
from machining_judge import CELL, SLIVER, HeightMap, PartJudge, opened, part_heights
from machining_parts import KINDS, TOOLS, kinds, random_tool, stock_around
from riffler import plan
from riffler.plan.operations import LINK, RAPID
from tilting_judge import deepest

SELDOM = 0.015  # share of samples that patterns with checks at places may leave too high
PATTERNS = {"parallel": (0, 65), "waterline": (25, 90), "scallop": (0, 65), "spiral": (0, 65), "radial": (0, 65)}


@dataclass
class Run:
    """One random part, and what was found on it."""

    number: int
    seed: int
    names: tuple = ()
    scale: float = 1.0  # of the part
    threads: tuple = ("1", "2", "4")
    faults: list = field(default_factory=list)
    lines: list = field(default_factory=list)

    def fault(self, operation, text):
        self.faults.append(f"part {self.number}, {operation}: {text}")

    def run(self):
        self.random = np.random.default_rng([self.seed, self.number])
        names = self.names or kinds()
        self.kind = names[self.number % len(names)]
        part = KINDS[self.kind](self.random)
        self.part = riffler.Mesh(self.scale * np.asarray(part.vertices), part.triangles)
        self.stock = stock_around(self.part, self.random)
        setup = plan.Setup(self.part, self.stock)
        self.judge = PartJudge(self.part, self.random)
        self.map = HeightMap(self.stock.lower, self.stock.upper)
        self.heights = part_heights(self.part, self.map.x, self.map.y)
        self.rough(setup)
        for pattern in PATTERNS:
            self.finish(setup, pattern)
        self.outline(setup)
        self.drill(setup)
        self.pencil(setup)
        self.lean(setup)
        return self.faults

    def random_tool(self, kinds=TOOLS):
        return random_tool(self.random, kinds[int(self.random.integers(len(kinds)))])

    def planned(self, name, setup, call):
        """The operation, after checks that hold for all of them; None if the call refuses its arguments."""
        before, found = setup.stock.to_bytes(), []
        calls = []
        for threads in self.threads:
            os.environ["RIFFLER_THREADS"] = threads
            calls.clear()
            try:
                found.append(call(lambda share: calls.append(share)))
            except ValueError as error:
                self.lines.append(f"{name}: refused: {error}")
                return None
        os.environ.pop("RIFFLER_THREADS")
        op = found[0]
        if any(one.poses.tobytes() != op.poses.tobytes() or one.kind.tobytes() != op.kind.tobytes() for one in found):
            self.fault(name, f"other bytes for another number of threads ({self.threads})")
        self.cancelled(name, call, int(self.random.integers(max(1, len(calls)))))
        if setup.stock.to_bytes() != before:
            self.fault(name, "planning changed the stock")
        if not len(op) and not op.reason:
            self.fault(name, "empty without a reason")
        if not np.isfinite(op.poses).all() or not np.isfinite(op.feed).all():
            self.fault(name, "poses that are not finite")
        self.lines.append(
            f"{name}: {op.tool.name}, {len(op)} rows, {op.reason or [one.reason for one in op.report.blocked]}"
        )
        return op

    def cancelled(self, name, call, last):
        count = 0

        def stop(share):
            nonlocal count
            count += 1
            return count <= last

        try:
            call(stop)
        except riffler.Cancelled:
            if count != last + 1:
                self.fault(name, f"cancelled at call {last + 1}, and progress was called {count} times")
        else:
            if count > last:
                self.fault(name, f"call {last + 1} of progress asked to cancel, and an operation came back")

    def checked(self, name, setup, op, allowance, tolerance, heights):
        """Checks gouges, rapids, and that a program can be made. Returns what the height map says of the cuts."""
        gouges = self.judge.gouges(op, allowance, tolerance)
        if gouges:
            p, depth = max(gouges, key=lambda one: one[1])
            self.fault(name, f"gouge of {depth:.4f} mm at {p.round(3)}, tolerance {tolerance}, {len(gouges)} places")
        thick, widths = heights.cut(op)
        if thick[RAPID] > SLIVER:
            self.fault(name, f"a rapid removes {thick[RAPID]:.3f} mm")
        try:
            plan.program(setup, [op])
        except ValueError as error:
            # What lies under the holes of an open surface counts as solid there, by winding numbers.
            note = self.lines.append if self.kind == "scan" else lambda text: self.fault(name, text)
            note(f"no program: {error}")
        return thick, widths

    def rough(self, setup):
        tool = self.random_tool()
        options = {
            "stepdown": self.random.uniform(1, 4),
            "engagement": self.random.uniform(0.15, 0.6),
            "allowance": self.random.uniform(0, 0.5),
            "tolerance": self.random.uniform(0.02, 0.1),
            "climb": bool(self.random.uniform() < 0.5),
        }
        options["stepdown"] = min(options["stepdown"], 0.9 * tool.length)
        op = self.planned("rough", setup, lambda progress: plan.rough(setup, tool, progress=progress, **options))
        if op is None or not len(op):
            return
        thick, widths = self.checked("rough", setup, op, options["allowance"], options["tolerance"], self.map)
        if thick[LINK] > 2 * SLIVER:
            self.lines.append(f"rough: a link removes {thick[LINK]:.3f} mm")
        if tool.kind == "flat":  # other cutters also take the ridges that the last pass has left next to them
            limit = options["engagement"] * tool.diameter
            width, length = widths.T
            over = length[width > limit + 2.5 * CELL].sum() / max(length.sum(), 1e-9)
            if over > 0.003:
                self.fault("rough", f"{100 * over:.2f} % of the cuts are wider than {limit:.3f} mm, {width.max():.3f}")
            elif width.max(initial=0) > 1.25 * limit + 2.5 * CELL:
                self.lines.append(f"rough: a cut of {width.max() / limit:.2f} × the width asked")
        setup.apply(op)
        if not op.report.blocked and not tool.holder:
            thicker = options["allowance"] + options["tolerance"] + CELL
            reached = opened(np.maximum(self.heights, self.stock.lower[2]), tool, thicker, self.stock.lower[2])
            left = self.map.z - reached - options["stepdown"] - options["tolerance"]
            if left.max() > SLIVER:
                at = np.unravel_index(left.argmax(), left.shape)
                self.fault(
                    "rough", f"{left.max():.3f} mm too high at {self.map.x[at[0]]:.2f}, {self.map.y[at[1]]:.2f}; "
                    f"{(left > SLIVER).sum()} cells"
                )  # fmt: skip

    def finish(self, setup, pattern):
        tool = self.random_tool()
        slopes = tuple(math.radians(x) for x in PATTERNS[pattern])
        if tool.kind == "flat" and pattern != "waterline":
            slopes = (0.0, math.radians(5))
        cusp, tolerance = self.random.uniform(0.05, 0.2), self.random.uniform(0.01, 0.04)
        allowance = 0.0 if self.random.uniform() < 0.6 else self.random.uniform(0.05, 0.4)
        angle = self.random.uniform(0, math.pi)
        options = {"cusp": cusp, "tolerance": tolerance, "allowance": allowance, "angle": angle, "slopes": slopes}
        if cusp >= 0.5 * tool.diameter:
            return
        op = self.planned(
            pattern, setup, lambda progress: plan.finish(setup, tool, pattern, progress=progress, **options)
        )
        if op is None:
            return
        hidden = any("shank" in one.reason or "holder" in one.reason for one in op.report.blocked)
        judge = Judge(self.part, tool, allowance, slopes, count=800, seed=self.number)
        standing = judge.standing(op, cusp, tolerance)
        share = len(standing) / max(1, judge.reachable.sum())
        if len(standing) and not hidden:
            text = (
                f"{tool.kind}: {len(standing)} of {judge.reachable.sum()} samples stand, such as {standing[0].round(3)}"
            )
            if share > SELDOM:
                self.fault(pattern, text)
            else:
                self.lines.append(f"{pattern}: {text}")
        if len(op):
            self.checked(pattern, setup, op, allowance, tolerance, self.map.copy())

    def outline(self, setup):
        tool = self.random_tool()
        allowance = 0.0 if self.random.uniform() < 0.5 else self.random.uniform(0.05, 0.5)
        options = {
            "stepdown": self.random.uniform(1, 4),
            "tabs": int(self.random.integers(0, 4)),
            "allowance": allowance,
            "tolerance": 0.03,
            "climb": bool(self.random.uniform() < 0.5),
        }
        if self.random.uniform() < 0.5:  # nothing roughed before
            setup = plan.Setup(self.part, self.stock)
        whole = setup.stock.volume == self.stock.volume
        op = self.planned("outline", setup, lambda progress: plan.outline(setup, tool, progress=progress, **options))
        if op is None or not len(op):
            return
        before = HeightMap(self.stock.lower, self.stock.upper) if whole else self.map.copy()
        self.checked("outline", setup, op, allowance, 0.03, before)

    def drill(self, setup):
        tool = self.random_tool(("flat", "ball"))
        lower, upper = self.stock.lower, self.stock.upper
        points = np.column_stack([self.random.uniform(lower[:2] - 1, upper[:2] + 1, (6, 2)), np.full(6, upper[2])])
        depth = self.random.uniform(0.5, upper[2] - lower[2], 6)
        peck = None if self.random.uniform() < 0.5 else self.random.uniform(0.5, 3)
        op = self.planned(
            "drill", setup, lambda progress: plan.drill(setup, tool, points, depth, peck, progress=progress)
        )
        if op is not None and len(op):
            self.checked("drill", setup, op, 0.0, 0.05, self.map.copy())

    def pencil(self, setup):
        tool = self.random_tool(("ball",))
        op = self.planned(
            "pencil", setup, lambda progress: plan.pencil_operation(setup, tool, tolerance=0.03, progress=progress)
        )
        if op is not None and len(op):
            self.checked("pencil", setup, op, 0.0, 0.03, self.map.copy())

    def lean(self, setup):
        """Finishes with axes that change, judged by points of a cloud on the part at dense poses of the moves."""
        tool = self.random_tool(("ball",))
        lower, upper = self.stock.lower, self.stock.upper
        target = 0.5 * (lower + upper) + [0, 0, 2 * (upper[2] - lower[2])]
        rules = ("normal", (0.3, -0.2), {"towards": target}, {"away": lower - 20}, "least_tilt")
        rule = rules[int(self.random.integers(len(rules)))]
        pattern = plan.PATTERNS[int(self.random.integers(len(plan.PATTERNS)))]
        five = plan.Setup(self.part, setup.stock, machine="tcp")
        options = {"cusp": 0.4, "tolerance": 0.05, "orientation": rule, "slopes": (0.1, 1.1)}
        op = self.planned("lean", five, lambda progress: plan.finish(five, tool, pattern, progress=progress, **options))
        if op is None or not len(op):
            return
        depth, move = deepest(op, self.part, (0, 1, 2, 3), count=1500, seed=self.number, step=0.8, turn=0.08)
        if depth > 0.05 + 1e-3:
            self.fault("lean", f"{rule}, {pattern}: {depth:.4f} mm deep in move {move}, tolerance 0.05")
        try:
            plan.program(five, [op])
        except ValueError as error:  # shank and holder in the stock are found there only
            note = self.lines.append if self.kind == "scan" or "gouges" not in str(error) else self.fault_of_lean
            note(f"no program: {error}")

    def fault_of_lean(self, text):
        self.fault("lean", text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--parts", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    numbers = range(arguments.first, arguments.first + arguments.parts)
    faults = []
    for number in numbers if arguments.only is None else [arguments.only]:
        begin, run = time.monotonic(), Run(number, arguments.seed)
        faults += run.run()
        print(f"part {number}: {run.kind}, {len(run.faults)} faults, {time.monotonic() - begin:.1f} s", flush=True)
        for line in run.lines if arguments.verbose or arguments.only is not None else []:
            print(f"  {line}")
        for line in run.faults:
            print(f"  FAULT {line}", flush=True)
    print(f"{len(faults)} faults")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
