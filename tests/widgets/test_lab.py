"""A lab and its name: what it cannot take changes nothing, what it takes replaces the lab of that name."""

import pytest
from ecsim_widgets import Lab

from ecsim.errors import EcsimError

PROGRAM = "LD X0\nOUT Y0"


@pytest.fixture
def lab():
    """A lab that runs, as fast as it goes."""
    made = Lab("EC20", PROGRAM, name="of a test", speed=None)
    yield made
    for each in (made, Lab.named("of a test")):
        if each is not None:
            each.close()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"devices": ["D0", "Q7"]}, "Q7"),
        ({"devices": "D0"}, r"devices= takes a list of names, such as \[\"D0\", \"X5\"\], not 'D0'"),
        ({"devices": 5}, "devices= takes a list of names"),
        ({"trace": ["X0", "Q7"]}, "Q7"),
        ({"trace": [3]}, r"trace= takes a list of names, such as .* not \[3\]"),
        ({"plant": 3}, r"3 is no machine; give an object with `wiring` and `step\(seconds, outputs\)`, or None"),
        ({"plant": dict}, "no machine"),
        ({"program": "LD X0\nOUT Q0"}, "Q0"),
    ],
)
def test_what_a_lab_cannot_take_leaves_the_running_lab_of_that_name_as_it_is(lab, wrong, words):
    with pytest.raises(EcsimError, match=words):
        Lab(**{"model": "EC20", "program": PROGRAM, "name": "of a test", **wrong})
    assert Lab.named("of a test") is lab
    assert lab.session.state == "running"
    assert lab.comm is not None  # still on the page
    lab.session.pause()
    before = lab.plc.scans
    lab.session.scan()
    assert lab.plc.scans == before + 1


def test_a_lab_takes_the_place_of_the_one_of_the_same_name(lab):
    new = Lab("EC20", PROGRAM, name="of a test", devices=("D0",), trace=("X0",), autostart=False)
    assert Lab.named("of a test") is new
    assert (lab.session.state, lab.comm) == ("stopped", None)
    assert [row.name for row in new.rig.table.rows.values()] == ["D0"]


def test_two_labs_of_one_plc_end_as_one_that_runs(lab):
    new = Lab(lab.plc, name="of a test")
    assert (lab.session.state, new.session.state) == ("stopped", "running")
