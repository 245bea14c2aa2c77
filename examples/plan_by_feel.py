"""Plan by feel: a pen turns the tool on its path, beside a clamp that the hand cannot push it through.

Shows: OrientSession, its keys and frames, plan.cutter_locations, Program.from_cl, verify.
"""

import time

import numpy as np
import riffler
from picture import BLUE, ORANGE, RED, STEEL, View, plt, save
from riffler import plan, shape

# A plate with a wall, and a clamp beside their inner edge.
outline = np.array([(-40, 0), (0, 0), (0.01, 22), (16, 22)])
top = np.array([[(x, y, z) for y, z in outline] for x in (0.0, 60.0)])
part = shape.slab(top, top * [1, 1, 0] - [0, 0, 8])
clamp = riffler.Volume.block((22, -34, 0), (36, -11, 26), 0.5, "xyz")
room = riffler.Volume.block((21, -35, 0), (37, -10, 27), 0.5, "xyz")  # the hand feels the clamp 1 mm early
tool = riffler.Tool.ball(diameter=6, length=16).with_shank([(16, 2.5, 30, 2.5)]).with_holder([(30, 9, 60, 11)])
felt, collider = (riffler.Collider(part, fixtures=[block]) for block in (room, clamp))
edge = plan.pencil(part, tool)[0].divided(1.0)

with riffler.pen.open("simulated") as pen:
    while not pen.state().homed:
        time.sleep(0.01)
    home = pen.state().pose
    session = riffler.OrientSession(edge, tool, felt, pen, axis=home[3:], ramp=0.2)
    rows, wishes = [], []
    start = edge.centres[0, 0]
    direction = np.sign(edge.centres[-1, 0] - start)
    with session:
        for t in np.arange(0, 9.0, 0.03):  # along the edge; before, at and behind the clamp the hand leans to its side
            along = np.interp(t, [0.8, 8.5], [2, 56])
            lean = np.interp(along, [2, 8, 15, 22, 28, 31, 37, 44, 52], [0, 0.6, 0.6, 0.1, 0.6, 0.6, 0.1, 0.6, 0.6])
            axis = np.array([0, -np.sin(lean), np.cos(lean)])
            press = np.abs(along - np.array([10, 20.5, 29.5, 38.5, 50])).min() < 0.5  # button 1 sets a key
            pen.aim(np.r_[home[:3] + direction * np.array([along, 0, 0]), axis], buttons=int(press))
            time.sleep(0.03)
            frame = session.frame()
            rows.append(np.column_stack([frame.stations, frame.poses, frame.forces[:, 3:], frame.depth]))
            wishes.append((frame.station, lean))
    path = session.path

stations, poses, torque, depth = (part_.squeeze() for part_ in np.split(np.concatenate(rows), [1, 7, 10], axis=1))
lean = np.degrees(np.arcsin(-poses[:, 4]))
strongest = np.linalg.norm(torque, axis=1).max()
at_clamp = np.abs(edge.centres[np.round(stations).astype(int), 0] - 29) < 3
print(f"{len(session.keys)} keys; the hand leans {np.degrees(0.6):.1f} degrees, at the clamp the tool {lean[at_clamp].max():.1f}")
print(f"torque up to {strongest:.0f} N·mm, the tool at most {depth.max():.2f} mm deep")

rows_, report = plan.cutter_locations(path, tool, collider)
program = riffler.Program.from_cl([rows_], tools=[tool], feed=600, spindle=12000, collider=collider)
program.write("by_feel.ngc", post="linuxcnc-xyzac", options={"rot_point": (0, 0, -40)}, collider=collider)
stock = riffler.Volume.from_mesh(part, 0.5, "xyz")
found = riffler.verify(program, stock, part_mesh=part, fixtures=[clamp])
print(f"by_feel.ngc: lifted at {len(report.lifted)} points; verified: {found.passed}")

scene = riffler.Volume.block((0, -40, -8), (60, 16, 26), 0.25, "xyz") - riffler.Volume.block((0, -40, 22), (60, 16, 26), 0.25)
figure, (above, below) = plt.subplots(2, 1, figsize=(7, 6), height_ratios=(2.6, 1.2))
view = View(scene.to_mesh(), azimuth=-115, elevation=38)
view.show(above, STEEL)
for point in range(0, len(path), 3):
    key = point in session.keys
    view.line(above, path.centres[point] + np.outer([0, 34], path.axes[point]), RED if key else BLUE, 2 if key else 0.8)
above.set_title("Tool axes beside the clamp; red: keys set with the pen's button", loc="left")
below.plot(stations, lean, color=BLUE, label="the tool leans, degrees")
below.plot(*np.degrees(np.array(wishes) * [[np.pi / 180, 1]]).T, color=ORANGE, label="the hand, degrees")
below.set(xlabel="point of the path")
below.legend(frameon=False, ncols=2)
save(figure, "plan_by_feel.png")
