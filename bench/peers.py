"""The same workloads in other hands: a plain interpreter, awlsim and pyrung.

Each class takes the instruction list of a workload, translates it into what its system runs, and then offers
`inputs(states)` and `scan(count)`. The translations are plain: one statement for one instruction where the other
system has it, the usual idiom where it has not, and in doubt the faster of two.

awlsim and pyrung live in an environment of their own, since pyrung needs an older pymodbus than ecsim:

    python bench/peers.py install             both, as their wheels and sources come
    python bench/peers.py install --cython    awlsim with its core compiled; a quarter of an hour and a C compiler

`speed.py` finds that environment and runs `python bench/peers.py serve` in it, which answers one JSON line with another.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
import time
import venv
from collections.abc import Callable, Iterator
from importlib.metadata import PackageNotFoundError, version
from itertools import count as counted
from pathlib import Path
from typing import Any, Protocol

from programs import INPUTS, OUTPUTS, RELAYS, WORKLOADS
from prototype import COUNTERS, PERIOD_US, REGISTERS, SCAN_US, SPECIAL, STATES, TIMERS, Instruction, Rung, parse, rungs

PERIOD_MS = int(PERIOD_US) // 1000
ENVIRONMENT = Path(__file__).resolve().parent.parent / "build" / "peers"
PYTHON = ENVIRONMENT / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
PACKAGES = ("awlsim==0.77.1", "pyrung==0.15.2")
CYTHON = "cython<3.1"


class Contender(Protocol):
    """A program ready to run in one system."""

    def inputs(self, states: list[bool]) -> None: ...

    def scan(self, count: int) -> None: ...


def sections(text: str) -> Iterator[tuple[str | None, list[Rung]]]:
    """The program cut at STL and RET: the state of a section (None outside of steps) and its rungs."""
    state: str | None = None
    found: list[Rung] = []
    for contacts, outputs in rungs(parse(text)):
        if not outputs:
            if found:
                yield state, found
            state, found = (contacts[0][1] if contacts[0][0] == "STL" else None), []
        else:
            found.append((contacts, outputs))
    if found:
        yield state, found


def number(device: str) -> int:
    """The linear index of a device: `X17` is 15."""
    digits = device.lstrip("XYMSTCD")
    return int(digits, 8 if device[0] in "XY" else 10)


# ---- a loop over tuples ------------------------------------------------------------------------------------------------

LD, OR, ANI, OUT, SET, TRANSIT, TON, CTU, LDGE, MOV, ADD = range(11)
CODES = {"LD": LD, "OR": OR, "ANI": ANI, "OUT": OUT, "SET": SET, "TON": TON, "CTU": CTU, "LD>=": LDGE, "MOV": MOV, "ADD": ADD}


class TupleLoop:
    """The simplest interpreter worth its name: resolved operands in tuples, one `if` chain in order of frequency."""

    def __init__(self, text: str) -> None:
        self.memory = {
            "X": [False] * INPUTS, "Y": [False] * OUTPUTS, "M": [False] * RELAYS, "S": [False] * STATES, "SM": [False] * SPECIAL,
            "T": [0] * TIMERS, "TB": [False] * TIMERS, "C": [0] * COUNTERS, "CB": [False] * COUNTERS, "D": [0] * REGISTERS,
        }  # fmt: skip
        self.memory["SM"][0] = self.memory["SM"][1] = True
        self.due, self.running = [0.0] * TIMERS, [False] * TIMERS
        self.was, self.before, self.edges = [False] * STATES, [], counted()
        self.sections: list[tuple[int | None, list[tuple[Any, ...]], list[tuple[list, int, Any]], list[int]]] = []
        for state, found in sections(text):
            code = [self.resolved(state, line) for contacts, outputs in found for line in (*contacts, *outputs)]
            coils = [(a, b, False) for operation, a, b, _ in code if operation == OUT]
            timers = [b for operation, _, b, _ in code if operation == TON]
            self.sections.append((number(state) if state else None, code, coils, timers))
        self.now = 0.0

    def resolved(self, state: str | None, line: Instruction) -> tuple[Any, ...]:
        """(code, list, index, rest): what the loop needs at hand."""
        mnemonic, *operands = line
        where = [self.place(operand) for operand in operands]
        code = CODES[mnemonic]
        if code in (SET, OUT) and operands[0][:2].rstrip("0123456789") == "S":
            return (TRANSIT, *where[0], number(state)) if state else (SET, *where[0], None)
        if code in (LD, OR, ANI) and operands[0][0] in "TC":
            return code, self.memory[operands[0][0] + "B"], where[0][1], None
        if code == CTU:
            self.before.append(False)
            return code, *where[0], (where[1][1], next(self.edges))
        return (code, *where[0], where[1] if len(where) == 2 else where[1:] or None)

    def place(self, operand: str) -> tuple[list | None, int]:
        if operand.isdigit():
            return None, int(operand)
        area = operand.rstrip("0123456789")
        return self.memory[area], int(operand[len(area) :], 8 if area in "XY" else 10)

    def inputs(self, states: list[bool]) -> None:
        self.memory["X"][:] = states

    def scan(self, count: int) -> None:
        for _ in range(count):
            for state, code, coils, timers in self.sections:
                if state is None:
                    self.walk(code)
                elif self.memory["S"][state]:
                    self.was[state] = True
                    self.walk(code)
                elif self.was[state]:
                    self.was[state] = False
                    for area, index, value in coils:
                        area[index] = value
                    for index in timers:
                        self.reset_timer(index)
            self.memory["SM"][1] = False
            self.now += SCAN_US

    def reset_timer(self, index: int) -> None:
        self.running[index] = self.memory["TB"][index] = False
        self.memory["T"][index] = 0

    def walk(self, code: list[tuple[Any, ...]]) -> None:
        """Run one section from the left bus."""
        flow = True
        now, due, running, before, states = self.now, self.due, self.running, self.before, self.memory["S"]
        timer_bits, counter_bits, special = self.memory["TB"], self.memory["CB"], self.memory["SM"]
        for operation, area, index, rest in code:
            if operation == LD:
                flow = area[index]
            elif operation == OUT:
                area[index] = flow
            elif operation == OR:
                flow = flow or area[index]
            elif operation == ANI:
                flow = flow and not area[index]
            elif operation == TRANSIT:
                if flow:
                    area[index] = True
                    states[rest] = False
            elif operation == TON:
                if flow:
                    if not running[index]:
                        running[index] = True
                        due[index] = now + PERIOD_US
                    elif now >= due[index]:
                        periods = (now - due[index]) // PERIOD_US + 1
                        area[index] = min(area[index] + int(periods), 32767)
                        due[index] += periods * PERIOD_US
                    timer_bits[index] = area[index] >= rest[1]
                elif running[index]:
                    self.reset_timer(index)
            elif operation == CTU:
                preset, edge = rest
                if flow and not before[edge] and area[index] < 32767:
                    area[index] += 1
                before[edge] = flow
                counter_bits[index] = area[index] >= preset
            elif operation == LDGE:
                flow = area[index] >= rest[1]
            elif operation == MOV:
                if flow:
                    rest[0][rest[1]] = area[index]
            elif operation == ADD:
                if flow:
                    (_, constant), (target, place) = rest
                    total = area[index] + constant
                    low = total if -32768 <= total <= 32767 else (total + 32768 & 65535) - 32768
                    target[place] = low
                    special[180], special[181], special[182] = not low, total > 32767, total < -32768
            elif operation == SET and flow:
                area[index] = True


# ---- awlsim ------------------------------------------------------------------------------------------------------------

BITS = {"LD": "U", "OR": "O", "ANI": "UN", "OUT": "="}
AWL_STATES, AWL_WAS, AWL_WORDS, AWL_FIRST = 2000, 3000, 512, 4000  # bits of the flag area, then its words from byte 512


class Awl:
    """awlsim as a CPU that runs OB 1; its timers read the wall clock, so that time passes slowly for it."""

    package = "awlsim"
    title = "awlsim, pure Python"

    def __init__(self, text: str) -> None:
        common, core, compiler = (importlib.import_module(f"{self.package}.{name}") for name in ("common", "core", "awlcompiler"))
        parsed = compiler.AwlParser()
        parsed.parseSource(common.AwlSource(name="program", sourceBytes=self.translated(text).encode()))
        self.simulation = core.AwlSim()
        self.simulation.reset()
        self.cpu = self.simulation.getCPU()
        self.cpu.getSpecs().setNrFlags(8192)
        self.simulation.load(parsed.getParseTree())
        self.simulation.build()
        self.simulation.startup()

    def inputs(self, states: list[bool]) -> None:
        packed = sum(state << place for place, state in enumerate(states))
        image = self.cpu.inputs.getDataBytes()
        image[: INPUTS // 8] = packed.to_bytes(INPUTS // 8, "little")
        self.cpu.inputs.setDataBytes(image)

    def scan(self, count: int) -> None:
        for _ in range(count):
            self.simulation.runCycle()

    def translated(self, text: str) -> str:
        """OB 1 in AWL, German mnemonics."""
        self.labels = (f"L{place:03d}" for place in counted())
        lines = []
        for state, found in sections(text):
            body = [line for contacts, outputs in found for line in self.rung(state, contacts, outputs)]
            lines += body if state is None else self.step(state, found, body)
        lines += ["SET", f"S {self.bit('SM1')}"]
        return "ORGANIZATION_BLOCK OB 1\nBEGIN\n" + "".join(f"  {line};\n" for line in lines) + "END_ORGANIZATION_BLOCK\n"

    def step(self, state: str, found: list[Rung], body: list[str]) -> list[str]:
        """The body of an active step; one pass of clearing after it; two tests where it is inactive."""
        active, after = next(self.labels), next(self.labels)
        own, was = self.bit(state), self.flag(AWL_WAS + number(state))
        driven = [output for _, outputs in found for output in outputs]
        clearing = [f"R {self.bit(o[1])}" for o in driven if o[0] == "OUT" and o[1][0] != "S"]
        clearing += [line for o in driven if o[0] == "TON" for line in (f"U {was}", *self.timer(o))]
        tests = [f"U {own}", f"SPB {active}", f"U {was}", f"SPBN {after}", f"R {was}", *clearing, f"SPA {after}"]
        return [*tests, f"{active}: SET", f"S {was}", *body, f"{after}: NOP 0"]

    def rung(self, state: str | None, contacts: list[Instruction], outputs: list[Instruction]) -> list[str]:
        if not contacts:  # the left bus of a step
            contacts = [("LD", state)]
        lines = []
        for mnemonic, *operands in contacts:
            if mnemonic == "LD>=":
                # The timer counts down here: past its half it has that much left, and it is running.
                timer = number(operands[0])
                lines += [f"L T {timer}", f"L {2 + timer % 9 - int(operands[1])}", "<=I", f"U M {timer // 8}.{timer % 8}"]
            elif operands[0] == "SM1":
                lines.append(f"UN {self.bit('SM1')}")
            else:
                lines.append(f"{BITS[mnemonic]} {self.bit(operands[0])}")
        if outputs[0][0] == "MOV":
            after = next(self.labels)
            return [*lines, f"SPBN {after}", *(line for output in outputs for line in self.word_output(output)), f"{after}: NOP 0"]
        for output in outputs:
            lines += self.output(state, output)
        return lines

    def output(self, state: str | None, output: Instruction) -> list[str]:
        mnemonic, operand, *_ = output
        if mnemonic == "TON":
            return self.timer(output)
        if mnemonic == "CTU":
            return [f"ZV Z {number(operand)}"]
        if operand[0] == "S":
            return [f"S {self.bit(operand)}", *([f"R {self.bit(state)}"] if state else [])]
        return [f"{BITS.get(mnemonic, 'S')} {self.bit(operand)}"]

    def timer(self, output: Instruction) -> list[str]:
        return [f"L W#16#1{int(output[2]):03d}", f"SE T {number(output[1])}"]  # base 100 ms, three decimal digits

    def word_output(self, output: Instruction) -> list[str]:
        mnemonic, source, *rest = output
        if mnemonic == "MOV":
            return [f"L {self.word(source)}", f"T {self.word(rest[0])}"]
        return [f"L {self.word(source)}", f"L {rest[0]}", "+I", f"T {self.word(rest[1])}"]

    def flag(self, place: int) -> str:
        return f"M {place // 8}.{place % 8}"

    def bit(self, device: str) -> str:
        if device == "SM1":
            return self.flag(AWL_FIRST)
        place = number(device)
        match device[0]:
            case "X":
                return f"E {place // 8}.{place % 8}"
            case "Y":
                return f"A {place // 8}.{place % 8}"
            case "T":
                return f"T {place}"
            case "S":
                return self.flag(AWL_STATES + place)
            case _:
                return self.flag(place)

    def word(self, device: str) -> str:
        return f"Z {number(device)}" if device[0] == "C" else f"MW {AWL_WORDS + 2 * number(device)}"


class AwlCython(Awl):
    """awlsim with its core compiled by Cython, where it was built so."""

    package = "awlsim_cython"
    title = "awlsim, Cython core"

    def __init__(self, text: str) -> None:
        os.environ["AWLSIM_CYTHON"] = "2"
        super().__init__(text)


# ---- pyrung ------------------------------------------------------------------------------------------------------------


class Pyrung:
    """pyrung's PLC, one `step()` a scan."""

    package = "pyrung"
    title = "pyrung, PLC.step()"

    def __init__(self, text: str) -> None:
        self.pyrung = importlib.import_module("pyrung")
        self.program = self.translated(text)
        self.start()

    def start(self) -> None:
        self.plc = self.pyrung.PLC(self.program, dt=SCAN_US / 1e6)
        self.scan_once: Callable[[], Any] = self.plc.step

    def inputs(self, states: list[bool]) -> None:
        self.plc.patch({self.areas["X"][place]: state for place, state in enumerate(states)})

    def scan(self, count: int) -> None:
        step = self.scan_once
        for _ in range(count):
            step()

    def translated(self, text: str) -> Any:
        p = self.pyrung
        bits, words = p.TagType.BOOL, p.TagType.INT
        self.areas = {area: p.Block(area, bits, 0, size) for area, size in (("Y", OUTPUTS), ("M", RELAYS), ("S", STATES), ("SM", 2))}
        self.areas |= {"X": p.InputBlock("X", bits, 0, INPUTS), "D": p.Block("D", words, 0, REGISTERS)}
        self.timers = p.Timer.clone("T", count=TIMERS)
        self.counters = p.Counter.clone("C", count=COUNTERS)
        with p.Program(strict=False) as program:
            for state, found in sections(text):
                for contacts, outputs in found:
                    self.rung(state, contacts, outputs)
            with p.rung():
                p.latch(self.areas["SM"][1])
        return program

    def bit(self, device: str) -> Any:
        if device == "SM1":
            return ~self.areas["SM"][1]
        if device[0] in "TC":
            return self.word(device, "Done")
        return self.areas[device[0]][number(device)]

    def word(self, device: str, field: str = "Acc") -> Any:
        if device[0] in "TC":
            return getattr((self.timers if device[0] == "T" else self.counters)[number(device) + 1], field)
        return self.areas["D"][number(device)]

    def rung(self, state: str | None, contacts: list[Instruction], outputs: list[Instruction]) -> None:
        p = self.pyrung
        conditions: list[Any] = []
        for mnemonic, *operands in contacts:
            if mnemonic == "LD>=":
                conditions.append(self.word(operands[0]) >= int(operands[1]) * PERIOD_MS)
            elif mnemonic == "OR":
                conditions[-1] = p.Or(conditions[-1], self.bit(operands[0]))
            else:
                conditions.append(~self.bit(operands[0]) if mnemonic == "ANI" else self.bit(operands[0]))
        if outputs[0][0] == "CTU":
            conditions[-1] = p.rise(conditions[-1])
        if state:
            conditions.insert(0, self.bit(state))
        with p.rung(*conditions):
            for output in outputs:
                self.output(state, output)

    def output(self, state: str | None, output: Instruction) -> None:
        p = self.pyrung
        mnemonic, *operands = output
        if mnemonic == "TON":
            p.on_delay(self.timers[number(operands[0]) + 1], int(operands[1]) * PERIOD_MS)
        elif mnemonic == "CTU":
            p.count_up(self.counters[number(operands[0]) + 1], int(operands[1])).reset(self.areas["SM"][0])
        elif mnemonic == "MOV":
            p.copy(self.word(operands[0]), self.word(operands[1]))
        elif mnemonic == "ADD":
            p.calc(self.word(operands[0]) + int(operands[1]), self.word(operands[2]))
        elif operands[0][0] == "S":
            p.latch(self.bit(operands[0]))
            if state:
                p.reset(self.bit(state))
        else:
            (p.latch if mnemonic == "SET" else p.out)(self.bit(operands[0]))


