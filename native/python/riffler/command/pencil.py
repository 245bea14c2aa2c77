"""Find the pencil cuts of a part: valleys that a ball touches on both sides. They are written as a plan.

riffler pencil part.stl --tool ball:6 --out pencil.json [--tolerance 0.01]

It is the same as riffler plan pencil.
"""

from ..plan import strategies
from .plan import StrategyCommand

HELP = "find the pencil cuts of a part"
_command = StrategyCommand(strategies.of("pencil"))
add_arguments, run = _command.add_arguments, _command.run
