"""Readers of CAD files whose import of OpenCASCADE is shared: it takes a second, longer than most reading.

A process imports the reader once (``python cad_reader.py SOCKET FOLDER``). For each file it forks a process, which runs
the reader's program with the request's folder, limits and outputs, as the one that `riffler.cad` starts does.
"""

from __future__ import annotations

import os
import runpy
import signal
import socket
import subprocess
import sys
import traceback
from contextlib import contextmanager
from pathlib import Path

STATUS = 16  # bytes: of a process's number, then of its exit status, in decimal digits


class Reader:
    """A forked process with what `riffler.cad.process` uses of a Popen."""

    def __init__(self, connection: socket.socket, stdout) -> None:
        self.connection, self.stdout, self.status = connection, stdout, None
        self.pid = int(connection.recv(STATUS, socket.MSG_WAITALL))

    def wait(self) -> int:
        if self.status is None:
            self.status = int(self.connection.recv(STATUS, socket.MSG_WAITALL))
            self.connection.close()
        return self.status

    def poll(self) -> int | None:
        if self.status is None:
            self.connection.settimeout(0)
            try:
                self.connection.recv(STATUS, socket.MSG_PEEK)
            except BlockingIOError:
                return None
            finally:
                self.connection.settimeout(None)
        return self.wait()

    def kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)


@contextmanager
def shared_import(process):
    """Within, `process` (riffler.cad.process) gets its readers from one that has imported OpenCASCADE, unless another
    Python is asked for. Only where messages pass files (Linux); elsewhere nothing is shared."""
    if sys.platform != "linux":
        yield
        return
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    command = [sys.executable, __file__, str(theirs.fileno()), str(process.WORKER)]
    server = subprocess.Popen(command, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL)
    theirs.close()
    start = process._start

    def forked(python, folder, messages):
        if python != sys.executable:
            return start(python, folder, messages)
        connection, far = socket.socketpair()
        reading, writing = os.pipe()
        socket.send_fds(ours, [str(folder).encode()], [far.fileno(), writing, messages.fileno()])
        far.close()
        os.close(writing)
        return Reader(connection, os.fdopen(reading, "rb"))

    process._start = forked
    try:
        yield
    finally:
        process._start = start
        ours.close()
        server.wait()


def serve(requests: socket.socket, worker: Path) -> None:
    program = runpy.run_path(str(worker / "__main__.py"), run_name="worker")
    program["package"]()
    forked = 0
    while True:
        folder, fds, _, _ = socket.recv_fds(requests, 4096, 3)
        if not folder:
            break
        forked += 1
        if not os.fork():
            requests.close()
            os._exit(follow(socket.socket(fileno=fds[0]), *fds[1:], Path(os.fsdecode(folder)), program))
        for fd in fds:
            os.close(fd)
    for _ in range(forked):  # their processor time counts as this process's
        os.wait()


def follow(caller: socket.socket, stdout: int, stderr: int, folder: Path, program: dict) -> int:
    """Forks the reader and tells the caller its number and how it ends, as Popen does."""
    parent = os.getpid()
    reader = os.fork()
    if not reader:
        caller.close()
        os.setsid()
        os.dup2(stdout, 1)
        os.dup2(stderr, 2)
        os.closerange(3, 256)
        status = 1
        try:
            status = program["main"](folder, parent)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    os.close(stdout)
    os.close(stderr)
    caller.sendall(b"%*d" % (STATUS, reader))
    _, status = os.waitpid(reader, 0)
    caller.sendall(b"%*d" % (STATUS, os.waitstatus_to_exitcode(status)))
    return 0


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])), Path(sys.argv[2]))
