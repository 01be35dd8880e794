"""What a Plc is made with: the system block's settings (2.2.1) and the numbers given to its methods."""

import threading

import pytest

from ecsim import EcsimError, Plc, Session, SystemBlock
from ecsim.hardware.serial import PortSettings


@pytest.mark.parametrize(
    ("model", "settings", "says"),
    [
        ("EC20", {"stop_outputs": "freze"}, "choose disable or freeze or configure"),
        ("EC20", {"watchdog_ms": 1001}, "watchdog_ms is 1001; it is a number from 0 to 1000"),
        ("EC20", {"watchdog_ms": -1}, "from 0 to 1000"),
        ("EC20", {"constant_scan_ms": 300}, "above the watchdog's 200"),
        ("EC20", {"input_filter_ms": 61}, "EC20 takes 0 to 60"),
        ("EC10", {"input_filter_ms": 10}, "EC10 takes 0, 8, 16, 32 or 64"),
        ("EC10", {"retain": {"T": [(0, 1)]}}, "EC10 cannot retain T; it retains D, M, S, C"),
        ("EC20", {"retain": {"Y": [(0, 1)]}}, "EC20 cannot retain Y"),
        ("EC20", {"retain": {"M": [(0, 2000)]}}, "write numbers from 0 to 1999"),
        ("EC20", {"retain": {"M": [("M0", "M5")]}}, "write numbers from 0 to 1999"),
        ("EC20", {"retain": {"M": [(0, 1), (3, 4), (6, 7)]}}, "3 ranges of M; EC20 takes 2"),
        ("EC10", {"retain": {"M": [(0, 1), (3, 4)]}}, "2 ranges of M; EC10 takes 1"),
        ("EC20", {"retain": {"C": [(0, 200)]}}, "201 counters; EC20 can retain 200"),
        ("EC10", {"retain": {"M": [(0, 199)], "S": [(0, 120)]}}, "321 bits; EC10 can retain 320"),
        ("EC10", {"retain": {"D": [(0, 180)]}}, "181 words; EC10 can retain 180"),
        ("EC20", {"data_block": {"M0": 1}}, "data_block names M0; it holds D devices"),
        ("EC20", {"data_block": {"D0": 70000}}, "70000 does not fit into D0"),
        ("EC20", {"stop_output_table": {"M0": 1}}, "it holds Y devices"),
        ("EC20", {"stop_output_table": {"Y0": 2}}, "Y0 is one bit"),
        ("EC20", {"power_loss_ms": 101}, "power_loss_ms is 101; it is a number from 0 to 100"),
        ("EC10", {"power_loss_ms": 1}, "power_loss_ms is 1, but EC10 has no such setting; leave it out"),
        ("EC20", {"run_input": "X20"}, "run_input is 'X20'; choose one of X0 to X17, or None"),
        ("EC10", {"run_input": "M0"}, "run_input is 'M0'; choose one of X0 to X17, or None"),
        ("EC20", {"interrupt_priority": {8: "high"}}, "names event 8; EC20 has 0, 1, 2"),
        ("EC20", {"interrupt_priority": {29: "high"}}, "names event 29; EC20 has 0, 1, 2"),
        ("EC10", {"interrupt_priority": {29: "highest"}}, "event 29 is 'highest'; choose low or high"),
        ("EC10", {"no_battery": True}, "EC10 has no battery that could be missing; leave it out"),
        ("EC20", {"format_lock": 1}, "format_lock is 1; write True or False"),
        ("EC20", {"modules": {0: {}}}, "place 0, which the system block of EC20 has not; set its modules up with TO"),
        ("EC10", {"modules": {4: {}}}, "place 4, which the system block of EC10 has not; write a place from 0 to 3"),
        ("EC20", {"port0": PortSettings("modbus master")}, "the protocol of port 0 is 'modbus master'; choose "),
        ("EC20", {"port1": PortSettings("freeport", baud=300)}, "the baud rate of port 1 is 300; choose "),
        ("EC10", {"modules": {0: 5}}, "place 0 is set to 5; write its settings by name"),
    ],
)
def test_a_setting_that_the_model_does_not_have_is_refused(model, settings, says):
    with pytest.raises(EcsimError, match=says):
        Plc(model, system=SystemBlock(**settings))


