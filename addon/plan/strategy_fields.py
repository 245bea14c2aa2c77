"""Blender fields for the strategies, made from riffler.plan.STRATEGIES: one for the choice, one for each parameter."""

from bpy.props import EnumProperty, IntProperty
from riffler.plan import STRATEGIES

from ..blender.fields import angle, length, stored_number
from ..common import units

# its fields have no prefix: scripts and files used them before there were other strategies
FIRST = next(iter(STRATEGIES))


def _entries(choices):
    return [(value.upper(), label, about, "NONE", stored_number(value)) for value, label, about in choices]


def identifier(strategy, parameter):
    """Name of a parameter's field, such as `tolerance` or `engrave_depth`."""
    return parameter.key if strategy.id == FIRST else f"{strategy.id}_{parameter.key}"


def _field(parameter):
    about, default = parameter.help, parameter.default or 0
    how = {"name": parameter.label, "description": about}
    if parameter.choices:
        return EnumProperty(items=_entries(parameter.choices), default=default.upper(), **how)
    if not parameter.unit:
        return IntProperty(default=default, min=int(parameter.low), max=int(parameter.high), **how)
    if parameter.unit == "rad":
        return angle(parameter.label, default, about, parameter.low, parameter.high)
    return length(parameter.label, default, about, parameter.low, parameter.high)


def choice(**how):
    """The field of the strategy itself."""
    return EnumProperty(
        name="Strategy",
        items=_entries([(s.id, s.label, s.description) for s in STRATEGIES.values()]),
        default=FIRST.upper(),
        description="How paths are found on the part",
        **how,
    )


FIELDS = {"strategy": choice()} | {identifier(s, p): _field(p) for s in STRATEGIES.values() for p in s.parameters}


def chosen(settings):
    """The riffler.plan.Strategy chosen in `settings`."""
    return STRATEGIES[settings.strategy.lower()]


def shown(settings):
    """Names of the fields of the chosen strategy."""
    return [identifier(chosen(settings), p) for p in chosen(settings).parameters]


def options(settings):
    """The chosen strategy's options, as riffler.plan.find takes them."""
    strategy = chosen(settings)
    return {p.key: _value(p, getattr(settings, identifier(strategy, p))) for p in strategy.parameters}


def _value(parameter, value):
    if parameter.choices:
        return value.lower()
    if parameter.default is None and not value:
        return None
    return value if not parameter.unit else units.clean(value)
