"""A tab of the toolbox without a browser: viser's socket, spoken by Python, for many tabs and for times."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import msgspec
import viser
import zstandard
from viser import _messages as messages
from websockets.sync.client import connect

ASK = 0.1  # s at most between two looks at what is waited for
WAIT = 60.0  # s


class SocketTab:
    """A tab.

    Attributes:
        labels: Of what is in the panel, by viser's number of it, the latest last.
        values: What the panel shows, by viser's number.
        moved: Names of nodes of the scene that were moved, and when, s.
        notes: Titles and texts of notifications.
    """

    def __init__(self, url: str, headers: dict[str, str] | None = None) -> None:
        address = url.replace("http://", "ws://").rstrip("/")
        self._socket = connect(
            address,
            subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
            additional_headers=headers,
            max_size=None,
            compression=None,
        )
        self.labels: dict[str, str] = {}
        self.values: dict[str, Any] = {}
        self.moved: list[tuple[str, float]] = []
        self.notes: list[tuple[str, str]] = []
        self.open = True
        self._owners: dict[str, str] = {}
        self._changed = threading.Condition()
        threading.Thread(target=self._listen, daemon=True).start()
        self.send(
            messages.ViewerCameraMessage(
                wxyz=(1.0, 0.0, 0.0, 0.0),
                position=(3.0, 3.0, 3.0),
                fov=1.0,
                near=0.01,
                far=1000.0,
                image_height=600,
                image_width=900,
                look_at=(0.0, 0.0, 0.0),
                up_direction=(0.0, 0.0, 1.0),
            )
        )

    def send(self, message: Any) -> None:
        """Send one of viser's messages."""
        self._socket.send(msgspec.msgpack.encode(message.as_serializable_dict()))

    def find(self, label: str) -> str:
        """viser's number of what has this label, once it is there."""
        self.wait_until(lambda: label in self.labels.values())
        return next(uuid for uuid, text in reversed(self.labels.items()) if text == label)

    def set(self, label: str, value: Any) -> None:
        """Set an input, or click a button."""
        self.send(messages.GuiUpdateMessage(self.find(label), {"value": value}))

    def value(self, label: str) -> Any:
        """What an input shows."""
        return self.values.get(self.find(label))

    def see(self, text: str) -> None:
        """Wait until some text of the panel has this in it."""
        self.wait_until(lambda: any(text in str(value) for value in self.values.values()))

    def text(self, part: str) -> str:
        """A text of the panel that has this in it."""
        self.see(part)
        return next(str(value) for value in self.values.values() if part in str(value))

    def told(self, part: str) -> None:
        """Wait until a notification has this in it."""
        self.wait_until(lambda: any(part in text for _, text in self.notes))

    def send_file(self, label: str, name: str, content: bytes, declared: int | None = None) -> None:
        """Send a file by an upload button."""
        button, transfer, part = self.find(label), str(time.monotonic_ns()), 1 << 20
        parts = [content[k : k + part] for k in range(0, len(content), part)]
        size = len(content) if declared is None else declared
        self.send(messages.FileTransferStartUpload(button, transfer, name, "", len(parts), size))
        for number, data in enumerate(parts):
            self.send(messages.FileTransferPart(button, transfer, number, data))

    def drag(self, node: str, position: tuple[float, ...], wxyz: tuple[float, ...]) -> None:
        """Move a gizmo."""
        self.send(messages.TransformControlsUpdateMessage(node, wxyz, position, self._owners[node]))  # type: ignore[arg-type]

    def wait_until(self, met: Callable[[], bool], seconds: float = WAIT) -> None:
        """Wait until something is so, here or in the server: it is asked at each message, and as often in between."""
        end = time.monotonic() + seconds
        with self._changed:
            while not met():
                if time.monotonic() > end:
                    raise TimeoutError(f"labels {list(self.labels.values())[-60:]}; notes {self.notes}")
                self._changed.wait(ASK)

    def close(self) -> None:
        """Close it."""
        self._socket.close()

    def _listen(self) -> None:
        unpacked = zstandard.ZstdDecompressor()
        try:
            for raw in self._socket:
                data = raw if isinstance(raw, bytes) else raw.encode()
                size, packed = (int.from_bytes(data[at : at + 8], "little") for at in (0, 8))
                inner = msgspec.msgpack.decode(unpacked.decompress(data[16 : 16 + packed], max_output_size=size))
                with self._changed:
                    for message in inner["messages"]:
                        self._take(message)
                    self._changed.notify_all()
        except Exception:  # the socket is gone, however that shows
            pass
        self.open = False

    def _take(self, message: dict[str, Any]) -> None:
        kind, props = message["type"], message.get("props") or {}
        uuid = message.get("uuid", "")
        if kind == "NotificationShowMessage":
            self.notes.append((props["title"], props["body"]))
        elif kind == "GuiRemoveMessage":
            self.labels.pop(uuid, None)
            self.values.pop(uuid, None)
        elif kind == "GuiUpdateMessage":
            for name, value in message["updates"].items():
                if name in ("value", "_markdown", "content"):
                    self.values[uuid] = value
        elif uuid and "label" in props:
            self.labels[uuid] = props["label"] or ""
            self.values[uuid] = message.get("value")
        if "owner" in message and "name" in message:
            self._owners[message["name"]] = message["owner"]
        if kind == "SetPositionMessage":
            self.moved.append((message["name"], time.perf_counter()))
