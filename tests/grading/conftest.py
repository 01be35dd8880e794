"""What the tests of grading share."""

import pytest

import ecsim
from ecsim.grading import find_exercise
from ecsim.grading.choices import usual
from ecsim.grading.run import Run


@pytest.fixture(scope="session")
def conveyor():
    return find_exercise("conveyor")


@pytest.fixture(scope="session")
def conveyor_trace(conveyor):
    """The reference program on the first scenario, as it usually goes."""
    plc = ecsim.Plc("EC20")
    plc.load(conveyor.solution)
    scenario = conveyor.scenarios[0]
    return Run(conveyor, plc, scenario, usual(scenario.choices)).to()
