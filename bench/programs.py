"""The workloads of the benchmark, as instruction lists for an EC20.

LOGIC  2,000 latch rungs over all inputs, outputs and auxiliary relays
MIXED  340 blocks: latch, 100 ms TON driving an M, CTU, compare contact driving MOV and ADD
SFC    20 flows of 10 steps, each step with an output and a timer

`LARGEST` is a program of exactly 12,000 steps for the measurement of load time. An EC20 has fewer timers and counters
than MIXED has blocks, so a block shares timer, counter and relays with the block 200 before it, which is no program
for a machine but takes the same time. A block is 35 steps: 340 of them are what a memory of 12,000 steps holds.
"""

from __future__ import annotations

import random
import re
from dataclasses import dataclass

INPUTS = 256
OUTPUTS = 256
RELAYS = 2000
SHARED = 200  # blocks with devices of their own: EC20 has 210 timers of 100 ms and 200 counters of 16 bits
FLOWS, STEPS_OF_A_FLOW = 20, 10
FIRST_NORMAL_STEP = 20  # S0 to S19 are the initial steps


@dataclass(frozen=True)
class Workload:
    """A program and the share of inputs that is ON while it runs."""

    name: str
    text: str
    inputs_on: float

    @property
    def instructions(self) -> int:
        """Number of instructions, one a line."""
        return self.text.count("\n") + 1

    def inputs(self, turn: int) -> list[bool]:
        """The state of all inputs in one turn of measurement; the same for every engine."""
        chance = random.Random(f"{self.name} {turn}")
        return [chance.random() < self.inputs_on for _ in range(INPUTS)]


def x(number: int) -> str:
    """The name of an input, which the manual numbers in octal."""
    return f"X{number:o}"


def coil(number: int) -> str:
    """The outputs first, then the auxiliary relays."""
    return f"Y{number:o}" if number < OUTPUTS else f"M{number - OUTPUTS}"


def latch_rungs(count: int) -> list[str]:
    """Rungs of four instructions and four steps each; beyond the last free coil they set one that exists."""
    chance = random.Random(count)
    lines = []
    for number in range(count):
        start, stop = chance.sample(range(INPUTS), 2)
        own = coil(number % (OUTPUTS + RELAYS))
        verb = "OUT" if number < OUTPUTS + RELAYS else "SET"
        lines += [f"LD {x(start)}", f"OR {own}", f"ANI {x(stop)}", f"{verb} {own}"]
    return lines


def mixed_blocks(count: int) -> list[str]:
    """Blocks of thirteen instructions: a timed latch, a counter of its pulses, and arithmetic while the time is past its half."""
    lines = []
    for number in range(count):
        own = number % SHARED
        busy, done = f"M{own}", f"M{1000 + own}"
        preset = 2 + own % 9
        lines += [
            f"LD {x(own)}", f"OR {busy}", f"ANI {done}", f"OUT {busy}",
            f"LD {busy}", f"TON T{own} {preset}",
            f"LD T{own}", f"OUT {done}",
            f"LD {done}", f"CTU C{own} {10 + own}",
            f"LD>= T{own} {preset // 2}", f"MOV C{own} D{number}", f"ADD D{number} {number} D{1000 + number}",
        ]  # fmt: skip
    return lines


def flows() -> list[str]:
    """Twenty independent flows that each return to their initial step; neighbours run at different rates."""
    lines = ["LD SM1", *(f"SET S{flow}" for flow in range(FLOWS))]
    for flow in range(FLOWS):
        later = FIRST_NORMAL_STEP + flow * (STEPS_OF_A_FLOW - 1)
        states = [flow, *range(later, later + STEPS_OF_A_FLOW - 1)]
        for place, state in enumerate(states):
            timer = flow * STEPS_OF_A_FLOW + place
            last = place == STEPS_OF_A_FLOW - 1
            lines += [
                f"STL S{state}",
                f"OUT {coil(timer)}",
                f"TON T{timer} {1 + (flow + place) % 7}",
                f"LD T{timer}",
                f"OUT S{flow}" if last else f"SET S{states[place + 1]}",
            ]
        lines.append("RET")
    return lines


_FX_NAMES = {"TON": "OUT", "CTU": "OUT", "SM0": "M8000", "SM1": "M8002"}
_WHOLE = re.compile(r"-?\d+")


def in_fx(text: str) -> str:
    """The same work as a program of the FX family: coils of timers and counters, constants with their K."""
    lines = [[_FX_NAMES.get(word, word) for word in line.split()] for line in text.split("\n")]
    return "\n".join(" ".join(f"K{word}" if _WHOLE.fullmatch(word) else word for word in line) for line in lines)


LOGIC = Workload("LOGIC", "\n".join(latch_rungs(2000)), inputs_on=0.5)
MIXED = Workload("MIXED", "\n".join(mixed_blocks(340)), inputs_on=0.75)
SFC = Workload("SFC", "\n".join(flows()), inputs_on=0.5)
WORKLOADS = (LOGIC, MIXED, SFC)
LARGEST = "\n".join(latch_rungs(3000))
