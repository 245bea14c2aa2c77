"""Bytes inside the .blend, in packed images.

A packed image is the only datablock with bytes that survives every version, undo, save and reopening without being
doubled or truncated. The datablock that points to an image owns it; the image goes when its owner goes.
"""

import bpy
from riffler import files

IDENTITY = "riffler_content"  # on the image: the hash of its packed bytes


def new(name):
    """A new image for the data of `name`. Blender does not list a name that starts with a dot among images to choose
    from."""
    return bpy.data.images.new(f".riffler {name}", 1, 1)


def write(image, block, identity):
    image.pack(data=block, data_len=len(block))
    image[IDENTITY] = identity


def identity(image):
    """The hash of the packed bytes, or "" if there are none."""
    return image.get(IDENTITY, "") if image else ""


def read(image, what):
    """The bytes. ValueError, which names `what`, if they are missing."""
    if image.packed_file:
        return bytes(image.packed_file.data)
    # File > External Data > Unpack wrote the bytes to a file.
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        return files.read(path)
    except ValueError as error:
        raise ValueError(f"{what}'s data is not in this .blend, and not at {path}: {error}") from error
