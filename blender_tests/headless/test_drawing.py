"""Drawings over the 3D view, as numbers: force and torque with their gauges, the contact at a device's tool."""

from types import SimpleNamespace

import bpy
import numpy as np

from support import common, plans


def force():
    return common.part("sculpt.force_view")


def shown(size, moment):
    """At (1, 2, 3) mm in a sculpt that is turned by 90° about z, at 10 mm a Blender unit; limits 3 N and 24 N·mm."""
    turned = np.array([[0, -0.1, 0, 0], [0.1, 0, 0, 0], [0, 0, 0.1, 0], [0, 0, 0, 1.0]])
    made = force().Shown(3.0, 8.0, np.array([1, 2, 3, 0, 0, 1.0]), to_world=turned)
    made.force, made.torque = np.array([size, 0, 0]), np.array([0, 0, moment])
    return made


def test_arrows_are_as_long_as_force_and_torque_and_red_beyond_their_limits():
    module, tip, pixel = force(), np.array([-0.2, 0.1, 0.3]), 0.01
    assert module.arrows(shown(0, 0), pixel) == []
    for size, moment in ((1.5, 6), (3, 24), (3.1, 25), (300, 2500)):
        straight, bent = module.arrows(shown(size, moment), pixel)
        points = straight[0].reshape(-1, 3) - tip
        length = module.LENGTH * pixel * min(size / 3, 1)
        assert abs(points[:, 1].max() - length) < 1e-9 and abs(points[:, 1].min()) < 0.1 * length  # x, turned by 90°
        assert straight[1] == (module.FORCE if size <= 3 else module.BEYOND)
        assert bent[1] == (module.TORQUE if moment < 24 else module.BEYOND)
        around = bent[0].reshape(-1, 3) - tip
        assert np.hypot(around[:, 0], around[:, 1]).max() < module.LENGTH * pixel  # about z, next to the other


def test_gauges_show_force_and_torque_and_mark_both_limits():
    module = force()
    for size, moment in ((0, 0), (1.25, 10), (4, 30)):
        first, second = module.gauges(shown(size, moment))
        assert (first.value, first.limit, second.value, second.limit) == (size, 3, moment, 24)
        assert first.title == f"{size:g} N" and second.title == f"{moment:g} N·mm"
        assert first.high >= 3.75 and second.high >= 30  # there is room above the mark
        assert first.fill[:3] == (module.FORCE if size <= 3 else module.BEYOND)
        assert second.fill[:3] == (module.TORQUE if moment <= 24 else module.BEYOND)


def test_the_contact_at_a_device_s_tool_is_the_nearest_within_its_diameter():
    ob = plans.on_timeline(mm_per_unit=10.0)
    drawing, sessions = common.part("plan.path_view"), common.part("pen.session")
    contacts = [path.contacts.reshape(-1, 3) for path in common.part("plan.plan_store").plan(ob).paths]
    mm = common.part("blender.scene_units").mm_per_unit(bpy.context.scene)
    to_world = np.diag([1 / mm] * 3 + [1.0])  # a sculpt at the origin
    assert drawing.at_tool(bpy.context) is None  # no device session
    rng = np.random.default_rng(3)
    try:
        for _ in range(50):
            path = rng.integers(len(contacts))
            tip = contacts[path][rng.integers(len(contacts[path]))] + rng.normal(0, 3, 3)
            run = SimpleNamespace(pose=np.array([*tip, 0, 0, 1.0]))
            live = SimpleNamespace(to_world=to_world)
            sessions.running = SimpleNamespace(run=run, live=live, diameter=6.0, contact=None)
            gaps = [np.linalg.norm(c - tip, axis=1) for c in contacts]
            least, found = min(g.min() for g in gaps), drawing.at_tool(bpy.context)
            assert (found is None) == (least > 6)
            if found is not None:
                assert abs(np.linalg.norm(found.point - tip) - least) < 1e-9
                assert abs(gaps[found.path].min() - least) < 1e-9 and abs(np.linalg.norm(found.normal) - 1) < 1e-9
                assert np.argmin(gaps[found.path]) // 2 == found.index
    finally:
        sessions.running = None
