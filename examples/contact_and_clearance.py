"""Hold a tool against a part and a fixture: the distance to them, and the force that pushes it out where it enters.

Shows: Collider, Collider.clearance, Collider.query, Collider.nearest, a tool with shank and holder.
"""

import numpy as np
import riffler
from picture import BLUE, ORANGE, RED, STEEL, View, plt, save

# A plate up to z = 0 with a ball of 12 mm radius on it, around the origin, and a clamp at the far end.
LOWER, UPPER = (-40, -20, -10), (50, 20, 14)
part = riffler.Volume.sphere((0, 0, 0), 12, 0.5, "xyz", lower=LOWER, upper=UPPER)
part |= riffler.Volume.cylinder((0, 0, -5), 60, 10, 0.5, "xyz", lower=LOWER, upper=UPPER)
clamp = riffler.Volume.block((38, -8, 0), (50, 8, 20), 0.5, "xyz")
collider = riffler.Collider(part.to_mesh(), fixtures=[clamp])

tool = riffler.Tool.ball(diameter=8, length=20).with_shank([(20, 4, 24, 6)]).with_holder([(24, 12, 40, 14)])
x = np.linspace(-36, 40, 153)
poses = np.column_stack([x, 0 * x, np.full_like(x, 4.0), 0 * x, 0 * x, np.ones_like(x)])  # tip, axis

clearance = collider.clearance(tool, poses)  # to the part alone, mm; negative inside
contacts = [collider.query(tool, pose) for pose in poses]  # part and fixture
force = np.array([contact.force for contact in contacts])
for name, place in (("far from the ball", -30.0), ("near it", -17.0), ("in it", -12.0), ("at the clamp", 36.0)):
    k = np.abs(x - place).argmin()
    distance, _, member = collider.nearest(tool, poses[k])
    print(f"x {x[k]:.1f}, {name}: part {clearance[k]:.3f} mm, nearest {distance:.3f} mm ({member}), "
          f"force {np.linalg.norm(force[k]):.1f} N")  # fmt: skip

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.4), height_ratios=(2.4, 1.6))
scene = part.to_mesh()
both = riffler.Mesh(np.vstack([scene.vertices, clamp.to_mesh().vertices]),
                    np.vstack([scene.triangles, clamp.to_mesh().triangles + len(scene.vertices)]))  # fmt: skip
view = View(both, azimuth=-75, elevation=35)
view.show(above, STEEL)
view.line(above, poses[:, :3], RED)
view.label(above, (0, 0, 12), "ball on the part", (0, 16))
view.label(above, (44, 0, 20), "clamp", (0, 16))
below.axhline(0, color="k", lw=0.6)
below.plot(x, clearance, color=BLUE, label="clearance to the part, mm")
below.plot(x, np.linalg.norm(force, axis=1) / 100, color=ORANGE, label="force, 100 N")
below.set(xlabel="x of the tip, mm", xlim=(x[0], x[-1]))
below.legend(frameon=False)
save(figure, "contact_and_clearance.png")
