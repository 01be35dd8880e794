"""The base unit's terminals and what hangs on its extension bus: I/O modules, and special modules with their buffer memory (BFM, 6.8).

docs/modules.md has the map of the buffers and the modes of the analog modules.
"""

from collections.abc import Sequence
from numbers import Integral
from typing import Any

from ..devices import Device, OperandError, number_text
from ..errors import NO_ANSWER, NO_BUFFER, NO_MODULE, REFRESH, EcsimError, Fault
from ..memory import Memory
from ..models import Model
from ..models.model import AnalogMode, ModuleKind
from ..values import signed16
from .analog import FACES, MOST_SAMPLES, USUAL_SAMPLES, Mean, Terminals, Wires, number_of, signal_of, ticks
from .faults import SystemErrors
from .supply import Supply
from .unit import Unit

GROUP = 8  # each unit begins with the next multiple of eight (3.1.3)
OFF = -1  # the mode of a channel that is not used
# The parts of an analog module's buffer memory, each with one buffer a channel; behind them stand the status and the code.
VALUE, PRESENT, SAMPLES, MODE, ZERO, FULL = range(6)
PARTS = 6


class Extension:
    """What may hang on the extension bus."""

    kind = "extension"

    def __init__(self) -> None:
        self.present = True
        self.rack: Rack | None = None

    def remove(self) -> None:
        """Take the module off while the PLC has power: it does not answer (error 74) until `insert` or the next power-up, which forgets it."""
        self._attach(False)

    def insert(self) -> None:
        """Put a removed module back."""
        self._attach(True)

    def _attach(self, present: bool) -> None:
        if self.rack is None:
            raise EcsimError(f"{self!r} is not on the bus of a PLC; give it to plc.modules.add")
        self.present = present
        self.rack.changed()

    def reset(self) -> None:
        """Power comes: the module begins with its factory settings."""

    def state(self) -> Any:
        """What the module remembers, as plain data."""

    def restore(self, state: Any) -> None:
        """Take back what `state` gave."""


class DigitalModule(Extension):
    """An I/O module with so many inputs and outputs; `first` holds the numbers of its first X and its first Y."""

    kind = "digital"

    def __init__(self, inputs: int, outputs: int):
        super().__init__()
        self.inputs, self.outputs = points(inputs, outputs)
        self.first = {"X": 0, "Y": 0}

    def state(self) -> list[int]:
        return [self.inputs, self.outputs]

    def __repr__(self) -> str:
        return f"<DigitalModule {self.inputs} inputs, {self.outputs} outputs>"


class Module(Extension):
    """A special module as the base unit sees it: so many buffers of 16 bits. What a module does with them, a subclass says."""

    kind = "buffers"
    timed = False  # whether it works between scans

    def __init__(self, buffers: int):
        super().__init__()
        self.buffers = [0] * buffers

    def read(self, first: int, count: int) -> list[int]:
        """`count` buffers from `first` on; buffers that do not exist are error 78."""
        self._check(first, count)
        return self.buffers[first : first + count]

    def write(self, first: int, values: Sequence[int]) -> None:
        """Write buffers from `first` on."""
        self._check(first, len(values))
        self.buffers[first : first + len(values)] = [signed16(value) for value in values]

    def _check(self, first: int, count: int) -> None:
        if not self.present:
            raise Fault(NO_ANSWER)
        if first + count > len(self.buffers):
            raise Fault(NO_BUFFER)

    def advance(self, since: int, now: int) -> None:
        """Time goes from `since` to `now`."""

    def channels(self) -> list:
        """Its analog channels: "I" or "O", number, the modes it can have, the mode it is in."""
        return []

    def state(self) -> dict:
        return {"buffers": list(self.buffers)}

    def restore(self, state: dict) -> None:
        self.buffers[:] = state["buffers"]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {len(self.buffers)} buffers>"


