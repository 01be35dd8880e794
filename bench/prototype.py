"""The yardstick: the workloads as generated Python over plain lists, with nothing around them.

It knows the twelve or so instructions of `programs.py`, trusts its input, and has neither memory interface, forcing,
recording, interrupts nor error handling. What it does, it does as the machine does: timers count whole periods of
simulated time, counters count edges, a step that was left clears its outputs at the next pass, ADD sets its flags.
So its figure is what CPython needs for the program itself, and the engine is measured against it.

Run it alone for its own figures: `python bench/prototype.py`; with `--source LOGIC` it prints what it generates.
"""

from __future__ import annotations

import argparse
import re
import time
from collections.abc import Callable, Iterator

from programs import INPUTS, OUTPUTS, RELAYS, WORKLOADS, Workload

INSTRUCTIONS_OF_A_CHUNK = 200
TIMERS, COUNTERS, STATES, REGISTERS, SPECIAL = 256, 256, 992, 8000, 256
PERIOD_US = 100_000.0  # T0 to T209
SCAN_US = 10_000.0
LISTS = "X Y M S SM T TB C CB D due running was before".split()
CONTACT = re.compile(r"(LD|AND|OR)(>=|I)?$|ANI$")

Instruction = tuple[str, ...]
Rung = tuple[list[Instruction], list[Instruction]]


def parse(text: str) -> list[Instruction]:
    """One tuple of mnemonic and operands a line."""
    return [tuple(line.split()) for line in text.splitlines()]


def rungs(instructions: list[Instruction]) -> Iterator[Rung]:
    """Contacts and the outputs they drive; STL and RET stand alone as contacts without outputs."""
    contacts: list[Instruction] = []
    outputs: list[Instruction] = []
    for instruction in instructions:
        mnemonic = instruction[0]
        alone = mnemonic in ("STL", "RET")
        if outputs and (alone or CONTACT.match(mnemonic)):
            yield contacts, outputs
            contacts, outputs = [], []
        if alone:
            yield [instruction], []
        elif CONTACT.match(mnemonic):
            contacts.append(instruction)
        else:
            outputs.append(instruction)
    if contacts or outputs:
        yield contacts, outputs


def place(device: str, areas: dict[str, str] | None = None) -> str:
    """`X17` -> `X[15]`; `areas` maps an area to another list, as T to TB for its contact."""
    area, digits = re.fullmatch(r"([A-Z]+)(\d+)", device).groups()
    number = int(digits, 8 if area in "XY" else 10)
    return f"{(areas or {}).get(area, area)}[{number}]"


def bit(device: str) -> str:
    return place(device, {"T": "TB", "C": "CB"})


def word(operand: str) -> str:
    return operand if operand.lstrip("-").isdigit() else place(operand)


def folded(contacts: list[Instruction]) -> str:
    """The contacts of one rung as one Python condition; an empty list is the left bus."""
    condition, loosest = "", ""
    for mnemonic, *operands in contacts:
        if mnemonic.endswith(">="):
            term = f"{word(operands[0])} >= {word(operands[1])}"
        else:
            term = ("not " if mnemonic.endswith("I") else "") + bit(operands[0])
        if not condition:
            condition = term
        elif mnemonic.startswith("OR"):
            condition, loosest = f"{condition} or {term}", "or"
        else:
            condition, loosest = (f"({condition})" if loosest == "or" else condition) + f" and {term}", "and"
    return condition or "True"


