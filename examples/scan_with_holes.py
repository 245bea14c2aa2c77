"""Make stock of a scan that is not closed: the volume closes its holes, and a report lists them.

Shows: Volume.from_mesh_with_report, Mesh.audit, Volume.sphere.
"""

import numpy as np
import riffler
from picture import CLAY, View, plt, save

# What a scanner gives of a ball of 20 mm: noise of 0.05 mm, and three holes.
R = 20.0
ball = riffler.Volume.sphere((0, 0, 0), R, 1.0, "xyz").to_mesh()
rng = np.random.default_rng(7)
outward = ball.vertices / np.linalg.norm(ball.vertices, axis=1)[:, None]
vertices = outward * (R + rng.normal(0, 0.05, (len(outward), 1)))
middle = outward[ball.triangles].mean(axis=1)
holes = np.array([(0.3, -0.8, 0.52), (0.9, -0.35, -0.2), (-0.4, -0.6, -0.69)])
holes /= np.linalg.norm(holes, axis=1)[:, None]
kept = ball.triangles[(middle @ holes.T < np.cos([0.30, 0.22, 0.16])).all(axis=1)]
scan = riffler.Mesh(vertices, kept)
scan.write("scan.stl")

stock, report = riffler.Volume.from_mesh_with_report(riffler.Mesh.read("scan.stl"), 0.25, "xyz")
print(f"scan: {report.openings} openings with {report.open_edges} open edges; "
      f"{report.doubtful_rays:.1%} of the rays end in one")  # fmt: skip
mesh = stock.to_mesh()
ball_volume = 4 / 3 * np.pi * R**3
print(f"stock: {stock.volume:.0f} mm³, {mesh.audit().open_edges} open edges; a perfect ball has {ball_volume:.0f}")

# The scan's own picture needs a body: each triangle gets a thickness of 0.4 mm.
inner = scan.vertices * (1 - 0.4 / R)
count = len(inner)
rims = np.sort(np.concatenate([kept[:, [0, 1]], kept[:, [1, 2]], kept[:, [2, 0]]]), axis=1)
edges, times = np.unique(rims, axis=0, return_counts=True)
a, b = edges[times == 1].T
walls = np.vstack([np.c_[a, b, b + count], np.c_[a, b + count, a + count]])
shell = riffler.Mesh(np.vstack([scan.vertices, inner]), np.vstack([kept, kept[:, ::-1] + count, walls]))
figure, axes = plt.subplots(1, 2, figsize=(7, 3.6))
for ax, body, title in zip(axes, (shell, mesh), ("the scan", "the stock"), strict=True):
    View(body, azimuth=-70, elevation=10, width=900).show(ax, CLAY)
    ax.set_title(title, loc="left")
save(figure, "scan_with_holes.png")
