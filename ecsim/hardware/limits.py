"""How fast inputs may be (6.10.8, 8.1.4, 8.2, 9.4): what is faster is counted all the same, and said in `warnings`."""

from collections import defaultdict
from math import inf

from .counters import Counters
from .inputs import FAST, Inputs
from .interrupts import Interrupts
from .meters import Meters
from .unit import Unit

SLACK = 1e-9  # of a sum of floats


class FrequencyLimits(Unit):
    """Holds the signals on the inputs against the greatest frequencies whenever a signal or what counts it begins."""

    def __init__(self, inputs: Inputs, counters: Counters, meters: Meters, interrupts: Interrupts, awake: list[Unit]):
        super().__init__(awake)
        self.inputs, self.counters, self.meters, self.interrupts = inputs, counters, meters, interrupts
        self.limits = defaultdict(lambda: inf, counters.model.limits)  # of what is not known no one is warned
        self.warnings: list[str] = []

    def _khz(self, number: int) -> float:
        signal = self.inputs.signals.get(number)
        return signal.hertz / 1000 if signal is not None else 0.0

    def check(self) -> None:
        """Note in `warnings` what is too fast at present."""
        if self.inputs.signals:
            self._counting()
            self._watching()

    def _counting(self) -> None:
        """8.1.4: each counter alone, by its own kind and its comparisons, and all together with SPD."""
        total, uses = 0.0, {""}
        for number in self.counters.presets:
            fast = self.counters.model.fast_counters[number]
            kinds = {comparison.kind for comparison in self.counters.comparisons.values() if comparison.counter == number}
            use = " zone" if "zone" in kinds else " compared" if kinds else ""
            uses.add(use)
            phases = fast.mode == "phases"
            limit = min(fast.khz, self.limits[f"kHz{use} phases" if phases else f"kHz{use} single"]) if use else fast.khz
            for source in fast.inputs[:1] if phases else fast.inputs:
                khz = self._khz(source)
                total += khz
                if khz > limit + SLACK:
                    self._warn(f"C{number} gets {khz:g} kHz, it counts up to {limit} kHz (manual 8.1.4)")
        limit = self.limits["kHz metered"]
        for source in sorted({meter.source for meter in self.meters.meters.values()}):
            khz = self._khz(source)
            total += khz
            if khz > limit + SLACK:
                self._warn(f"SPD gets {khz:g} kHz on X{source}, it measures up to {limit} kHz (manual 6.10.8)")
        limit = min(self.limits[f"kHz{use} together"] for use in uses)
        if total > limit + SLACK:
            who = "the counters and SPD" if self.meters.meters else "the counters"
            self._warn(f"{who} get {total:g} kHz together, {limit} kHz are allowed (manual 8.1.4)")

    def _watching(self) -> None:
        """8.2: all inputs together where one is captured. 9.4: each input with an interrupt program, and all of them together."""
        asking = {number for number, _, _ in self.interrupts.edges}
        if self.inputs.unfiltered - self.inputs.taken - asking:
            khz, limit = sum(map(self._khz, range(FAST))), self.limits["kHz captured together"]
            if khz > limit + SLACK:
                self._warn(f"X0 to X{FAST - 1} get {khz:g} kHz together, pulse capture allows {limit} kHz (manual 8.2)")
        limit, total = self.limits["Hz interrupting"], 0.0
        for number in sorted(asking):
            hertz = 1000 * self._khz(number)
            total += hertz
            if hertz > limit + SLACK:
                self._warn(f"X{number} asks for interrupts with {hertz:g} Hz, up to {limit} Hz are allowed (manual 9.4)")
        limit = self.limits["Hz interrupting together"]
        if total > limit + SLACK:
            self._warn(f"the inputs ask for interrupts with {total:g} Hz together, up to {limit} Hz are allowed (manual 9.4)")

    def _warn(self, text: str) -> None:
        if text not in self.warnings:
            self.warnings.append(text)

    def restart(self, now: int) -> None:
        self.warnings.clear()

    def snapshot(self) -> list[str]:
        return list(self.warnings)

    def restore(self, snapshot: list[str]) -> None:
        self.warnings[:] = snapshot
