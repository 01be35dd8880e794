"""Measure ecsim against its yardstick and its peers, all in one run, and print tables.

With the Python of the project's environment:

    python bench/speed.py                 print
    python bench/speed.py --write         print, and put the tables into docs/performance.md
    python bench/speed.py --rounds 40     take more turns

Every turn sets new inputs and then times some scans of each contender, one contender after the other, so that a
slow moment of the machine falls on all of them. Times are wall clock; nothing here is a test and nothing fails by
being slow.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import json
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pages
import peers
from peers import PEERS, Contender, TupleLoop, timed
from programs import LARGEST, WORKLOADS, Workload, in_fx, x
from prototype import Prototype

import ecsim

ROOT = Path(__file__).resolve().parent.parent
TURN_NS = 30_000_000
IDLE = Workload("IDLE", "LD SM0\nOUT M0", inputs_on=0.0)
LARGEST_STEPS = 12_000
SCAN_MS = 10


# ---- who is measured ---------------------------------------------------------------------------------------------------


class Compiled:
    """ecsim as a user has it: whole scans of a Plc with its phases, clocks and registers."""

    def __init__(self, text: str) -> None:
        self.plc = ecsim.Plc("EC20", scan_ms=SCAN_MS, input_filter_ms=0)
        self.plc.load(text)
        self.plc.run()

    def inputs(self, states: list[bool]) -> None:
        for number, state in enumerate(states):
            self.plc[x(number)] = int(state)

    def scan(self, count: int) -> None:
        self.plc.scan(count)


class Stepping(Compiled):
    """The engine that walks the program one instruction at a time, with nothing recorded."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        assert self.plc.engine == "compiled"
        self.plc.engine = "stepping"


class CompiledFx(Compiled):
    """The compiled engine with the same work as a program of the FX family."""

    def __init__(self, text: str) -> None:
        self.plc = ecsim.Plc("H2U", scan_ms=SCAN_MS, input_filter_ms=0)
        self.plc.load(in_fx(text))
        self.plc.run()


class Local:
    """A contender of this process."""

    def __init__(self, make: Callable[[str], Contender]) -> None:
        self.make = make
        self.ready: dict[str, Contender] = {}

    def load(self, workload: Workload) -> bool:
        self.ready[workload.name] = self.make(workload.text)
        return True

    def turn(self, workload: Workload, turn: int, scans: int) -> int:
        return timed(self.ready[workload.name], workload.inputs(turn), scans)


class Remote:
    """A peer in the peers' own environment."""

    def __init__(self, server: Server, peer: str) -> None:
        self.server, self.peer = server, peer

    def load(self, workload: Workload) -> bool:
        return self.server.ask(do="load", peer=self.peer, workload=workload.name) == "loaded"

    def turn(self, workload: Workload, turn: int, scans: int) -> int:
        return self.server.ask(do="turn", peer=self.peer, workload=workload.name, turn=turn, scans=scans)


class Server:
    """The process that runs the peers, asked by JSON lines."""

    def __init__(self, python: Path) -> None:
        command = [str(python), str(Path(peers.__file__)), "serve"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)

    def ask(self, **request: Any) -> Any:
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"the peers' process ended at {request}; run `{sys.executable} {Path(peers.__file__)} serve` to see why")
        return json.loads(answer)


@contextlib.contextmanager
def peers_server(python: Path) -> Iterator[Server | None]:
    """The peers' process for the time of the measurement, None where their environment was not made."""
    if not python.exists():
        yield None
        return
    server = Server(python)
    try:
        yield server
    finally:
        server.process.stdin.close()
        server.process.wait()


# ---- turns -------------------------------------------------------------------------------------------------------------


