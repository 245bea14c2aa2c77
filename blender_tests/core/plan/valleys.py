"""A path whose contacts are known in closed form."""

import numpy as np
import riffler


def valley(count, length):
    """Along x where the floor z = 0 meets the wall y = 0, a ball of 6 mm on the side of y < 0."""
    centres = np.c_[np.linspace(0, length, count), np.full(count, -3.0), np.full(count, 3.0)]
    contacts = np.stack([np.add(centres, (0, 3, 0)), np.subtract(centres, (0, 0, 3))], axis=1)
    normals = np.tile([(0.0, -1, 0), (0, 0, 1)], (count, 1, 1))
    return riffler.plan.PencilPath(3.0, centres, contacts, normals)
