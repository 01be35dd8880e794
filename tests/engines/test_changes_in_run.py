"""A change in RUN that changes nothing leaves no trace: random programs, one machine changed now and then, one left alone."""

import random

import pytest

from ecsim import Plc, SystemBlock
from ecsim.errors import ProgramError

from .random_programs import random_program
from .side_by_side import difference, state

IDLE = "LD M1990\nEU\nINC D6500\nLD M1991\nTON T100 5\n"  # a rung that nothing drives


def varied(text):
    """The program with more rungs that do nothing, before and behind its own; None where that would be another program."""
    lines = text.split("\n")
    first = next((n for n, line in enumerate(lines) if line.startswith("PROGRAM")), -1) + 1
    return "\n".join([*lines[:first], *IDLE.strip().split("\n"), *lines[first:]])


def machine(text, engine):
    plc = Plc("EC20", input_filter_ms=0, system=SystemBlock(watchdog_ms=0))
    plc.load(text)
    plc.engine = engine
    plc.run()
    return plc


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_a_change_that_changes_nothing_leaves_no_trace(engine):
    compared = 0
    for seed in range(16):
        chance = random.Random(seed)
        text = random_program(chance, 10)
        try:
            left, changed = machine(text, engine), machine(text, engine)
            forms = [text, varied(text)]
            for turn in range(12):
                number, level, value = chance.randrange(8), chance.randrange(2), chance.randrange(-5, 300)
                for plc in (left, changed):
                    plc[f"X{number}"] = level
                    plc[f"D{number}"] = value
                if turn % 3 == 2 and changed.running:
                    changed.edit(forms[turn // 3 % 2 - 1])
                left.scan()
                changed.scan()
                assert difference(state(left, []), state(changed, [])) == "", f"seed {seed}, turn {turn}:\n{text}"
                compared += 1
        except ProgramError:
            continue  # no room for more
    assert compared > 160
