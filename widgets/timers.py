"""Timers and counters in use: value, preset, contact, time unit and what they do, in words; the time of the active steps."""

from collections.abc import Callable

from .panel import Part

KINDS = {
    "TON": "timer",
    "TONR": "timer",
    "TOF": "timer",
    "TMON": "timer",
    "CTU": "counter",
    "CTR": "counter",
    "DCNT": "counter",
    "HCNT": "counter",
}
# Coils that are one of these by the number of their device.
LIKE = {
    "FX:OUT T": "TON",
    "FX:OUT T D": "TON",
    "FX:OUT T246": "TONR",
    "FX:OUT T246 D": "TONR",
    "FX:OUT C": "CTU",
    "FX:OUT C200": "DCNT",
    "FX:OUT C235": "HCNT",
}
BASES = {100_000: "100 ms", 10_000: "10 ms", 1_000: "1 ms"}


def duration(units: int, base_us: int) -> str:
    """So many time units as text, as precise as the unit: "0.3 s", "2.50 s", "7 ms"."""
    if base_us == 1_000 and units < 1_000:
        return f"{units} ms"
    digits = {100_000: 1, 10_000: 2}.get(base_us, 3)
    return f"{units * base_us / 1e6:,.{digits}f} s"


def _runs(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if on:
        return "done", f"*done*, {duration(value, base_us)}"
    if value or flow:
        return "run", f"{duration(value, base_us)}, *{duration(max(0, preset - value), base_us)} to go*"
    return "off", "off"


def _retains(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if value and not flow and not on:
        return "held", f"*held* at {duration(value, base_us)}"
    return _runs(value, preset, on, flow, base_us)


def _lags(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if on and flow:
        return "run", "*on*, waits for its input to go off"
    if on:
        return "run", f"{duration(value, base_us)}, *off in {duration(max(0, preset - value), base_us)}*"
    return "off", "off"


def _pulses(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if on:
        return "run", f"{duration(value, base_us)}, *{duration(max(0, preset - value), base_us)} to go*"
    return "off", "off"


def _counts(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if on:
        return "done", "*reached*"
    return ("run" if value else "off"), f"{preset - value:,} to go"


def _rings(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    if on:
        return "done", "*reached*, next edge makes 1"
    return _counts(value, preset, on, flow, base_us)


def _both_ways(value: int, preset: int, on: bool, flow: bool, base_us: int) -> tuple[str, str]:
    state = "done" if on else "run" if value else "off"
    return state, "*reached*" if on else f"{preset - value:,} to go".replace("-", "\N{MINUS SIGN}")


# What a timer or counter does, as a state and in words: (value, preset, contact, flow, time unit) -> (state, words).
WORDS: dict[str, Callable[[int, int, bool, bool, int], tuple[str, str]]] = {
    "TON": _runs,
    "TONR": _retains,
    "TOF": _lags,
    "TMON": _pulses,
    "CTU": _counts,
    "CTR": _rings,
    "DCNT": _both_ways,
    "HCNT": _both_ways,
}
WIDE = ("DCNT", "HCNT")  # 32 bits, up and down
RATE_US = 200_000  # simulated time over which a frequency is measured


class Rate:
    """How fast a counter counts, from what it was some simulated time ago."""

    def __init__(self) -> None:
        self.since: tuple[int, int] | None = None
        self.hz = 0.0

    def see(self, time_us: int, value: int) -> float:
        """The counts a second over the last whole stretch of time."""
        if self.since is None or time_us < self.since[0]:
            self.since, self.hz = (time_us, value), 0.0
        elif time_us - self.since[0] >= RATE_US:
            self.hz = abs(value - self.since[1]) * 1e6 / (time_us - self.since[0])
            self.since = time_us, value
        return self.hz


def frequency(hz: float) -> str:
    """A frequency as text: "40 Hz", "4.1 kHz"."""
    return f"{hz / 1000:,.1f} kHz" if hz >= 1000 else f"{hz:.0f} Hz"


def kind(instruction) -> str:
    """What drives a timer or counter, by EC's name of it."""
    return LIKE.get(instruction.mnemonic, instruction.mnemonic)


class Timers(Part):
    """A row for each timer and counter that the program drives, in the order of their numbers."""

    key = "timers"

    def __init__(self, rig):
        super().__init__(rig)
        self.rows = self._rows()
        self._rates = {device: Rate() for device, (_, instruction) in self.rows.items() if kind(instruction) == "HCNT"}

    def _rows(self):
        rows = {}
        for instruction in self.rig.instructions:
            unit = KINDS.get(kind(instruction))
            if unit and str(instruction.operands[0]) not in rows:
                rows[str(instruction.operands[0])] = (unit, instruction)
        return dict(sorted(rows.items(), key=lambda row: (row[1][0] != "timer", row[1][1].operands[0].number)))

    def layout(self):
        model = self.rig.plc.model
        rows = []
        steps: dict[str, list[int]] = {}  # device -> where it is used
        for instruction in self.rig.instructions:
            for device in set(map(str, instruction.operands)):
                steps.setdefault(device, []).append(instruction.step)
        for device, (unit, instruction) in self.rows.items():
            base_us = self._base_us(unit, instruction)
            used = steps[device]
            rows.append(
                {
                    "device": device,
                    "name": self.rig.name(device),
                    "kind": instruction.name,
                    "unit": unit,
                    "signed": kind(instruction) in WIDE,
                    "base": BASES.get(base_us, "") or self._counts_what(instruction),
                    "base_us": base_us,
                    "steps": ", ".join(map(str, used[:4])) + (", …" if len(used) > 4 else ""),
                }
            )
        return {"rows": rows, "timers": model.areas["T"].count, "counters": model.areas["C"].count, "sfc": bool(self.rig.charted)}

    def _counts_what(self, instruction):
        """What stands in place of a time unit: "ring", or the inputs that a high-speed counter counts."""
        fast = self.rig.plc.model.fast_counters.get(instruction.operands[0].number) if kind(instruction) == "HCNT" else None
        return " ".join(f"X{number:o}" for number in fast.inputs) if fast else "ring" if kind(instruction) == "CTR" else ""

    def _direction(self, instruction):
        """The relay that makes an up/down counter count down while it is ON, if it is ON."""
        model, number = self.rig.plc.model, instruction.operands[0].number
        relay = f"{model.special_bits}{model.relays['counter direction'] + number}"
        return relay if self.rig.bit(relay) else ""

    def _base_us(self, unit, instruction):
        return self.rig.plc.model.timer_base_us(instruction.operands[0].number) if unit == "timer" else 0

    def frame(self):
        entries = {}
        for device, (unit, instruction) in self.rows.items():
            value, preset, on = self._now(device, instruction)
            entries[device], entries[f"{device}.preset"], entries[f"{device}.on"] = value, preset, int(on)
            flow = self.rig.flow(instruction.position)
            entries[f"{device}.is"], entries[f"{device}.say"] = WORDS[kind(instruction)](
                value, preset, on, flow, self._base_us(unit, instruction)
            )
            if kind(instruction) == "DCNT" and (relay := self._direction(instruction)):
                entries[f"{device}.say"] = f"*{relay} on*, counts down"
            if device in self._rates:
                hz = self._rates[device].see(self.rig.plc.time_us, value)
                entries[f"{device}.say"] += f", {frequency(hz)}" if hz else ""
        entries["steps"] = [self._step(device) for device in self.rig.active()]
        return entries

    def _now(self, device, instruction):
        preset = self.rig.value(instruction.operands[1], wide=kind(instruction) in WIDE)
        return self.rig.plc[device], preset, self.rig.bit(device)

    def _step(self, device):
        elapsed_us, scans = self.rig.since(device)
        usual_us, _ = self.rig.times.usual.get(device, (0, 0))
        return [device, self.rig.step_name(device), elapsed_us, round(usual_us), scans, str(self.rig.charted[device].step)]
