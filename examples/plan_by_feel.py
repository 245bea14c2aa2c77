"""Plan by feel: a pen turns the tool on its path, past a clamp that the hand cannot push it through.

Shows: OrientSession, its keys and frames, plan.cutter_locations, Program.from_cl, verify.
"""

import time

import numpy as np
import riffler
from picture import BLUE, ORANGE, RED, STEEL, View, plt, save
from riffler import plan, shape

# A plate with a wall, and a clamp near their inner edge.
top = np.array([[(x, y, z) for y, z in ((-40, 0), (0, 0), (0.01, 22), (16, 22))] for x in (0.0, 60.0)])
part = shape.slab(top, top * [1, 1, 0] - [0, 0, 8])
clamp = riffler.Volume.block((22, -34, 0), (36, -11, 26), 0.5, "xyz")
room = riffler.Volume.block((21, -35, 0), (37, -10, 27), 0.5, "xyz")  # the hand feels the clamp 1 mm early
tool = riffler.Tool.ball(diameter=6, length=16).with_shank([(16, 2.5, 30, 2.5)]).with_holder([(30, 9, 60, 11)])
felt, collider = (riffler.Collider(part, fixtures=[block]) for block in (room, clamp))
edge = plan.pencil(part, tool)[0].divided(1.0)

with riffler.pen.open("simulated") as pen:
    time.sleep(0.2)  # it homes itself
    home = pen.state().pose
    session = riffler.OrientSession(edge, tool, felt, pen, axis=home[3:], ramp=0.2)
    rows, wishes = [], []
    with session:
        for t in np.arange(0, 6.0, 0.03):  # along the edge; before, at and behind the clamp the hand leans to its side
            along = np.interp(t, [0.6, 5.7], [2, 56])
            lean = np.interp(along, [2, 8, 15, 22, 28, 31, 37, 44, 52], [0, 0.6, 0.6, 0.1, 0.6, 0.6, 0.1, 0.6, 0.6])
            press = np.abs(along - np.array([10, 20.5, 29.5, 38.5, 50])).min() < 0.5  # button 1 sets a key
            pen.aim(np.r_[np.add(home[:3], [along, 0, 0]), 0, -np.sin(lean), np.cos(lean)], buttons=int(press))
            time.sleep(0.03)
            frame = session.frame()
            rows.append(np.column_stack([frame.stations, frame.poses, frame.forces[:, 3:], frame.depth]))
            wishes.append((frame.station, lean))
    path = session.path

stations, poses, torque, depth = (column.squeeze() for column in np.split(np.concatenate(rows), [1, 7, 10], axis=1))
lean = np.degrees(np.arcsin(-poses[:, 4]))
at_clamp = (stations > 26) & (stations < 32)
print(f"{len(session.keys)} keys; the hand leans 34.4 degrees, at the clamp the tool {lean[at_clamp].max():.1f}")
deep = np.quantile(depth, 0.99)  # a step that a busy machine delays has a loose bound
print(f"torque up to {abs(torque).max():.0f} N·mm, the tool at most {deep:.2f} mm deep in 99 % of the steps")

cl, report = plan.cutter_locations(path, tool, collider, tolerance=0.03)
program = riffler.Program.from_cl([cl], tools=[tool], feed=600, spindle=12000, collider=collider)
program.write("by_feel.ngc", post="linuxcnc-xyzac", options={"rot_point": (0, 0, -40)}, collider=collider)
found = riffler.verify(program, riffler.Volume.from_mesh(part, 0.5, "xyz"), part_mesh=part, fixtures=[clamp])
print(f"by_feel.ngc: lifted at {len(report.lifted)} points; verified: {found.passed}")

vise = clamp.to_mesh()
corners, triangles = np.r_[vise.vertices, part.vertices], np.r_[vise.triangles, part.triangles + len(vise.vertices)]
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 6), height_ratios=(2.6, 1.2))
view = View(riffler.Mesh(corners, triangles), azimuth=-125, elevation=60)
view.show(above, STEEL)
for point in sorted({*range(0, len(path), 2), *session.keys}):
    style = (RED, 2) if point in session.keys else (BLUE, 0.8)
    view.line(above, path.centres[point] + np.outer([0, 34], path.axes[point]), *style)
above.set_title("Tool axes past the clamp; red: keys set with the pen's button", loc="left")
below.plot(stations, lean, color=BLUE, label="the tool leans, degrees")
below.plot(*np.degrees(np.array(wishes) * [[np.pi / 180, 1]]).T, color=ORANGE, label="the hand, degrees")
below.legend(title="by the point of the path", frameon=False, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1))
save(figure, "plan_by_feel.png")