@dataclass
class Row:
    """One contender and its nanoseconds a scan, turn by turn, for each workload."""

    title: str
    contender: Local | Remote | None
    scans: dict[str, int] = field(default_factory=dict)
    times: dict[str, list[float]] = field(default_factory=dict)

    def prepare(self, workload: Workload) -> None:
        """Load the workload and find the number of scans that fills a turn."""
        if self.contender is None or not self.contender.load(workload):
            return
        scans = 3
        while (spent := self.contender.turn(workload, 0, scans)) < TURN_NS / 4 and scans < 100_000:
            scans *= 3
        self.scans[workload.name] = max(3, round(scans * TURN_NS / spent))
        self.times[workload.name] = []

    def take(self, workload: Workload, turn: int) -> None:
        scans = self.scans.get(workload.name)
        if scans:
            self.times[workload.name].append(self.contender.turn(workload, turn, scans) / scans)


def contenders(server: Server | None) -> list[Row]:
    own = {
        "yardstick: generated Python, nothing around it": Prototype,
        "**ecsim, compiled engine**": Compiled,
        "the same for an H2U": CompiledFx,
        "**ecsim, stepping engine**, nothing recorded": Stepping,
        "a loop over tuples": TupleLoop,
    }
    rows = [Row(title, Local(make)) for title, make in own.items()]
    return rows + [Row(title, Remote(server, title) if server else None) for title in PEERS]


def measure(rows: list[Row], rounds: int) -> None:
    """All turns; the loads come first so that no turn pays for one."""
    workloads = [*WORKLOADS, IDLE]
    for row in rows:
        for workload in workloads if isinstance(row.contender, Local) else WORKLOADS:
            row.prepare(workload)
    for turn in range(rounds):
        for workload in workloads:
            for row in rows:
                row.take(workload, turn)
        print(f"\rturn {turn + 1} of {rounds}", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)


# ---- tables ------------------------------------------------------------------------------------------------------------


def per_instruction(rows: list[Row]) -> list[str]:
    lines = [
        "| ns per instruction: least (median) | " + " | ".join(workload.name for workload in WORKLOADS) + " |",
        "|---|" + "---|" * len(WORKLOADS),
    ]
    for row in rows:
        cells = []
        for workload in WORKLOADS:
            times = [time / workload.instructions for time in row.times.get(workload.name, [])]
            cells.append(f"{figure(min(times))} ({figure(statistics.median(times))})" if times else "not installed")
        lines.append(f"| {row.title} | " + " | ".join(cells) + " |")
    return lines


def ratios(rows: list[Row]) -> list[str]:
    """ecsim against the yardstick: whole scans, and the program's share of them."""
    yardstick, compiled, second, stepping, *_ = rows
    idle = statistics.median(compiled.times[IDLE.name])
    lines = [
        "| ratio to the yardstick, median of the turns | " + " | ".join(workload.name for workload in WORKLOADS) + " |",
        "|---|---|---|---|",
    ]

    def line(title: str, row: Row, over: Row, less: float) -> None:
        cells = []
        for workload in WORKLOADS:
            pairs = zip(row.times[workload.name], over.times[workload.name], strict=True)
            cells.append(f"{statistics.median((own - less) / other for own, other in pairs):.2f}")
        lines.append(f"| {title} | " + " | ".join(cells) + " |")

    line("whole scans of the Plc", compiled, yardstick, 0.0)
    line("the program alone: less an idle scan", compiled, yardstick, idle)
    line("an H2U over an EC20", second, compiled, 0.0)
    line("stepping engine over compiled engine", stepping, compiled, 0.0)
    return [*lines, "", f"An idle scan, with a program of one rung, takes {idle / 1000:.1f} us; the workloads' scans contain as much."]


def figure(value: float) -> str:
    return f"{value:.1f}" if value < 99.5 else f"{value:,.0f}"


def loading(repeats: int = 7) -> str:
    """From text to the end of the first scan, each time with a text not seen before."""
    times = []
    for repeat in range(repeats):
        plc = ecsim.Plc("EC20", scan_ms=SCAN_MS)
        text = f"{LARGEST} // {repeat}"
        began = time.perf_counter()
        plc.load(text)
        plc.run()
        plc.scan()
        times.append(time.perf_counter() - began)
    return f"| load a program of {LARGEST_STEPS:,} steps, from text to the end of its first scan | {min(times):.3f} s ({statistics.median(times):.3f} s) |"


