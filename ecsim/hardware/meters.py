"""SPD: how many pulses an input gets in a stretch of time (6.10.8)."""

from dataclasses import dataclass, replace

from ..devices import Device
from ..memory import Memory
from ..values import signed16
from .inputs import Inputs
from .unit import Unit


@dataclass(frozen=True, slots=True)
class Meter:
    """One driven SPD: its input, its window in us, where its three words stand, and what the present window has so far."""

    source: int
    window: int
    target: Device
    begin: int
    pulses: int = 0


class Meters(Unit):
    """All driven SPD instructions. The result is written at the end of each window, the running count whenever time stops."""

    rank = 0

    def __init__(self, memory: Memory, inputs: Inputs, awake: list[Unit]):
        super().__init__(awake)
        self.memory, self.inputs = memory, inputs
        self.meters: dict[int, Meter] = {}
        self.time = 0

    def measure(self, claim: int, source: int, window_ms: int, target: Device, now: int) -> None:
        """SPD is driven: the first window begins now; a changed length holds for the windows that begin from now on."""
        meter = self.meters.get(claim)
        if meter is None:
            if not self.meters:
                self.time = now
            self.meters[claim] = Meter(source, window_ms * 1000, target, now)
            self._show(self.meters[claim], now)
            self.wake()
            self.inputs.check()
        elif (meter.window, meter.target) != (window_ms * 1000, target):
            self.meters[claim] = replace(meter, window=window_ms * 1000, target=target)

    def release(self, claim: int, now: int) -> None:
        if self.meters.pop(claim, None) is not None:
            self.wake(bool(self.meters))

    def restart(self, now: int) -> None:
        self.meters.clear()
        self.wake(False)

    def edge(self, number: int, level: bool, now: int) -> None:
        for claim, meter in self.meters.items():
            if meter.source == number and level:
                self.meters[claim] = meter = replace(meter, pulses=meter.pulses + 1)
                self._show(meter, now)

    def advance(self, now: int) -> None:
        since, self.time = self.time, now
        for claim, meter in self.meters.items():
            signal = self.inputs.signals.get(meter.source)
            ended = (now - meter.begin) // meter.window  # windows that end in this stretch
            if ended > 0:
                last = meter.begin + ended * meter.window
                begin = last - meter.window
                pulses = meter.pulses if ended == 1 else 0
                if signal is not None:
                    pulses += signal.count(True, max(since, begin), last)
                self.memory.lists[meter.target.area][meter.target.number] = signed16(pulses)
                meter = replace(meter, begin=last, pulses=0)
                since_then = last
            else:
                since_then = since
            if signal is not None:
                meter = replace(meter, pulses=meter.pulses + signal.count(True, since_then, now))
            self.meters[claim] = meter
            self._show(meter, now)

    def _show(self, meter: Meter, now: int) -> None:
        words, number = self.memory.lists[meter.target.area], meter.target.number
        words[number + 1 : number + 3] = signed16(meter.pulses), signed16((now - meter.begin) // 1000)

    def snapshot(self) -> tuple:
        return dict(self.meters), self.time

    def restore(self, snapshot: tuple) -> None:
        meters, self.time = snapshot
        self.meters = dict(meters)
        self.wake(bool(self.meters))
