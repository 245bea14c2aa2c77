"""Verify a long program on a Dask cluster: the report has the same bytes as on one machine.

Shows: verify, cluster.verify with a Client of Dask, VerifyReport.findings. Needs pip install "riffler[cluster]".
"""

import time

import numpy as np
import riffler
from distributed import Client, LocalCluster
from picture import BLUE, ORANGE, View, plt, save

# A relief of waves, finished with a ball in 160 rows: 32 000 moves, and one rapid that is too low.
stock = riffler.Volume.block((0, 0, 0), (80, 60, 10), 0.2, "z")
ball = riffler.Tool.ball(4, 20)
x = np.linspace(-3, 83, 200)
rows = []
for k, y in enumerate(np.linspace(0, 60, 160)):
    z = 7 + 1.5 * np.sin(x / 6) * np.cos(y / 8)
    row = np.column_stack([x, np.full_like(x, y), z])
    rows.append(row if k % 2 == 0 else row[::-1])
tips = np.vstack(rows)
poses = np.hstack([tips, np.tile([0.0, 0.0, 1.0], (len(tips), 1))])
rapid = np.zeros(len(poses), bool)
rapid[16_100] = True
program = riffler.Program(poses, 1500.0, rapid=rapid, spindle=12000.0, line=np.arange(len(poses)) + 1, tools={1: ball})

start = time.perf_counter()
alone = riffler.verify(program, stock)
seconds = [time.perf_counter() - start]

# Here the workers are threads of this process. On a network, start `dask scheduler` and `dask worker` and pass the
# scheduler's address: riffler.cluster.verify(…, scheduler="tcp://192.168.1.10:8786").
workers = {"n_workers": 1, "threads_per_worker": 2, "processes": False, "dashboard_address": None}
with LocalCluster(**workers) as local, Client(local) as client:
    start = time.perf_counter()
    shared = riffler.cluster.verify(program, stock, scheduler=client)
    seconds.append(time.perf_counter() - start)

same = shared.volume.to_bytes() == alone.volume.to_bytes() and (shared.removed == alone.removed).all()
(finding,) = shared.findings
print(f"{len(poses) - 1} moves, {alone.removed.sum():.1f} mm³ removed; {finding.kind} in line {finding.line}")
print(f"the same on the cluster: {same}; {seconds[0]:.2f} s alone, {seconds[1]:.2f} s with a scheduler")

figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3.4), width_ratios=(2, 1))
view = View(shared.volume.to_mesh(), azimuth=-60, elevation=50)
view.show(left)
view.label(left, finding.point, f"{finding.kind}, line {finding.line}")
left.set_title("Stock after the cut", loc="left")
right.bar(("one machine", "cluster"), seconds, color=(BLUE, ORANGE), width=0.6)
right.set(title="s; a job this small is faster alone")
save(figure, "cluster_run.png")