class AnalogModule(Terminals, Module):
    """A 4AD, 4DA, 4PT, 4TC ...: `module.volts[0] = 2.5` puts a signal on an input, `module.output_volts[1]` tells what an output gives.

    Settings that make no sense stand in the buffers as they were written; their channel rests and the status tells of it.
    """

    timed = True

    def __init__(self, kind: ModuleKind):
        self.type = kind
        self.kind = kind.name
        self.status, self.code = PARTS * kind.channels, PARTS * kind.channels + 1
        super().__init__(PARTS * kind.channels + 2)
        self.signals: list[tuple[str, float] | None] = [None] * (0 if kind.output else kind.channels)
        self.means = [Mean() for _ in self.signals]
        self.reset()

    def reset(self) -> None:
        self.buffers[:] = [0] * len(self.buffers)
        self.buffers[self.code] = self.type.code
        for channel in range(self.type.channels):
            if self.signals:
                self._put(SAMPLES, channel, USUAL_SAMPLES)
            self._choose(channel, min(self.type.modes))

    # -- signals ------------------------------------------------------------------------------------------------

    @property
    def degrees(self) -> Wires:
        """Temperatures of the sensors in degrees Celsius; None is a broken sensor."""
        return self._wires("C")

    def _wires(self, unit: str) -> Wires:
        units = sorted({mode.unit for mode in self.type.modes.values()}) if self.signals else []
        if unit not in units:
            known = " and ".join(FACES[each] for each in units) or "outputs alone"
            raise EcsimError(f"a {self.kind} has no input for {FACES[unit]}; it has {known}")
        return Wires(self.signals, unit, lambda: None)

    @property
    def output_volts(self) -> list[float]:
        """The voltages that the outputs give; 0.0 where a channel gives a current or nothing."""
        return self._given("V")

    @property
    def output_milliamperes(self) -> list[float]:
        """The currents that the outputs give; 0.0 where a channel gives a voltage or nothing."""
        return self._given("mA")

    def _given(self, unit: str) -> list[float]:
        if not self.type.output:
            raise EcsimError(f"a {self.kind} has no outputs; a 4DA has")
        found = []
        for channel in range(self.type.channels):
            mode = self._mode(channel) if self.present and (self.rack is None or self.rack.supply.powered) else None
            given = 0.0
            if mode is not None and mode.unit == unit:
                given, _ = signal_of(mode, self._get(ZERO, channel), self._get(FULL, channel), self._get(PRESENT, channel))
            found.append(given)
        return found

    # -- buffers ------------------------------------------------------------------------------------------------

    def _get(self, part: int, channel: int) -> int:
        return self.buffers[part * self.type.channels + channel]

    def _put(self, part: int, channel: int, value: int) -> None:
        self.buffers[part * self.type.channels + channel] = value

    def _mode(self, channel: int) -> AnalogMode | None:
        """How a channel works, None while it is off or set up wrongly."""
        return None if self._wrong(channel) else self.type.modes.get(self._get(MODE, channel))

    def channels(self) -> list[tuple[str, int, tuple[AnalogMode, ...], AnalogMode | None]]:
        sense, modes = "O" if self.type.output else "I", tuple(self.type.modes.values())
        return [(sense, number, modes, self._mode(number)) for number in range(self.type.channels)] if self.present else []

    def _wrong(self, channel: int) -> bool:
        if self.signals and not 1 <= self._get(SAMPLES, channel) <= MOST_SAMPLES:
            return True
        mode = self._get(MODE, channel)
        return mode != OFF and (mode not in self.type.modes or self._get(ZERO, channel) == self._get(FULL, channel))

    def _choose(self, channel: int, mode: int) -> None:
        """Another mode brings its own zero and full scale."""
        self._put(MODE, channel, mode)
        if mode in self.type.modes:
            self._put(ZERO, channel, self.type.modes[mode].zero)
            self._put(FULL, channel, self.type.modes[mode].full)
        self._begin(channel)

    def _begin(self, channel: int) -> None:
        """A channel begins to work with its settings."""
        if self._get(MODE, channel) == OFF:
            self._put(PRESENT, channel, 0)
        if self.signals:
            self.means[channel].clear()
            self._put(VALUE, channel, self._get(PRESENT, channel))
        if self.signals or self._mode(channel) is None:
            self._tell(channel, False)
        else:
            self._give(channel)

    def write(self, first: int, values: Sequence[int]) -> None:
        """Write buffers from `first` on; those that the module itself writes keep their values."""
        self._check(first, len(values))
        for buffer, value in enumerate(map(signed16, values), first):
            part, channel = divmod(buffer, self.type.channels)
            if part == VALUE and self.type.output:
                self._put(VALUE, channel, value)
                self._begin(channel)
            elif part == MODE and value != self._get(MODE, channel):
                self._choose(channel, value)
            elif (part in (ZERO, FULL) or (part == SAMPLES and self.signals)) and value != self._get(part, channel):
                self._put(part, channel, value)
                self._begin(channel)

    def _give(self, channel: int) -> None:
        """An output follows its value."""
        number = self._get(VALUE, channel)
        _, fits = signal_of(self._mode(channel), self._get(ZERO, channel), self._get(FULL, channel), number)
        self._put(PRESENT, channel, number)
        self._tell(channel, not fits)

    def _tell(self, channel: int, beyond: bool) -> None:
        """Status: bit n, channel n is beyond its range; bit 8 + n, its settings make no sense."""
        bits = (1 << channel if beyond else 0) | (1 << 8 + channel if self._wrong(channel) else 0)
        self.buffers[self.status] = signed16(self.buffers[self.status] & ~(0x101 << channel) | bits)

    def advance(self, since: int, now: int) -> None:
        times = ticks(since, now) if self.present else 0
        if not times:
            return
        for channel, signal in enumerate(self.signals):
            mode = self._mode(channel)
            if mode is not None:
                number, fits = number_of(mode, self._get(ZERO, channel), self._get(FULL, channel), signal)
                mean = self.means[channel]
                mean.take(number, times, self._get(SAMPLES, channel))
                self._put(VALUE, channel, mean.value)
                self._put(PRESENT, channel, number)
                self._tell(channel, not fits)

    def state(self) -> dict:
        signals = [None if signal is None else list(signal) for signal in self.signals]
        return super().state() | {"signals": signals, "means": [mean.state() for mean in self.means]}

    def restore(self, state: dict) -> None:
        super().restore(state)
        self.signals[:] = [None if signal is None else tuple(signal) for signal in state["signals"]]
        for mean, runs in zip(self.means, state["means"], strict=True):
            mean.restore(runs)

    def __repr__(self) -> str:
        return f"<AnalogModule {self.kind}>"


