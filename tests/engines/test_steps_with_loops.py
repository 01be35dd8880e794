"""A loop inside a step belongs to the step: its transitions hand over as they do outside (5.3.2, 6.1.1)."""

import pytest

import ecsim
from ecsim import Plc

FLOW = "LD SM1\nSET S0\nSTL S0\nLD X0\nFOR 2\nLD SM0\nINC D0\nLD SM0\n{}\nNEXT\nSTL S20\nOUT Y0\nLD X1\nOUT S0\nRET"


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
@pytest.mark.parametrize("jump", ["", "LD X7\nCJ 1\nLBL 1\n"], ids=["", "with jumps"])
def test_a_transition_in_a_loop_ends_the_step(engine, jump):
    plc = Plc(input_filter_ms=0)
    plc.load(jump + FLOW.format("SET S20"))
    plc.engine = engine
    plc.run()
    plc["X0"] = 1
    plc.scan()
    assert (plc["S0"], plc["S20"], plc["Y0"], plc["D0"]) == (0, 1, 1, 2)


def test_a_jump_to_the_next_step_is_refused_in_a_loop_too():
    with pytest.raises(ecsim.ProgramError) as refused:
        ecsim.compile(FLOW.format("OUT S20"))
    assert [problem.message for problem in refused.value.problems] == ["OUT S20 leads to the adjacent step"]
