"""Carve a groove with a ball cutter, and compute the force of every move from the material that it removes.

Shows: Volume.block, Tool.ball, Volume.carve with times, Cut.removed and Cut.force.
"""

import numpy as np
import riffler
from picture import BLUE, ORANGE, View, plt, save

FEED = 10.0  # mm/s
block = riffler.Volume.block((0, 0, 0), (80, 40, 15), pitch=0.2, directions="xyz")
ball = riffler.Tool.ball(diameter=8, length=30)

# A straight groove 2 mm deep for 40 mm, then a wave that goes down to 5 mm.
x = np.linspace(-6, 86, 461)
depth = 2 + 3 * np.clip((x - 40) / 30, 0, 1)
tips = np.column_stack([x, 20 + 8 * np.clip((x - 40) / 10, 0, 1) * np.sin((x - 40) / 5), 15 - depth])
poses = np.hstack([tips, np.tile([0.0, 0.0, 1.0], (len(x), 1))])  # tip and axis; the axis points to the spindle

way = np.linalg.norm(np.diff(tips, axis=0), axis=1)
cut = block.carve(ball, poses, dt=way / FEED, removal_constant=0.05)  # N per mm³/s
force = np.linalg.norm(cut.force, axis=1)

# Where the groove is straight, a circle's segment moves along: the area is known.
straight = (x[1:] > 15) & (x[1:] < 35)
area = cut.removed[straight].sum() / way[straight].sum()
print(f"removed {cut.removed.sum():.1f} mm³, section of the straight groove {area:.3f} mm²")
print(f"force {force[straight].mean():.3f} N in the straight groove, {force.max():.3f} N at most")

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.6), height_ratios=(3, 1.3))
view = View(block.to_mesh(), azimuth=-70, elevation=50)
view.show(above)
above.set_title("What is left of the block", loc="left")
below.plot(x[1:], force, color=BLUE)
below.plot(x[1:], depth[1:], color=ORANGE)
below.text(20, force[straight].mean() + 0.4, "force, N", color=BLUE)
below.text(46, 0.9, "depth, mm", color=ORANGE)
below.set(xlabel="x of the tip, mm", xlim=(-6, 86), ylim=(0, None))
save(figure, "carve_and_force.png")
