"""What the panels tell of the past: how long steps were active, which followed which, and bits that pulsed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any


@dataclass(frozen=True, slots=True)
class Change:
    """Steps that ended and began in one scan."""

    time_us: int
    left: tuple[str, ...]
    entered: tuple[str, ...]


@dataclass(slots=True)
class StepTimes:
    """The session's log of steps, summed up: changes newest first, and each step's mean time and how often it was active."""

    changes: list[Change] = field(default_factory=list)
    usual: dict[str, tuple[float, int]] = field(default_factory=dict)

    @classmethod
    def of(cls, log: Iterable[Any]) -> StepTimes:
        """Sum up a log whose entries have time_us, scan, step and active, oldest first."""
        times = cls()
        began: dict[str, int] = {}
        for (time_us, _), entries in groupby(log, key=lambda entry: (entry.time_us, entry.scan)):
            entries = list(entries)
            left = tuple(entry.step for entry in entries if not entry.active)
            entered = tuple(entry.step for entry in entries if entry.active)
            for step in left:
                if step in began:
                    times._count(step, time_us - began.pop(step))
            began.update(dict.fromkeys(entered, time_us))
            times.changes.insert(0, Change(time_us, left, entered))
        return times

    def _count(self, step: str, lasted_us: int) -> None:
        mean, count = self.usual.get(step, (0.0, 0))
        self.usual[step] = mean + (lasted_us - mean) / (count + 1), count + 1


class Pulses:
    """Bits that were on in a scan between two frames and are off in both: a frame alone would never show them."""

    def __init__(self):
        self._before: frozenset[str] = frozenset()
        self._seen: set[str] = set()

    def see(self, on: Iterable[str]) -> None:
        """Take note of the bits that are on after a scan."""
        self._seen.update(on)

    def take(self, on: Iterable[str]) -> list[str]:
        """The bits that pulsed since the last call; `on` are those that are on now."""
        now = frozenset(on)
        pulsed = sorted(self._seen - now - self._before)
        self._before, self._seen = now, set()
        return pulsed


def changes(before: Mapping[str, object], now: Mapping[str, object]) -> dict[str, object]:
    """The entries of `now` that differ from `before`; None for those that are gone."""
    missing = object()
    changed = {key: value for key, value in now.items() if before.get(key, missing) != value}
    changed.update(dict.fromkeys(before.keys() - now.keys()))
    return changed
