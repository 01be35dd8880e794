"""Kill a process again and again while it saves a PLC: the file always opens, as one of the states that were saved.

    python bench/kill_while_saving.py [TIMES] [FOLDER]

Every register of generation n holds n, so that a mixture would be seen. Needs a system with fork and SIGKILL.
"""

import os
import random
import select
import signal
import sys
import tempfile
from pathlib import Path

from ecsim import Plc

REGISTERS = 8000
LATEST_S = 0.02  # a save takes a few milliseconds; the kill comes anywhere in the first of them


def fill(plc: Plc, generation: int) -> None:
    """Make a state that tells its generation in every register."""
    plc.memory.lists["D"][:] = [generation] * REGISTERS


def generation_of(path: Path) -> int:
    """The generation that a file holds; raises AssertionError for a mixture."""
    values = set(Plc.open(path).memory.lists["D"])
    assert len(values) == 1, f"a mixture of {sorted(values)}"
    return values.pop()


def save_for_ever(plc: Plc, path: Path, generation: int, begun: int) -> None:
    """What the process does that will be killed."""
    os.write(begun, b"!")
    while True:
        generation += 1
        fill(plc, generation)
        plc.save(path)


def kill_once(plc: Plc, path: Path, generation: int, after_s: float) -> None:
    """Start a process that saves, wait that long, and kill it."""
    seen, begun = os.pipe()
    child = os.fork()
    if not child:
        try:
            save_for_ever(plc, path, generation, begun)
        finally:
            os._exit(1)
    os.read(seen, 1)
    select.select([], [], [], after_s)
    os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    os.close(seen)
    os.close(begun)
    assert os.WIFSIGNALED(status), "the process ended by itself"


def main(times: int, folder: Path) -> None:
    chance, path, plc = random.Random(1), folder / "machine.plc", Plc()
    fill(plc, 0)
    plc.save(path)
    generation = torn = went_on = 0
    for _ in range(times):
        kill_once(plc, path, generation, chance.uniform(0, LATEST_S))
        found = generation_of(path)
        assert found >= generation, f"generation {found} after {generation}"
        went_on += found > generation
        generation = found
        for left in folder.glob(".machine.plc.*.new"):
            torn += 1
            left.unlink()
    print(f"{times} kills, {torn} of them in the middle of writing, {went_on} behind a complete save; every file opened")


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    with tempfile.TemporaryDirectory() as scratch:
        main(count, Path(sys.argv[2]) if len(sys.argv) > 2 else Path(scratch))
