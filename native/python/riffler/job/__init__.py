"""Jobs: make a program and a set-up sheet from one TOML file with part, stock, machine, tools and operations."""

from .model import Job, read
from .running import Result, run
from .sheet import write_sheet
from .table import JobError

__all__ = ["Job", "JobError", "Result", "read", "run", "write_sheet"]
