"""Timers and counters in use: value, preset, contact, time unit and what they do, in words; the time of the active steps."""

from collections.abc import Callable

from .panel import Part

KINDS = {"TON": "timer", "TONR": "timer", "TOF": "timer", "TMON": "timer", "CTU": "counter", "CTR": "counter", "DCNT": "counter"}
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
}


class Timers(Part):
    """A row for each timer and counter that the program drives, in the order of their numbers."""

    key = "timers"

    def __init__(self, rig):
        super().__init__(rig)
        self.rows = self._rows()

    def _rows(self):
        rows = {}
        for instruction in self.rig.instructions:
            unit = KINDS.get(instruction.mnemonic)
            if unit and str(instruction.operands[0]) not in rows:
                rows[str(instruction.operands[0])] = (unit, instruction)
        return dict(sorted(rows.items(), key=lambda row: (row[1][0] != "timer", row[1][1].operands[0].number)))

    def layout(self):
        model = self.rig.plc.model
        rows = []
        for device, (unit, instruction) in self.rows.items():
            base_us = self._base_us(unit, instruction)
            used = [i.step for i in self.rig.instructions if device in map(str, i.operands)]
            rows.append(
                {
                    "device": device,
                    "name": self.rig.name(device),
                    "kind": instruction.mnemonic,
                    "unit": unit,
                    "base": BASES.get(base_us, ""),
                    "steps": ", ".join(map(str, used[:4])) + (", …" if len(used) > 4 else ""),
                }
            )
        return {"rows": rows, "timers": model.areas["T"].count, "counters": model.areas["C"].count, "sfc": bool(self.rig.charted)}

    def _base_us(self, unit, instruction):
        return self.rig.plc.model.timer_base_us(instruction.operands[0].number) if unit == "timer" else 0

    def frame(self):
        entries = {}
        for device, (unit, instruction) in self.rows.items():
            value, preset, on = self.rig.plc[device], self.rig.value(instruction.operands[1]), self.rig.bit(device)
            entries[device], entries[f"{device}.preset"], entries[f"{device}.on"] = value, preset, int(on)
            flow = self.rig.flow(instruction.position)
            entries[f"{device}.is"], entries[f"{device}.say"] = WORDS[instruction.mnemonic](
                value, preset, on, flow, self._base_us(unit, instruction)
            )
        entries["steps"] = [self._step(device) for device in self.rig.active()]
        return entries

    def _step(self, device):
        elapsed_us, scans = self.rig.since(device)
        usual_us, _ = self.rig.times.usual.get(device, (0, 0))
        return [device, self.rig.step_name(device), elapsed_us, round(usual_us), scans, str(self.rig.charted[device].step)]