def check_io(model: Model, io: Any) -> None:
    """Raise EcsimError unless a model has the base unit and the modules that `io` names."""
    memory = Memory(model)
    Rack(memory, SystemErrors(memory, []), Supply(memory, []), [], [0]).configure(io)


def points(inputs: Any, outputs: Any) -> tuple[int, int]:
    """Numbers of inputs and outputs; raises EcsimError for what is none."""
    for count in (inputs, outputs):
        if not isinstance(count, Integral) or isinstance(count, bool) or count < 0:
            raise EcsimError(f"{count!r} is no number of points; write (inputs, outputs), for example (8, 8)")
    if inputs + outputs == 0:
        raise EcsimError("a unit without inputs and outputs; write (inputs, outputs), for example (8, 8)")
    return int(inputs), int(outputs)


# -- the system block's settings of special modules (2.2.1, EC10) ---------------------------------------------------------

_PARTS = {"mode": MODE, "zero": ZERO, "full_scale": FULL, "samples": SAMPLES}
_LINKS = {False: {"mean": VALUE, "present": PRESENT}, True: {"value": VALUE}}  # by ModuleKind.output: what a D register stands for


def check_settings(model: Model, place: int, settings: dict) -> None:
    """Raise EcsimError unless a module can be set so: {"kind": "4AD", "channels": [{"mode": 0, "mean": "D100"}, ...]}."""
    kind = model.module_kinds.get(settings.get("kind"))
    if kind is None:
        raise EcsimError(
            f"modules: place {place} has the kind {settings.get('kind')!r}; {model.name} knows {', '.join(model.module_kinds)}"
        )
    unknown = set(settings) - {"kind", "channels"}
    if unknown:
        raise EcsimError(f"modules: place {place} has no setting {min(unknown)!r}; known are kind and channels")
    channels = settings.get("channels", [])
    if not isinstance(channels, (list, tuple)) or len(channels) > kind.channels or not all(isinstance(each, dict) for each in channels):
        raise EcsimError(
            f"modules: place {place} has channels {channels!r:.60}; a {kind.name} takes a list of up to {kind.channels} tables"
        )
    for channel, given in enumerate(channels):
        where = f"modules: place {place}, channel {channel}"
        links = _LINKS[kind.output]
        known = [name for name in (*_PARTS, *links) if name != "samples" or not kind.output]
        for name, value in given.items():
            if name not in known:
                raise EcsimError(f"{where} has no setting {name!r}; a {kind.name} has {', '.join(known)}")
            if name in links:
                _register(model, value, where)
            elif isinstance(value, bool) or not isinstance(value, int) or not -0x8000 <= value <= 0x7FFF:
                raise EcsimError(f"{where}: {name} is {value!r}; it is a number of 16 bits")
        mode = given.get("mode", min(kind.modes))
        if mode != OFF and mode not in kind.modes:
            raise EcsimError(f"{where}: there is no mode {mode}; a {kind.name} has {OFF} (off) and {', '.join(map(str, kind.modes))}")
        if not 1 <= given.get("samples", 1) <= MOST_SAMPLES:
            raise EcsimError(f"{where}: samples is {given['samples']}; the mean is taken of 1 to {MOST_SAMPLES}")
        usual = kind.modes.get(mode)
        if usual is not None and given.get("zero", usual.zero) == given.get("full_scale", usual.full):
            raise EcsimError(f"{where}: zero and full scale are the same number; they must differ")


