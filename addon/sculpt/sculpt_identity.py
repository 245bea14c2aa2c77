"""Finds a live sculpt's object in the file."""

from . import sculpt_store, sculpts


class SculptIdentity:
    """The identity of the sculpt `ob`, which has a mark (sculpts.new_mark)."""

    def __init__(self, ob):
        self.mark, self.name, self.mm = ob.riffler.mark, ob.name, sculpts.shown_mm_per_unit(ob.data)
        self._contents = {sculpt_store.identity(ob.data)}  # content ids under which the file has states of this session

    def written(self, ob):
        """The file has another state of this session."""
        self._contents.add(sculpt_store.identity(ob.data))

    @property
    def object(self):
        """The sculpt, as long as nothing else has changed it; otherwise None."""
        ob = sculpts.marked(self.mark, self.name)
        if ob is None or not ob.users or sculpt_store.identity(ob.data) not in self._contents:
            return None
        self.name = ob.name
        return ob