class PyrungKernel(Pyrung):
    """The function that pyrung generates for its replays, called bare: no state kept, no forcing, no history."""

    title = "pyrung, generated kernel alone"

    def start(self) -> None:
        compiled = importlib.import_module("pyrung.circuitpy.codegen.render_kernel").compile_kernel(self.program)
        self.kernel = kernel = compiled.create_kernel()
        step, seconds = compiled.step_fn, SCAN_US / 1e6
        self.scan_once = lambda: step(kernel.tags, kernel.blocks, kernel.memory, kernel.prev, seconds)

    def inputs(self, states: list[bool]) -> None:
        for place, state in enumerate(states):
            self.kernel.tags[self.areas["X"][place].name] = state


PEERS: dict[str, type[Awl] | type[Pyrung]] = {peer.title: peer for peer in (AwlCython, Awl, PyrungKernel, Pyrung)}


# ---- an environment and a process of their own ---------------------------------------------------------------------------


def install(cython: bool) -> None:
    """Make the peers' environment; pip shows its own progress."""
    venv.create(ENVIRONMENT, with_pip=True, clear=True)
    pip = [str(PYTHON), "-m", "pip", "install", "--disable-pip-version-check"]
    if cython:
        subprocess.run([*pip, CYTHON, "setuptools", "wheel"], check=True)
        subprocess.run([*pip, "--no-build-isolation", "--no-binary", "awlsim", "--no-cache-dir", PACKAGES[0]], check=True)
    subprocess.run([*pip, *PACKAGES], check=True)


