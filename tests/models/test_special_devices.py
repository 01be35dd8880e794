"""Which special relays and registers a program may write: those that appendices 1 and 2 list so for the model; reserved ones are read only."""

import json
import re
from pathlib import Path

import pytest

import ecsim

FACTS = json.loads((Path(__file__).parent.parent / "facts" / "system.json").read_text(encoding="utf-8"))


def writable(kind: str, model: str) -> set[int]:
    found: set[int] = set()
    for row in FACTS[kind]:
        numbers = [int(number) for number in re.findall(r"\d+", row["address"])]
        if row["access"] != "R" and model in row["models"]:
            found.update(range(numbers[0], numbers[-1] + 1))
    return found


def accepted(text: str, model: str) -> bool:
    try:
        ecsim.compile(text, model)
    except ecsim.ProgramError:
        return False
    return True


@pytest.mark.parametrize("model", ["EC10", "EC20"])
@pytest.mark.parametrize(("kind", "write"), [("sm", "LD X0\nOUT SM{}"), ("sd", "LD X0\nMOV 1 SD{}")])
def test_a_program_writes_what_the_appendix_lets_it_write(model, kind, write):
    assert {number for number in range(256) if accepted(write.format(number), model)} == writable(kind, model)
