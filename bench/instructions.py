"""What an application instruction costs: chains of one kind under one contact, with the flow ON and OFF.

`python bench/instructions.py` prints the table; `--write` puts it into docs/performance.md.

A rung is one contact and a chain; the contact's time counts for the chain, an idle scan's does not. Turns are short, take the
processor's time, and each has its turn of the yardstick beside it: the ratio says how many of the yardstick's instructions
(LOGIC of prototype.py) one of these is worth, whatever else the machine does.
"""

from __future__ import annotations

import argparse
import random
import statistics
import struct
import time
from dataclasses import dataclass, field

import pages
from programs import LOGIC
from prototype import Prototype

import ecsim

TURNS = 60
TURN_NS = 2_000_000
RUNGS, CHAIN = 20, 10
WORDS, PAIRS, SINGLES, RESULTS, FACTOR = 0, 1000, 2000, 4000, 3900  # where operands and results lie in D
SECOND = 500  # how far behind the first operands the second ones lie
UNDER = "LD M0"


@dataclass
class Row:
    """One line of the table: a chain's pattern, how many instructions a copy of it is, and the bounds in ns with the flow ON and OFF."""

    title: str
    pattern: str
    bounds: tuple[float, float]
    contact: str = UNDER
    count: int = 1
    copies: int = CHAIN
    rungs: int = RUNGS
    unit: str = "ns"
    times: dict[bool, list[float]] = field(default_factory=lambda: {True: [], False: []})
    ratios: dict[bool, list[float]] = field(default_factory=lambda: {True: [], False: []})

    @property
    def program(self) -> str:
        lines = []
        for copy in range(self.rungs * self.copies):
            if copy % self.copies == 0 and self.contact:
                lines.append(self.contact)
            word, pair, single, result = WORDS + copy, PAIRS + 2 * copy, SINGLES + 2 * copy, RESULTS + 4 * copy
            places = {"word": word, "pair": pair, "single": single, "result": result, "further": result + 2}
            places |= {"word2": word + SECOND, "pair2": pair + SECOND, "single2": single + SECOND, "bit": 100 + copy}
            lines.append(self.pattern.format(**places))
        return "\n".join(lines)


ROWS = [
    Row("MOV", "MOV D{word} D{result}", (60, 15)),
    Row("ADD", "ADD D{word} D{word2} D{result}", (60, 15)),
    Row("DADD", "DADD D{pair} D{pair2} D{result}", (0, 15)),
    *(
        Row(f"LD{kind}{sign}, OUT in turns", f"LD{kind}{sign} D{{{place}}} D{{{place}2}}\nOUT M{{bit}}", (60, 0), contact="", count=2)
        for kind, place in (("", "word"), ("D", "pair"), ("R", "single"))
        for sign in ("=", "<=")
    ),
    *(
        Row(f"LD, AND{kind}=, OUT in turns", f"LD M0\nAND{kind}= D{{{place}}} D{{{place}2}}\nOUT M{{bit}}", (60, 15), contact="", count=3)
        for kind, place in (("", "word"), ("D", "pair"), ("R", "single"))
    ),
    Row("FLT, RMUL in turns", f"FLT D{{word}} D{{result}}\nRMUL D{{result}} D{FACTOR} D{{further}}", (60, 15), count=2),
    Row("RADD", "RADD D{single} D{single2} D{result}", (0, 15)),
    Row("DTI", "DTI D{result} D{further}", (0, 15)),
    Row("BCD", "BCD D{word} D{result}", (0, 15)),
    Row("SHL", "SHL D{word} D{result} 3", (0, 15)),
    Row("ROR", "ROR D{word} D{result} 3", (0, 15)),
    Row("BMOV of 1,000 words", f"BMOV D0 D{RESULTS} 1000", (20_000, 0), copies=1, unit="us"),
    Row("FMOV of 1,000 words", f"FMOV D{{word}} D{RESULTS} 1000", (20_000, 0), copies=1, unit="us"),
]