@pytest.mark.parametrize(
    ("model", "settings"),
    [
        ("EC20", {"power_loss_ms": 100, "run_input": "X17", "interrupt_priority": {0: "high", 28: "low"}, "no_battery": True}),
        ("EC10", {"run_input": "X0", "interrupt_priority": {37: "high"}, "format_lock": True, "modules": {3: {"kind": "4AD"}}}),
    ],
)
def test_the_settings_at_the_end_of_their_ranges_are_taken(model, settings):
    plc = Plc(model, system=SystemBlock(**settings))
    assert {name: getattr(plc.system, name) for name in settings} == settings


def test_the_filter_given_beside_the_system_block_is_held_to_the_same_choices():
    with pytest.raises(EcsimError, match="EC10 takes 0, 8, 16, 32 or 64"):
        Plc("EC10", input_filter_ms=9)
    assert Plc("EC10", input_filter_ms=64)["SD35"] == 64


@pytest.mark.parametrize("scan_ms", [0, -1, 70_000, "10", True, float("nan")])
def test_a_scan_period_out_of_range_is_refused(scan_ms):
    with pytest.raises(EcsimError, match=r"from 0\.001 to 60000"):
        Plc(scan_ms=scan_ms)


@pytest.mark.parametrize("count", [-1, 1.5, "3", None])
def test_a_strange_number_of_scans_is_refused(count):
    plc = Plc()
    with pytest.raises(EcsimError, match="whole number from 0 on"):
        plc.scan(count)
    assert plc.scans == 0


@pytest.mark.parametrize("ms", [-1, "3", None, float("nan")])
def test_time_does_not_go_back(ms):
    with pytest.raises(EcsimError, match="ms is"):
        Plc().advance(ms=ms)


def test_until_says_so_when_the_plc_is_in_stop():
    plc = Plc()
    with pytest.raises(EcsimError, match=r"Y0 did not become 1 within 50 ms .* in STOP, run\(\) starts it"):
        plc.until("Y0", timeout_ms=50)


def test_tab_offers_names_and_devices_between_the_brackets():
    plc = Plc()
    plc.load("VAR_GLOBAL\nMotor AT Y0\nEND_VAR\nLD X3\nOUT Motor")
    assert plc._ipython_key_completions_() == ["Motor", "X3", "Y0"]


def test_a_program_may_be_loaded_while_a_session_runs_the_plc():
    short, long = "LD SM0\nINC D0", "LD SM0\nTON T0 5\nEU\nCTU C0 5\nINC D0\nEU\nOUT Y0"
    plc = Plc(input_filter_ms=0)
    plc.load(short)
    session = Session(plc, name="loaded meanwhile", speed=None)
    session.run()
    for turn in range(61):
        plc.load(long if turn % 2 else short)
        plc.force("Y1", 1)
        plc.run()
        plc.scan()
        plc.unforce()
    moved = threading.Event()
    session.observe(lambda session: moved.set() if session.plc["D0"] > 5 else None)
    assert moved.wait(5)
    assert (session.state, session.error) == ("running", None)
    session.stop()


@pytest.mark.parametrize(
    ("setting", "says"),
    [
        ({"retain": [("D", 100, 199)]}, "retain is .*; write a dict"),
        ({"retain": {"D": (100, 199)}}, r"retain of D is \(100, 199\); write a list of ranges, for example \[\(100, 199\)\]"),
        ({"retain": {"D": 5}}, "retain of D is 5; write a list of ranges"),
        ({"data_block": [5]}, r"data_block is \[5\]; write a dict"),
        ({"interrupt_priority": "high"}, "interrupt_priority is 'high'; write a dict"),
        ({"port1": "freeport"}, r"port1 is 'freeport'; write PortSettings, for example PortSettings\('freeport'\)"),
    ],
)
def test_a_setting_of_another_kind_is_told(setting, says):
    with pytest.raises(EcsimError, match=says):
        Plc("EC20", system=SystemBlock(**setting))
