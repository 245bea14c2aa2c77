"""The tools' icons are those that tools/icons.py draws, in the form that Blender reads."""

import icons


def test_the_icons_are_what_their_script_draws():
    drawn = {f"{name}.dat": icons.encode(triangles) for name, triangles in icons.icons().items()}
    assert {p.name: p.read_bytes() for p in icons.FOLDER.iterdir()} == drawn
    for name, data in drawn.items():
        corners, rest = divmod(len(data) - 8, 18)
        assert data[:8] == b"VCO\0\xff\xff\0\0" and rest == 0 and corners > 100, name
