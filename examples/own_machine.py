"""Describe your own machine in a TOML file, write NC code for it, and read the code back.

Shows: a machine file, machines with RIFFLER_MACHINES, Program.from_cl, Program.write with options, Program.read.
"""

import os
import re
from pathlib import Path

import numpy as np
import riffler
from picture import BLUE, ORANGE, plt, save

# A tilting head over a rotary table: B tilts the tool about Y, C turns the part. Machines of this folder have a name.
os.environ["RIFFLER_MACHINES"] = str(Path.cwd())
Path("my-mill.toml").write_text("""
description = "my mill: head B, table C"
words = "joints"             # X Y Z say where the linear axes stand
direction = "iso"            # the sense in which the table turns
options.pivot = 150          # mm from the head's axis to the tool's tip, unless given otherwise
axis.X.limits = [-400, 400]  # mm
axis.B.limits = [-95, 95]    # deg
axis.C.rate = 9000           # deg/min
rotary = [
    {letter = "C", carries = "part", axis = [0, 0, -1], at = [0, 0, -60]},
    {letter = "B", carries = "tool", axis = [0, 1, 0], at.pivot = [0, 0, 1]},
]
""")
print("listed as:", riffler.machines()["my-mill"])

# A rosette around the table's axis, the tool leaning outwards by up to 30 degrees.
t = np.linspace(0, 2 * np.pi, 181)
radius, lean = 30 + 8 * np.cos(5 * t), np.radians(20 + 10 * np.cos(5 * t))
axes = np.column_stack([np.sin(lean) * np.cos(t), np.sin(lean) * np.sin(t), np.cos(lean)])
path = np.column_stack([radius * np.cos(t), radius * np.sin(t), 2 * np.sin(5 * t), axes])
program = riffler.Program.from_cl([path], tools=[riffler.Tool.ball(6, 40)], feed=900, spindle=12000)
options = {"pivot": 180}
written = program.write("rosette.ngc", post="my-mill", tolerance=0.005, options=options)

back = riffler.Program.read("rosette.ngc", machine="my-mill", options=options).poses
error = max(np.linalg.norm(back[:, :3] - pose[:3], axis=1).min() for pose in path)
code = Path("rosette.ngc").read_text()
blocks = np.array([[float(x) for x in found] for found in re.findall(r" B(\S+) C(\S+)", code)])
print(f"{written.blocks} blocks, B from {blocks[:, 0].min():.2f} to {blocks[:, 0].max():.2f} deg")
print(f"read back: every point within {error:.1e} mm")

figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3.2))
left.plot(*path[:, :2].T, color=BLUE)
left.quiver(*path[::6, :2].T, *axes[::6, :2].T, color=ORANGE, scale=8, width=0.004)
left.set(aspect="equal", title="the tip, and where the axis leans", xlabel="x, mm", ylabel="y, mm")
right.plot(blocks[:, 0], color=ORANGE, label="B, deg")
right.plot(blocks[:, 1] / 10, color=BLUE, label="C, 10 deg")
right.set(title="the machine's axes", xlabel="block")
right.legend(frameon=False)
save(figure, "own_machine.png")