def versions() -> dict[str, str]:
    """The installed version of each peer's distribution."""
    found = {}
    for requirement in PACKAGES:
        name = requirement.partition("==")[0]
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def serve() -> None:
    """Answer requests until the input ends. What the peers print themselves goes to stderr."""
    answers, sys.stdout = sys.stdout, sys.stderr
    texts = {workload.name: workload for workload in WORKLOADS}
    ready: dict[tuple[str, str], Contender] = {}
    for line in sys.stdin:
        request = json.loads(line)
        key = request.get("peer"), request.get("workload")
        if request["do"] == "versions":
            answer: Any = versions()
        elif request["do"] == "load":
            try:
                ready[key] = PEERS[key[0]](texts[key[1]].text)
                answer = "loaded"
            except ImportError:
                answer = "not installed"
        else:
            answer = timed(ready[key], texts[key[1]].inputs(request["turn"]), request["scans"])
        print(json.dumps(answer), file=answers, flush=True)


def timed(contender: Contender, states: list[bool], scans: int) -> int:
    """Nanoseconds for `scans` scans with these inputs; setting the inputs does not count."""
    contender.inputs(states)
    began = time.perf_counter_ns()
    contender.scan(scans)
    return time.perf_counter_ns() - began


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = arguments.add_subparsers(dest="command", required=True)
    commands.add_parser("install", help="make the peers' environment").add_argument("--cython", action="store_true")
    commands.add_parser("serve", help="answer requests of speed.py")
    chosen = arguments.parse_args()
    if chosen.command == "install":
        install(chosen.cython)
    else:
        serve()


if __name__ == "__main__":
    main()
