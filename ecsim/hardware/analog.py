"""Analog channels: signals in volts, milliamperes or degrees, the mean of the last samples, and the channels of the base unit itself.

All channels are sampled together every 10 ms of simulated time.
"""

import re
from collections import deque
from collections.abc import Callable
from math import floor, inf, isfinite
from numbers import Real
from typing import Any, NamedTuple

from ..errors import EcsimError
from ..memory import Memory
from ..models.model import AnalogMode, AnalogPort
from .supply import Supply
from .unit import Unit

SAMPLE_US = 10_000
MOST_SAMPLES = 1000  # appendix 2, SD173
USUAL_SAMPLES = 8
FACES = {"V": "volts", "mA": "milliamperes", "C": "degrees"}


def ticks(since: int, now: int) -> int:
    """How many samples are taken after `since`, up to `now`."""
    return now // SAMPLE_US - since // SAMPLE_US


def number_of(mode: AnalogMode, zero: int, full: int, signal: tuple[str, float] | None) -> tuple[int, bool]:
    """What a signal becomes as a number, and whether it is one that the mode can measure; beyond its range it counts as the range's end.

    Without a signal there are 0 V or 0 mA; an open sensor of temperature reads as the highest one.
    """
    fits = signal is None or signal[0] == mode.unit
    value = signal[1] if signal is not None and fits else inf if mode.unit == "C" else 0.0
    held = min(max(value, mode.low), mode.high)
    number = zero + (held - mode.origin) * (full - zero) / (mode.high - mode.origin)
    return min(max(floor(number + 0.5), -0x8000), 0x7FFF), fits and held == value


def signal_of(mode: AnalogMode, zero: int, full: int, number: int) -> tuple[float, bool]:
    """What a number gives on an analog output, and whether it lies in the mode's range; beyond it the range's end is given."""
    value = mode.origin + (number - zero) * (mode.high - mode.origin) / (full - zero)
    held = min(max(value, mode.low), mode.high)
    return held, held == value


class Mean:
    """The mean of a channel's last samples, kept as runs of equal ones."""

    def __init__(self) -> None:
        self.runs: deque[list[int]] = deque()  # [number, how often], the oldest first
        self.total = self.count = 0

    def clear(self) -> None:
        self.runs.clear()
        self.total = self.count = 0

    def take(self, number: int, times: int, window: int) -> None:
        """`times` equal samples come; only the last `window` samples count."""
        if times:
            self.runs.append([number, times])
            self.total += number * times
            self.count += times
        while self.count > window:
            oldest = self.runs[0]
            gone = min(oldest[1], self.count - window)
            self.total -= oldest[0] * gone
            self.count -= gone
            oldest[1] -= gone
            if not oldest[1]:
                self.runs.popleft()

    @property
    def value(self) -> int:
        """The mean, halves rounded up; 0 before the first sample."""
        return (2 * self.total + self.count) // (2 * self.count) if self.count else 0

    def state(self) -> list[list[int]]:
        return [list(run) for run in self.runs]

    def restore(self, runs: list[list[int]]) -> None:
        self.clear()
        for number, times in runs:
            self.take(number, times, MOST_SAMPLES)


class Wires:
    """The terminals of analog inputs for one kind of signal: `volts[0] = 2.5` puts 2.5 V on the first, None takes the signal off."""

    def __init__(self, signals: list[tuple[str, float] | None], unit: str, wired: Callable[[], None]):
        self.signals, self.unit, self.wired = signals, unit, wired

    def __getitem__(self, channel: int) -> float | None:
        signal = self.signals[known_channel(channel, len(self.signals))]
        return signal[1] if signal is not None and signal[0] == self.unit else None

    def __setitem__(self, channel: int, value: float | None) -> None:
        self.signals[known_channel(channel, len(self.signals))] = self.fitting(value)
        self.wired()

    def fitting(self, value: float | None) -> tuple[str, float] | None:
        """A signal of this kind; raises EcsimError for what is no number."""
        if value is not None and (isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value)):
            raise EcsimError(f"an analog input takes a number of {FACES[self.unit]}, or None for no signal, not {value!r:.40}")
        return None if value is None else (self.unit, float(value))

    def __len__(self) -> int:
        return len(self.signals)

    def __repr__(self) -> str:
        return f"<{FACES[self.unit]} {[self[channel] for channel in range(len(self))]}>"


