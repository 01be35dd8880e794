"""A live panel as a widget: parts described once, then one message a frame with the entries that changed."""

from __future__ import annotations

import contextlib
import threading
import uuid
from collections.abc import Iterable, Sequence
from contextvars import Context, copy_context
from importlib import resources
from typing import Any

import anywidget
import traitlets

from ecsim.errors import EcsimError

from .history import changes
from .rig import Rig
from .stream import Stream

SCRIPTS = ("panel", "il", "plate", "transport", "unit", "machine", "chart", "ladder", "microscope", "trace", "timers", "devices", "editor")
STYLES = ("panel", "plate", "transport", "unit", "machine", "chart", "ladder", "microscope", "trace", "timers", "devices", "editor", "lab")


def _together(folder: resources.abc.Traversable, names: Iterable[str], ending: str) -> str:
    return "\n".join((folder / f"{name}.{ending}").read_text(encoding="utf-8") for name in names)


class Part:
    """One panel's Python side: described once by `layout`, then a `frame` of entries a moment, and verbs that the page may say."""

    key = ""

    def __init__(self, rig: Rig):
        self.rig = rig

    def layout(self) -> dict[str, Any]:
        """What never changes while the program is loaded."""
        return {}

    def frame(self) -> dict[str, Any]:
        """All entries at this moment; the panel sends those that differ from the last frame."""
        return {}

    def pulsed(self) -> list[str]:
        """Bits that were on between this frame and the last one, and are off in both."""
        return []

    def receive(self, verb: str, values: dict[str, Any]) -> Any:
        """A message from the page is one call: the method `on_<verb>`; what it gives goes to a page that asked for it."""
        method = getattr(self, f"on_{verb}", None)
        if method is None:
            raise ValueError(f"the {self.key} panel knows no {verb!r}")
        return method(**values)

    def close(self) -> None:
        """Nobody looks at this part any more."""


class Panel(anywidget.AnyWidget):
    """Shows some parts of a rig. Frames are made in the session's thread; inputs go into the session's queue."""

    _esm = _together(resources.files(__package__), SCRIPTS, "js")
    _css = "\n".join(
        (
            _together(resources.files("ecsim.views") / "look", ("tokens", "drawing"), "css"),
            _together(resources.files(__package__), STYLES, "css"),
        )
    )
    page = traitlets.Unicode().tag(sync=True)
    face = traitlets.Dict().tag(sync=True)
    last = traitlets.Dict().tag(sync=True)

    def __init__(self, rig: Rig, kinds: Sequence[type[Part]] = (), **traits: Any):
        self.rig = rig
        self.kinds = kinds
        self.parts: dict[str, Part] = {}
        self.stream = Stream()
        self._lock = threading.Lock()
        self._sent: dict[str, dict[str, Any]] = {}
        self._later: threading.Timer | None = None
        self._asked_in: Context | None = None
        self._make_parts()
        super().__init__(page=uuid.uuid4().hex, face=self.describe(), last=self.moment(), **traits)
        self.on_msg(self._receive)
        self._leave = rig.session.observe(lambda session: self.show())

    def chosen(self) -> Sequence[type[Part]]:
        """Which parts are shown of the program that is loaded."""
        return self.kinds

    def _make_parts(self) -> None:
        for part in self.parts.values():
            part.close()
        self.parts = {kind.key: kind(self.rig) for kind in self.chosen()}
        self._of = self.rig.program

    def _follow_program(self) -> bool:
        """Make the parts anew when another program has been loaded; says whether it was so."""
        if self.rig.program is not self.rig.plc.program:
            self.rig.read_program()
        if self._of is self.rig.program:
            return False
        self._make_parts()
        return True

    def describe(self) -> dict[str, Any]:
        """The static description of all parts."""
        return {"parts": list(self.parts), "panels": {key: part.layout() for key, part in self.parts.items()}}

    def moment(self) -> dict[str, dict[str, Any]]:
        """The whole state of all parts, and of the run itself."""
        return {"run": self.rig.run(), **{key: part.frame() for key, part in self.parts.items()}}

    def show(self, full: bool = False) -> None:
        """Send what has changed since the last frame, if a frame is due; everything when `full`."""
        if not (full or self.stream.due):
            self._show_later()
            return
        with self.rig.session.held(), self._lock:
            renewed = self._follow_program()
            now = self.moment()
            message: dict[str, Any] = {"state": now, "full": True}
            if renewed:
                message["layout"] = self.describe()
            elif not full:
                changed = {part: changes(self._sent.get(part, {}), entries) for part, entries in now.items()}
                message = {"state": {part: entries for part, entries in changed.items() if entries}}
            pulsed = {key: keys for key, part in self.parts.items() if (keys := part.pulsed())}
            if pulsed:
                message["pulsed"] = pulsed
            if message["state"] or pulsed:
                self._sent = now
                self._answer(self.stream.count() | message)

    def _answer(self, message: dict[str, Any]) -> None:
        """Send as an answer to the page's last message, from whatever thread.

        The kernel hands what comes over a comm to the shell that last sent over it. Frames that were sent as part of a
        cell would bring the page's clicks behind that cell; as answers they keep them in the page's own shell.
        """
        context = self._asked_in.copy() if self._asked_in is not None else copy_context()
        context.run(self.send, message)

    def _show_later(self) -> None:
        """While nothing runs no other frame follows: the last state must not be the one that was left out."""
        with self._lock:
            if self._later is None and self.stream.open and self.rig.session.state != "running":
                self._later = threading.Timer(self.stream.wait_s, self._show_now)
                self._later.daemon = True
                self._later.start()

    def _show_now(self) -> None:
        with self._lock:
            self._later = None
        self.show()

    def _receive(self, widget: object, message: dict[str, Any], buffers: object) -> None:
        self._asked_in = copy_context()
        if "part" in message:
            values = {key: value for key, value in message.items() if key not in ("part", "do", "asked")}
            try:
                answer = self.parts[message["part"]].receive(message["do"], values)
            except EcsimError as error:  # told in the run control
                self.rig.refused, answer = str(error), None
            if "asked" in message:
                self._answer({"n": self.stream.number, "asked": message["asked"], "answer": answer})
            self.show()
        elif "ack" in message:
            self.stream.heard(message["ack"])
        else:  # a page has come, or asks whether somebody is here
            self.stream.heard()
            if "hello" in message:
                self.show(full=True)
            else:
                self._answer({"n": self.stream.number})

    def __repr__(self) -> str:
        return f"<Panel {', '.join(self.parts)}: {self.rig.plc.model.name}>"

    def close(self) -> None:
        """Leave the session and close the view."""
        with contextlib.suppress(AttributeError):
            self._leave()
        parts, self.parts = getattr(self, "parts", {}), {}  # it may not have been made to the end
        for part in parts.values():
            part.close()
        super().close()