class Writer:
    """Writes the functions of one program and remembers which step it is in."""

    def __init__(self) -> None:
        self.chunks: list[list[str]] = [[]]
        self.state: str | None = None
        self.cleared: list[str] = []
        self.edges = 0
        self.depth = 1

    def line(self, text: str, deeper: int = 0) -> None:
        self.chunks[-1].append("    " * (self.depth + deeper) + text)

    def program(self, instructions: list[Instruction]) -> list[str]:
        """The source of each function, cut between rungs and never inside a step."""
        filled = 0
        for contacts, outputs in rungs(instructions):
            opens = bool(contacts) and contacts[0][0] in ("STL", "RET")
            if opens:
                self.leave_state()
            if filled >= INSTRUCTIONS_OF_A_CHUNK and (opens or self.state is None):
                self.chunks.append([])
                filled = 0
            filled += len(contacts) + len(outputs)
            if not opens:
                self.rung(contacts, outputs)
            elif contacts[0][0] == "STL":
                self.enter_state(contacts[0][1])
        signature = ", ".join(f"{name}={name}" for name in LISTS)
        return [
            f"def chunk_{number}(now, {signature}, advance=advance, wrapped=wrapped):\n" + "\n".join(lines)
            for number, lines in enumerate(self.chunks)
        ]

    def enter_state(self, state: str) -> None:
        self.state, self.cleared = place(state), []
        self.line(f"if {self.state}:")
        self.depth += 1
        self.line(f"was{self.state[1:]} = True")

    def leave_state(self) -> None:
        """An inactive step costs two tests; the second finds the pass after it was left."""
        if self.state is None:
            return
        self.depth -= 1
        was = f"was{self.state[1:]}"
        self.line(f"elif {was}:")
        for statement in [f"{was} = False", *self.cleared]:
            self.line(statement, 1)
        self.state = None

    def rung(self, contacts: list[Instruction], outputs: list[Instruction]) -> None:
        flow = folded(contacts)
        if len(outputs) > 1 and all(output[0] in ("MOV", "ADD", "SET") for output in outputs):
            self.line(f"if {flow}:")
            self.depth += 1
            for output in outputs:
                self.output(output, "True")
            self.depth -= 1
            return
        if len(outputs) > 1 and flow != "True":
            self.line(f"flow = {flow}")
            flow = "flow"
        for output in outputs:
            self.output(output, flow)

    def output(self, output: Instruction, flow: str) -> None:
        mnemonic, *operands = output
        name = mnemonic if operands[0][0] != "S" or mnemonic == "MOV" else f"{mnemonic} S"
        getattr(self, f"write_{name.lower().replace(' ', '_')}")(flow, *operands)

    def when(self, flow: str, *statements: str) -> None:
        """The statements under their condition, or bare where the flow is the left bus."""
        if flow != "True":
            self.line(f"if {flow}:")
        for statement in statements:
            self.line(statement, flow != "True")

    def write_out(self, flow: str, device: str) -> None:
        self.line(f"{place(device)} = {flow}")
        self.cleared.append(f"{place(device)} = False")

    def write_set(self, flow: str, device: str) -> None:
        self.when(flow, f"{place(device)} = True")

    def write_set_s(self, flow: str, state: str) -> None:
        """A transition: the next step on, the step it stands in off."""
        statements = [f"{place(state)} = True"]
        if self.state:
            statements.append(f"{self.state} = False")
        self.when(flow, *statements)

    write_out_s = write_set_s

    def write_ton(self, flow: str, timer: str, preset: str) -> None:
        elapsed, contact, number = place(timer), bit(timer), timer[1:]
        self.when(
            flow,
            f"if now >= due[{number}]: advance({number}, now)",
            f"if {elapsed} >= {word(preset)}: {contact} = True",
            f"else: {contact} = False",
        )
        reset = [f"running[{number}] = {contact} = False", f"{elapsed} = 0", f"due[{number}] = 0.0"]
        if flow != "True":
            self.line(f"elif running[{number}]:")
            for statement in reset:
                self.line(statement, 1)
        self.cleared += reset

    def write_ctu(self, flow: str, counter: str, preset: str) -> None:
        count, contact, edge = place(counter), bit(counter), f"before[{self.edges}]"
        self.edges += 1
        self.line(f"if {flow}:")
        self.line(f"if not {edge}:", 1)
        self.line(f"{edge} = True", 2)
        self.line(f"if {count} < 32767: {count} += 1", 2)
        self.line(f"elif {edge}: {edge} = False")
        self.line(f"if {count} >= {word(preset)}: {contact} = True")
        self.line(f"else: {contact} = False")

    def write_mov(self, flow: str, source: str, target: str) -> None:
        self.when(flow, f"{word(target)} = {word(source)}")

    def write_add(self, flow: str, first: str, second: str, target: str) -> None:
        self.when(
            flow,
            f"r = {word(first)} + {word(second)}",
            "if -32768 <= r <= 32767:",
            f"    {word(target)} = r",
            "    SM[180] = not r",
            "    SM[181] = SM[182] = False",
            f"else: {word(target)} = wrapped(r)",
        )