class Terminals:
    """The terminals of analog inputs by what is measured; `_wires` gives those of one kind of signal."""

    @property
    def volts(self) -> Wires:
        """Voltages on the inputs."""
        return self._wires("V")

    @property
    def milliamperes(self) -> Wires:
        """Currents into the inputs."""
        return self._wires("mA")


def known_channel(channel: int, count: int) -> int:
    """The number of a channel, if there is one of that number; raises EcsimError."""
    if isinstance(channel, bool) or channel not in range(count):
        raise EcsimError(f"there is no channel {channel!r}; there are {count}, counted from 0")
    return channel


class AnalogPoint(NamedTuple):
    """An analog terminal by its name: "AI0:V" is an input of the base unit, "AI1.2:mA" one of special module 1, "AO1.0:V" an output."""

    name: str
    owner: Any
    face: str
    channel: int

    def get(self) -> float | None:
        """The signal on the terminal in the name's unit; None where an input has none of that kind."""
        terminals = getattr(self.owner, self.face)
        return terminals[known_channel(self.channel, len(terminals))]

    def check(self, value: float | None) -> None:
        """Raise EcsimError unless the signal can be put on this terminal."""
        terminals = getattr(self.owner, self.face)
        if not isinstance(terminals, Wires):
            raise EcsimError(f"{self.name} is an output, which the program sets; signals go to inputs, AI")
        terminals.fitting(value)

    def put(self, value: float | None) -> None:
        """Put a signal on an input; raises EcsimError for an output."""
        self.check(value)
        getattr(self.owner, self.face)[self.channel] = value


_NAME = re.compile(r"A([IO])(?:(\d+)\.)?(\d+):(V|mA|C)")


def analog_point(name: str, base: Any, modules: Any) -> AnalogPoint | None:
    """The analog terminal of that name, None where the name is none of one; raises EcsimError when it is not there."""
    found = _NAME.fullmatch(name.strip())
    if found is None:
        return None
    sense, place, channel, unit = found.groups()
    owner = base if place is None else modules[int(place)]
    face = FACES[unit] if sense == "I" else f"output_{FACES[unit]}"
    if not hasattr(type(owner), face):
        raise EcsimError(f"{name}: {owner!r} has no {face.replace('_', ' ')}")
    point = AnalogPoint(name, owner, face, int(channel))
    point.get()
    return point


class Channel(NamedTuple):
    """An analog channel as it is set up now: its terminal, "AI1.0" or "AO0" without the kind of signal, and the mode it works in.

    `place` is that of its special module, -1 for the base unit; `units` are the kinds of signal that it can have. A channel that
    is off has no `mode`.
    """

    terminal: str
    place: int
    number: int
    units: tuple[str, ...]
    mode: AnalogMode | None

    @property
    def output(self) -> bool:
        return self.terminal.startswith("AO")


def analog_channels(base: Any, modules: Any) -> list[Channel]:
    """All analog channels that there are: those of the base unit, then those of the special modules by their places."""
    found = []
    for place, owner in ((-1, base), *sorted(modules.modules.items())):
        for sense, number, modes, mode in owner.channels():
            terminal = f"A{sense}{number}" if place < 0 else f"A{sense}{place}.{number}"
            found.append(Channel(terminal, place, number, tuple(dict.fromkeys(each.unit for each in modes)), mode))
    return found


