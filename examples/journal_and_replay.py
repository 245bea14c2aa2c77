"""Record strokes in a journal, undo one, and carve the same volume again from the file, to the bit.

Shows: Journal.set_stock, add_tool, add_stroke, undo, save, load, replay and program.
"""

import numpy as np
import riffler
from picture import BLUE, GREEN, ORANGE, View, plt, save

LOWER, UPPER, PITCH = (0, 0, 0), (70, 50, 12), 0.25
tools = {1: riffler.Tool.ball(6, 30), 2: riffler.Tool.flat(4, 30)}
block = riffler.Volume.block(LOWER, UPPER, PITCH, "xyz")
journal = riffler.Journal()
journal.set_stock(LOWER, UPPER, PITCH, "xyz")
for number, tool in tools.items():
    journal.add_tool(number, tool)


def stroke(number, x, y, depth, seconds):
    """Carves and records one stroke along points of the block's top."""
    tips = np.column_stack([x, y, 12 - depth + 0 * x])
    poses = np.hstack([tips, np.tile([0.0, 0.0, 1.0], (len(x), 1))])
    cut = block.carve(tools[number], poses)
    removed = np.concatenate([[0], cut.removed])
    journal.add_stroke(number, poses, times=np.linspace(0, seconds, len(x)), removed=removed)
    return poses


t = np.linspace(0, 2 * np.pi, 200)
lines = [stroke(1, 35 + 22 * np.sin(2 * t), 25 + 15 * np.sin(3 * t), 2.5, seconds=6.0)]
lines.append(stroke(2, 8 + 54 * t / t[-1], 6 + 0 * t, 2, seconds=2.0))
kept = block.copy()
lines.append(stroke(2, 35 + 20 * np.cos(t), 25 + 20 * np.sin(t), 5, seconds=3.0))
journal.undo()  # undo: the last stroke no longer counts
journal.save("strokes.rjournal")

read = riffler.Journal.load("strokes.rjournal")
again = read.replay()
program = read.program(spindle=12000)  # feeds follow from the recorded times
program.write("strokes.ngc", post="3-axis")
print(f"{len(read.strokes)} strokes, {sum(map(len, read.strokes))} rows, {len(program)} rows of NC code")
print(f"replayed {again.volume:.3f} mm³, the same bytes: {again.to_bytes() == kept.to_bytes()}")

figure, ax = plt.subplots(figsize=(7, 4.4))
view = View(again.to_mesh(), azimuth=-65, elevation=50)
view.show(ax)
for poses, colour in zip(lines, (BLUE, GREEN, ORANGE), strict=True):
    view.line(ax, poses[:, :3] + [0, 0, 6], colour, 1)
ax.set_title("The replayed block, strokes 6 mm above it; the undone one is orange", loc="left")
save(figure, "journal_and_replay.png")