class Prototype:
    """A program ready to scan: `memory[area]` is a plain list."""

    def __init__(self, text: str) -> None:
        self.memory = memory = {
            "X": [False] * INPUTS, "Y": [False] * OUTPUTS, "M": [False] * RELAYS, "S": [False] * STATES, "SM": [False] * SPECIAL,
            "T": [0] * TIMERS, "TB": [False] * TIMERS, "C": [0] * COUNTERS, "CB": [False] * COUNTERS, "D": [0] * REGISTERS,
            "due": [0.0] * TIMERS, "running": [False] * TIMERS, "was": [False] * STATES, "before": [],
        }  # fmt: skip
        writer = Writer()
        sources = writer.program(parse(text))
        memory["before"] = [False] * writer.edges
        memory["SM"][0] = memory["SM"][1] = True
        self.source = "\n\n\n".join(sources)
        names = dict(memory, advance=self.advance, wrapped=self.wrapped)
        for number, source in enumerate(sources):
            exec(compile(source, f"<chunk {number}>", "exec"), names)
        self.chunks: list[Callable[[float], None]] = [names[f"chunk_{number}"] for number in range(len(sources))]
        self.now = 0.0

    def advance(self, timer: int, now: float) -> None:
        """Start the timer, or add the periods that have passed since it was due."""
        memory = self.memory
        if not memory["running"][timer]:
            memory["running"][timer] = True
            memory["due"][timer] = now + PERIOD_US
            return
        periods = (now - memory["due"][timer]) // PERIOD_US + 1
        memory["T"][timer] = min(memory["T"][timer] + int(periods), 32767)
        memory["due"][timer] += periods * PERIOD_US

    def wrapped(self, value: int) -> int:
        """The rare sum beyond 16 bits: its flags, and what is left of it."""
        low = (value + 32768 & 65535) - 32768
        self.memory["SM"][180:183] = [not low, value > 32767, value < -32768]
        return low

    def inputs(self, states: list[bool]) -> None:
        self.memory["X"][:] = states

    def scan(self, count: int) -> None:
        special, chunks, now = self.memory["SM"], self.chunks, self.now
        for _ in range(count):
            for chunk in chunks:
                chunk(now)
            special[1] = False
            now += SCAN_US
        self.now = now


def nanoseconds(workload: Workload, turns: int = 20, scans: int = 30) -> float:
    """The best turn's time for one instruction."""
    prototype = Prototype(workload.text)
    best = float("inf")
    for turn in range(turns):
        prototype.inputs(workload.inputs(turn))
        began = time.perf_counter_ns()
        prototype.scan(scans)
        best = min(best, time.perf_counter_ns() - began)
    return best / scans / workload.instructions


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--source", choices=[workload.name for workload in WORKLOADS], help="print the generated Python")
    chosen = arguments.parse_args()
    for workload in WORKLOADS:
        if chosen.source == workload.name:
            print(Prototype(workload.text).source)
        elif not chosen.source:
            print(f"{workload.name:6} {nanoseconds(workload):5.1f} ns per instruction")


if __name__ == "__main__":
    main()
