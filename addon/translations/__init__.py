"""The interface in other languages: <code of the language>.json has what is said in English, and how it is there.

Blender looks in the table for labels, tooltips and why a button is grey; for what it does not look up itself, reports
and lines that are wrapped, there is `local`. What is not in the table stays English. A message that has numbers or
names in it is made when it is said, and stays English, too.

Blender asks its own catalogue first, where Pitch is a slope and Path belongs to a file. So the add-on's classes and
fields have a context of their own, given to them as they are registered (versions.own_words).
"""

import json
from pathlib import Path

import bpy

CLASSES = ()
FOLDER = Path(__file__).resolve().parent
CONTEXT = "Riffler"
CONTEXTS = ("*", "Operator", CONTEXT)  # tooltips have none


def table():
    """As bpy.app.translations.register takes it."""
    found = {}
    for path in sorted(FOLDER.glob("*.json")):
        texts = json.loads(path.read_text(encoding="utf-8"))
        found[path.stem] = {(context, text): said for text, said in texts.items() for context in CONTEXTS}
    return found


def local(text):
    """A fixed text in the interface's language."""
    return bpy.app.translations.pgettext_iface(text) if text else text


def attach():
    bpy.app.translations.register(__name__, table())


def detach():
    bpy.app.translations.unregister(__name__)
