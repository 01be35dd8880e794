"""The scan microscope: one scan slowed down, from the input latch through each instruction to the output refresh (2.1.2)."""

from __future__ import annotations

import copy
from types import SimpleNamespace
from typing import Any

from ecsim.engines import Trace
from ecsim.views.labels import figure
from ecsim.views.ladder import ladder

from .panel import Part
from .rig import PREFIX, Rig

NARROWEST, WIDEST = 340, 1400
SHOWN = 200  # rows of writes around the instruction


class Microscope(Part):
    """The last traced scan, stopped anywhere in it. Place 0 is the input latch, 1 to n an instruction, then housekeeping and output refresh.

    It looks while the run stands still; while it runs it keeps what it saw last.
    """

    key = "microscope"

    def __init__(self, rig: Rig):
        super().__init__(rig)
        self.width = NARROWEST
        self.place = 0
        self.networks = {
            instruction.position: (unit, network)
            for unit in rig.program.units
            if not unit.closed
            for network in unit.networks
            for instruction in unit.instructions[network.start : network.end]
        }
        self.instructions = {instruction.position: instruction for instruction in rig.instructions}
        self.trace: Trace | None = None
        self.scan = 0
        self.before: dict[str, int] = {}  # terminals and images of the scan before
        self._images: list[tuple[int, tuple]] = [(-1, ()), (-1, ())]
        self._seen: Trace | None = None
        self._drawn: tuple[tuple, Any, str] = ((), None, "")
        self._shown: tuple[tuple, dict[str, Any]] = ((), {})
        self._watch()
        self._leave = rig.session.each_scan(self._watch)

    def close(self):
        self._leave()

    def _watch(self) -> None:
        """After each scan: what the program saw of the inputs."""
        self._images = [self._images[1], (self.rig.plc.scans, tuple(self.rig.plc.memory.lists["X"][: len(self.rig.inputs)]))]

    # -- the scan -----------------------------------------------------------------------------------------------

    def _take(self) -> None:
        """Keep the last scan, if there is another one than before and the run stands still."""
        plc = self.rig.plc
        if self.rig.session.state == "running" or not plc.running or not plc.tracing or plc.trace is None or plc.trace is self._seen:
            return
        self._seen, self.trace, self.scan, self.place = plc.trace, plc.trace, plc.scans, 0
        self.memory, self.forced = self._memory_now(), plc.forced
        (earlier, former), (_, now) = self._images
        self.latched = [device for device, old, new in zip(self.rig.inputs, former, now, strict=False) if old != new]
        self.known_before = earlier == self.scan - 1

    def _memory_now(self):
        memory = copy.copy(self.rig.plc.memory)
        memory.lists = {name: list(values) for name, values in memory.lists.items()}
        return memory

    @property
    def last(self) -> int:
        """The place of the output refresh."""
        return len(self.trace.order) + 2 if self.trace else 0

    def _done(self, place: int) -> int:
        """How many writes there were at a place."""
        order = self.trace.order
        return 0 if place < 1 else order[place - 1][2] if place <= len(order) else len(self.trace.writes)

    def _memory_at(self, place: int):
        """The memory as it was at a place: what was written later taken back."""
        memory = copy.copy(self.memory)
        memory.lists = dict(self.memory.lists)
        copied = set()
        for write in reversed(self.trace.writes[self._done(place) :]):
            device, _ = memory.parse(write.device)
            name = f"{device.area}B" if write.device.endswith(":BOOL") else device.area
            if name not in copied:
                memory.lists[name] = list(memory.lists[name])
                copied.add(name)
            memory.lists[name][device.number] = write.old
        return memory

    def _moment_at(self, place: int, memory) -> SimpleNamespace:
        """What the ladder is drawn from: nothing that comes later has been executed."""
        order, whole = self.trace.order, self.trace
        seen = Trace.blank(len(whole.flow))
        for position, flow, _ in order[: max(0, min(place, len(order)))]:
            seen.flow[position], seen.closed[position] = flow, whole.closed[position]
        return SimpleNamespace(memory=memory, running=True, tracing=True, trace=seen, program=self.rig.program, forced=self.forced)

    # -- a frame ------------------------------------------------------------------------------------------------

    def frame(self) -> dict[str, Any]:
        self._take()
        if self.trace is None:
            return {"svg": "", "place": 0, "last": 0, "n": 0, "phase": "", "words": self._nothing(), "writes": [], "points": []}
        shown = self.scan, id(self.trace), self.place, self.width
        if shown != self._shown[0]:
            self._shown = shown, self._frame()
        return dict(self._shown[1])

    def _frame(self) -> dict[str, Any]:
        """Everything at the present place."""
        n, place = len(self.trace.order), self.place
        memory = self._memory_at(place)
        position = self._position(place)
        entries: dict[str, Any] = {"svg": self._draw(position)}
        if self._drawn[1] is not None:
            moment = self._moment_at(place, memory)
            entries |= self._drawn[1].state(moment)
            for key in [key for key in entries if key.startswith("e") and key.endswith(":class")]:
                if moment.trace.flow[int(key[1:-6])] is None:  # power stands before it; it has not been executed yet
                    entries[key] = entries[key].replace("flow", "open")
                    entries[f"{key[:-6]}:aria-label"] = f"{entries[f'{key[:-6]}:aria-label'].rpartition(',')[0]}, not yet executed"
            if 1 <= place <= n:
                known = entries.get(f"e{position}:class", "")
                entries[f"e{position}:class"] = f"{known} here".strip()
        phase = "input" if place == 0 else "program" if place <= n else "housekeeping" if place == n + 1 else "output"
        entries |= {
            "scan": self.scan,
            "place": place,
            "last": self.last,
            "n": n,
            "phase": phase,
            "words": self._words(place, position, phase),
            "writes": self._writes(place),
            "points": self._points(place, memory),
            "about": f"scan {self.scan:,}",
            "network": self._network(position),
        }
        return entries

    def _nothing(self) -> str:
        if self.rig.session.state == "running":
            return "Pause to see the last scan, or take the next one."
        return "Take the next scan to see it slowed down." if self.rig.plc.running else "The PLC is in STOP: no program is executed."

    def _position(self, place: int) -> int:
        """The instruction at a place; before the program its first one, behind it its last."""
        order = self.trace.order
        return order[max(1, min(place, len(order))) - 1][0] if order else -1

    def _network(self, position: int) -> str:
        unit, network = self.networks.get(position, (None, None))
        return "" if unit is None else f"{unit.name}, network {network.number + 1}"

    def _draw(self, position: int) -> str:
        """The network of an instruction, drawn when it is another one."""
        unit, network = self.networks.get(position, (None, None))
        shape = (None if unit is None else (unit.name, network.start), self.width)
        if shape != self._drawn[0]:
            drawing = ladder(network, self.rig.program) if network is not None else None
            self._drawn = shape, drawing, drawing.svg(PREFIX, self.width) if drawing else ""
        return self._drawn[2]

    def _words(self, place: int, position: int, phase: str) -> str:
        """What happens at a place, as a sentence."""
        if phase == "input":
            if not self.known_before:
                return "The inputs are latched: the program sees these levels for the whole scan."
            changed = [
                f"{self._called(device)} goes {'on' if self.memory.lists['X'][self._number(device)] else 'off'}" for device in self.latched
            ]
            return f"The inputs are latched: {' and '.join(changed) if changed else 'none has changed'}."
        if phase == "housekeeping":
            return "The program has ended: communication, then housekeeping; the terminals still hold the last scan's outputs."
        if phase == "output":
            changed = [
                f"{self._called(device)} goes {'on' if level else 'off'}" for device, level, was in self._outputs(self.last) if level != was
            ]
            return f"The outputs are refreshed: {' and '.join(changed) if changed else 'none has changed'}."
        flow = self.trace.order[place - 1][1]
        instruction = self.instructions[position]
        written = self.trace.writes[self._done(place - 1) : self._done(place)]
        told = [f"{self._called(write.device)} goes from {figure(write.old)} to {figure(write.new)}" for write in written]
        effect = " and ".join(told) if told else "nothing changes"
        return f"{instruction}: {'power flows' if flow else 'no power'}, {effect}."

    def _called(self, device: str) -> str:
        return f"{self.rig.name(device.partition(':')[0])} {device}".strip()

    def _number(self, device: str) -> int:
        return self.memory.parse(device)[0].number

    def _writes(self, place: int) -> list[tuple]:
        """The scan's writes around the place: (number of the instruction, itself, device, name, old, new, state)."""
        done, now = self._done(place), self._done(place - 1) if place else 0
        rows, at = [], 0
        for number, (_, _, count) in enumerate(self.trace.order, 1):
            rows += [(number, write) for write in self.trace.writes[at:count]]
            at = count
        rows += [(len(self.trace.order), write) for write in self.trace.writes[at:]]
        first = max(0, min(done - SHOWN // 2, len(rows) - SHOWN))
        return [
            (
                number,
                str(self.instructions[write.position]),
                write.device,
                self.rig.name(write.device.partition(":")[0]),
                figure(write.old),
                figure(write.new),
                "later" if index >= done else "here" if index >= now and place <= len(self.trace.order) else "done",
            )
            for index, (number, write) in enumerate(rows[first : first + SHOWN], first)
        ]

    def _outputs(self, place: int) -> list[tuple[str, int, int]]:
        """The outputs of the unit: the image at a place, and what the terminals have until they are refreshed."""
        start, now = self._memory_at(0).lists["Y"], self._memory_at(place).lists["Y"]
        numbers = [(device, self._number(device)) for device in self.rig.outputs]
        return [(device, int(now[number]), int(start[number])) for device, number in numbers]

    def _points(self, place: int, memory) -> list[tuple[str, str, int, int]]:
        """What the program uses of the outputs: device, name, image, terminal."""
        used = {str(device) for device in self.rig.plc.in_use(("Y",))}
        refreshed = place == self.last
        return [
            (device, self.rig.name(device), image, image if refreshed else was)
            for device, image, was in self._outputs(place)
            if device in used
        ]

    # -- what the page may do -----------------------------------------------------------------------------------

    def on_fit(self, width):
        """The room of the drawing in px."""
        self.width = min(max(int(width), NARROWEST), WIDEST)

    def on_go(self, place):
        """To a place of the scan."""
        self.place = min(max(int(place), 0), self.last)

    def on_move(self, by):
        """So many places on, or back."""
        self.on_go(self.place + int(by))

    def on_write(self, by):
        """To the next instruction that writes something, or back to the last; without one to the end."""
        if self.trace is None:
            return
        step = 1 if by > 0 else -1
        place = min(self.place, len(self.trace.order) + 1) + step
        while 0 < place <= len(self.trace.order) and self._done(place) == self._done(place - 1):
            place += step
        self.on_go(place if by < 0 or place <= len(self.trace.order) else self.last)

    def on_next(self):
        """Do one scan, and look at it from its beginning."""
        self.rig.session.scan()
