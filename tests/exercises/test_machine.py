"""What the machines' base does for each of them, on the gate of exercises/README.md."""

import re
from dataclasses import dataclass, field
from typing import ClassVar

import pytest
from ecsim_exercises.plant import Incident, Machine, Point, remaining, towards

from ecsim import EcsimError

OPENS, DARK, OFF = {"Y0": 1, "Y1": 1}, {"Y0": 1, "Y1": 0}, {"Y0": 0, "Y1": 0}


@pytest.fixture
def gate(root):
    """The gate as the page writes it: 8 s from end to end."""
    text = (root / "exercises" / "README.md").read_text(encoding="utf-8")
    names = {"Machine": Machine, "Point": Point, "remaining": remaining, "towards": towards}
    names |= {"dataclass": dataclass, "field": field, "ClassVar": ClassVar, "__name__": __name__}
    exec(re.search(r"```python\n(@dataclass\nclass Gate.*?)```", text, re.DOTALL)[1], names)
    return names["Gate"]()


@pytest.mark.parametrize("step", [0.01, 0.3, 1.7, 9.0])
def test_a_step_of_any_length_ends_at_the_same_mark(gate, step):
    for _ in range(round(9 / step)):
        sensors = gate.step(step, OPENS)
    assert (gate.place, sensors) == (1.0, {"X0": 1})
    assert gate.step(2.0, OFF) == {"X0": 0}
    assert gate.place == pytest.approx(0.75)


def test_what_is_amiss_is_noted_once_while_it_lasts(gate):
    for _ in range(10):
        gate.step(0.1, DARK)
    gate.step(0.1, OPENS)
    gate.step(0.1, DARK)
    assert gate.incidents == (Incident(0.0, "it runs without a lamp"), Incident(1.1, "it runs without a lamp"))


def test_a_moment_comes_back_with_all_that_belongs_to_it(gate):
    gate.step(3.0, OPENS)
    gate.fail("jammed")
    before = gate.state()
    gate.step(9.0, DARK)
    gate.fail("jammed", on=False)
    gate.step(9.0, OPENS)
    assert gate.place == 1
    gate.restore(before)
    assert gate.state() == before
    gate.step(9.0, OPENS)
    assert (gate.place, gate.faults) == (3 / 8, {"jammed"})


def test_a_fault_that_a_machine_does_not_have_is_refused(gate):
    with pytest.raises(EcsimError, match="this machine has no fault 'rust'; it has jammed"):
        gate.fail("rust")
    assert gate.faults == frozenset()
