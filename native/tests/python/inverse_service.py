"""Haply's Inverse Service for tests: the documented messages over a WebSocket on the loopback."""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import socketserver
import struct
import threading
from collections.abc import Iterator
from typing import Any

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455, 1.3


def arm(name: str, **status: bool) -> dict[str, Any]:
    return {
        "device_id": name,
        "config": {"type": "inverse3", "handedness": "right"},
        "state": {
            "cursor_position": {"x": 0.01, "y": -0.12, "z": 0.15},
            "cursor_velocity": {"x": 0.0, "y": 0.0, "z": 0.0},
            "control_mode": "idle",
        },
        "status": {"calibrated": True, "in_use": False, "power_supply": True, "ready": True, **status},
    }


def grip(name: str) -> dict[str, Any]:
    state = {"orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0}, "buttons": {"a": True, "b": False, "c": False}}
    return {"device_id": name, "state": state}


class Connection(socketserver.StreamRequestHandler):
    server: Service

    def handle(self) -> None:
        lines = [self.rfile.readline()]
        while (line := self.rfile.readline().strip()) != b"":
            lines.append(line)
        fields = dict(line.decode().split(": ", 1) for line in lines[1:])
        if lines[0].startswith(b"GET /version "):
            version = {"project_name": "haply-inverse-service", "project_version": self.server.version}
            body = json.dumps(version).encode()
            self.wfile.write(b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n" % len(body) + body)
            return
        digest = hashlib.sha1((fields["Sec-WebSocket-Key"] + GUID).encode()).digest()
        accept = base64.b64encode(digest).decode()
        self.wfile.write(
            f"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode()
        )
        self.send(self.server.devices)
        while (text := self.receive()) is not None:
            command = json.loads(text)["inverse3"][0]["commands"]["set_cursor_force"]
            self.server.forces.append(command["vector"])
            self.send(self.server.devices)

    def send(self, message: dict[str, Any]) -> None:
        payload = json.dumps(message).encode()
        head = bytes([0x81, len(payload)]) if len(payload) < 126 else b"\x81\x7e" + struct.pack(">H", len(payload))
        self.wfile.write(head + payload)

    def receive(self) -> bytes | None:
        """A client's text message; None at the end."""
        head = self.rfile.read(2)
        if len(head) < 2 or head[0] & 15 == 8:
            return None
        size = head[1] & 127
        if size == 126:
            (size,) = struct.unpack(">H", self.rfile.read(2))
        mask = self.rfile.read(4)
        return bytes(b ^ mask[k % 4] for k, b in enumerate(self.rfile.read(size)))


class Service(socketserver.ThreadingTCPServer):
    daemon_threads = True
    block_on_close = False

    def __init__(self, devices: dict[str, Any], version: str) -> None:
        super().__init__(("127.0.0.1", 0), Connection)
        self.devices, self.version = devices, version
        self.forces: list[dict[str, float]] = []

    def handle_error(self, *_: object) -> None:
        """A client may end at any time."""


@contextlib.contextmanager
def inverse_service(
    *arms: dict[str, Any], grips: tuple[dict[str, Any], ...] = (), version: str = "3.5.0.0"
) -> Iterator[Service]:
    """A service that runs meanwhile, with these arms and wireless grips."""
    with Service({"inverse3": list(arms), "wireless_verse_grip": list(grips)}, version) as service:
        thread = threading.Thread(target=service.serve_forever, daemon=True)
        thread.start()
        try:
            yield service
        finally:
            service.shutdown()
            thread.join()
