"""The solid that shows a tool: closed, and its triangles face outwards."""

import numpy as np
import pytest

from addon.common import tool_solid


def test_the_tool_that_is_shown_is_closed_and_outward():
    outline = [
        ("cutter", np.array([[0, 0], [3, 0], [3, 10], [0, 10]])),
        ("shank", np.array([[0, 10], [2, 10], [0, 12]])),
    ]
    vertices, triangles = tool_solid.solid(outline, sides=720)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(np.pi * (90 + 8 / 3), rel=1e-4)
    # the points on the axis exist once for each side: weld them
    place = np.unique(vertices.round(9), axis=0, return_inverse=True)[1].ravel()
    edges = place[triangles][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    assert sorted(map(tuple, edges)) == sorted(map(tuple, edges[:, ::-1]))
