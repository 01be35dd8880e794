"""What the panels of one simulation share: the PLC and its session, who drives each input, and the history of the steps.

Nothing here knows Jupyter. A panel reads the rig when it makes a frame; a message from the page becomes one call on it.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from ecsim.assembler.program import Instruction
from ecsim.devices import Bits, Constant, number_text
from ecsim.errors import EcsimError
from ecsim.hardware.analog import Channel
from ecsim.values import DINT

from .history import StepTimes
from .table import Table

PREFIX = "EC0-"  # of all ids in a drawing; the page makes it unique for each view
LEAST_POINTS = {"X": 16, "Y": 12}
RECENT = 24  # scan times shown beside the watchdog


class Moment(NamedTuple):
    """What a machine's picture is drawn from: the plant, and the terminals (device -> 0 or 1)."""

    plant: Any
    inputs: Mapping[str, int]
    outputs: Mapping[str, int]


class Rig:
    """One simulation as its panels see it."""

    def __init__(
        self,
        plc: Any,
        session: Any,
        *,
        picture: Any = None,
        controls: Mapping[str, str] | None = None,
        title: str = "Machine",
        devices: Iterable[str] = (),
        traced: Iterable[str] = (),
    ):
        self.plc, self.session, self.sensors = plc, session, session.sensors
        self.wiring: Mapping[str, Any] = session.plant.wiring if session.plant is not None else {}
        self.picture, self.title = picture, title
        self.controls = dict(controls or {})
        self.refused = ""  # why the last thing asked for was not done
        self.traced = tuple(traced)
        self.scope: Any = None  # of the trace, made by the first panel that shows it
        self.recent: deque[int] = deque(maxlen=RECENT)
        session.each_scan(self._note_scan)
        self.table = Table(plc, self.point)
        for text in devices:
            self.table.add(text)
        self.read_program()

    def read_program(self) -> None:
        """Look up what the panels need of the program that is loaded now."""
        self.program = self.plc.program
        self.instructions = self.program.instructions
        self._names = {device: point.name for device, point in self.wiring.items()}
        self._comments = {device: point.what for device, point in self.wiring.items()}
        for device, point in self.wiring.items():
            if self.plc.analog_point(device) is not None:  # named with its kind of signal
                terminal = device.partition(":")[0]
                self._names[terminal], self._comments[terminal] = point.name, point.what
        for variable in self.program.variables.values():
            self._names[str(variable.device)] = variable.name
            self._comments.setdefault(str(variable.device), variable.comment)
        self._titles = {
            unit.instructions[index].position: title
            for unit in self.program.units
            for index, title in unit.titles.items()
            if index < len(unit.instructions)
        }
        self.inputs, self.outputs = self._points("X"), self._points("Y")
        self.analog = [channel.terminal for channel in self._channels()]
        self._places: dict[str, tuple[str, int]] = {}
        self.charted: dict[str, Instruction] = {}  # step -> its first STL
        for instruction in self.instructions:
            if instruction.mnemonic == "STL":
                self.charted.setdefault(str(instruction.operands[0]), instruction)
        self._times, self._times_of = StepTimes(), (0, None)
        self.table.follow_program()

    # -- what there is ------------------------------------------------------------------------------------------

    def _points(self, area: str) -> list[str]:
        """The unit's terminals of an area: the least it has, in whole groups of eight more where program or machine use more."""
        operands = [
            operand for instruction in self.instructions for operand in instruction.operands if getattr(operand, "area", "") == area
        ]
        last = [operand.number + (4 * operand.digits if isinstance(operand, Bits) else 1) for operand in operands]
        last += [int(device[1:], 8) + 1 for device in self.wiring if device.startswith(area)]
        used = max(last, default=0)
        count = LEAST_POINTS[area] if used <= LEAST_POINTS[area] else -(-used // 8) * 8
        return [f"{area}{number_text(area, number)}" for number in range(min(count, self.plc.model.areas[area].count))]

    def _channels(self) -> list[Channel]:
        """The analog channels; of a base unit that nobody has named only when program or machine use them."""
        channels = self.plc.analog_channels
        if self.plc.modules.base is None and not self._uses_analog():
            return [channel for channel in channels if channel.place >= 0]
        return channels

    def _uses_analog(self) -> bool:
        model = self.plc.model
        ports = (*model.analog_inputs, *model.analog_outputs)
        devices = {f"{model.special_bits}{port.enable}" for port in ports} | {f"{model.special_words}{port.register}" for port in ports}
        used = {str(device) for device in self.plc.in_use((model.special_bits, model.special_words))} if ports else set()
        return not devices.isdisjoint(used) or any(device[:2] in ("AI", "AO") and "." not in device for device in self.wiring)

    def name(self, device: str) -> str:
        """The variable's name, or what the machine calls the point."""
        return self._names.get(device, "")

    def point(self, device: str) -> tuple[str, str]:
        """A terminal's name and what it is."""
        return self.name(device), self._comments.get(device, "")

    def step_name(self, device: str) -> str:
        """What a step is called: its variable, the comment of its STL, or the comment line before it."""
        if device not in self.charted:
            return ""
        stl = self.charted[device]
        words = self.name(device) or stl.comment or self._titles.get(stl.position, "")
        return re.sub(rf"^{device}\b[\s:.,-]*", "", words)

    # -- values -------------------------------------------------------------------------------------------------

    def bit(self, device: str) -> int:
        """A bit as the program sees it; of T and C the contact."""
        area, number = self._place(device)
        return int(self.plc.memory.bits(area)[number])

    def terminal(self, device: str) -> int:
        """What the wiring holds at an input's terminal, and what an output's terminal gives."""
        area, number = self._place(device)
        return int((self.plc.inputs.terminals if area == "X" else self.plc.driven)[number])

    def _place(self, device: str) -> tuple[str, int]:
        place = self._places.get(device)
        if place is None:
            parsed, _ = self.plc.memory.parse(device)
            place = self._places[device] = parsed.area, parsed.number
        return place

    def value(self, operand: Any, wide: bool = False) -> int:
        """A constant, or the value of the register that stands in its place; `wide` of two registers, where the device can be had as that."""
        if isinstance(operand, Constant):
            return int(operand.value)
        index = 0 if operand.index is None else self.plc.memory.lists[operand.index_area][operand.index]
        device = replace(operand, number=operand.number + index, index=None)
        tail = ":DINT" if wide and device.area != "Z" and DINT in self.plc.memory.types(device) else ""
        return int(self.plc[f"{device}{tail}"])

    def flow(self, position: int) -> bool:
        """Whether power flowed at an instruction in the last recorded scan."""
        trace = self.plc.trace
        return bool(trace and trace.flow[position])

    @property
    def watchdog_ms(self) -> int:
        """The longest time the program may take."""
        return self.plc.system.watchdog_ms

    def run(self) -> dict[str, Any]:
        """The state of the run, which every panel is stamped with."""
        plc, session = self.plc, self.session
        errors = plc.errors if plc.system_error else []
        return {
            "state": session.state,
            "mode": "RUN" if plc.running else "STOP",
            "scan": plc.scans,
            "time_us": plc.time_us,
            "scan_us": plc.period_us,
            "recent": list(self.recent),
            "speed": session.speed,
            "plant": session.plant_on if session.plant is not None else None,
            "can_back": session.history.first is not None and session.history.first < plc.scans,
            "error": f"{type(session.error).__name__}: {session.error}" if session.error else "",
            "refused": self.refused or session.refused,
            "hit": session.hit.text if session.hit and session.state == "paused" else "",
            "held": int(session.transitions_held),
            "back": session.tip.scan - plc.scans,
            "back_us": session.tip.time_us - plc.time_us,
            "fault": f"Error {errors[0].code}, {errors[0].meaning}" if errors else "",
        }

    def machine_moment(self) -> Moment:
        """What the machine's picture is drawn from: the tags show the unit's terminals; other devices (M2, D2) stand with the inputs."""
        inputs = {
            device: self.terminal(device) if device.startswith("X") else self.plc[device]
            for device in self.wiring
            if not device.startswith("Y")
        }
        outputs = {device: self.terminal(device) for device in self.wiring if device.startswith("Y")}
        return Moment(self.session.plant, inputs, outputs)

    # -- steps --------------------------------------------------------------------------------------------------

    def active(self) -> list[str]:
        """The steps of the charts that are active, in the program's order."""
        return [device for device in self.charted if self.bit(device)]

    def since(self, device: str) -> tuple[int, int]:
        """How long a step has been active: microseconds and scans."""
        began_us = self.session.step_since.get(device)
        elapsed_us = 0 if began_us is None else self.plc.time_us - began_us
        return elapsed_us, round(elapsed_us / self.plc.period_us)

    @property
    def times(self) -> StepTimes:
        """The steps' past, from the session's log."""
        log = self.session.log
        now = len(log), log[-1] if log else None
        if now != self._times_of:
            self._times, self._times_of = StepTimes.of(log), now
        return self._times

    def _note_scan(self) -> None:
        self.recent.append(self.plc.period_us)

    def by(self, device: str) -> str:
        """Who drives an input: "hand", "machine" or "stuck"."""
        if not self.session.plant_on or device not in self.sensors.says:
            return "hand"
        fault = self.sensors.faults.get(device)
        return "stuck" if fault is not None and fault.kind == "stuck" else "machine"

    # -- what the page may do -----------------------------------------------------------------------------------

    def post(self, action: Callable[[Any], object]) -> None:
        """Have an action done in the session's thread; what it refuses is told in the run control, not raised there."""
        self.session.post(lambda plc: self._do(action, plc))

    def _do(self, action: Callable[[Any], object], plc: Any) -> None:
        try:
            action(plc)
            self.refused = ""
        except EcsimError as error:
            self.refused = str(error)

    def call(self, action: Callable[[], object]) -> None:
        """Do what the session may refuse; the reason is told in the run control."""
        self._do(lambda plc: action(), self.plc)

    def connect(self, on: bool) -> None:
        """Connect the machine to the terminals, or leave them to the hand."""
        if self.session.plant is not None:
            self.session.plant_on = on

    def put(self, device: str, level: float | None) -> None:
        """Put a level on an input; one that the machine drives is taken over and held."""
        self.post(lambda plc: self._put(plc, device, level))

    def _put(self, plc: Any, device: str, level: float | None) -> None:
        if self.by(device) == "hand":
            plc[device] = level
        else:
            self.sensors.fail(f"{device} stuck {level}")

    def signal(self, name: str, value: float | None) -> None:
        """Put a signal on an analog input, "AI0:V", None for none; one that the machine drives is taken over. Raises EcsimError for what cannot be."""
        self.plc.analog_point(name).check(value)
        if value is None and self.by(name) != "hand":
            raise EcsimError(f"{name} is driven by the machine; give a number, or disconnect the machine")
        self.put(name, value)

    def free(self, device: str) -> None:
        """Give an input back to the machine."""
        self.post(lambda plc: self.sensors.mend(device))
