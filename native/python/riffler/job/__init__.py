"""Jobs: part, stock, machine, tools and operations in one TOML file, computed into a program and a set-up sheet."""

from .model import Job, read
from .running import Result, run
from .sheet import write_sheet
from .table import JobError

__all__ = ["Job", "JobError", "Result", "read", "run", "write_sheet"]
