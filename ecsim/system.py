"""The system block (2.2.1): what a PLC is set to besides its program, each option checked against the model."""

from dataclasses import dataclass, field
from numbers import Real
from typing import Any

from .devices import Device
from .errors import EcsimError
from .hardware.modules import check_settings
from .hardware.serial import PortSettings
from .memory import Memory
from .models import Model

STOP_OUTPUTS = ("disable", "freeze", "configure")
PRIORITIES = ("low", "high")


@dataclass
class SystemBlock:
    """What the system block sets; a Plc refuses settings that its model does not have.

    `retain` maps an area to its retained ranges, [(first, last), ...] as numbers. `run_input` is the input that puts the PLC
    into RUN, or None. `interrupt_priority` maps an interrupt event to "low" or "high". `modules` maps the place of a special
    module to its settings. A port of None is as the unit comes: port 0 for programming, port 1 for nothing. `data_block` belongs to the project and is downloaded with it; it holds D registers ("D0",
    "D0:DINT") and their values.
    """

    retain: dict[str, list[tuple[int, int]]] = field(default_factory=dict)
    hold_values: bool = False
    data_block: dict[str, int | float] = field(default_factory=dict)
    data_block_valid: bool = True
    stop_outputs: str = "disable"  # disable, freeze or configure
    stop_output_table: dict[str, int] = field(default_factory=dict)
    watchdog_ms: int = 200
    constant_scan_ms: int = 0
    input_filter_ms: float | None = None
    power_loss_ms: int = 0
    run_input: str | None = None
    interrupt_priority: dict[int, str] = field(default_factory=dict)
    no_battery: bool = False
    format_lock: bool = False
    modules: dict[int, dict[str, Any]] = field(default_factory=dict)
    port0: PortSettings | None = None
    port1: PortSettings | None = None

    def retention(self, model: Model) -> dict[str, frozenset[int]]:
        """The devices that keep their values, by area: what `retain` names, or else what is usual, and what the model always retains."""
        found = {}
        for area in model.retained:
            runs = (*self.retain.get(area, model.usual_retention.get(area, ())), *model.fixed_retention.get(area, ()))
            found[area] = frozenset(number for first, last in runs for number in range(first, last + 1))
        return found

    def check(self, model: Model) -> None:
        """Raise EcsimError for a setting that the model does not have."""
        for setting, remedy in model.unset.items():
            if getattr(self, setting) != getattr(_USUAL, setting):
                raise EcsimError(f"{setting} is {getattr(self, setting)!r:.40}, but {model.name} has no such setting; {remedy}")
        for table in ("retain", "data_block", "stop_output_table", "interrupt_priority", "modules"):
            if not isinstance(getattr(self, table), dict):
                raise EcsimError(f"{table} is {getattr(self, table)!r:.40}; write a dict, as retain={{'D': [(100, 199)]}} is one")
        if self.stop_outputs not in STOP_OUTPUTS:
            raise EcsimError(f"stop_outputs is {self.stop_outputs!r}; choose {' or '.join(STOP_OUTPUTS)}")
        for switch in ("hold_values", "data_block_valid", "no_battery", "format_lock"):
            if not isinstance(getattr(self, switch), bool):
                raise EcsimError(f"{switch} is {getattr(self, switch)!r}; write True or False")
        within("watchdog_ms", self.watchdog_ms, 0, 1000)
        within("constant_scan_ms", self.constant_scan_ms, 0, 1000)
        if self.constant_scan_ms > self.watchdog_ms > 0:
            raise EcsimError(
                f"constant_scan_ms is {self.constant_scan_ms}, above the watchdog's {self.watchdog_ms}; raise watchdog_ms (2.1.4)"
            )
        choices = model.filter_choices
        if self.input_filter_ms is not None and choices and (isinstance(self.input_filter_ms, bool) or self.input_filter_ms not in choices):
            raise EcsimError(f"input_filter_ms is {self.input_filter_ms!r}; {model.name} takes {choice_text(choices)}")
        longest = model.limits.get("power loss ms", 0)
        if self.power_loss_ms and not longest:
            raise EcsimError(f"power_loss_ms is {self.power_loss_ms!r}, but {model.name} has no such setting; leave it out (2.2.1)")
        within("power_loss_ms", self.power_loss_ms, 0, longest)
        if self.no_battery and not model.battery:
            raise EcsimError(f"no_battery is set, but {model.name} has no battery that could be missing; leave it out (2.1.10)")
        self._check_retention(model)
        self._check_devices(model)
        self._check_interrupts(model)
        self._check_modules(model)
        for number, port in enumerate((self.port0, self.port1)):
            if port is not None:
                if not isinstance(port, PortSettings):
                    raise EcsimError(f"port{number} is {port!r:.40}; write PortSettings, for example PortSettings('freeport')")
                port.check(model, number)

    def _check_retention(self, model: Model) -> None:
        held = {"bits": 0, "words": 0, "counters": 0}
        for area, ranges in self.retain.items():
            if area not in model.retained:
                raise EcsimError(f"{model.name} cannot retain {area}; it retains {', '.join(model.retained)}")
            if not isinstance(ranges, (list, tuple)) or not all(isinstance(each, (list, tuple)) and len(each) == 2 for each in ranges):
                raise EcsimError(f"retain of {area} is {ranges!r:.40}; write a list of ranges, for example [(100, 199)]")
            if len(ranges) > model.retention_limits.get("ranges", len(ranges)):
                raise EcsimError(f"retain has {len(ranges)} ranges of {area}; {model.name} takes {model.retention_limits['ranges']}")
            count = model.ordinary(area)
            for first, last in ranges:
                if not (isinstance(first, int) and isinstance(last, int) and 0 <= first <= last < count):
                    raise EcsimError(
                        f"retain names {area} from {first!r} to {last!r}; write numbers from 0 to {count - 1}, the first one first"
                    )
            size = len({number for first, last in ranges for number in range(first, last + 1)})
            held["bits" if model.areas[area].kind == "bit" else "words"] += size
            held["counters"] += size if model.areas[area].kind == "counter" else 0
        for what, size in held.items():
            if size > model.retention_limits.get(what, size):
                raise EcsimError(f"retain names {size} {what}; {model.name} can retain {model.retention_limits[what]} of them")

    def _check_devices(self, model: Model) -> None:
        """The data block, the output table and the input that puts into RUN name devices that exist, with values that they hold."""
        if not (self.data_block or self.stop_output_table or self.run_input is not None):
            return
        memory = Memory(model)
        for where, area in (("data_block", "D"), ("stop_output_table", "Y")):
            taken: dict[int, str] = {}
            for name, value in getattr(self, where).items():
                device, kind = memory.parse(name)
                if not isinstance(device, Device) or device.area != area:
                    raise EcsimError(f"{where} names {name}; it holds {area} devices")
                memory.fitting(device, kind, value)
                for number in range(device.number, device.number + max(1, kind.words)):
                    if number in taken:
                        raise EcsimError(f"{where} sets {Device(area, number)} twice, by {taken[number]} and by {name}; leave one out")
                    taken[number] = name
        if self.run_input is not None:
            device, _ = memory.parse(self.run_input)
            last = Device("X", model.limits.get("run inputs", 0) - 1)
            if not isinstance(device, Device) or device.area != "X" or device.number > last.number:
                raise EcsimError(f"run_input is {self.run_input!r}; choose one of X0 to {last}, or None")

    def _check_interrupts(self, model: Model) -> None:
        for event, level in self.interrupt_priority.items():
            if event not in model.events:
                raise EcsimError(
                    f"interrupt_priority names event {event!r}; {model.name} has {', '.join(map(str, sorted(model.events)))} (9.1)"
                )
            if level not in PRIORITIES:
                raise EcsimError(f"interrupt_priority of event {event} is {level!r}; choose {' or '.join(PRIORITIES)}")

    def _check_modules(self, model: Model) -> None:
        places = model.limits.get("modules set up", 0)
        for place, settings in self.modules.items():
            if not isinstance(place, int) or not 0 <= place < places:
                where = f"write a place from 0 to {places - 1}" if places else "set its modules up with TO"
                raise EcsimError(f"modules names place {place!r}, which the system block of {model.name} has not; {where} (2.2.1)")
            if not isinstance(settings, dict) or not isinstance(settings.get("kind", ""), str):
                raise EcsimError(f"modules: place {place} is set to {settings!r:.40}; write its settings by name, its kind as text")
            check_settings(model, place, settings)


_USUAL = SystemBlock()


def within(what: str, value: Any, low: float, high: float) -> None:
    """Raise EcsimError unless a number lies within its range."""
    if isinstance(value, bool) or not isinstance(value, Real) or not low <= value <= high:
        raise EcsimError(f"{what} is {value!r}; it is a number from {low:g} to {high:g}")


def choice_text(choices: tuple[int, ...]) -> str:
    """Numbers to choose from, in words: "0 to 60", "0, 8, 16, 32 or 64"."""
    if choices == tuple(range(choices[0], choices[-1] + 1)):
        return f"{choices[0]} to {choices[-1]}"
    return f"{', '.join(map(str, choices[:-1]))} or {choices[-1]}"
