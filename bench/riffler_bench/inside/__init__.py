"""Scripts that Blender's own Python runs, each by its path, in a window or without: the add-on's side in ``stroke.py``
and ``planning.py``, Blender's in ``sculpt_mode.py``, both in ``export.py`` and ``booleans.py``."""
