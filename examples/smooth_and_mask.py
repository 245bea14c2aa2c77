"""Smooth a carved surface with a round brush, and protect a part of it with a mask.

Shows: Volume.carve, Volume.cylinder as a mask, Volume.smooth with protect.
"""

import numpy as np
import riffler
from picture import BLUE, RED, View, plt, save

# Rows of a ball cutter 4 mm apart leave ridges of about 0.7 mm on a block.
LOWER, UPPER, PITCH = (0, 0, 0), (60, 40, 10), 0.4
block = riffler.Volume.block(LOWER, UPPER, PITCH, "xyz")
ball = riffler.Tool.ball(6, 30)
for y in np.arange(-2, 45, 4.0):
    block.carve(ball, [[-5, y, 7, 0, 0, 1], [65, y, 7, 0, 0, 1]])
before = block.copy()

# The mask is a volume on the same grid: what lies in it stays, material and air. Here it is a cylinder in the middle.
mask = riffler.Volume.cylinder((30, 20, 5), 11, 30, PITCH, "xyz", lower=LOWER, upper=UPPER)
x, y = np.meshgrid(np.arange(8, 53, 3.0), np.arange(8, 33, 3.0))
dabs = np.column_stack([x.ravel(), y.ravel(), np.full(x.size, 7.3)])
for _ in range(3):
    block.smooth(dabs, radius=5, strength=1.0, protect=mask)


def heights(volume):
    """Upper ends of the z rays, mm."""
    counts, spans = volume.intervals("z")
    return spans[np.cumsum(counts.ravel()) - 1, 1].reshape(counts.shape)


old, new = heights(before), heights(block)
i, j = np.meshgrid(*((np.arange(n) + 0.5) * PITCH for n in old.shape), indexing="ij")
masked = np.hypot(i - 30, j - 20) < 11
free = (np.hypot(i - 30, j - 20) > 17) & (np.abs(i - 30) < 18) & (np.abs(j - 20) < 9)
print(f"ridges {np.ptp(old[free]):.3f} mm high before, {np.ptp(new[free]):.3f} mm after, "
      f"change under the mask {np.abs(new - old)[masked].max():.3f} mm")  # fmt: skip

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.4), height_ratios=(3, 1))
View(block.to_mesh(), azimuth=-62, elevation=45).show(above)
above.set_title("Smoothed, but for the masked disc", loc="left")
below.plot(j[30], old[30], color=RED, lw=1, label="before")
below.plot(j[30], new[30], color=BLUE, label="after")
below.set(xlabel="y, mm, on the line x = 12 mm", ylabel="height, mm")
below.legend(frameon=False, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))
save(figure, "smooth_and_mask.png")
