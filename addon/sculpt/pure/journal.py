"""The journal of a session at one sculpt: a folder with its strokes, written one by one, and their initial state.

Its purpose is recovery after a crash. During the session the strokes' file is locked (flock), so an unlocked journal
belongs to a Blender that has died. A stroke is written carve by carve: a crash loses only what the hand did since the
last one.
"""

from __future__ import annotations

import json
import os
import shutil
import time
import uuid
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import riffler
from riffler import files

from ...common import json_object
from ...common.contents import Content
from ...common.job import Cut
from .. import brushes
from ..brushes.brush import Brush
from . import sculpt_payload

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None
    import msvcrt

STROKES, STOCK, MASK, CUTS, ABOUT = "strokes.rjournal", "stock.rvol", "mask.rvol", "cuts", "about.json"
STATES = "states"  # of a session's journal: a line for each state, with its number of strokes and its token
# Modes of the strokes that a device's session writes, and the mode of the equivalent brush.
OF_SESSIONS = {"beside": "remove", "build": "add"}
FAR = 1 << 30
PROBLEMS = (OSError, RuntimeError, ValueError)


class StrokeJournal:
    """Begins with `content`, the state `token`, which nothing changes any more. OSError, RuntimeError if it cannot be
    written.

    `identity` is the id under which the file has `content`, or "". `about`, a dictionary of strings, is stored with it.
    A subclass writes the strokes.
    """

    def __init__(self, root: Path, content: Content, token: str, identity: str = "", about: dict | None = None):
        self.folder = root / uuid.uuid4().hex
        self.base, self.first = identity, token
        self.ended = ""  # the id under which the file has its result, once it is known
        self._tokens, self._counts, self._at = [token], [0], 0  # number of strokes of each state
        self._open = 0  # strokes of the file that belong to the stroke in progress
        self._saving: list = []  # tasks
        self.whole = True  # whether all of it can be replayed
        self.problem = ""
        self.folder.mkdir(parents=True)
        try:
            about = {"began": time.time(), "token": token, "base": identity, **(about or {})}
            (self.folder / ABOUT).write_text(json.dumps(about))
            if content.cuts or content.shaped:
                (self.folder / CUTS).write_bytes(sculpt_payload.encode(b"", content.cuts, shaped=content.shaped))
            self._begin(content)
        except BaseException:
            shutil.rmtree(self.folder, ignore_errors=True)
            raise

    def finish(self, token: str) -> None:
        """The stroke has ended, and made this state."""
        count = self._counts[self._at] + self._open
        del self._tokens[self._at + 1 :], self._counts[self._at + 1 :]
        self._tokens.append(token)
        self._counts.append(count)
        self._at, self._open = self._at + 1, 0

    @property
    def token(self) -> str:
        """The state that its strokes make."""
        return self._tokens[self._at]

    def settled(self) -> bool:
        """Whether its initial state is in its folder."""
        while self._saving and self._saving[0].done():
            try:
                self._saving.pop(0).result()
            except PROBLEMS as error:
                self.problem = self.problem or str(error)
        return not self._saving

    def state(self, token: str) -> Content | None:
        """The content of a state made here, by replay; None if it is unknown. ValueError, OSError."""
        if token not in self._tokens or not self.whole:
            return None
        for task in self._saving:
            task.result()
        return replay(self.folder, self._counts[self._tokens.index(token)])


class LiveJournal(StrokeJournal):
    """The journal of strokes that are carved here, piece by piece."""

    def _begin(self, content: Content) -> None:
        self._tools: dict[str, int] = {}
        self._writer = riffler.JournalWriter(self.folder / STROKES, keep=False)
        v, mask = content.volume, MASK if content.mask is not None else ""
        self._writer.set_stock(v.lower, v.upper, v.pitch, v.directions, snapshot=STOCK, mask=mask)
        self._saving = [riffler.submit(riffler.Volume.save, v, self.folder / STOCK)]
        if mask:
            self._saving.append(riffler.submit(riffler.Volume.save, content.mask, self.folder / MASK))

    # ------------------------------------------------------------------ strokes
    def carved(self, tool: dict, poses: np.ndarray, mode: str, token: str, strength: float = 0.5, **options) -> None:
        """Records that the poses, each a move (poses.moving), were carved in one call, towards the state `token`;
        `strength`, `options`: Brush.options."""
        if brushes.of_journal(mode) is None:
            self.whole = False
            return
        text = json.dumps(tool, sort_keys=True)
        if text not in self._tools and self._write(lambda: self._writer.add_tool(len(self._tools) + 1, tool)):
            self._tools[text] = len(self._tools) + 1
        number = self._tools.get(text)
        if len(poses) and self._write(
            lambda: self._writer.add_stroke(number, poses, mode=mode, name=token, strength=strength, **options)
        ):
            self._open += 1

    def cancel(self) -> None:
        if self._open:
            self._write(lambda: self._writer.undo(self._open))
            self._open = 0

    def go(self, token: str) -> bool:
        """The state is `token` again. False if this journal does not know it."""
        if token not in self._tokens:
            return False
        self.cancel()
        at = self._tokens.index(token)
        n = self._counts[at] - self._counts[self._at]
        if n < 0:
            self._write(lambda: self._writer.undo(-n))
        elif n > 0:
            self._write(lambda: self._writer.redo(n))
        self._at = at
        return True

    def _write(self, call) -> bool:
        """Writes to the file. A journal that cannot be written must not stop the hand: it reports the error, and writes
        no more, so that what is written can be replayed."""
        if self.problem:
            return False
        try:
            call()
        except PROBLEMS as error:
            self.problem = str(error)
        return not self.problem

    # ------------------------------------------------------------------ files
    def sync(self) -> None:
        self._write(self._writer.sync)

    def delete(self) -> None:
        """Deletes the journal, which is no longer needed."""
        for task in self._saving:
            task.cancel()
        self._saving.clear()
        self._writer.close()
        shutil.rmtree(self.folder, ignore_errors=True)


