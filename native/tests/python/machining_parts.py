"""Random parts, stocks and tools for the stress of operations: terrains, booleans of boxes and balls, real models, and
scans with holes."""

import math
import os

import numpy as np
import riffler
from finish_judge import solid_under

MODELS = os.path.join(os.path.dirname(__file__), *[".."] * 4, "shared", "models")
LARGEST_MODEL = 4000  # triangles of a real model after decimation


def terrain(random):
    """A block whose top is a sum of waves, or terraces with steep walls between them."""
    n, size, height = int(random.integers(8, 22)), random.uniform(14, 24), random.uniform(1.5, 6)
    x = np.linspace(0, size, n)
    z = np.zeros((n, n))
    for k in range(1, 5):
        a, b, c = random.uniform(-1, 1, 3)
        z += np.sin(2 * math.pi * k * (a * x[:, None] + b * x[None, :]) / size + c) / k
    z = (z - z.min()) / (z.max() - z.min())
    if random.uniform() < 0.3:
        z = np.floor(3.99 * z) / 3
    return solid_under(x, 2 + height * z)


def box(low, high):
    """The triangles of a box."""
    x, y, z = np.meshgrid(*np.stack([low, high], 1), indexing="ij")
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return riffler.Mesh(
        np.stack([x, y, z], -1).reshape(-1, 3), [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    )


def bodies(random):
    """A plate with boxes and balls added and removed: with pockets, bosses, and overhangs."""
    size, top, pitch = random.integers(16, 25, 2), int(random.integers(3, 7)), 0.25
    frame = {"lower": (0, 0, 0), "upper": (*size, top + 5), "pitch": pitch, "directions": "xyz"}
    volume = riffler.Volume.from_mesh(box((0, 0, 0), (*size, top)), **frame)
    for _ in range(int(random.integers(2, 6))):
        centre = np.array([*random.uniform(2, size - 2), random.uniform(0.6 * top, top + 2)])
        if random.uniform() < 0.5:
            half = random.uniform(1, 5, 3)
            body = riffler.Volume.from_mesh(box(centre - half, centre + half), **frame)
        else:
            body = riffler.Volume.sphere(centre, random.uniform(1.5, 4.5), **frame)
        volume = volume | body if random.uniform() < 0.5 else volume - body
    return max(volume.parts(), key=lambda part: part.volume).to_mesh(tolerance=0.02)


def model(random):
    """A real model in a random orientation."""
    names = sorted(name for name in os.listdir(MODELS) if name.endswith(".stl"))
    mesh = riffler.Mesh.read(os.path.join(MODELS, names[int(random.integers(len(names)))]))
    if len(mesh.triangles) > LARGEST_MODEL:
        mesh = mesh.decimate(triangles=LARGEST_MODEL)
    q, r = np.linalg.qr(random.normal(size=(3, 3)))
    turn = q * np.sign(np.diag(r))
    turn[:, 0] *= np.sign(np.linalg.det(turn))
    points = np.asarray(mesh.vertices) @ turn.T
    lower, upper = points.min(axis=0), points.max(axis=0)
    scale = min(24 / (upper - lower)[:2].max(), 14 / (upper - lower)[2])
    return riffler.Mesh((points - lower) * scale, mesh.triangles)


def scan(random):
    """A sheet of triangles with noise and holes, as scanners make them."""
    n, size = int(random.integers(14, 26)), random.uniform(14, 22)
    x = np.linspace(0, size, n)
    gx, gy = np.meshgrid(x, x, indexing="ij")
    a, b = random.uniform(0.1, 0.4, 2)
    z = 3 + 1.5 * np.sin(a * gx) * np.cos(b * gy) + random.normal(scale=0.03, size=gx.shape)
    i, j = (k.ravel() for k in np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij"))
    first = i * n + j
    triangles = np.concatenate(
        [np.stack([first, first + n, first + n + 1], 1), np.stack([first, first + n + 1, first + 1], 1)]
    )
    keep = random.uniform(size=len(triangles)) > 0.03
    middles = np.stack([gx, gy], -1).reshape(-1, 2)[triangles].mean(axis=1)
    for _ in range(int(random.integers(1, 4))):
        keep &= np.linalg.norm(middles - random.uniform(0, size, 2), axis=1) > random.uniform(0.5, 3)
    return riffler.Mesh(np.stack([gx, gy, z], -1).reshape(-1, 3), triangles[keep])


KINDS = {"terrain": terrain, "bodies": bodies, "model": model, "scan": scan}


def kinds():
    """The kinds of parts that can be made here: real models need the folder of test parts."""
    return [name for name in KINDS if name != "model" or os.path.isdir(MODELS)]


def stock_around(part, random):
    """A block around the part, sometimes wider than it."""
    lower, upper = (np.array(corner) for corner in part.bounds)
    side = 0.0 if random.uniform() < 0.5 else random.uniform(0.5, 3)
    over = np.array([side, side, random.uniform(0.2, 1.5)])
    return riffler.Volume.block(lower - over * [1, 1, 0], upper + over, 0.4)


def random_tool(random, kind):
    """A cutter of Ø2.5 to 8 mm, some with a shank and a holder."""
    diameter, length = random.uniform(2.5, 8), random.uniform(20, 30)
    if kind == "ball":
        tool = riffler.Tool.ball(diameter, length)
    elif kind == "flat":
        tool = riffler.Tool.flat(diameter, length)
    elif kind == "fillet":
        tool = riffler.Tool.fillet(diameter, random.uniform(0.15, 0.45) * diameter, length)
    else:
        tip, angle = random.uniform(0.15, 0.35) * diameter, random.uniform(0.1, 0.3)
        length = max(length, 0.5 * diameter / math.tan(angle) + diameter)
        tool = riffler.Tool.taper(tip, angle, diameter, length)
    if random.uniform() < 0.4:
        shank = 0.5 * diameter * random.uniform(0.8, 1.3)
        tool = tool.with_shank([(length, shank, length + 10, shank)]).with_holder([(length + 10, 9, length + 40, 9)])
    return tool


TOOLS = ("ball", "flat", "fillet", "taper")
