"""A simulation whose scans the test makes by hand: no thread, no wall clock, no Jupyter."""

from typing import NamedTuple

import pytest
from ecsim_widgets.rig import Rig

from ecsim.plc import Plc
from ecsim.session import Session

PROGRAM = """
VAR_GLOBAL
  Start AT X5      // start button
  Lamp AT Y0
  Settle AT T0
END_VAR
PROGRAM MAIN
// the lamp follows the button
LD Start
OUT Lamp
// one scan for every press
LD Start
EU
OUT Y1
LD SM1
SET S0
// wait for a part
STL S0
LD X0
SET S20
// hold it
STL S20
OUT Y2
LD SM0
TON Settle 5
LD Settle
OUT S0
RET
LD S20
CTU C0 3
END_PROGRAM
"""


class Point(NamedTuple):
    """A terminal as a plant describes it."""

    name: str
    what: str


class Shuttle:
    """A plant with one valve and one sensor: after 50 ms with the valve on, the sensor is on."""

    def __init__(self):
        self.wiring = {"X0": Point("There", "the part is there"), "X5": Point("Start", "start button"), "Y0": Point("Valve", "the valve")}
        self.seconds = 0.0

    def step(self, seconds, outputs):
        self.seconds = self.seconds + seconds if outputs["Y0"] else 0.0
        return {"X0": int(self.seconds >= 0.05)}


class Picture:
    """The plant's drawing."""

    def svg(self, prefix="", width=None):
        return f'<svg class="ec"><g id="{prefix}part"/></svg>'

    def state(self, moment):
        return {"part:transform": f"translate({moment.plant.seconds * 100:.0f} 0)", "X0:class": "on" if moment.inputs["X0"] else ""}


@pytest.fixture
def make_rig():
    """Make a rig around a PLC in RUN whose session has no thread: scans come when the test asks for them."""

    def make(plant=None, program=PROGRAM, **more):
        plc = Plc("EC20", scan_ms=10, input_filter_ms=0)
        plc.load(program)
        session = Session(plc, plant=plant, name="test")
        session.trace_frames = True
        plc.run()
        return Rig(plc, session, **more)

    return make


@pytest.fixture
def rig(make_rig):
    """A rig without a plant."""
    return make_rig()


@pytest.fixture
def shuttle():
    """The plant with one valve and one sensor."""
    return Shuttle()


@pytest.fixture
def picture():
    """The drawing of the shuttle."""
    return Picture()
