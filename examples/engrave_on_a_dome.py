"""Engrave a curve on a curved surface to a constant depth, with the tool's axis following the surface.

Shows: shape.slab for a part of heights, plan.engrave, Volume.from_mesh, Volume.carve, Program.from_cl.
"""

import numpy as np
import riffler
from picture import RED, STEEL, View, plt, save
from riffler import plan, shape

R, DEPTH = 60.0, 0.6  # mm

# The part: a dome, a piece of a ball of 60 mm radius.
x, y = np.meshgrid(np.linspace(-36, 36, 181), np.linspace(-26, 26, 131), indexing="ij")
top = np.stack([x, y, np.sqrt(R**2 - x**2 - y**2) - R], -1)
part = shape.slab(top, top * [1, 1, 0] - [0, 0, 25])

# The curves: a spiral and a wave, above the dome; they are projected to its nearest points.
t = np.linspace(0, 1, 400)
angle = 6 * np.pi * t
spiral = np.column_stack([-14 + 13 * t * np.cos(angle), 13 * t * np.sin(angle), np.zeros(400)])
wave = np.column_stack([3 + 26 * t, 8 * np.sin(4 * np.pi * t), np.zeros(400)])
ball = riffler.Tool.ball(diameter=2, length=12).with_shank([(12, 1, 14, 3), (14, 3, 40, 3)])
lines = plan.engrave([spiral, wave], ball, part, depth=DEPTH, reach=30.0)

volume = riffler.Volume.from_mesh(part, 0.2, "xyz")
before = volume.volume
for line in lines:
    volume.carve(ball, line.poses)
program = riffler.Program.from_cl([line.poses for line in lines], tools=[ball], feed=600, spindle=18000)
program.write("engraving.ngc", post="tcp")

tips = np.vstack([line.poses for line in lines])
below = R - np.linalg.norm(tips[:, :3] + [0, 0, R], axis=1)  # under the ball that the dome is a piece of
leaning = np.degrees(np.arccos(tips[:, 5]).max())
print(f"{len(lines)} lines, {len(tips)} points; tips {below.min():.3f} to {below.max():.3f} mm deep")
print(f"{before - volume.volume:.2f} mm³ removed; the axis leans by up to {leaning:.1f} deg")

figure, ax = plt.subplots(figsize=(7, 4.4))
view = View(volume.to_mesh(), azimuth=-68, elevation=48)
view.show(ax, STEEL)
for line in lines:
    for pose in line.poses[:: len(line.poses) // 14]:
        view.line(ax, pose[:3] + np.outer([1, 7], pose[3:]), RED, 1)
ax.set_title("Engraved 0.6 mm deep; the tool's axis (red) follows the surface", loc="left")
save(figure, "engrave_on_a_dome.png")
