"""The report with its replay buttons, without a browser."""

import pytest
from ecsim_widgets.report import ReportPanel

from ecsim.grading import find_exercise


@pytest.fixture
def panel():
    exercise = find_exercise("conveyor")
    panel = ReportPanel(exercise.grade(exercise.mistakes["cycle_ends_early"][0]), seconds=1.0)
    yield panel
    if panel.lab is not None:
        panel.lab.close()


def test_there_is_a_button_for_each_broken_rule(panel):
    assert [button.description for button in panel.buttons] == [
        "Replay from 1 s before: The gate opens for no pallet while the one before it is on its way from X1 to the falling edge of X4"
    ]


def test_a_click_opens_a_lab_before_the_failure(panel):
    failure = panel.report["one-at-a-time"].failure
    panel.buttons[0].click()
    lab = panel.lab
    assert panel.place.children == (lab,)
    assert lab.session.state in ("paused", "stopped")
    assert lab.plc.scans == failure.scan - 100
    assert lab.plc["Y0"] == 0
    lab.session.scan(101)
    assert (lab.plc["Y0"], lab.plc["X4"]) == (1, 1)


def test_a_second_click_opens_another_lab(panel):
    panel.buttons[0].click()
    first = panel.lab
    panel.buttons[0].click()
    assert panel.lab is not first
    assert panel.place.children == (panel.lab,)
