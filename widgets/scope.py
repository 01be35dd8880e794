"""What the trace panels of one simulation show: lanes, the window on time, two cursors, a trigger. Nothing here knows Jupyter."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ecsim.errors import EcsimError
from ecsim.record import STEPS, Recording, Trigger

CHUNKS = 8  # a window is drawn in as many pieces
LEAST_US, MOST_US = 8_000, 24 * 3_600_000_000
FIRST_US = 4_000_000
PRE = 0.25  # of the window lies before the trigger
MOST_LANES = 24
DEFAULT_LANES = 14


@dataclass(slots=True)
class Lane:
    """One signal: its name in the recording, what it is ("bit", "word" or "steps"), whether a word is a curve, and the curve's scale."""

    name: str
    kind: str
    curved: bool = False
    low: int = 0
    high: int = 0

    @property
    def style(self) -> str:
        """How it is drawn: "bit", "curve", "bus" or "steps"."""
        return self.kind if self.kind != "word" else "curve" if self.curved else "bus"


class Scope:
    """The analyser behind the trace panels. `names` are devices or names; without any the machine's terminals and the steps."""

    def __init__(self, rig: Any, names: Iterable[str] = ()):
        self.rig = rig
        self.given = tuple(names)
        self.recording = Recording(rig.plc, [])
        self.lanes: list[Lane] = []
        self.begin_us, self.span_us = 0, FIRST_US
        self.following = True
        self.cursors: dict[str, int | None] = {"A": None, "B": None}
        self.trigger: Trigger | None = None
        self.armed = False
        self.hit_us: int | None = None
        self.program = None
        self.follow_program()
        rig.session.recording = self.recording
        self._leave = rig.session.each_scan(self._look)

    def follow_program(self) -> None:
        """Show what the program that is loaded now has; lanes that were chosen by hand stay as long as they exist."""
        if self.program is self.rig.program:
            return
        self.program = self.rig.program
        if not self.lanes:
            for name in self.given or self._usual():
                self.add(name)

    def _usual(self) -> list[str]:
        """The terminals that the machine is wired to, or those that the program uses, and the steps."""
        rig = self.rig
        terminals = [device for device in rig.wiring if device[0] in "XY" and device[1:].isdigit()]
        if not terminals:
            terminals = [str(device) for device in rig.plc.in_use(("X", "Y"))]
        terminals.sort(key=lambda device: (device[0], int(device[1:], 8)))
        return terminals[:DEFAULT_LANES] + ([STEPS] if rig.charted else [])

    # -- lanes --------------------------------------------------------------------------------------------------

    def add(self, name: str) -> Lane:
        """A lane more: a device, a name of the program, or S for the steps. Raises EcsimError."""
        plc = self.rig.plc
        name = self._devices().get(name.strip().lower(), name.strip())
        if name.upper() == STEPS:
            name = STEPS
        else:
            device, _ = plc.memory.parse(name)
            suffix = name.partition(":")[2]
            name = f"{device}:{suffix.upper()}" if suffix else str(device)
        if len(self.lanes) >= MOST_LANES:
            raise EcsimError(f"there are {MOST_LANES} lanes, and no room for more; remove one first")
        self.recording.add(name)
        kind = self.recording.kind(name)
        lane = Lane(name, kind, curved=kind == "word" and name[0] not in "TC")
        self.lanes.append(lane)
        self._renew_trigger()
        return lane

    def remove(self, place: int) -> None:
        """A lane less; a trigger that needs it goes too."""
        self.recording.remove(self.lanes.pop(place).name)
        self._renew_trigger()

    def move(self, place: int, to: int) -> None:
        """A lane to another place."""
        self.lanes.insert(max(0, min(to, len(self.lanes) - 1)), self.lanes.pop(place))

    # -- the window ---------------------------------------------------------------------------------------------

    def window(self) -> tuple[int, int]:
        """Its first moment and its length, in us. While it follows it goes on by an eighth when the present has reached its end."""
        if self.following:
            piece = self.span_us // CHUNKS
            end = -(-max(self.rig.plc.time_us, 1) // piece) * piece
            self.begin_us = max(0, end - self.span_us)
        return self.begin_us, self.span_us

    def look_at(self, begin_us: float, span_us: float) -> None:
        """Hold the window on a stretch of time."""
        self.following = False
        self._set_span(span_us)
        self.begin_us = max(0, min(int(begin_us), self.rig.plc.time_us))

    def _set_span(self, span_us: float) -> None:
        self.span_us = int(min(max(span_us, LEAST_US), MOST_US)) // CHUNKS * CHUNKS

    def zoom(self, factor: float, at_us: float) -> None:
        """Show `factor` times as long a stretch, with one moment left where it is; what follows goes on to follow."""
        begin, span = self.window()
        share = (at_us - begin) / span
        self._set_span(span * factor)
        if not self.following:
            self.begin_us = max(0, int(at_us - share * self.span_us))

    def fit(self) -> None:
        """Show all that was recorded."""
        first = self.recording.times[0] if self.recording.times else 0
        self.look_at(first, (self.rig.plc.time_us - first) * 1.02)

    # -- cursors ------------------------------------------------------------------------------------------------

    def place(self, letter: str, time_us: float, snap_us: float = 0) -> None:
        """A cursor to a moment, or to the edge that lies nearest within `snap_us`."""
        time = int(max(0, min(time_us, self.rig.plc.time_us)))
        near = [edge for edge in (self.recording.edge(time), self.recording.edge(time + 1, forward=False)) if edge is not None]
        nearest = min(near, key=lambda edge: abs(edge - time), default=time)
        self.cursors[letter] = nearest if abs(nearest - time) <= snap_us else time

    def to_edge(self, letter: str, forward: bool, names: Iterable[str] | None = None) -> None:
        """A cursor to the next edge, or the last one before; a held window goes with it."""
        begin, span = self.window()
        at = self.cursors[letter]
        edge = self.recording.edge(begin if at is None else at, forward, names)
        if edge is None:
            return
        self.cursors[letter] = edge
        if not begin <= edge <= begin + span:
            self.look_at(edge - span / 2, span)

    # -- the trigger --------------------------------------------------------------------------------------------

    def arm(self, text: str) -> None:
        """Wait for a condition; when it comes true the window holds around that moment. Empty text ends it. Raises EcsimError."""
        if not text.strip():
            self.trigger, self.armed, self.hit_us = None, False, None
            return
        devices = self._devices()
        self.trigger = Trigger(self.recording, " ".join(devices.get(word.lower(), word) for word in text.split()))
        self.armed, self.hit_us, self.following = True, None, True

    def _devices(self) -> dict[str, str]:
        """Names of machine and program, in small letters, and their devices."""
        wired = {point.name.lower(): device for device, point in self.rig.wiring.items()}
        return wired | {name.lower(): device for device, name in self.rig.plc.names.items()}

    def _renew_trigger(self) -> None:
        if self.trigger is not None:
            try:
                self.trigger = Trigger(self.recording, self.trigger.text)
            except EcsimError:
                self.trigger, self.armed, self.hit_us = None, False, None

    def _look(self) -> None:
        """After each scan."""
        recording = self.recording
        if self.armed and len(recording) > 1 and recording.times[-1] == self.rig.plc.time_us and self.trigger(*recording.rows[-2:]):
            self.armed, self.hit_us = False, recording.times[-1]
            self.look_at(self.hit_us - PRE * self.span_us, self.span_us)
