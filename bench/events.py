"""What the fast side costs: figures of counters, pulses and interrupts between two scans.

`python bench/events.py` prints the table; `--write` puts it into docs/performance.md.
"""

import argparse
import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass

import pages

import ecsim

REPEATS = 5
TIMED = "PROGRAM MAIN\nLD SM1\nMOV 10 SD66\nEI\nSET SM66\nEND_PROGRAM\nINTERRUPT I EVENT 26\nLD SM0\nINC D0\nEND_INTERRUPT"


def ready(program: str, scan_ms: float = 10) -> ecsim.Plc:
    """A machine in RUN behind its first scan."""
    plc = ecsim.Plc("EC20", scan_ms=scan_ms)
    plc.load(program)
    plc.run()
    plc.scan()
    return plc


@dataclass(frozen=True)
class Spent:
    """Seconds of the processor, which other work on the machine does not change, and seconds of the wall clock, which somebody waits."""

    process: float
    wall: float

    def per(self, count: float) -> "Spent":
        return Spent(self.process / count, self.wall / count)

    def without(self, other: "Spent") -> "Spent":
        return Spent(self.process - other.process, self.wall - other.wall)


def seconds(run: Callable[[], object]) -> Spent:
    wall, process = time.perf_counter(), time.process_time()
    run()
    return Spent(time.process_time() - process, time.perf_counter() - wall)


def counted(program: str = "LD SM0\nHCNT C236 0\nDHSCS 1000 C236 M0") -> Spent:
    """ns for an edge of 50 kHz on C236 with one DHSCS, all included."""
    plc = ready(program)
    plc.square("X0", hz=50_000)
    return seconds(lambda: plc.advance(ms=20_000)).per(1_000_000 / 1e9)


def merged() -> Spent:
    """ns for an edge where both inputs of an up/down counter move on their own."""
    plc = ready("LD SM0\nHCNT C246 0")
    plc.square("X0", hz=20_000)
    plc.square("X1", hz=13_000)
    return seconds(lambda: plc.advance(ms=2_000)).per(66_000 / 1e9)


def compared() -> Spent:
    """us for an edge that meets a DHSCI and runs its program: a table would not be dearer."""
    plc = ready(
        "PROGRAM MAIN\nLD SM0\nEI\nSET SM65\nHCNT C236 0\nDHSCI 1 C236 20\nEND_PROGRAM\nINTERRUPT I EVENT 20\nLD SM0\nRST C236\nEND_INTERRUPT"
    )
    plc.square("X0", hz=10_000)
    return seconds(lambda: plc.advance(ms=2_000)).per(20_000 / 1e6)


def beyond(program: str, scans: int = 20_000) -> Spent:
    """us that an instruction without watchers adds to a scan."""
    idle, busy = ready("LD M0\nOUT Y7"), ready(program)
    return seconds(lambda: busy.scan(scans)).without(seconds(lambda: idle.scan(scans))).per(scans / 1e6)


def interrupted() -> Spent:
    """s for an hour of a timed interrupt every 10 ms."""
    plc = ready(TIMED)
    return seconds(lambda: plc.advance(ms=3_600_000))


ROWS: list[tuple[str, Callable[[], Spent], str, str]] = [
    ("50 kHz into C236 with one DHSCS, an edge", counted, "ns", "1,000"),
    ("20 and 13 kHz into C246, both inputs moving, an edge", merged, "ns", ""),
    ("10 kHz into C236, each edge a DHSCI with its program, an edge", compared, "us", ""),
    ("100 kHz PLSY with nothing watching, added to a scan", lambda: beyond("LD SM0\nPLSY 100000 0 Y0"), "us", "5"),
    ("DRVI on its way, added to a scan", lambda: beyond("LD SM0\nDRVI 999999 20000 Y0 Y4", 2_000), "us", ""),
    ("an hour of a timed interrupt every 10 ms", interrupted, "s", "3"),
]


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--write", action="store_true", help="put the table into docs/performance.md")
    chosen = arguments.parse_args()
    lines = [
        "`python bench/events.py --write`",
        "",
        "| | processor, best (median) | wall clock, best (median) | to stay below |",
        "|---|---|---|---|",
    ]
    for title, run, unit, bound in ROWS:
        times = [run() for _ in range(REPEATS)]
        columns = [[spent.process for spent in times], [spent.wall for spent in times]]
        shown = " | ".join(f"{min(column):,.3g} {unit} ({statistics.median(column):,.3g})" for column in columns)
        lines.append(f"| {title} | {shown} | {f'{bound} {unit}' if bound else ''} |")
        print(lines[-1], flush=True)
    if chosen.write:
        pages.put(pages.PERFORMANCE, "events", lines)


if __name__ == "__main__":
    main()
