"""Bytes inside the .blend, in packed images.

Of all datablocks that hold bytes, a packed image is the one that survives every version, undo, save and reopening
without being doubled or cut short. Who points to an image owns it; it goes when its owner goes.
"""

import bpy
from riffler import files

IDENTITY = "riffler_content"  # on the image: the hash of what is packed in it


def new(name):
    """An image for what belongs to `name`. A name with a dot in front is not listed among images to choose from."""
    return bpy.data.images.new(f".riffler {name}", 1, 1)


def write(image, block, identity):
    image.pack(data=block, data_len=len(block))
    image[IDENTITY] = identity


def identity(image):
    """The hash of what is packed, or "" where there is nothing."""
    return image.get(IDENTITY, "") if image else ""


def read(image, what):
    """The bytes; `what` they are of is for the ValueError where they are gone."""
    if image.packed_file:
        return bytes(image.packed_file.data)
    # File > External Data > Unpack wrote it to a file of its own.
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        return files.read(path)
    except ValueError as error:
        raise ValueError(f"{what}'s data is not in this .blend, and not at {path}: {error}") from error
