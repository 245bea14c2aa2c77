"""Geometry on the graphics card: uploaded once per signature, drawn as often as the view, with the GPU state restored.

Nothing here may run without a window: `gpu` is imported where it is used.
"""

from __future__ import annotations

from contextlib import contextmanager

import numpy as np

LIGHT = np.array([0.35, 0.45, 0.82])  # from over the right shoulder, so that arrows look round


class Batches:
    """Batches by name. A batch is rebuilt only when its signature changes; `built` counts rebuilds."""

    def __init__(self):
        self._kept = {}
        self.built = 0

    def get(self, name, signature, make):
        """`make()` returns (shader name, primitive kind, {attribute: array}). An empty array draws nothing."""
        kept = self._kept.get(name)
        if kept is None or kept[0] != signature:
            kept = self._kept[name] = (signature, _batch(*make()))
            self.built += 1
        return kept[1]

    def clear(self):
        self._kept.clear()


def _batch(shader, kind, arrays):
    import gpu
    from gpu_extras.batch import batch_for_shader

    if not len(arrays["pos"]):
        return None
    program = gpu.shader.from_builtin(shader)
    contiguous = {key: np.ascontiguousarray(value, np.float32) for key, value in arrays.items()}
    return program, batch_for_shader(program, kind, contiguous)


def flat(triangles):
    """Triangles (n, 3, 2 or 3) in one colour, which `draw` takes."""
    return "UNIFORM_COLOR", "TRIS", {"pos": np.asarray(triangles).reshape(-1, np.shape(triangles)[-1])}


def shaded(triangles, colour, towards):
    """Triangles (n, 3, 3), lighter where they face the light; `towards`: (3, 3) right, up and back of the view."""
    triangles = np.asarray(triangles)
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    light = 0.55 + 0.45 * np.clip(normal @ (LIGHT @ np.asarray(towards)), 0, 1)
    colours = np.ones((len(triangles), 3, 4))
    colours[:, :, :3] = light[:, None, None] * np.asarray(colour[:3])
    return "SMOOTH_COLOR", "TRIS", {"pos": triangles.reshape(-1, 3), "color": colours.reshape(-1, 4)}


def draw(batch, colour=None):
    """`colour`: for batches of one colour."""
    if batch is None:
        return
    program, triangles = batch
    program.bind()
    if colour is not None:
        program.uniform_float("color", colour)
    triangles.draw(program)


def draw_lines(batch, colour, width, size):
    """For batches of the shader POLYLINE_UNIFORM_COLOR. `width`, and `size` of the region: pixels."""
    if batch is None:
        return
    program, lines = batch
    program.bind()
    program.uniform_float("viewportSize", size)
    program.uniform_float("lineWidth", width)
    program.uniform_float("color", colour)
    lines.draw(program)


@contextmanager
def nearer(share=2e-4):
    """Context in which drawings win against others at the same depth, by a small share of the depth."""
    import gpu

    with gpu.matrix.push_pop_projection():
        matrix = gpu.matrix.get_projection_matrix()
        matrix[2] = matrix[2] - share * matrix[3]
        gpu.matrix.load_projection_matrix(matrix)
        yield


@contextmanager
def state(blend="ALPHA", depth="NONE", write=True):
    """Context that sets the GPU state for drawing and restores it afterwards. `write`: drawings write depth, so they
    hide later ones behind them."""
    import gpu

    before = gpu.state.blend_get(), gpu.state.depth_test_get(), gpu.state.depth_mask_get()
    gpu.state.blend_set(blend)
    gpu.state.depth_test_set(depth)
    gpu.state.depth_mask_set(write and depth != "NONE")
    try:
        yield
    finally:
        gpu.state.blend_set(before[0])
        gpu.state.depth_test_set(before[1])
        gpu.state.depth_mask_set(before[2])
