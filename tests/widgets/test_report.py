"""The report with its buttons, without a browser."""

import threading
import time

import pytest
from ecsim_widgets.report import TRIES, ReportPanel

from ecsim.grading import find_exercise

RULE = "one-at-a-time"


@pytest.fixture(scope="module")
def report():
    exercise = find_exercise("conveyor")
    return exercise.grade(exercise.mistakes["cycle_ends_early"][0])


@pytest.fixture
def panel(report, monkeypatch):
    monkeypatch.setattr(ReportPanel, "_failures", {})
    panel = ReportPanel(report, seconds=0.2)
    yield panel
    if panel.lab is not None:
        panel.lab.close()


def click(panel, act, rule=""):
    """What the page sends for a click."""
    panel.sheet._handle_custom_msg({"act": act, "rule": rule}, [])


def test_a_broken_rule_has_its_buttons_and_no_other(panel):
    assert panel.sheet.html.count('data-act="replay"') == panel.sheet.html.count('data-act="scan"') == len(panel.report.failed) == 1
    assert f'data-rule="{RULE}"' in panel.sheet.html
    assert "Replay from 0.2 s before" in panel.sheet.html


def test_a_click_replays_up_to_the_failing_scan_and_stops_there(panel):
    failure = panel.report[RULE].failure
    click(panel, "replay", RULE)
    lab = panel.lab
    assert panel.place.children == (lab,)
    wait_for(lambda: lab.session.state == "paused" and lab.plc.scans == failure.scan + 1)
    assert (lab.plc["Y0"], lab.plc["X4"]) == (1, 1)


def wait_for(holds, seconds=20):
    """Until a condition holds that another thread makes true."""
    end = time.monotonic() + seconds
    pause = threading.Event()
    while not holds():
        assert time.monotonic() < end
        pause.wait(0.01)


def test_the_scan_itself_is_one_click_away(panel):
    failure = panel.report[RULE].failure
    click(panel, "scan", RULE)
    assert panel.lab.plc.scans == failure.scan + 1
    assert panel.lab.session.state in ("paused", "stopped")
    assert (panel.lab.plc["Y0"], panel.lab.plc["X4"]) == (1, 1)


def test_a_second_click_opens_another_lab(panel):
    click(panel, "scan", RULE)
    first = panel.lab
    click(panel, "scan", RULE)
    assert panel.lab is not first
    assert panel.place.children == (panel.lab,)


def test_a_rule_that_was_kept_opens_nothing(panel):
    click(panel, "scan", "lets-in")
    click(panel, "dance", RULE)
    assert panel.lab is None


def test_hints_come_after_repeated_failures_one_after_the_other(panel, report):
    assert TRIES == 2
    assert panel.sheet.help["open"] is False
    click(panel, "hint")
    assert panel.sheet.help["words"] == ""
    again = ReportPanel(report)
    hints = report.task.hints
    assert again.sheet.help == {"words": "", "button": f"Hint 1 of {len(hints) + 1}", "open": True}
    for number, words in enumerate(hints, 1):
        click(again, "hint")
        assert again.sheet.help == {"words": words, "button": f"Hint {number + 1} of {len(hints) + 1}", "open": True}
    click(again, "hint")
    again.search.join(60)
    assert again.sheet.help["words"].startswith("Look at network")
    assert again.sheet.help["open"] is False


def test_a_report_on_a_right_program_has_no_buttons(report):
    right = ReportPanel(report.task.grade(report.task.solution))
    assert "<button" not in right.sheet.html
    click(right, "hint")
    assert right.search is None