def importing(repeats: int = 15) -> str:
    """`import ecsim` in fresh processes, the interpreter's own start left out."""
    script = "import time; t = time.perf_counter(); import ecsim; print(time.perf_counter() - t)"
    run = lambda: float(subprocess.run([sys.executable, "-c", script], cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    times = [run() for _ in range(repeats)]
    return f"| `import ecsim` in a fresh process | {min(times):.3f} s ({statistics.median(times):.3f} s) |"


def machine() -> str:
    """What the figures hold for."""
    model = platform.processor() or platform.machine()
    with contextlib.suppress(OSError):
        facts = dict(line.split(":", 1) for line in Path("/proc/cpuinfo").read_text().splitlines() if ":" in line)
        model = next((value.strip() for name, value in facts.items() if name.strip() == "model name"), model)
    return f"{model}, {platform.system()}, {platform.python_implementation()} {platform.python_version()} ({platform.python_compiler()});"


# ---- the conveyor ------------------------------------------------------------------------------------------------------


def conveyor(scans: int = 20_000, repeats: int = 5) -> list[str]:
    """The pallet-lift conveyor with its plant, as the lab runs it: simulated seconds in one second of the host."""
    from ecsim_exercises.conveyor import Conveyor

    from ecsim.session import Session

    solution = ROOT / "exercises" / "conveyor" / "solution.il"
    simulated = scans * SCAN_MS / 1000

    def ready() -> tuple[Any, Any]:
        plc, plant = ecsim.Plc("EC20", scan_ms=SCAN_MS), Conveyor()
        plc.load(solution)
        plc.run()
        plc["X5"] = 1
        return plc, plant

    def bare() -> float:
        """The loop of a script: outputs to the plant, its inputs back, one scan."""
        plc, plant = ready()
        outputs = [name for name in plant.wiring if name.startswith("Y")]
        began = time.perf_counter()
        for _ in range(scans):
            for name, state in plant.step(SCAN_MS / 1000, {name: plc[name] for name in outputs}).items():
                plc[name] = state
            plc.scan()
        return time.perf_counter() - began

    def recorded() -> float:
        """The session of a notebook, with all that it keeps for its panels and for stepping back."""
        session = Session(*ready(), name="bench")
        began = time.perf_counter()
        session.scan(scans)
        return time.perf_counter() - began

    lines = []
    gc.collect()  # what was measured before is not to be collected in these turns
    gc.freeze()
    for title, run in (("by a script, name by name", bare), ("in a session with its recording", recorded)):
        times = [run() for _ in range(repeats)]
        least, middle = simulated / min(times), simulated / statistics.median(times)
        lines.append(f"| conveyor and plant, {title} | {least:,.0f} times real time ({middle:,.0f}) |")
    gc.unfreeze()
    return lines


# ---- the run -----------------------------------------------------------------------------------------------------------


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--rounds", type=int, default=20, help="turns of measurement (20)")
    arguments.add_argument("--write", action="store_true", help="put the tables into docs/performance.md")
    arguments.add_argument("--peers", type=Path, default=peers.PYTHON, help="the Python of the peers' environment")
    chosen = arguments.parse_args()
    with peers_server(chosen.peers) as server:
        rows = contenders(server)
        measure(rows, chosen.rounds)
        installed = server.ask(do="versions") if server else {}
    named = ", ".join(f"{name} {number}" for name, number in installed.items()) or "no peers installed (`python bench/peers.py install`)"
    lines = [
        "`python bench/speed.py --write`" + f", {chosen.rounds} turns. {machine()} {named}.",
        "",
        *per_instruction(rows),
        "",
        *ratios(rows),
        "",
        "| best (median) | |",
        "|---|---|",
        loading(),
        *conveyor(),
        importing(),
    ]
    print("\n".join(lines))
    if chosen.write:
        pages.put(pages.PERFORMANCE, "speed", lines)


if __name__ == "__main__":
    main()