class SessionJournal(StrokeJournal):
    """The journal of strokes that a device's session, not started yet, writes by itself. This class counts them."""

    def __init__(self, session, *args, **more):
        self._session, self._lock = session, None
        super().__init__(*args, **more)

    def _begin(self, content: Content) -> None:
        self._session.journal(self.folder / STROKES)

    def made(self, strokes: int) -> None:
        """Counts further strokes of the file, towards the next state."""
        self._open += strokes
        self.problem = self._session.journal_problem or ""

    def finish(self, token: str) -> None:
        super().finish(token)
        try:
            with (self.folder / STATES).open("a") as file:
                file.write(f"{self._counts[self._at]} {token}\n")
        except OSError as error:
            self.problem = self.problem or str(error)

    def go(self, token: str) -> bool:
        """The session is in the state `token` again, and its file records that. False if this journal does not
        know it."""
        if token not in self._tokens:
            return False
        self._at, self._open = self._tokens.index(token), 0
        return True

    def state(self, token: str) -> Content | None:
        return super().state(token) if self._session.journal_written() else None

    def stopped(self) -> None:
        """The session writes no more: locks the file, so that no other Blender takes it for an abandoned one."""
        self._lock = Lock(self.folder)

    def sync(self) -> None:
        """Does nothing: the session syncs once a second."""

    def delete(self) -> None:
        """Deletes the journal, which is no longer needed."""
        shutil.rmtree(self.folder, ignore_errors=True)
        if self._lock is not None:
            self._lock.release()


def write_recording(folder: Path, path: Path, notes: dict[str, str]) -> None:
    """Writes the journal of a session, without undone strokes, to a file of the user's, with its stock next to it.
    OSError, ValueError."""
    journal, out = riffler.Journal.load(folder / STROKES), riffler.Journal()
    if not journal.strokes:
        return
    for key, value in {**journal.notes, **notes}.items():
        out.add_note(key, value)
    stock, names = journal.stock, {}
    for what, name in (("stock", stock.snapshot), ("mask", stock.mask)):
        names[what] = f"{path.stem}-{what}.rvol" if name else ""
        if name:
            shutil.copyfile(folder / name, path.with_name(names[what]))
    out.set_stock(stock.lower, stock.upper, stock.pitch, stock.directions, snapshot=names["stock"], mask=names["mask"])
    for number, tool in journal.tools.items():
        out.add_tool(number, tool)
    for stroke in journal.strokes:
        add_again(out, stroke)
    out.save(path)


def add_again(out: riffler.Journal, stroke, **changed) -> None:
    """Adds a stroke of another journal, with everything it has except what `changed` names."""
    kept = ("poses", "times", "tolerance", "name", "forces", "removed", "mode", "strength", "amount", "falloff")
    out.add_stroke(stroke.tool, **{name: getattr(stroke, name) for name in kept} | changed)


# ---------------------------------------------------------------------- after a crash
@dataclass
class FoundJournal:
    """A journal that no process holds."""

    folder: Path
    about: dict

    @property
    def name(self) -> str:
        return str(self.about.get("name", "")) or self.folder.name

    when: float  # of its last stroke, s since 1970


def crashed(root: Path) -> list[FoundJournal]:
    """The newest first. Unreadable ones are left out, not deleted."""
    found = []
    try:
        folders = [path for path in root.iterdir() if (path / STROKES).is_file()]
    except OSError:
        return []
    for folder in folders:
        lock = Lock(folder)
        if lock.held:
            lock.release()
            found.append(FoundJournal(folder, about(folder), (folder / STROKES).stat().st_mtime))
    return sorted(found, key=lambda f: f.when, reverse=True)


