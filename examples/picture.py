"""Pictures of meshes for the examples, rendered by Riffler: a volume of the turned mesh has one ray per pixel, and the
end of each ray is the surface that the viewer sees. Needs matplotlib."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import riffler
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize

CLAY, STEEL, INK = (0.80, 0.71, 0.60), (0.66, 0.72, 0.78), "#22262b"
BLUE, RED, GREEN, ORANGE = "#2f6690", "#c8553d", "#3f7d4f", "#d08c2a"
plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "text.color": INK})


class View:
    """A closed mesh seen from `azimuth` and `elevation` (degrees), `width` pixels wide."""

    def __init__(self, mesh, azimuth=-60.0, elevation=35.0, width=1200):
        a, e = np.radians([azimuth, elevation])
        right, towards = (-np.sin(a), np.cos(a), 0), (np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e))
        self.axes = np.array([right, np.cross(towards, right), towards]).T
        turned = riffler.Mesh(mesh.vertices @ self.axes, mesh.triangles)
        self.lower, upper = turned.bounds
        self.pitch = (upper[0] - self.lower[0]) / width
        counts, spans = riffler.Volume.from_mesh(turned, self.pitch, "z").intervals("z")
        last = np.cumsum(counts.ravel()).reshape(counts.shape) - 1
        self.depth = np.where(counts > 0, spans[np.maximum(last, 0), 1], np.nan)  # [column, row], mm towards the viewer

    def project(self, points):
        """(n, 2) places in the picture and (n,) whether the point is seen."""
        seen = np.asarray(points, float) @ self.axes
        pixel = np.clip(((seen - self.lower)[:, :2] / self.pitch).astype(int), 0, np.array(self.depth.shape) - 1)
        surface = np.nan_to_num(self.depth[tuple(pixel.T)], nan=-np.inf)
        return seen[:, :2], seen[:, 2] > surface - 4 * self.pitch

    def values(self, mesh, values):
        """An image of values at the mesh's vertices; pixels between vertices get the mean of the nearest values."""
        seen = mesh.vertices @ self.axes
        pixel = np.clip(((seen - self.lower)[:, :2] / self.pitch).astype(int), 0, np.array(self.depth.shape) - 1)
        near = seen[:, 2] > self.depth[tuple(pixel.T)] - 6 * self.pitch
        total, count = np.zeros(self.depth.shape), np.zeros(self.depth.shape)
        np.add.at(total, tuple(pixel[near].T), np.asarray(values, float)[near])
        np.add.at(count, tuple(pixel[near].T), 1)
        while (count[np.isfinite(self.depth)] == 0).any():
            total, count = (np.where(count > 0, image, blurred(image, 1)) for image in (total, count))
        return total / np.maximum(count, 1e-300)

    def shaded(self, colour=CLAY):
        """The image: light from the upper left, hollows darker, white around. `colour`: RGB, or one for each pixel."""
        step = np.diff(self.depth, axis=0, prepend=np.nan), np.diff(self.depth, axis=1, prepend=np.nan)
        slopes = []
        for axis, before in enumerate(step):  # take the smaller step of the two sides, so that edges stay sharp
            after = np.roll(before, -1, axis)
            take = np.abs(np.nan_to_num(after, nan=1e9)) < np.abs(np.nan_to_num(before, nan=1e9))
            slopes.append(np.nan_to_num(np.where(take, after, before)) / self.pitch)
        normal = np.stack([-slopes[0], -slopes[1], np.ones_like(self.depth)], -1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        light = np.clip(normal @ np.array([-0.44, 0.53, 0.72]), 0, 1)
        floor = np.nan_to_num(self.depth, nan=np.nanmin(self.depth))
        hollow = np.clip((blurred(floor, 12) - floor) / (40 * self.pitch), 0, 0.35)
        image = np.asarray(colour) * ((0.35 + 0.68 * light) * (1 - hollow))[..., None]
        return np.where(np.isnan(self.depth)[..., None], 1.0, np.clip(image, 0, 1))

    def show(self, ax, colour=CLAY, values=None, limits=(0, 1), cmap="RdBu"):
        """Draws the mesh; with `values`, an image of View.values, coloured by them. Returns what a colour bar needs."""
        scale = ScalarMappable(Normalize(*limits), cmap)
        if values is not None:
            colour = scale.to_rgba(values)[..., :3]
        n, m = (size // 2 * 2 for size in self.depth.shape)
        image = self.shaded(colour)[:n, :m].reshape(n // 2, 2, m // 2, 2, 3).mean((1, 3))
        far = self.lower[:2] + self.pitch * np.array([n, m])
        ax.imshow(image.transpose(1, 0, 2), origin="lower", extent=(self.lower[0], far[0], self.lower[1], far[1]))
        ax.set_axis_off()
        return scale

    def line(self, ax, points, colour=RED, width=1.6, **style):
        """Draws a line in space; what the mesh hides is thin."""
        place, seen = self.project(points)
        ax.plot(*place.T, color=colour, lw=0.5 * width, alpha=0.3, zorder=3)
        ax.plot(*np.where(seen[:, None], place, np.nan).T, color=colour, lw=width, zorder=4, **style)

    def label(self, ax, point, text, away=(0, 34)):
        """Names a point in space, with an arrow from the text, which is `away` points from it."""
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.5}
        place = self.project([point])[0][0]
        ax.annotate(text, place, away, textcoords="offset points", ha="center", bbox=box, zorder=5,
                    arrowprops={"arrowstyle": "->", "color": INK})  # fmt: skip


def blurred(image, radius):
    """The mean over squares of 2 · radius + 1 pixels."""
    for axis in (0, 1):
        padded = np.pad(image, [(radius + 1, radius) if k == axis else (0, 0) for k in (0, 1)], mode="edge")
        total = np.cumsum(padded, axis)
        size = 2 * radius + 1
        image = (np.take(total, range(size, total.shape[axis]), axis)
                 - np.take(total, range(total.shape[axis] - size), axis)) / size  # fmt: skip
    return image


def save(figure, name):
    """Writes the picture into the current folder."""
    figure.savefig(name, dpi=110, facecolor="white", bbox_inches="tight")
    plt.close(figure)
    print(f"{name} written")