class BaseAnalog(Terminals, Unit):
    """The analog channels of the base unit (appendix 1, section 11; appendix 2, section 13): `plc.analog.volts[0] = 2.5`.

    Relays enable the channels and choose between voltage and current. A channel takes samples while it is enabled; the
    mean starts anew when it is enabled and when its kind of signal changes.
    """

    def __init__(self, memory: Memory, supply: Supply, points: Callable[[], tuple[int, int]], awake: list[Unit], clock: list[int]):
        super().__init__(awake)
        self.memory, self.supply, self.points, self.clock = memory, supply, points, clock
        self.inputs, self.outputs = memory.model.analog_inputs, memory.model.analog_outputs
        self.signals: list[tuple[str, float] | None] = [None] * len(self.inputs)
        self.means = [Mean() for _ in self.inputs]
        self.modes: list[AnalogMode | None] = [None] * len(self.inputs)  # of the samples in the means
        self.time = 0

    # -- the terminals ------------------------------------------------------------------------------------------

    def _wires(self, unit: str) -> Wires:
        self._must_be_there()
        return Wires(self.signals, unit, self._wired)

    @property
    def output_volts(self) -> list[float]:
        """The voltages on the outputs; 0 V while a channel is not enabled."""
        self._must_be_there()
        return [self._given(port) for port in self.outputs]

    def _given(self, port: AnalogPort) -> float:
        model, (mode,) = self.memory.model, port.modes
        if not (self.supply.powered and self.memory.lists[model.special_bits][port.enable]):
            return 0.0
        return signal_of(mode, mode.zero, mode.full, self.memory.lists[model.special_words][port.register])[0]

    def channels(self) -> list[tuple[str, int, tuple[AnalogMode, ...], AnalogMode | None]]:
        """The channels that this base unit has: "I" or "O", number, the modes it can have, the mode it is in."""
        relays = self.memory.lists[self.memory.model.special_bits]
        sides = zip("IO", (self.inputs, self.outputs), self.points(), strict=True)
        ports = [(sense, number, port) for sense, side, count in sides for number, port in enumerate(side[:count])]
        return [(sense, number, port.modes, _mode(port, relays)) for sense, number, port in ports]

    def _must_be_there(self) -> None:
        if not any(self.points()):
            raise EcsimError("this base unit has no analog channels; the EC10 with 16 inputs and 14 outputs has them, or a special module")

    def _wired(self) -> None:
        if self not in self.awake:
            self.time = self.clock[0]
            self.wake()

    # -- time ---------------------------------------------------------------------------------------------------

    def advance(self, now: int) -> None:
        times = ticks(self.time, now)
        self.time = now
        model = self.memory.model
        relays, registers = self.memory.lists[model.special_bits], self.memory.lists[model.special_words]
        for channel, port in enumerate(self.inputs):
            mode = _mode(port, relays)
            mean = self.means[channel]
            if mode is not self.modes[channel]:
                self.modes[channel] = mode
                mean.clear()
            if mode is not None and times:
                number, _ = number_of(mode, mode.zero, mode.full, self.signals[channel])
                mean.take(number, times, min(max(registers[port.samples], 1), MOST_SAMPLES))
                registers[port.register] = mean.value

    def snapshot(self) -> dict:
        modes = [None if mode is None else port.modes.index(mode) for mode, port in zip(self.modes, self.inputs, strict=True)]
        return {
            "signals": [None if signal is None else list(signal) for signal in self.signals],
            "means": [mean.state() for mean in self.means],
            "modes": modes,
            "time": self.time,
            "awake": self in self.awake,
        }

    def restore(self, snapshot: dict) -> None:
        self.signals[:] = [None if signal is None else tuple(signal) for signal in snapshot["signals"]]
        for mean, runs in zip(self.means, snapshot["means"], strict=True):
            mean.restore(runs)
        self.modes = [None if place is None else port.modes[place] for place, port in zip(snapshot["modes"], self.inputs, strict=True)]
        self.time = snapshot["time"]
        self.wake(snapshot["awake"])


def _mode(port: AnalogPort, relays: list) -> AnalogMode | None:
    """How a channel of the base unit works, None while it is not enabled."""
    return port.modes[port.second is not None and relays[port.second]] if relays[port.enable] else None
