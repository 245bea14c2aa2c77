"""One JSON line on standard output for each result, which run.py reads."""

import json
import time

try:
    import resource
except ImportError:  # Windows
    resource = None

MARK = "RIFFLER_TEST "


def say(**message):
    print(MARK + json.dumps(message), flush=True)


def processor_time():
    """Seconds of all threads of this process and of its ended children: what a test costs on a busy machine, too."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN) if resource else None
    return time.process_time() + (children.ru_utime + children.ru_stime if children else 0.0)
