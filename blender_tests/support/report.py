"""One JSON line on standard output for each result, which run.py reads."""

import json

MARK = "RIFFLER_TEST "


def say(**message):
    print(MARK + json.dumps(message), flush=True)
