"""Draws pictures for the set-up sheet: part and stock from one viewpoint, with paths. Needs matplotlib."""

from __future__ import annotations

import base64
import io
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .. import plan
from .._core import Mesh, Volume

INK = "#22262b"
STEEL, CLAY, GLASS = (0.66, 0.72, 0.78), (0.80, 0.71, 0.60), (0.62, 0.68, 0.62)
# Colours of the kinds of moves: rapid, lead, cut, link.
KINDS = ("#c8553d", "#d08c2a", "#2f6690", "#3f7d4f")
NAMES = ("rapid", "lead", "cut", "link")
PIXELS = 640
ROUNDING = 1e-5  # pixels: more than what is allowed for on a triangle's edges
LIGHT = np.array([-0.44, 0.53, 0.72])
SEGMENTS = 60_000  # largest number drawn of a path; more would differ by less than a pixel


class View:
    """A view of meshes from ``azimuth`` and ``elevation``, degrees, on one scale: the box of all meshes fills it."""

    def __init__(self, meshes: Sequence[Mesh], azimuth: float = -60.0, elevation: float = 38.0) -> None:
        a, e = np.radians([azimuth, elevation])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        towards = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        self.axes = np.array([right, np.cross(towards, right), towards]).T
        corners = np.concatenate([mesh.vertices for mesh in meshes]) @ self.axes
        low, high = corners.min(axis=0)[:2], corners.max(axis=0)[:2]
        self.pixel = float(max(high - low)) / PIXELS
        self.lower = low - 4 * self.pixel
        self.shape = tuple(int(n) + 8 for n in np.ceil((high - low) / self.pixel))

    def depth(self, mesh: Mesh) -> NDArray[np.float64]:
        """(columns, rows): coordinate of the mesh towards the viewer in each pixel, mm; -inf outside of the mesh."""
        out = np.full(self.shape, -np.inf)
        seen = mesh.vertices @ self.axes
        place = (seen[:, :2] - self.lower) / self.pixel
        corners, z = place[mesh.triangles], seen[:, 2][mesh.triangles]
        # The box of pixels whose centres a triangle can cover: none for most triangles smaller than a pixel.
        low = np.maximum(np.ceil(corners.min(axis=1) - 0.5 - ROUNDING).astype(int), 0)
        size = np.floor(corners.max(axis=1) - 0.5 + ROUNDING).astype(int) - low + 1
        edge1, edge2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        area = edge1[:, 0] * edge2[:, 1] - edge1[:, 1] * edge2[:, 0]
        # Draw triangles of similar size together, each over the pixels of its box.
        side = np.where((size > 0).all(axis=1), size.max(axis=1), 0)
        for level in range(int(np.ceil(np.log2(side.max(initial=1)))) + 1):
            width = 2**level
            which = np.flatnonzero((side <= width) & (side > width // 2) & (np.abs(area) > 1e-12))
            for some in np.array_split(which, max(1, len(which) * width * width // 2_000_000)):
                self._draw(out, some, width, low, corners, edge1, edge2, area, z)
        return out

    def _draw(self, out, some, width, low, corners, edge1, edge2, area, z) -> None:  # type: ignore[no-untyped-def]
        pixel = low[some, None] + np.arange(width)[:, None]  # (triangles, width, 2): columns and rows of the box
        rel = pixel + 0.5 - corners[some, None, 0]
        one, two = rel * edge1[some, None, ::-1], rel * edge2[some, None, ::-1]
        size = area[some, None, None]
        u = (two[:, :, None, 0] - two[:, None, :, 1]) / size
        v = (one[:, None, :, 1] - one[:, :, None, 0]) / size
        inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9)
        within = pixel < np.array(self.shape)
        inside &= within[:, :, None, 0] & within[:, None, :, 1]
        which, column, row = np.nonzero(inside)
        u, v, z = u[inside], v[inside], z[some][which]
        near = z[:, 0] + u * (z[:, 1] - z[:, 0]) + v * (z[:, 2] - z[:, 0])
        np.maximum.at(out.reshape(-1), pixel[which, column, 0] * self.shape[1] + pixel[which, row, 1], near)

    def shaded(self, depth: NDArray[np.float64], colour: NDArray[np.float64] | tuple) -> NDArray[np.float64]:
        """RGBA image with light from the upper left; transparent where there is nothing."""
        there = np.isfinite(depth)
        height = np.where(there, depth, np.nan)
        slopes = []
        for axis in (0, 1):  # the smaller of the steps on both sides keeps edges sharp
            before = np.diff(height, axis=axis, prepend=np.nan)
            after = np.roll(before, -1, axis)
            take = np.abs(np.nan_to_num(after, nan=1e9)) < np.abs(np.nan_to_num(before, nan=1e9))
            slopes.append(np.nan_to_num(np.where(take, after, before)) / self.pixel)
        normal = np.stack([-slopes[0], -slopes[1], np.ones_like(depth)], -1)
        normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
        light = 0.35 + 0.65 * np.clip(normal @ LIGHT, 0, 1)
        image = np.clip(np.asarray(colour) * light[..., None], 0, 1)
        return np.concatenate([image, there[..., None].astype(float)], -1)

    def show(self, axes: Axes, image: NDArray[np.float64]) -> None:
        far = self.lower + self.pixel * np.array(image.shape[:2])
        axes.imshow(image.transpose(1, 0, 2), origin="lower", extent=(self.lower[0], far[0], self.lower[1], far[1]))
        axes.set_aspect("equal")
        axes.set_axis_off()

    def places(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        return (np.asarray(points) @ self.axes)[:, :2]

    def at_vertices(self, mesh: Mesh, depth: NDArray[np.float64], values: NDArray[np.float64]) -> NDArray[np.float64]:
        """For each pixel of the mesh, the value of the nearest visible vertex."""
        seen = mesh.vertices @ self.axes
        pixel = np.clip(((seen[:, :2] - self.lower) / self.pixel).astype(int), 0, np.array(self.shape) - 1)
        near = seen[:, 2] > depth[tuple(pixel.T)] - 6 * self.pixel
        total, count = np.zeros(self.shape), np.zeros(self.shape)
        np.add.at(total, tuple(pixel[near].T), values[near])
        np.add.at(count, tuple(pixel[near].T), 1)
        for _ in range(64):
            empty = (count == 0) & np.isfinite(depth)
            if not empty.any():
                break
            total, count = (np.where(count > 0, one, _spread(one)) for one in (total, count))
        return total / np.maximum(count, 1e-300)


def _spread(image: NDArray[np.float64]) -> NDArray[np.float64]:
    """The sum over each pixel and its four neighbours."""
    padded = np.pad(image, 1)
    return image + padded[:-2, 1:-1] + padded[2:, 1:-1] + padded[1:-1, :-2] + padded[1:-1, 2:]


def mesh_of(stock: Volume) -> Mesh:
    """A mesh of a volume for pictures."""
    return stock.to_mesh(tolerance=stock.pitch / 4)


def draw_setup(view: View, part: Mesh, stock: Mesh, fixtures: Sequence[Mesh], zero: NDArray[np.float64]) -> str:
    """The part in its stock, with fixtures and the program's zero, as PNG in base64."""
    figure, axes = _figure()
    depth = view.depth(stock)
    clear = view.shaded(depth, STEEL)
    inside = view.shaded(view.depth(part), CLAY)
    view.show(axes, _over(clear * [1, 1, 1, 0.42], inside))
    for one in fixtures:
        view.show(axes, view.shaded(view.depth(one), GLASS))
    size = 0.12 * PIXELS * view.pixel
    for k, name in enumerate("xyz"):
        ends = view.places(np.array([zero, zero + size * np.eye(3)[k]]))
        axes.annotate(name, ends[0], ends[1], arrowprops={"arrowstyle": "<-", "color": INK, "lw": 1.2}, color=INK)
    axes.plot(*view.places(zero[None])[0], "o", color=INK, ms=4)
    return _png(figure)


def draw_operation(view: View, left: Mesh, op: plan.Operation) -> str:
    """The stock after an operation, with the operation's path coloured by kind of move, as PNG in base64."""
    figure, axes = _figure()
    view.show(axes, view.shaded(view.depth(left), STEEL))
    draw_path(view, axes, op)
    return _png(figure)


def draw_path(view: View, axes: Axes, op: plan.Operation) -> None:
    from matplotlib.collections import LineCollection

    places = view.places(op.poses[:, :3])
    lines = np.stack([places[:-1], places[1:]], axis=1)
    kinds = op.kind[1:]
    for kind in (2, 3, 1, 0):
        some = lines[kinds == kind]
        some = some[:: max(1, len(some) // SEGMENTS)]
        width, alpha = (0.25, 0.5) if kind == 0 else (0.35 if kind == 2 else 0.6, 1.0)
        axes.add_collection(LineCollection(list(some), colors=KINDS[kind], linewidths=width, alpha=alpha))
    present = [kind for kind in range(4) if (kinds == kind).any()]
    handles = [axes.plot([], [], color=KINDS[kind], lw=1.5)[0] for kind in present]
    axes.legend(handles, [NAMES[kind] for kind in present], loc="lower left", fontsize=7, frameon=False, ncols=4)
    axes.autoscale_view()


def draw_deviation(view: View, mesh: Mesh, distance: NDArray[np.float64], scale: float) -> str:
    """The remaining stock, coloured by its distance from the part: blue for rest material, red for gouges."""
    figure, axes = _figure()
    depth = view.depth(mesh)
    values = view.at_vertices(mesh, depth, np.nan_to_num(distance, posinf=scale, neginf=-scale))
    colours = ScalarMappable(Normalize(-scale, scale), "RdBu")
    view.show(axes, view.shaded(depth, colours.to_rgba(values)[..., :3]))
    bar = figure.colorbar(colours, ax=axes, shrink=0.6, pad=0.02)
    bar.set_label("mm over the part (blue) and under it (red)", fontsize=7)
    bar.ax.tick_params(labelsize=7)
    return _png(figure)


def _over(top: NDArray[np.float64], below: NDArray[np.float64]) -> NDArray[np.float64]:
    alpha = top[..., 3:] + below[..., 3:] * (1 - top[..., 3:])
    colour = top[..., :3] * top[..., 3:] + below[..., :3] * below[..., 3:] * (1 - top[..., 3:])
    return np.concatenate([colour / np.maximum(alpha, 1e-12), alpha], -1)


def _figure() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    axes = figure.add_subplot()
    axes.set_axis_off()
    return figure, axes


def _png(figure: Figure) -> str:
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=130, facecolor="white", bbox_inches="tight", metadata={"Software": None})
    return base64.b64encode(data.getvalue()).decode()