def _register(model: Model, name: Any, where: str) -> int:
    """The number of the D register that a channel is linked to."""
    try:
        device = model.syntax.parse(str(name))
    except OperandError:
        device = None
    if not isinstance(device, Device) or device.area != "D" or device.index is not None or device.number >= model.areas["D"].count:
        raise EcsimError(f"{where}: {name!r} is no register; write one of {model.areas['D'].span}")
    return device.number


class Rack(Unit):
    """The base unit's points and the extension bus: `plc.modules.add((8, 8))` adds an I/O module, `plc.modules.add("4AD")` a special one.

    Special modules are counted from 0 in the order in which they are added; `plc.modules[0]` is the first. Without a base
    unit (`Plc("EC20", io=(24, 16))`) every X and Y has a terminal.
    """

    def __init__(self, memory: Memory, health: SystemErrors, supply: Supply, awake: list[Unit], clock: list[int]):
        super().__init__(awake)
        self.memory, self.health, self.supply, self.clock = memory, health, supply, clock
        self.model = memory.model
        self.told: set[str] = set()  # the faults that the modules have reported
        self.base: tuple[int, int] | None = None
        self.digital: list[DigitalModule] = []
        self.modules: dict[int, Module] = {}
        self.settings: dict[int, dict] = {}  # of the system block, by place
        self.links: list[tuple[int, int, int, int]] = []  # place, part, channel, D register
        self.time = 0
        self.terminals: dict[str, list[range]] = {}

    # -- the configuration --------------------------------------------------------------------------------------

    def configure(self, io: Any) -> None:
        """Build what `io` names: (24, 16), a base unit alone, or [(24, 16), (8, 8), "4AD"], the base unit and its modules in order."""
        if not isinstance(io, (tuple, list)) or not io:
            raise EcsimError(
                f'io is {io!r}; write (inputs, outputs) of a base unit, or a list of it and its modules: [(24, 16), (8, 8), "4AD"]'
            )
        first, *others = [io] if isinstance(io[0], Integral) else io
        unit = tuple(first) if isinstance(first, list) else first
        if unit not in self.model.base_units:
            known = ", ".join(f"({x}, {y})" for x, y in self.model.base_units)
            raise EcsimError(f"{self.model.name} has no base unit {first!r}; choose (inputs, outputs) of {known}")
        self.base = unit
        self.changed()
        for each in others:
            self.add(each)

    @property
    def io(self) -> list | None:
        """What `configure` would build all this from; None without a base unit, and with modules that have no name for it."""
        kinds = [module.kind for module in self.modules.values()]
        if self.base is None or list(self.modules) != list(range(len(kinds))) or not self.model.module_kinds.keys() >= set(kinds):
            return None
        return [self.base, *((module.inputs, module.outputs) for module in self.digital), *kinds]

    def add(self, module: Any) -> Extension:
        """Put a module at the end of the bus: (inputs, outputs), the name of a special module, or a module; gives the module."""
        if isinstance(module, str):
            module = AnalogModule(self._kind(module))
        elif isinstance(module, (tuple, list)) and len(module) == 2:
            module = DigitalModule(*module)
        if not isinstance(module, Extension):
            raise EcsimError(f'{module!r} is no module; give (inputs, outputs), a name like "4AD" or a module')
        self._check_room(module)
        if isinstance(module, DigitalModule):
            self.digital.append(module)
        else:
            self.modules[next(place for place in range(self.model.limits["modules"]) if place not in self.modules)] = module
        module.rack, module.present = self, True
        self.changed()
        return module

    def _kind(self, name: str) -> ModuleKind:
        kinds = self.model.module_kinds
        kind = kinds.get(name.upper().removeprefix(f"{self.model.name}-"))
        if kind is None:
            raise EcsimError(f"{self.model.name} has no special module {name!r}; it has {', '.join(kinds)}")
        return kind

    def _check_room(self, module: Extension) -> None:
        if module.rack is not None and module in module.rack:
            raise EcsimError(f"{module!r} is on the bus of a PLC already; take another one")
        most = self.model.limits["modules"]
        if len(self.digital) + len(self.modules) >= most:
            raise EcsimError(f"{self.model.name} has room for {most} modules; take one off first")
        if isinstance(module, DigitalModule):
            if self.base is None:
                raise EcsimError(f"an I/O module needs a base unit before it; make Plc({self.model.name!r}, io={self.model.base_units[0]})")
            units = [self.base, *((each.inputs, each.outputs) for each in self.digital), (module.inputs, module.outputs)]
            if sum(map(sum, units)) > self.model.limits["points"]:
                raise EcsimError(f"{self.model.name} has at most {self.model.limits['points']} points; these are {sum(map(sum, units))}")
            for area, counts in zip("XY", zip(*units, strict=True), strict=True):
                if sum(-(-count // GROUP) * GROUP for count in counts) > self.model.areas[area].count:
                    raise EcsimError(f"{self.model.name} has no more {area} for {module!r} ({self.model.areas[area].span})")

    def power_up(self) -> None:
        """The base unit finds its modules and gives them their numbers (2.2.4); those that were removed are gone, all begin anew."""
        gone = [place for place, module in self.modules.items() if not module.present]
        for module in (*self.digital, *self.modules.values()):
            if not module.present:
                module.rack = None
        self.digital = [module for module in self.digital if module.present]
        self.modules = {
            place - sum(other < place for other in gone): module for place, module in sorted(self.modules.items()) if module.present
        }
        for module in self.modules.values():
            module.reset()
        self.changed()

    def changed(self) -> None:
        """A module came, went or was set up: find the terminals again, and show everything in relays and registers."""
        self.terminals = {"X": [], "Y": []}
        first = {"X": 0, "Y": 0}
        for unit in [self.base, *self.digital] if self.base is not None else []:
            counts = unit if unit is self.base else (unit.inputs, unit.outputs)
            if unit is not self.base:
                unit.first = dict(first)
            for area, count in zip("XY", counts, strict=True):
                if unit is self.base or unit.present:
                    self.terminals[area].append(range(first[area], first[area] + count))
                first[area] += -(-count // GROUP) * GROUP
        self.links = [
            (place, part, channel, _register(self.model, given[name], ""))
            for place, settings in self.settings.items()
            if self._as_set(place)
            for channel, given in enumerate(settings.get("channels", []))
            for name, part in _LINKS[self.modules[place].type.output].items()
            if name in given
        ]
        timed = any(module.timed for module in self.modules.values())
        if timed and self not in self.awake:
            self.time = self.clock[0]
        self.wake(timed)
        self._report()
        self.show()

    def _report(self) -> None:
        """Tell of modules that do not answer or are not those of the system block (errors 21, 22 and 26), and when that is over."""
        faults = {
            "I/O module": any(not module.present for module in self.digital),
            "special module": any(not module.present for module in self.modules.values()),
            "module configuration": bool(self.misplaced),
        }
        for part, faulty in faults.items():
            if faulty != (part in self.told) and part in self.health.parts:
                (self.health.damage if faulty else self.health.repair)(self.health.parts[part])
        self.told = {part for part, faulty in faults.items() if faulty}

    def show(self) -> None:
        """Tell in registers what is there (SD7, SD8, SD10 to SD12) and what does not answer (SD191, SD192)."""
        model, words = self.model, self.memory.lists[self.model.special_words]
        extension = [sum(module.inputs for module in self.digital), sum(module.outputs for module in self.digital)]
        silent = [place for place, module in enumerate(self.digital) if not module.present]
        silent_special = [place for place, module in sorted(self.modules.items()) if not module.present]
        values = {
            "modules": len(self.digital), "special modules": len(self.modules),
            "base points": _both(self.base or (0, 0)), "extension points": _both(extension), "analog points": _both(self.analog_points),
            "silent module": silent[0] if silent else 0, "silent special module": silent_special[0] if silent_special else 0,
        }  # fmt: skip
        for meaning, value in values.items():
            if meaning in model.registers:
                words[model.registers[meaning]] = value

    @property
    def analog_points(self) -> tuple[int, int]:
        """How many analog inputs and outputs the base unit has."""
        there = self.base is None or self.base == self.model.analog_base
        return (len(self.model.analog_inputs), len(self.model.analog_outputs)) if there else (0, 0)

    # -- terminals ----------------------------------------------------------------------------------------------

    def missing(self, area: str, numbers: range) -> int | None:
        """The first of some X or Y that has no terminal, None when all have one."""
        if self.base is None or area not in self.terminals:
            return None
        return next((number for number in numbers if not any(number in span for span in self.terminals[area])), None)

    def check(self, area: str, numbers: range) -> None:
        """Raise EcsimError unless all these X or Y have terminals."""
        number = self.missing(area, numbers)
        if number is not None:
            spans = [f"{area}{number_text(area, span[0])} to {area}{number_text(area, span[-1])}" for span in self.terminals[area] if span]
            raise EcsimError(f"{area}{number_text(area, number)} has no terminal; there are {' and '.join(spans)}")

    def refresh(self, area: str, numbers: range) -> None:
        """An immediate refresh of groups of eight: one without any terminal is error 75, and a register tells its number (6.8.7, SD26)."""
        for first in numbers[::GROUP]:
            group = range(first, first + GROUP)
            if self.base is not None and all(self.missing(area, range(number, number + 1)) is not None for number in group):
                self._note("faulty group", first // GROUP)
                raise Fault(REFRESH)

    # -- buffers ------------------------------------------------------------------------------------------------

    def read(self, place: int, first: int, count: int) -> list[int]:
        """Buffers of the module in a place; the register for it tells where an error was."""
        try:
            return self._at(place).read(first, count)
        except Fault:
            self._note("faulty module", place)
            raise

    def write(self, place: int, first: int, values: Sequence[int]) -> None:
        """Write buffers of the module in a place."""
        try:
            self._at(place).write(first, values)
        except Fault:
            self._note("faulty module", place)
            raise

    def _at(self, place: int) -> Module:
        if place not in self.modules:
            raise Fault(NO_MODULE)
        return self.modules[place]

    def _note(self, meaning: str, number: int) -> None:
        if meaning in self.model.registers:
            self.memory.lists[self.model.special_words][self.model.registers[meaning]] = number

    # -- the system block ---------------------------------------------------------------------------------------

    def set_up(self, settings: dict[int, dict]) -> None:
        """STOP -> RUN: the modules work as the system block has them."""
        self.settings = settings
        self.changed()
        for place, given in settings.items():
            module = self.modules.get(place)
            if self._as_set(place):
                for channel, parts in enumerate(given.get("channels", [])):
                    for name, part in _PARTS.items():
                        if name in parts:
                            module.write(part * module.type.channels + channel, [parts[name]])

    def _as_set(self, place: int) -> bool:
        """Whether the module in a place is there and of the kind that the system block has set."""
        module = self.modules.get(place)
        return module is not None and module.present and module.kind == self.settings[place]["kind"]

    @property
    def misplaced(self) -> list[int]:
        """The places in which another module hangs than the system block has set, or none (error 26)."""
        return [place for place in self.settings if not self._as_set(place)]

    # -- time ---------------------------------------------------------------------------------------------------

    def advance(self, now: int) -> None:
        registers = self.memory.lists["D"]
        for place, part, channel, number in self.links:
            if self.modules[place].type.output:
                self.modules[place].write(part + channel, [registers[number]])
        since, self.time = self.time, now
        for module in self.modules.values():
            module.advance(since, now)
        for place, part, channel, number in self.links:
            module = self.modules[place]
            if not module.type.output:
                registers[number] = module.buffers[part * module.type.channels + channel]

    # -- as a container of special modules ----------------------------------------------------------------------

    def __setitem__(self, place: int, module: Module) -> None:
        if isinstance(place, bool) or place not in range(self.model.limits["modules"]):
            raise EcsimError(f"special modules have the places 0 to {self.model.limits['modules'] - 1}, not {place!r}")
        if isinstance(module, str):
            module = AnalogModule(self._kind(module))
        if not isinstance(module, Module):
            raise EcsimError(f"{module!r} is no special module")
        former = self.modules.pop(place, None)
        try:
            self._check_room(module)
        except EcsimError:
            if former is not None:
                self.modules[place] = former
            raise
        if former is not None:
            former.rack = None
        self.modules[place] = module
        module.rack, module.present = self, True
        self.changed()

    def __getitem__(self, place: int) -> Module:
        if place not in self.modules:
            known = ", ".join(map(str, sorted(self.modules)))
            raise EcsimError(
                f"there is no special module in place {place!r}; " + (f"there are some in {known}" if known else "the rack is empty")
            )
        return self.modules[place]

    def __delitem__(self, place: int) -> None:
        self[place].rack = None
        del self.modules[place]
        self.changed()

    def __contains__(self, module: object) -> bool:
        return any(module is each for each in (*self.digital, *self.modules.values()))

    def __len__(self) -> int:
        return len(self.modules)

    def __repr__(self) -> str:
        return f"<Rack {dict(sorted(self.modules.items()))}>"

    # -- state --------------------------------------------------------------------------------------------------

    def snapshot(self) -> dict:
        """Everything on the bus as plain data: another PLC of the same model can be given it."""
        return {
            "base": None if self.base is None else list(self.base),
            "digital": [[module.state(), module.present] for module in self.digital],
            "special": [[place, module.kind, module.state(), module.present] for place, module in sorted(self.modules.items())],
            "settings": [[place, settings] for place, settings in self.settings.items()],
            "time": self.time,
        }

    def restore(self, snapshot: dict) -> None:
        """Go back to a snapshot; modules that are no longer the same are built anew, those that are keep their identity."""
        built = {}
        for place, kind, state, _ in snapshot["special"]:
            module = self.modules.get(place)
            built[place] = module if module is not None and module.kind == kind else self.built(place, kind, state)
        points_then = [state for state, _ in snapshot["digital"]]
        if [module.state() for module in self.digital] != points_then:
            self.digital = [DigitalModule(*state) for state in points_then]
        self.base = None if snapshot["base"] is None else tuple(snapshot["base"])
        self.modules = built
        self.settings = dict(snapshot["settings"])
        for module, (_, present) in zip(self.digital, snapshot["digital"], strict=True):
            module.rack, module.present = self, present
        for place, _, state, present in snapshot["special"]:
            module = self.modules[place]
            module.restore(state)
            module.rack, module.present = self, present
        self.changed()
        self.time = snapshot["time"]

    def built(self, place: int, kind: str, state: dict) -> Module:
        """A new module of a kind; raises EcsimError for one that ecsim does not know."""
        if kind in self.model.module_kinds:
            return AnalogModule(self.model.module_kinds[kind])
        if kind == Module.kind:
            return Module(len(state["buffers"]))
        raise EcsimError(f"ecsim cannot build the special module {kind!r} of place {place}; put one into plc.modules[{place}] first")


def _both(counts: Sequence[int]) -> int:
    """Inputs in the high byte, outputs in the low one (SD10 to SD12)."""
    return signed16(min(counts[0], 255) << 8 | min(counts[1], 255))
