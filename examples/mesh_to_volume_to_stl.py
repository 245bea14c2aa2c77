"""Make a dexel volume of a mesh, cut it, and write a closed STL file: 3D printing, milling, or the next program.

Shows: Mesh, Volume.from_mesh, Volume.cylinder, set operators, Volume.to_mesh, Mesh.audit, Mesh.write.
"""

import numpy as np
import riffler
from picture import STEEL, View, plt, save

PITCH = 0.4  # mm between rays
R, r = 20.0, 8.0  # mm, of the ring


def ring(around=160, across=64):
    """A torus around z as a mesh."""
    u, v = np.meshgrid(np.arange(around), np.arange(across), indexing="ij")
    a, b = 2 * np.pi * u / around, 2 * np.pi * v / across
    points = np.stack([(R + r * np.cos(b)) * np.cos(a), (R + r * np.cos(b)) * np.sin(a), r * np.sin(b)], -1)

    def number(i, j):
        return (i % around) * across + j % across

    corners = number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)
    a, b, c, d = (corner.ravel() for corner in corners)
    return riffler.Mesh(points.reshape(-1, 3), np.concatenate([np.c_[a, b, c], np.c_[a, c, d]]))


LOWER, UPPER = (-30, -30, -10), (30, 30, 10)
volume = riffler.Volume.from_mesh(ring(), PITCH, "xyz", lower=LOWER, upper=UPPER)
print(f"volume of the ring {volume.volume:.1f} mm³")

# Six bores along z. Volumes on the same grid are joined (|), subtracted (-) and intersected (&) exactly.
for angle in np.arange(6) * np.pi / 3:
    centre = (R * np.cos(angle), R * np.sin(angle), 0)
    volume -= riffler.Volume.cylinder(centre, 3.0, 40.0, PITCH, "xyz", lower=LOWER, upper=UPPER)

mesh = volume.to_mesh().decimate(tolerance=0.01)
mesh.write("ring.stl")
audit = riffler.Mesh.read("ring.stl").audit()
print(f"ring.stl: {len(mesh.triangles)} triangles, {mesh.volume:.1f} mm³, {audit.open_edges} open edges")

figure, ax = plt.subplots(figsize=(7, 4.2))
View(riffler.Mesh.read("ring.stl"), azimuth=-65, elevation=40).show(ax, STEEL)
ax.set_title("The ring with its bores, from the STL file", loc="left")
save(figure, "mesh_to_volume_to_stl.png")
