"""The way from a machine's sensors to the inputs of the PLC, and what is wrong with it: one for sessions, panels and grading.

A fault is told in words: one of the machine's own ("jammed"), or a sensor by device or name with what it does: "X1 stuck 0",
"InLift inverted", "X1 delayed 0.5" (seconds), "X1 bounces 30" (milliseconds; a second number is the seed). Edges come at their own
times, also between scans, so that counters, interrupts and the input filter meet them as on a real line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite, nan
from random import Random
from typing import Any, NamedTuple

from .errors import EcsimError
from .hardware.signals import Edges
from .system import within

ALL = "all"  # what `mend` takes for everything
MOST_BOUNCES = 3  # how often a contact opens again behind an edge: 1 to so many times


class Kind(NamedTuple):
    """What can be wrong with a sensor: in words with its number, and the number's unit and limits where it has any."""

    words: str
    unit: str = ""
    least: float = 0.0
    most: float = 0.0


KINDS = {
    "stuck": Kind("stuck at {:g}"),
    "inverted": Kind("inverted"),
    "delayed": Kind("delayed by {:g} s", "s", 0.001, 600),
    "bounces": Kind("bounces for {:g} ms", "ms", 0.1, 1000),
}

NUMBERS = {"inverted": (0, 0), "bounces": (1, 2)}  # how many follow, where it is not one


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong with one sensor; `amount` is a level, seconds or milliseconds, by the kind."""

    device: str
    kind: str
    amount: float = 0.0
    seed: int = 0

    @property
    def words(self) -> str:
        """What it does: "delayed by 0.5 s"."""
        return KINDS[self.kind].words.format(self.amount)

    def __str__(self) -> str:
        amount = "" if self.kind == "inverted" else f" {self.amount:g}"
        return f"{self.device} {self.kind}{amount}{f' {self.seed}' if self.seed else ''}"


class Sensors:
    """What a machine's sensors say, and what of that comes to the inputs. The machine itself knows nothing of it."""

    def __init__(self, plc: Any, plant: Any):
        self.plc, self.plant = plc, plant
        self.says: dict[str, int] = {}  # device -> what the sensor says; the session asks before any time passes
        self.connected = True  # else the inputs are in the user's hand
        self.faults: dict[str, Fault] = {}  # device -> what is wrong with its sensor; replaced, never altered
        wiring = getattr(plant, "wiring", {})  # devices, or a mapping of them to what they are
        self.names = {device: getattr(wiring[device] if isinstance(wiring, Mapping) else None, "name", "") for device in wiring}

    # -- what is wrong ------------------------------------------------------------------------------------------

    @property
    def own(self) -> Mapping[str, str]:
        """The faults that the machine itself can have: name -> what is then wrong."""
        return getattr(self.plant, "FAULTS", {})

    @property
    def active(self) -> list[str]:
        """All faults that are switched in, as `fail` takes them."""
        return [*sorted(getattr(self.plant, "faults", ())), *map(str, self.faults.values())]

    def read(self, text: str) -> Fault | None:
        """What a text says of a sensor, None for a fault of the machine's own; raises EcsimError for what is neither."""
        if text in self.own:
            return None
        name, kind, *numbers = [*text.split(), "", ""][: max(2, len(text.split()))]
        if kind not in KINDS:
            machine = ", ".join(self.own) or "no faults of its own"
            raise EcsimError(
                f"there is no fault {text!r}; the machine has {machine}, a sensor is stuck 0 or 1, inverted, delayed or bounces"
            )
        device = self._sensor(name)
        least, most = NUMBERS.get(kind, (1, 1))
        try:
            amount, seed = float((numbers or "0")[0]), int((*numbers, "0", "0")[1])
        except ValueError:
            amount, seed = nan, 0
        if not isfinite(amount) or not least <= len(numbers) <= most:
            needs = f"{kind} needs a number ({KINDS[kind].unit or 'level'})" if most else f"no number follows {kind}"
            raise EcsimError(f"{text!r} is no fault: {needs}")
        self._check(device, kind, amount)
        return Fault(device, kind, amount, seed)

    def _sensor(self, name: str) -> str:
        device = next((device for device, known in self.names.items() if known == name), name)
        if device not in self.says:
            known = ", ".join(f"{one} {self.names.get(one, '')}".strip() for one in self.says) or "none"
            raise EcsimError(f"the machine has no sensor {name!r}; it has {known}")
        return device

    def _check(self, device: str, kind: str, amount: float) -> None:
        is_input = device.startswith("X")
        if kind == "stuck" and (not is_input or amount not in (0, 1)):
            self.plc._check_write(device, int(amount) if amount == int(amount) else amount)
        elif kind != "stuck" and not is_input:
            raise EcsimError(f"{device} is no contact but a value; it can be stuck only")
        elif KINDS[kind].unit:
            within(f"{device} {kind}", amount, KINDS[kind].least, KINDS[kind].most)

    def fail(self, text: str) -> None:
        """Switch a fault in at once; a sensor has one at a time. Raises EcsimError for one that there is not."""
        fault = self.read(text)
        if fault is None:
            self.plant.fail(text)
        else:
            self.faults = {**self.faults, fault.device: fault}
            self._renew([fault.device])

    def mend(self, text: str = ALL) -> None:
        """Switch out a fault of the machine's own, that of a sensor (by device or name), or all. Raises EcsimError for what is none."""
        own = list(getattr(self.plant, "faults", ())) if text == ALL else [text] if text in self.own else []
        for fault in own:
            self.plant.fail(fault, on=False)
        if text == ALL or not own:
            mended = list(self.faults) if text == ALL else [self._sensor(text)]
            self.faults = {device: fault for device, fault in self.faults.items() if device not in mended}
            self._renew(mended)

    # -- what comes through -------------------------------------------------------------------------------------

    def pass_on(self, says: Mapping[str, int], now: int) -> dict[str, int]:
        """The sensors say this at `now` (us): what is to be put on the inputs. What comes later is on its way as a signal."""
        before, self.says = self.says, says
        if not self.faults:
            return says
        levels = dict(says)
        for device, fault in self.faults.items():
            if fault.kind in ("delayed", "bounces"):
                level = levels.pop(device)
                if level != before.get(device):
                    self._send(fault, bool(level), now)
            else:
                levels[device] = self._level(fault)
        return levels

    def renew(self) -> None:
        """Put on all inputs what has come through by now, whatever the hand has put there."""
        self._renew(self.says)

    def _renew(self, devices: Any) -> None:
        if self.connected:
            faults = self.faults
            self.plc.set({device: self._level(faults[device]) if device in faults else self.says[device] for device in devices})

    def _level(self, fault: Fault) -> int:
        """What comes of a sensor that has not changed."""
        said = self.says[fault.device]
        amount = int(fault.amount) if fault.amount == int(fault.amount) else fault.amount
        return {"stuck": amount, "inverted": int(not said)}.get(fault.kind, said)

    def _send(self, fault: Fault, level: bool, now: int) -> None:
        """An edge is on its way over a slow line, or from a worn contact."""
        inputs = self.plc.inputs
        number = self.plc.memory.parse(fault.device)[0].number
        if fault.kind == "delayed":
            coming = [moment for moment, _ in inputs.signals[number].edges(now)] if number in inputs.signals else []
            times = [*coming, now + round(fault.amount * 1e6)]
        else:
            chance = Random(f"{fault.seed} {fault.device} {now}")
            bounces = {now + chance.randrange(1, round(fault.amount * 1000)) for _ in range(2 * chance.randint(1, MOST_BOUNCES))}
            bounces = sorted(bounces)[: len(bounces) // 2 * 2]
            times = [now, *bounces]
        first = level ^ bool(len(times) & 1)
        inputs.drive(number, Edges(tuple(times), first), now)

    def state(self) -> tuple:
        """Everything that changes; `restore` takes it back. What is on its way belongs to the inputs."""
        return self.faults, self.says

    def restore(self, state: tuple) -> None:
        """Make everything what it was when `state` was taken."""
        self.faults, self.says = state
