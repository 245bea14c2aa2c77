"""Brushes with falloff on the material: clay, inflate, flatten, grab, snake hook, crease and scrape, side by side.

Shows: Volume.brush with strokes of dabs, riffler.falloff, Brushed.
"""

import numpy as np
import riffler
from picture import INK, View, plt, save

UP = (0.0, 0.0, 1.0)
RADIUS, TOP = 7.0, 14.0
volume = riffler.Volume.block((0, 0, 0), (128, 40, 26), pitch=0.25, directions="xyz")
volume.carve(riffler.Tool.flat(400, 60), [(x, 20, TOP, 0, 0, 1) for x in (60, 61)])  # room for what is added
groove = riffler.Tool.ball(2, 30)
for y in range(4, 38, 4):  # grooves that show how the surface moves
    volume.carve(groove, [(-3, y, TOP - 0.5, 0, 0, 1), (131, y, TOP - 0.5, 0, 0, 1)])
start = volume.volume


def stroke(x, height=TOP, count=40):
    """Dabs along y."""
    return np.array([(x, y, height, *UP) for y in np.linspace(10, 30, count)])


# One dab of clay on the plain part of the lid adds its amount times the falloff's integral over the disc.
single = riffler.Volume.block((0, 0, 0), (30, 30, 20), 0.25, "xyz")
single.carve(riffler.Tool.flat(100, 60), [(15, 15, 10, 0, 0, 1), (16, 15, 10, 0, 0, 1)])
dab = single.brush("clay", [(15, 15, 10, *UP)], RADIUS, amount=1.0)
print(f"one dab of clay: {dab.added:.2f} mm³ added")

made = {
    "clay": volume.brush("clay", stroke(10), RADIUS, amount=0.2),
    "inflate": volume.brush("inflate", stroke(28), RADIUS, amount=0.15, falloff="sphere"),
    "scrape": volume.brush("scrape", stroke(46), RADIUS, strength=0.6),
    "fill": volume.brush("fill", stroke(64), RADIUS, strength=0.6),
    "grab": volume.brush("grab", [(82, 18, TOP, *UP), (82, 23, TOP + 7, *UP)], RADIUS),
    "snake hook": volume.brush(
        "snake_hook", [(100, 14 + 0.5 * k, TOP + 0.45 * k, *UP) for k in range(18)], RADIUS, strength=0.9
    ),
    "crease": volume.brush("crease", stroke(118), RADIUS, strength=0.08, amount=-4, falloff="sharp"),
}
change = sum(effect.added - effect.removed for effect in made.values())
print(f"volume {volume.volume - start:+.2f} mm³, the brushes report {change:+.2f} mm³")
audit = volume.to_mesh().audit()
print(f"open edges {audit.open_edges}, clipped {any(effect.clipped for effect in made.values())}")

figure, ax = plt.subplots(figsize=(10, 4.2))
view = View(volume.to_mesh(), azimuth=-84, elevation=44)
view.show(ax)
for name, x in zip(made, (10, 28, 46, 64, 82, 100, 118), strict=True):
    place, _ = view.project([(x, -4, 0)])
    ax.text(place[0][0], place[0][1] - 5, name, ha="center", color=INK)
save(figure, "brushes.png")
