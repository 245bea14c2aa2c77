"""Mill a dome on a plate out of a block: roughed in layers with a flat cutter, finished in rows with a ball.

Shows: plan.Setup, plan.rough, plan.finish, Setup.apply, plan.program, Operation.report, Program.write.
"""

import numpy as np
import riffler
from picture import BLUE, ORANGE, STEEL, View, plt, save
from riffler import plan

LOWER, UPPER = (0, 0, 0), (60, 44, 15)
plate = riffler.Volume.block(LOWER, (60, 44, 6), 0.25, "xyz")
part = riffler.Volume.sphere((30, 22, -4), 18, 0.25, "xyz", lower=LOWER, upper=UPPER)
part |= riffler.Volume.from_mesh(plate.to_mesh(), 0.25, "xyz", lower=LOWER, upper=UPPER)
setup = plan.Setup(part.to_mesh(tolerance=0.01), riffler.Volume.block(LOWER, UPPER, 0.25))

flat, ball = riffler.Tool.flat(diameter=8, length=25), riffler.Tool.ball(diameter=6, length=25)
roughing = plan.rough(setup, flat, stepdown=3, engagement=0.4, allowance=0.3, feed=1500)
setup.apply(roughing)
rough = setup.stock
finishing = plan.finish(setup, ball, cusp=0.02, tolerance=0.02, angle=0.5, slopes=(0, 1.2), feed=1500)
setup.apply(finishing)
program = plan.program(setup, [roughing, finishing])  # simulated: no rapid in material, no gouge, no collision
program.write("dome.ngc", post="3-axis")
for name, op, left in (("roughing", roughing, rough), ("finishing", finishing, setup.stock)):
    print(f"{name}: {op.report.time_s / 60:.1f} min, {op.report.cut_mm:.0f} mm cut, {left.volume:.0f} mm³ left")
print(f"widest cut {roughing.report.largest_engagement:.3f} of the diameter, 0.4 asked")

figure, columns = plt.subplots(1, 2, figsize=(9, 3.6))
for axes, stock, op, color in zip(columns, (rough, setup.stock), (roughing, finishing), (BLUE, ORANGE), strict=True):
    view = View(stock.to_mesh(tolerance=0.02), azimuth=-60, elevation=40)
    view.show(axes, STEEL)
    tips, cuts = op.poses[:, :3], op.kind == 2
    ends = np.flatnonzero(np.diff(np.r_[0, cuts, 0]))
    runs = [tips[max(first - 1, 0) : end] for first, end in zip(ends[::2], ends[1::2], strict=True)]
    lowest = min(run[-1, 2] for run in runs)
    for run in [run for run in runs if run[-1, 2] == lowest] if op is roughing else runs[::7]:
        view.line(axes, run, color)
columns[0].set_title("roughed: the rings of the lowest layer")
columns[1].set_title("finished: some of its rows")
save(figure, "rough_and_finish.png")
