"""The states of live sculpts, by the tokens that Blender's undo restores. Volumes share unchanged tiles."""

from dataclasses import dataclass
from uuid import uuid4

import bpy
import riffler

from ..common.contents import Content, Snapshots
from . import persistence

SPARE = 2  # states beyond Blender's undo steps: the displayed one, and the one before the first step

snapshots = Snapshots()


@dataclass
class State:
    content: Content
    shape: tuple  # of the mesh's lattice of bricks
    fillings: dict | None  # contents of the chunks; None: unknown


def remember(state, token, before, shown):
    """Stores a state under its token, or under a new one, in place of `before`, the previously displayed one; returns
    the token. `shown`: tokens of all live sculpts, which are never dropped."""
    token = token or uuid4().hex
    snapshots.most = bpy.context.preferences.edit.undo_steps + SPARE
    snapshots.hold(shown)
    snapshots.put(token, state, replaces=before)
    return token


def state_of(ob):
    """The state of the object's token, or None. A state no longer in memory may be replayed from a journal."""
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
    """Shows a message in the panel (stock/recover_panel.py): outside an operator there are no reports."""
    print(f"Riffler: {message}")
    bpy.context.window_manager.riffler.notice = message
