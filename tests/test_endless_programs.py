"""Programs without an end, and what the watchdog makes of them; the host never hangs (6.1.6, 2.1.3)."""

import pytest

from ecsim import Plc, Session, SystemBlock

FOR_EVER = "LBL 1\nLD SM0\nWDT\nINC D0\nCJ 1"


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
@pytest.mark.parametrize("watchdog_ms", [200, 0])
def test_a_loop_without_an_end_is_stopped_though_wdt_or_no_watchdog_would_let_it_run(engine, watchdog_ms, monkeypatch):
    monkeypatch.setattr("ecsim.plc.LONGEST_NS", 500_000_000)
    plc = Plc(system=SystemBlock(watchdog_ms=watchdog_ms))
    plc.load(FOR_EVER)
    plc.engine = engine
    plc.run()
    plc.scan()
    assert not plc.running
    assert [error.code for error in plc.errors] == [61]


def test_the_watchdog_is_an_execution_error_not_a_system_error():
    plc = Plc()
    plc.load("LD SM0\nFOR 32767\nLD SM0\nFOR 32767\nNEXT\nNEXT")
    plc.run()
    plc.scan()
    assert (plc["SM20"], plc["SD20"], plc["SM3"], plc["SD3"]) == (1, 61, 0, 0)  # 2.4.2, appendix 6


def test_wdt_restarts_the_watchdog_not_the_scan_time():
    plc = Plc("EC20", scan_ms=None, system=SystemBlock(watchdog_ms=3))
    plc.load("LD SM0\nFOR 10000\nLD SM0\nWDT\nINC D0\nNEXT")
    plc.run()
    plc.scan(2)
    assert plc["D0"] == 20000
    # 10,000 turns of LD, WDT, INC and NEXT (1 + 1 + 3 + 1 steps) at 0.09 us a step, and the FOR before them
    assert plc["SD30"] == round(10000 * 6 * 0.09 / 1000)


# -- what a snapshot holds ----------------------------------------------------------------------------------------------


def test_a_step_back_takes_back_what_was_forced_meanwhile():
    plc = Plc(input_filter_ms=0)
    plc.load("LD SM0\nOUT Y0")
    plc.run()
    session = Session(plc, name="forced")
    session.scan(5)
    session.post(lambda plc: plc.force("Y0", 0))
    session.scan(5)
    assert (plc["Y0"], plc.forced) == (0, {"Y0": 0})
    session.back(7)
    assert (plc["Y0"], plc.forced) == (1, {})


def test_a_step_back_forces_again_what_was_released_meanwhile():
    plc = Plc(input_filter_ms=0)
    plc.load("LD SM0\nOUT Y0")
    plc.run()
    session = Session(plc, name="released")
    session.post(lambda plc: plc.force("Y0", 0))
    session.scan(3)
    session.post(lambda plc: plc.unforce("Y0"))
    session.scan(3)
    assert plc["Y0"] == 1
    session.back(4)
    assert (plc["Y0"], plc.forced) == (0, {"Y0": 0})
