"""Plan a pencil cut: the path on which a ball cutter touches both walls of a valley, and its NC code.

Shows: plan.pencil, PencilPath.orient, plan.cutter_locations, Program.from_cl, Program.write.
"""

import numpy as np
import riffler
from picture import BLUE, RED, STEEL, View, plt, save
from riffler import plan, shape

# A die: two walls that meet in a valley, whose bottom goes up and down in a wave. 90 degrees between the walls.
x, y = np.meshgrid(np.linspace(0, 80, 161), np.linspace(-20, 20, 81), indexing="ij")
top = np.stack([x, y, np.abs(y) + 4 * np.sin(2 * np.pi * x / 80)], -1)
part = shape.slab(top, top * [1, 1, 0] - [0, 0, 12])

ball = riffler.Tool.ball(diameter=6, length=30).with_holder([(30, 10, 50, 12)])
paths = plan.pencil(part, ball, tolerance=0.01)
path = max(paths, key=lambda one: one.length)
# On each wall the ball touches R = 3 mm from its centre.
reach = np.linalg.norm(path.contacts - path.centres[:, None], axis=2)
print(f"{len(paths)} path, {path.length:.2f} mm long, {len(path)} points")
top_centre = path.centres[:, 2].max()
print(f"centre to contact {reach.min():.4f} to {reach.max():.4f} mm; highest centre z {top_centre:.3f}")

# The tool leans along the path: forwards at the beginning, upright in the middle. Where it would gouge it is lifted.
angles = {0: -0.3, len(path) // 2: 0.0, len(path) - 1: 0.3}  # rad, by the point of the path
lean = path.orient({point: (np.sin(a), 0, np.cos(a)) for point, a in angles.items()})
collider = riffler.Collider(part)
poses, report = plan.cutter_locations(lean, ball, collider)
program = riffler.Program.from_cl([poses], tools=[ball], feed=800, spindle=12000, collider=collider)
written = program.write("pencil.ngc", post="tcp", collider=collider)
print(f"pencil.ngc: {written.blocks} blocks, free of gouges: {report.ok}")

figure, ax = plt.subplots(figsize=(7, 4.4))
view = View(part, azimuth=-50, elevation=48)
view.show(ax, STEEL)
for side in (0, 1):
    view.line(ax, path.contacts[:, side] + 0.05 * path.normals[:, side], BLUE)
view.line(ax, path.centres, RED)
for tip_x, tip_y, tip_z, *axis in poses[:: len(poses) // 12]:
    view.line(ax, np.array([tip_x, tip_y, tip_z]) + np.outer([3, 15], axis), RED, 1)
ax.set_title("Ball centres and tool axes (red), contacts with both walls (blue)", loc="left")
save(figure, "pencil_cut.png")
