"""Carve with a pen that feels the force, without the hardware: the simulated pen, in real time.

Shows: pen.open, Session with a Collider that keeps the tool out, Session.frame, Session.journal and Session.replay.
"""

import time
from pathlib import Path

import numpy as np
import riffler
from picture import BLUE, ORANGE, View, plt, save

with riffler.pen.open("simulated") as pen:
    while not pen.state().homed:
        time.sleep(0.01)
    home = pen.state().pose  # tip and axis; the block's top is 4 mm below it
    lower, upper = np.add(home[:3], [-20, -12, -16]), np.add(home[:3], [20, 12, -4])
    block = riffler.Volume.block(lower, upper, 0.5, "xyz")
    before = block.volume
    table_top = upper[2] - 2.5  # what the tool must not enter
    table = riffler.Volume.block(lower - [9, 9, 9], [*(upper[:2] + 9), table_top], 1.0).to_mesh()
    session = riffler.Session(
        block, riffler.Tool.ball(6, 40), pen, obstacles=riffler.Collider(table), at=home, stiffness=1.0,
        material=riffler.Material(removal_constant=0.004),  # N per mm³/s
    )  # fmt: skip
    for old in Path().glob("pen*.r*"):  # a session never writes over a recording
        old.unlink()
    session.journal("pen.rjournal")
    rows, state = [], ""
    with session:
        for t in np.arange(0, 3.0, 0.03):  # the hand goes down, twice across, each time deeper, and up again
            across = 14 * np.cos(2 * np.pi * t / 1.5)
            down = np.interp(t, [0.2, 0.5, 2.6, 2.8], [0, 6, 9, 0])
            pose = home + np.array([across, 2 * t - 3, -down, 0, 0, 0])
            pen.aim(pose, buttons=int(down > 2))  # button 1, held: the force is on, and the tool cuts
            time.sleep(0.03)
            frame = session.frame()
            rows.append(np.column_stack([frame.times, frame.poses[:, :3], frame.applied[:, :3]]))
        state = session.frame().state

times, tips, force = (part.squeeze() for part in np.split(np.concatenate(rows), [1, 4], axis=1))
again = riffler.Session.replay("pen.rjournal")
strongest = np.linalg.norm(force, axis=1).max()
print(f"{len(times)} steps, {before - block.volume:.1f} mm³ removed, force up to {strongest:.2f} N")
print(f"the hand pressed the tool {table_top - tips[:, 2].min():.3f} mm into the table; state {state}")
print(f"replayed from the journal, the same bytes: {again.to_bytes() == block.to_bytes()}")

figure, (above, below) = plt.subplots(2, 1, figsize=(7, 5.4), height_ratios=(2.6, 1.4))
view = View(block.to_mesh(), azimuth=-70, elevation=45)
view.show(above)
view.line(above, tips, BLUE, 0.8)
above.set_title("The block, and where the tool was", loc="left")
below.plot(times, tips[:, 2] - table_top, color=BLUE, label="tip above the table, mm")
below.plot(times, force[:, 2], color=ORANGE, label="force on the hand along z, N")
below.set(xlabel="time, s")
below.legend(frameon=False, ncols=2, loc="lower center", bbox_to_anchor=(0.5, 0.9))
save(figure, "simulated_pen.png")
