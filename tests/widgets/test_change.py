"""Another program for a running PLC: online where that is allowed, else by a download, and in words."""

import pytest
from ecsim_widgets.change import change

from ecsim.errors import EcsimError, ProgramError

BEFORE = "LD X0\nOUT Y0\nLD SM0\nINC D0"


@pytest.fixture
def counting(make_rig):
    rig = make_rig(program=BEFORE)
    rig.session.scan(5)
    return rig


def test_a_change_in_run_keeps_the_values(counting):
    said = change(counting, "LD X0\nANI X1\nOUT Y0\nLD SM0\nINC D0")
    assert said == "Changed in RUN: 1 new instruction, 0 gone. No device has changed its value."
    assert (counting.plc.running, counting.plc["D0"]) == (True, 5)
    counting.session.scan()
    assert counting.plc["D0"] == 6


def test_it_can_be_gone_back_over(counting):
    change(counting, "LD X0\nOUT Y1\nLD SM0\nINC D0")
    counting.session.scan(2)
    counting.session.back(3)
    assert counting.plc["D0"] == 4
    assert counting.plc.program.source == BEFORE


def test_another_variable_table_is_a_download(counting):
    said = change(counting, "VAR_GLOBAL\nLamp AT Y0\nEND_VAR\nPROGRAM MAIN\nLD X0\nOUT Lamp\nEND_PROGRAM")
    assert said == "Downloaded, from STOP to RUN: the global variables differ (lamp)."
    assert counting.plc.running


def test_in_stop_it_is_a_download_and_stays_in_stop(counting):
    counting.plc.stop()
    assert change(counting, "LD X1\nOUT Y0") == "Downloaded: the PLC is in STOP."
    assert not counting.plc.running


def test_a_text_with_errors_changes_nothing(counting):
    with pytest.raises(ProgramError, match="line 2"):
        change(counting, "LD X0\nOUT X0")
    assert counting.plc.program.source == BEFORE
    assert counting.plc.running


def test_without_the_password_it_is_refused(counting):
    counting.plc.protection.passwords.download = "secret"
    with pytest.raises(EcsimError, match="password"):
        change(counting, "LD X1\nOUT Y0")
    assert counting.plc.program.source == BEFORE
