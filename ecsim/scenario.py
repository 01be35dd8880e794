"""Scenarios: steps of set, run and expect. One form for conformance cases, exercises and demonstrations."""

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from .assembler import assemble
from .errors import EcsimError, ProgramError
from .hardware.modules import Module
from .hardware.serial import PortSettings
from .hardware.wire import Framing, Station
from .memory import Memory
from .models import get_model
from .plc import Plc
from .system import SystemBlock

REAL_TOLERANCE = 1e-5
_SYSTEM_KEYS = {field.name for field in fields(SystemBlock)} - {"data_block"}  # which stands beside it
_STEP_KEYS = {"set", "pulses", "quadrature", "serial", "scans", "ms", "expect", "expect_range", "error", "action", "note",
              "force", "unforce", "edit", "load", "refused", "remove", "insert", "lamps"}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Mismatch:
    """One expectation that did not hold: in step `step` (from 1) a device had `value` instead of `expected`."""

    step: int
    device: str
    value: Any
    expected: Any

    def __str__(self) -> str:
        return f"step {self.step}: {self.device} is {self.value}, expected {self.expected}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """How one case went on one model; `reason` is empty when it passed."""

    case: str
    model: str
    mismatches: tuple[Mismatch, ...] = ()
    reason: str = ""

    @property
    def passed(self) -> bool:
        return not self.mismatches and not self.reason

    def __str__(self) -> str:
        what = self.reason or "; ".join(map(str, self.mismatches)) or "passed"
        return f"{self.case} [{self.model}]: {what}"


def same(value: int | float, expected: int | float, real: bool) -> bool:
    """Whether a value is the expected one; REAL numbers to a relative 1e-5."""
    if not real:
        return value == expected
    return value == expected or abs(value - expected) <= REAL_TOLERANCE * max(abs(expected), 1e-30)


def run_steps(plc: Plc, steps: list[dict[str, Any]]) -> Iterator[Mismatch]:
    """Carry out steps on a Plc, yielding every expectation that fails.

    In each: action, load or edit (a program's text), remove or insert (a special module by place), unforce, force, set, the run, then
    expect. With `refused` what stands before set must be refused with that in the message. An action is a word, some with what they are
    about: "switch TM", "battery absent", "power_cycle 30" (ms without mains), "damage program", "repair clock", "clear devices". `lamps`
    expects RUN, ERR or BAT to be "off", "on" or "flashing".
    """
    for number, step in enumerate(steps, 1):
        unknown = set(step) - _STEP_KEYS
        if unknown:
            raise EcsimError(f"step {number}: the key {min(unknown)!r} is not known; known are {', '.join(sorted(_STEP_KEYS))}")
        refusal = _act(plc, step, number)
        if ("refused" in step) != bool(refusal) or step.get("refused", "") not in refusal:
            yield Mismatch(number, "the refusal", repr(refusal), repr(step.get("refused", "")))
        plc.set(step.get("set", {}))
        _signals(plc, step)
        talks = [(talk, _partner(plc, talk)) for talk in step.get("serial", [])]
        if "ms" in step:
            plc.advance(ms=step["ms"])
        else:
            plc.scan(step.get("scans", 0))
        for talk, partner in talks:
            sent, expected = partner.taken.hex(" "), bytes.fromhex(talk.get("tx") or "").hex(" ")
            if "tx" in talk and sent != expected:
                yield Mismatch(number, f"port {talk['port']}", sent or "nothing", expected or "nothing")
        for name, expected in step.get("expect", {}).items():
            value = plc[name]
            if not same(value, expected, isinstance(value, float)):
                yield Mismatch(number, name, value, expected)
        for name, limits in step.get("expect_range", {}).items():
            value = plc[name]
            if not limits["min"] <= value <= limits["max"]:
                yield Mismatch(number, name, value, f"{limits['min']} to {limits['max']}")
        for lamp, expected in step.get("lamps", {}).items():
            if plc.lamps[lamp] != expected:
                yield Mismatch(number, f"lamp {lamp}", plc.lamps[lamp], expected)
        record = f"{plc.model.special_words}{plc.model.registers['faults']}"
        if "error" in step and plc[record] != step["error"]:
            yield Mismatch(number, record, plc[record], step["error"])


def _signals(plc: Plc, step: dict[str, Any]) -> None:
    """The pulses of a step, spread evenly over its time."""
    if "pulses" in step or "quadrature" in step:
        ms = plc.left(step["ms"]) if "ms" in step else step.get("scans", 0) * plc.period_us / 1000
        for name, count in step.get("pulses", {}).items():
            plc.pulse(name, count, ms)
        if (phases := step.get("quadrature")) is not None:
            plc.quadrature(phases["A"], phases["B"], phases["count"], phases["direction"], ms)


ANSWER_US = 20_000  # so long after the last character that a step expects, its answer begins


class Partner(Station):
    """The other end of a port's line: notes each character and says what a step gives it to say."""

    def __init__(self, framing: Framing):
        super().__init__(self, framing, name="partner")
        self.taken, self.wanted, self.reply = bytearray(), 0, b""

    def hear(self, message: bytes) -> None:
        """A message is over; the characters have been noted."""

    def take(self, byte: int, wrong: bool, at: int) -> None:
        self.taken.append(byte)
        if self.reply and len(self.taken) == self.wanted:
            self.answer, self.answer_due, self.reply = self.reply, at + ANSWER_US, b""


def _partner(plc: Plc, talk: dict[str, Any]) -> Partner:
    """The partner on a port, ready for what a step says about it."""
    port = plc.ports[talk["port"]]
    if port.wire is None:
        port.connect(Partner(port.framing))
    (partner,) = port.wire.stations
    reply = bytes.fromhex(talk.get("rx") or "")
    partner.taken, partner.wanted = bytearray(), len(bytes.fromhex(talk.get("tx") or ""))
    partner.reply = reply if partner.wanted else b""
    if reply and not partner.wanted:
        partner.send(reply, port.wire_time())
        port.stirred()
    return partner


# The first word of an action -> what it does, with what follows or with nothing.
_ACTIONS: dict[str, Callable[..., Any]] = {
    "run": Plc.run, "stop": Plc.stop, "reset": Plc.reset, "power_off": Plc.power_off, "power_on": Plc.power_on, "format": Plc.format,
    "power_cycle": lambda plc, ms=None: plc.power_cycle(None if ms is None else float(ms)),
    "switch": lambda plc, position: setattr(plc, "switch", position),
    "battery": lambda plc, state: setattr(plc, "battery", state),
    "clear": Plc.clear, "damage": Plc.damage, "repair": Plc.repair,
}  # fmt: skip


def _act(plc: Plc, step: dict[str, Any], number: int) -> str:
    """What is done to the PLC before a step runs; why it was refused, "" when it was not."""
    action, *about = step.get("action", "").split(" ", 1)
    if action and action not in _ACTIONS:
        raise EcsimError(f"step {number}: there is no action {action!r}; known are {', '.join(_ACTIONS)}")
    try:
        if action:
            _ACTIONS[action](plc, *about)
        for key, change in (("load", plc.load), ("edit", plc.edit)):
            if key in step:
                change(step[key])
        if "remove" in step:
            plc.modules[step["remove"]].remove()
        if "insert" in step:
            plc.modules[step["insert"]].insert()
        for name in step.get("unforce", []):
            plc.unforce(name)
        for name, value in step.get("force", {}).items():
            plc.force(name, value)
    except EcsimError as error:
        if "refused" not in step:
            raise
        return str(error)
    return ""


def run_case(case: dict[str, Any], model: str, tracing: bool = False, stepping: bool = False) -> Verdict:
    """One conformance case on one model, from a cold start; inputs are ideal unless the case says otherwise.

    `io` is what Plc takes under that name; `modules` are special modules with plain buffers, by place.

    `tracing` runs it on the stepping engine and records every scan, `stepping` runs it there without recording.
    """
    name = case["id"]
    try:
        program = assemble(case["il"], model)
    except ProgramError as error:
        return Verdict(name, model) if case.get("compile_error") else Verdict(name, model, reason=str(error))
    except EcsimError as error:
        return Verdict(name, model, reason=str(error))
    if case.get("compile_error"):
        return Verdict(name, model, reason="the program was accepted, expected a compile error")
    try:
        plc = Plc(model, scan_ms=case.get("scan_ms", 10), system=_system(case, model), io=case.get("io"))
        plc.tracing = tracing
        plc.engine = "stepping" if stepping else "compiled"
        for place, buffers in case.get("modules", {}).items():  # special modules by place, with what their buffers hold
            plc.modules[int(place)] = module = Module(len(buffers))
            module.write(0, buffers)
        plc.load(program)
        plc.run()
        return Verdict(name, model, tuple(run_steps(plc, case["steps"])))
    except EcsimError as error:
        return Verdict(name, model, reason=str(error))


def _system(case: dict[str, Any], model: str) -> SystemBlock:
    given = dict(case.get("system_block", {}))
    unknown = set(given) - _SYSTEM_KEYS
    if unknown:
        raise EcsimError(f"the system block's key {min(unknown)!r} is not known; known are {', '.join(sorted(_SYSTEM_KEYS))}")
    memory = Memory(get_model(model))
    if "retain" in given:
        given["retain"] = {
            area: [(memory.parse(_named(area, first))[0].number, memory.parse(_named(area, last))[0].number) for first, last in ranges]
            for area, ranges in given["retain"].items()
        }
    for name in ("port0", "port1"):
        if name in given:
            given[name] = _port(name, given[name])
    for name in ("interrupt_priority", "modules"):
        if name in given:  # JSON has no numbers for keys
            given[name] = {int(number): value for number, value in given[name].items()}
    filter_ms = given.pop("input_filter_ms", 0)  # ideal inputs until the program executes REFF
    return SystemBlock(**given, input_filter_ms=filter_ms, data_block=case.get("data_block", {}))


def _port(name: str, given: dict[str, Any]) -> PortSettings:
    """The settings of a port; a protocol may be parted into protocol and role, "modbus" and "slave"."""
    known = {each.name for each in fields(PortSettings)} | {"role"}
    unknown = set(given) - known
    if unknown:
        raise EcsimError(f"{name} has no setting {min(unknown)!r}; it has {', '.join(sorted(known))}")
    role = given.get("role")
    protocol = given.get("protocol", "none") + (f" {role}" if role else "")
    return PortSettings(**{key: value for key, value in given.items() if key != "role"} | {"protocol": protocol})


def _named(area: str, bound: str | int) -> str:
    return bound if isinstance(bound, str) and not bound.isdigit() else f"{area}{bound}"


def load_cases(path: str | Path) -> list[dict[str, Any]]:
    """The cases of a file; raises EcsimError when it is no JSON array of cases."""
    path = Path(path)
    try:
        cases = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise EcsimError(f"there is no file {path}") from None
    except OSError as error:
        raise EcsimError(f"{path} cannot be read: {error.strerror}") from None
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise EcsimError(f"{path} is no JSON: {error}") from None
    if not isinstance(cases, list):
        raise EcsimError(f"{path} holds no array of cases")
    for place, case in enumerate(cases, 1):
        wrong = _shape(case)
        if wrong:
            raise EcsimError(f"{path}: case {place} {wrong}")
    return cases


_SHAPES = {"id": (str, "a text"), "models": (list, "a list of models"), "il": (str, "a text"), "steps": (list, "a list of steps")}


def _shape(case: Any) -> str:
    """What is wrong with the form of a case, "" when nothing is."""
    if not isinstance(case, dict):
        return "is no object"
    needed = [key for key in _SHAPES if key != "steps" or not case.get("compile_error")]
    missing = [key for key in needed if key not in case]
    if missing:
        return f"lacks {', '.join(missing)}"
    for key, (kind, words) in _SHAPES.items():
        if key in case and not isinstance(case[key], kind):
            return f"has {case[key]!r:.40} for {key}; expected {words}"
    if any(not isinstance(step, dict) for step in case.get("steps", [])):
        return "has a step that is no object"
    return ""
