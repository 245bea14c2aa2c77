"""The interface in other languages: <language code>.json maps English texts to translated ones.

Blender looks up labels, tooltips and reasons for disabled buttons in the table; `local` translates what Blender does
not look up, reports and wrapped lines. Texts missing from the table stay English. A message with numbers or names in it
is built at run time, and stays English, too.

Blender first consults its own catalogue, where Pitch is a slope and Path belongs to a file. So the add-on's classes and
fields have a context of their own, set when they are registered (versions.own_words).
"""

import json
from pathlib import Path

import bpy

CLASSES = ()
FOLDER = Path(__file__).resolve().parent
CONTEXT = "Riffler"
CONTEXTS = ("*", "Operator", CONTEXT)  # tooltips have none


def table():
    """In the form of bpy.app.translations.register."""
    found = {}
    for path in sorted(FOLDER.glob("*.json")):
        texts = json.loads(path.read_text(encoding="utf-8"))
        found[path.stem] = in_contexts(texts)
    return found


def in_contexts(texts):
    """{(context, text): translation} from {text: translation}."""
    return {(context, text): said for text, said in texts.items() for context in CONTEXTS}


def local(text):
    """A fixed text in the interface's language."""
    return bpy.app.translations.pgettext_iface(text) if text else text


def attach():
    bpy.app.translations.register(__name__, table())


def detach():
    bpy.app.translations.unregister(__name__)