def fill(registers: list[int], turn: int, on: bool) -> None:
    """New operands, the same for every row: no sum overflows; a second operand equals the first one when contacts shall be closed."""
    chance = random.Random(turn)
    for place in range(RUNGS * CHAIN):
        number = chance.randrange(9999)
        registers[WORDS + place] = number
        registers[WORDS + SECOND + place] = number if on else number + 1
        for first, packed, other in (
            (PAIRS + 2 * place, struct.pack(">i", 70_000 * number), struct.pack(">i", 70_000 * number + 1)),
            (SINGLES + 2 * place, struct.pack(">f", number / 7), struct.pack(">f", number / 9 + 1)),
        ):
            registers[first : first + 2] = struct.unpack(">hh", packed)
            registers[first + SECOND : first + SECOND + 2] = struct.unpack(">hh", packed if on else other)
        registers[RESULTS + 4 * place : RESULTS + 4 * place + 2] = 0, number
    registers[FACTOR : FACTOR + 2] = struct.unpack(">hh", struct.pack(">f", 0.37))


class Contender:
    """Something that scans, and the number of scans that fills a turn."""

    def __init__(self, scanner: ecsim.Plc | Prototype) -> None:
        self.scanner, self.scans = scanner, 1
        while (spent := self.turn_ns() * self.scans) < TURN_NS / 4:
            self.scans *= 2
        self.scans = max(1, round(self.scans * TURN_NS / spent))

    def turn_ns(self) -> float:
        """The processor's time for a scan."""
        began = time.process_time_ns()
        self.scanner.scan(self.scans)
        return (time.process_time_ns() - began) / self.scans


def ready(program: str) -> Contender:
    plc = ecsim.Plc("EC20", input_filter_ms=0)
    plc.load(program)
    plc.run()
    fill(plc.memory.lists["D"], 0, True)
    plc["M0"] = 1
    return Contender(plc)


def measure() -> float:
    """All turns of all rows; gives the least ns of an instruction of the yardstick."""
    least = float("inf")
    idle = ready("LD SM0\nOUT M99")
    idle_ns = min(idle.turn_ns() for _ in range(TURNS))
    yardstick = Contender(Prototype(LOGIC.text))
    yardstick.scanner.inputs(LOGIC.inputs(0))
    rows = [(row, ready(row.program)) for row in ROWS]
    for turn in range(TURNS):
        for row, contender in rows:
            unit_ns = yardstick.turn_ns() / LOGIC.instructions
            least = min(least, unit_ns)
            for on in (True, False):
                contender.scanner["M0"] = int(on)
                fill(contender.scanner.memory.lists["D"], turn, on)
                spent = (contender.turn_ns() - idle_ns) / (row.rungs * row.copies * row.count)
                row.times[on].append(spent)
                row.ratios[on].append(spent / unit_ns)
    return least


def cell(row: Row, on: bool) -> str:
    """Best, median and ratio of one flow, and what it shall stay below."""
    scale = {"ns": 1, "us": 1000}[row.unit]
    times = [time / scale for time in row.times[on]]
    bound = row.bounds[not on] / scale
    limit = f", below {bound:g}" if bound else ""
    return f"{min(times):.1f} {row.unit} ({statistics.median(times):.1f}){limit} | {statistics.median(row.ratios[on]):.1f}"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--write", action="store_true", help="put the table into docs/performance.md")
    chosen = arguments.parse_args()
    least = measure()
    lines = [
        f"`python bench/instructions.py --write`; an instruction of the yardstick took {least:.1f} ns.",
        "",
        "| an instruction | flow ON: best (median) | to the yardstick | flow OFF: best (median) | to the yardstick |",
        "|---|---|---|---|---|",
        *(f"| {row.title} | {cell(row, True)} | {cell(row, False)} |" for row in ROWS),
    ]
    print("\n".join(lines))
    if chosen.write:
        pages.put(pages.PERFORMANCE, "instructions", lines)


if __name__ == "__main__":
    main()