def about(folder: Path) -> dict:
    try:
        return json_object.loads(files.read(folder / ABOUT), ABOUT)
    except ValueError:
        return {}


def _hold(file: int) -> None:
    """Locks the file until it is closed, or its process has died. OSError if another process holds it."""
    if fcntl is not None:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    # Windows also prevents others from reading locked bytes: so lock one byte far behind the end, which is allowed.
    # Untested.
    os.lseek(file, FAR, os.SEEK_SET)
    msvcrt.locking(file, msvcrt.LK_NBLCK, 1)


class Lock:
    """A lock on a journal's strokes, like the writer's; `held` if no other process has it."""

    def __init__(self, folder: Path):
        self.folder, self._file = folder, -1
        try:
            self._file = os.open(folder / STROKES, os.O_RDONLY)
            _hold(self._file)
        except OSError:
            self.release()

    @property
    def held(self) -> bool:
        return self._file >= 0

    def release(self) -> None:
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def delete(self) -> None:
        """Deletes the journal and everything in its folder."""
        shutil.rmtree(self.folder)
        self.release()


def part_of(folder: Path, count: int | None = None) -> tuple[riffler.Journal, list[Cut]]:
    """The journal in `folder`, or its first `count` strokes, and all cuts up to there. ValueError names its problem,
    OSError what cannot be read."""
    journal = riffler.Journal.load(folder / STROKES)
    extra = 0 if count is None else len(journal.strokes) - count
    if extra > 0:
        journal.undo(extra)
    elif extra < 0:  # undone strokes
        journal.redo(-extra)
    return journal, _before(folder)[0] + cuts_of(journal)


def shaped(folder: Path, journal: riffler.Journal) -> bool:
    """Whether other operations than cuts have shaped the journal's state, too (Content.shaped)."""
    return _before(folder)[1] or any(brush_of(stroke).shapes for stroke in journal.strokes)


def _before(folder: Path) -> tuple[list[Cut], bool]:
    """Cuts of the state that the journal in `folder` begins with, and whether other operations have shaped it."""
    if not (folder / CUTS).exists():
        return [], False
    _, cuts, _, by_others = sculpt_payload.decode((folder / CUTS).read_bytes())
    return cuts, by_others


def states(folder: Path, about: dict, journal: riffler.Journal) -> list[str]:
    """Tokens: of the journal's initial state, and of the states after each stroke; "" where no state ended."""
    out = [about.get("token", ""), *(stroke.name for stroke in journal.strokes)]
    try:
        lines = (folder / STATES).read_text().splitlines()
    except OSError:
        return out
    for line in lines:  # the last line counts: strokes may have been undone, and replaced by others
        count, _, token = line.partition(" ")
        if count.isdigit() and int(count) < len(out):
            out[int(count)] = token
    return out


def brush_of(stroke) -> Brush:
    """A brush that makes such strokes of a riffler.Journal; one without cuts if there is none."""
    if stroke.mode == brushes.of("hand").journal and stroke.poses.shape[1] == 9:
        return brushes.of("hand")
    return brushes.of_journal(OF_SESSIONS.get(stroke.mode, stroke.mode)) or Brush()


def cuts_of(journal: riffler.Journal) -> list[Cut]:
    """The strokes that shape the material, with the pieces of a stroke joined. Those of symmetric copies stay
    separate."""
    cuts: list[Cut] = []
    rows: dict[tuple, list[np.ndarray]] = {}
    tools, masked = journal.tools, bool(journal.stock and journal.stock.mask)
    for stroke in journal.strokes:
        brush = brush_of(stroke)
        masked |= brush.protects
        if not brush.cuts:
            continue
        poses = stroke.poses
        key = (stroke.name, stroke.tool, brush.cuts, masked)
        open_ones = rows.setdefault(key, [])
        for k, before in enumerate(open_ones):
            if np.array_equal(before[-1], poses[0]):
                open_ones[k] = np.vstack([before, poses[1:]])
                break
        else:
            open_ones.append(poses)
    for (_, tool, mode, beside), strokes in rows.items():
        cuts += [Cut(tools[tool], poses, mode=mode, masked=beside) for poses in strokes]
    return cuts


def replay(folder: Path, count: int | None = None) -> Content:
    """The result of the first `count` strokes of the journal in `folder`, or of all of them."""
    journal, cuts = part_of(folder, count)
    volume, mask = journal.replay_with_mask(folder)
    return Content(volume, cuts, mask, shaped(folder, journal))
