"""The states of live sculpts, by the tokens that Blender's undo brings back. Volumes share the tiles that did not
change."""

from dataclasses import dataclass
from uuid import uuid4

import bpy
import riffler

from ..common.contents import Content, Snapshots
from . import persistence

SPARE = 2  # states beyond Blender's undo steps: the one that is shown, and the one before the first step

snapshots = Snapshots()


@dataclass
class State:
    content: Content
    shape: tuple  # of the mesh's lattice of bricks
    fillings: dict | None  # what the chunks showed; None: not known


def remember(state, token, before, shown):
    """Keeps a state under its token, or under a new one, in place of `before`, which was shown until now; returns the
    token. `shown`: those of all live sculpts, which stay however many there are."""
    token = token or uuid4().hex
    snapshots.most = bpy.context.preferences.edit.undo_steps + SPARE
    snapshots.hold(shown)
    snapshots.put(token, state, replaces=before)
    return token


def state_of(ob):
    """The state that the object's token names, or None. What memory does not have any more, a journal may tell."""
    token = ob.riffler.token
    state = snapshots.get(token)
    if state is None and token:
        content = persistence.told(token)
        if content is not None:
            tell(f"{ob.name}: the state was rebuilt from its journal")
            state = State(content, tuple(riffler.Mesher(content.volume).shape), None)
            snapshots.put(token, state)
    return state


def tell(message):
    """Shows a message in the panel (stock/recover_panel.py): outside of an operator there is no report line."""
    print(f"Riffler: {message}")
    bpy.context.window_manager.riffler.notice = message
