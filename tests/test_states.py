"""What state a PLC is in: mode switch, run input, power and battery, damage, errors and lamps (2.1.6, 2.1.7, 2.1.10, 2.3, 2.4, appendix 6).

RUN and STOP by themselves stand in test_plc.py, whole stories in conformance/2-operation.json.
"""

import json
from datetime import datetime

import pytest

from ecsim import EcsimError, Plc, Session, SystemBlock
from ecsim.hardware.faults import ERRORS
from ecsim.hardware.serial import PortSettings

MODELS = ["EC10", "EC20"]
COUNTING = "LD SM0\nINC D0\nOUT Y0"


def plc_with(text=COUNTING, model="EC20", run=True, **system):
    """A PLC with a program, in RUN unless told otherwise; no input filter."""
    plc = Plc(model, system=SystemBlock(**({"input_filter_ms": 0} | system)))
    plc.load(text)
    if run:
        plc.run()
    return plc


def codes(plc):
    """The codes of all errors that the PLC reports."""
    return [error.code for error in plc.errors]


# -- the mode switch (2.3.2) --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("turns", "running"),
    [
        (["OFF"], False), (["TM"], True), (["OFF", "TM"], False), (["OFF", "ON"], True), (["TM", "OFF"], False),
        (["TM", "ON"], True), (["OFF", "TM", "ON"], True), (["ON"], True), (["off", "on"], True),
    ],
)  # fmt: skip
def test_the_switch_starts_and_stops(turns, running):
    plc = plc_with()
    for position in turns:
        plc.switch = position
    assert plc.running is running
    assert plc.switch == turns[-1].upper()


def test_the_switch_that_stands_at_on_does_not_start_by_itself():
    plc = plc_with(run=False)
    plc.switch = "ON"
    plc.scan(3)
    assert not plc.running


def test_tm_to_on_starts_a_plc_that_the_software_has_stopped():
    plc = plc_with()
    plc.switch = "TM"
    plc.stop()
    plc.switch = "ON"
    assert plc.running


def test_the_software_starts_at_tm_and_on_but_not_at_off():
    plc = plc_with(run=False)
    plc.switch = "TM"
    plc.run()
    assert plc.running
    plc.switch = "OFF"
    with pytest.raises(EcsimError, match=r"the mode switch is OFF, which allows no RUN; set plc\.switch to 'ON' or 'TM'"):
        plc.run()
    plc.stop()
    assert not plc.running


class Echo:
    """An instrument that keeps what it hears."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message)


def free_port():
    """A PLC that sends a character over port 0 as long as M0 is ON, and receives."""
    plc = plc_with("LD M0\nXMT 0 D0 1\nLD M1\nRCV 0 D10 5", port0=PortSettings("freeport"))
    plc["D0"] = 0x41
    plc.ports[0].connect(Echo())
    return plc, plc.ports[0].wire.stations[0].instrument


def test_at_tm_port_0_speaks_the_programming_protocol_only():
    plc, echo = free_port()
    plc.set({"M0": 1, "M1": 1})
    plc.scan(2)
    assert (echo.heard, plc["SM111"], plc["SM114"]) == ([b"A"] * 2, 1, 0)
    plc.switch = "TM"
    assert (plc["SM111"], plc["SM114"]) == (0, 1)  # what went on has ended
    plc.scan(5)
    assert (plc.running, echo.heard) == (True, [b"A"] * 2)
    assert repr(plc.ports[0]) == "<Port 0 programming>"
    plc.switch = "ON"
    plc.scan(2)
    assert (echo.heard, plc["SM111"]) == ([b"A"] * 4, 1)


def test_at_tm_a_slave_on_port_0_does_not_answer_and_on_port_1_does():
    slave = PortSettings("modbus slave", station=1)
    plc = plc_with(port0=slave, port1=slave)
    frame = bytes.fromhex("010300000001840a")  # D0, with the CRC of 10.4.9's kind
    answers = []
    for port in plc.ports:
        port.connect(Echo())
    for position in ("ON", "TM", "ON"):
        plc.switch = position
        before = [len(port.wire.log) for port in plc.ports]
        for port in plc.ports:
            port.wire.stations[0].send(frame, plc.time_us)
            port.stirred()
        plc.scan(5)
        answers.append([len(port.wire.log) - count - 1 for port, count in zip(plc.ports, before, strict=True)])
    assert answers == [[1, 1], [0, 1], [1, 1]]


def test_what_the_switch_makes_of_port_0_outlives_power_a_new_system_block_and_the_way_back(tmp_path):
    plc, echo = free_port()
    kept = plc.snapshot()
    plc.switch = "TM"
    at_tm = plc.snapshot()
    plc.save(tmp_path / "tm.ecplc")
    plc.power_cycle()
    plc.run()
    plc["M0"] = 1
    plc.scan(3)
    assert echo.heard == []
    plc.restore(kept)
    assert repr(plc.ports[0]) == "<Port 0 freeport>"
    plc.restore(at_tm)
    assert repr(plc.ports[0]) == repr(Plc.open(tmp_path / "tm.ecplc").ports[0]) == "<Port 0 programming>"


def test_a_position_that_the_switch_does_not_have_is_refused():
    plc = plc_with()
    with pytest.raises(EcsimError, match="the mode switch has no position 'RUN'; choose ON or TM or OFF"):
        plc.switch = "RUN"
    assert (plc.switch, plc.running) == ("ON", True)


@pytest.mark.parametrize("act", ["reset", "power_cycle"])
@pytest.mark.parametrize(("position", "running"), [("ON", True), ("TM", False), ("OFF", False)])
def test_the_switch_decides_what_follows_a_reset_and_power_up(act, position, running):
    plc = plc_with()
    plc.switch = position
    getattr(plc, act)()
    assert plc.running is running


# -- the run input (2.2.1, 2.3.2) -----------------------------------------------------------------------------------


def test_the_run_input_starts_on_its_rise_with_the_switch_at_on():
    plc = plc_with(run=False, run_input="X10")
    assert (plc["SM9"], plc["SD9"]) == (1, 8)
    plc.scan()
    plc["X10"] = 1
    plc.scan(2)
    assert (plc.running, plc["D0"]) == (True, 2)  # the scan that sees the rise runs the program


def test_the_run_input_going_off_does_not_stop():
    plc = plc_with(run=False, run_input="X0")
    plc["X0"] = 1
    plc.scan(2)
    plc["X0"] = 0
    plc.scan(2)
    assert plc.running


def test_a_run_input_that_stays_on_does_not_start_again_after_a_stop():
    plc = plc_with(run=False, run_input="X0")
    plc["X0"] = 1
    plc.scan(2)
    plc.stop()
    plc.scan(5)
    assert not plc.running
    plc["X0"] = 0
    plc.scan()
    plc["X0"] = 1
    plc.scan()
    assert plc.running


@pytest.mark.parametrize("position", ["TM", "OFF"])
def test_the_run_input_needs_the_switch_at_on(position):
    plc = plc_with(run=False, run_input="X0")
    plc.switch = position
    plc["X0"] = 1
    plc.scan(3)
    assert not plc.running


@pytest.mark.parametrize("act", ["reset", "power_cycle"])
@pytest.mark.parametrize("level", [0, 1])
def test_after_power_up_the_run_input_must_be_on(act, level):
    plc = plc_with(run_input="X3")
    plc["X3"] = level
    plc.scan()
    getattr(plc, act)()
    plc.scan(2)
    assert plc.running is bool(level)


def test_without_a_run_input_sm9_is_off():
    assert plc_with()["SM9"] == 0


# -- power ----------------------------------------------------------------------------------------------------------


def test_without_power_only_time_goes_by():
    plc = plc_with(stop_outputs="freeze")
    plc.scan(3)
    plc.power_off()
    plc["X0"] = 1
    plc.scan(4)
    assert (plc.powered, plc.running, plc["D0"], plc["Y0"], plc["X0"], plc.time_us) == (False, False, 3, 0, 0, 70_000)
    assert plc.lamps == {"RUN": "off", "ERR": "off", "BAT": "off"}


@pytest.mark.parametrize(
    "act",
    [
        lambda plc: plc.run(), lambda plc: plc.load("LD X0\nOUT Y0"), lambda plc: plc.force("Y0", 1), lambda plc: plc.reset(),
        lambda plc: plc.__setitem__("D0", 1), lambda plc: plc.set({"M0": 1}), lambda plc: plc.power_cycle(off_ms=5),
        lambda plc: plc.clear("devices"),
    ],
    ids=["run", "load", "force", "reset", "write", "set", "power_cycle", "clear"],
)  # fmt: skip
def test_without_power_a_plc_takes_nothing(act):
    plc = plc_with()
    plc.scan(2)
    plc.power_off()
    before = plc.snapshot()
    with pytest.raises(EcsimError, match=r"the PLC has no power; power_on\(\) gives it"):
        act(plc)
    assert plc.snapshot() == before


def test_power_off_twice_and_on_twice_do_it_once():
    plc = plc_with("LD SM2\nINC D0", retain={"D": [(0, 0)]})
    plc.scan()
    plc.power_off()
    plc.power_off()
    plc.power_on()
    plc.scan()
    plc.power_on()
    plc.scan()
    assert plc["D0"] == 2


def test_power_off_clears_the_pulse_counts_that_run_keeps():
    plc = plc_with()
    plc["SD50"] = 7
    plc.stop()
    plc.run()
    assert plc["SD50"] == 7
    plc.power_cycle()
    assert plc["SD50"] == 0


def test_inputs_are_what_the_wiring_holds_when_the_power_comes_back():
    plc = plc_with("LD X0\nOUT Y0")
    plc.power_off()
    plc["X0"] = 1
    plc.power_on()
    plc.scan()
    assert plc["Y0"] == 1


def test_a_switch_turned_without_power_counts_when_the_power_comes_back():
    plc = plc_with()
    plc.power_off()
    plc.switch = "OFF"
    plc.power_on()
    assert not plc.running


# A failure is bridged for SD5: 10 ms at least, 100 ms at most (appendix 2); EC10 has no such time.
@pytest.mark.parametrize(
    ("model", "setting", "off_ms", "bridged"),
    [
        ("EC20", 0, 10, True), ("EC20", 0, 11, False), ("EC20", 5, 9, True), ("EC20", 50, 49, True), ("EC20", 50, 50, True),
        ("EC20", 50, 51, False), ("EC20", 100, 100, True), ("EC20", 100, 101, False), ("EC10", 0, 1, False),
    ],
)  # fmt: skip
def test_a_short_failure_is_bridged(model, setting, off_ms, bridged):
    plc = plc_with("LD SM2\nINC D1\nLD SM0\nINC D0", model, power_loss_ms=setting, retain={"D": [(1, 1)]})
    plc.scan(3)
    plc.power_cycle(off_ms=off_ms)
    plc.scan()
    assert plc["D1"] == (1 if bridged else 2)
    assert plc.running


def test_the_program_sees_a_failure_in_sm5_while_it_is_bridged():
    plc = plc_with("LD SM5\nINC D0\nLDI SM5\nINC D1", power_loss_ms=50)
    assert plc["SD5"] == 50
    plc.scan(2)
    plc.power_cycle(off_ms=20)
    assert (plc["D0"], plc["D1"], plc["SM5"], plc.time_us) == (5, 2, 0, 70_000)
    plc.scan()
    assert plc["D1"] == 3


def test_a_failure_takes_its_time():
    plc = plc_with()
    plc.scan()
    plc.power_cycle(off_ms=250)
    assert plc.time_us == 260_000
    plc.advance(ms=10)
    assert (plc.time_us, plc["D0"]) == (270_000, 1)


def test_the_detection_time_is_10_ms_at_least():
    assert plc_with(power_loss_ms=3)["SD5"] == 10
    assert plc_with()["SD5"] == 10


def test_the_power_loss_program_runs_before_the_stop_and_sees_sm5():
    text = "PROGRAM MAIN\nLD SM1\nSET SM56\nEI\nEND_PROGRAM\nINTERRUPT LOST EVENT 29\nLD SM5\nMOV 7 D0\nEND_INTERRUPT"
    plc = plc_with(text, "EC10", retain={"D": [(0, 0)]})
    plc.scan(2)
    plc.power_off()
    assert plc["D0"] == 7
    plc.power_on()
    assert plc["D0"] == 7


def test_a_negative_failure_is_refused():
    plc = plc_with()
    with pytest.raises(EcsimError, match="off_ms is -1; it is a number from 0"):
        plc.power_cycle(off_ms=-1)
    assert plc.running


def test_the_24_volts_are_looked_at_every_50_ms():
    plc = plc_with()
    plc.scan()
    plc.dc24 = False
    assert plc["SM6"] == 1
    plc.scan(3)
    plc.dc24 = True
    seen = []
    for _ in range(3):
        seen.append(plc["SM6"])
        plc.scan()
    assert seen == [1, 1, 0]  # 30, 40 and 50 ms after the failure
    plc.dc24 = False
    plc.scan(6)
    assert (plc["SM6"], plc.dc24, plc.running) == (1, False, True)


# -- the battery (2.1.7, 2.1.10, SM4, SD4) --------------------------------------------------------------------------


@pytest.mark.parametrize(("state", "low", "voltage"), [("present", 0, 30), ("failing", 1, 22), ("absent", 1, 0)])
def test_the_battery_shows_in_sm4_sd4_and_its_lamp(state, low, voltage):
    plc = plc_with()
    plc.battery = state
    plc.scan()
    assert (plc.battery, plc["SM4"], plc["SD4"]) == (state, low, voltage)
    assert plc.lamps["BAT"] == ("on" if low else "off")
    plc.stop()
    plc.run()
    assert plc["SM4"] == low
    plc.battery = "present"
    assert (plc["SM4"], plc.lamps["BAT"]) == (0, "off")


def retaining(**system):
    """An EC20 with retained values, a forced output and its clock set."""
    plc = plc_with(retain={"D": [(0, 9)], "M": [(5, 5)]}, **system)
    plc.scan(3)
    plc.set({"D5": 5, "M5": 1})
    plc.force("Y7", 1)
    plc.clock_time = datetime(2024, 5, 14, 10, 20, 30)
    return plc


def test_a_power_failure_without_battery_loses_everything():
    plc = retaining()
    plc.battery = "absent"
    plc.scan(2)
    assert (plc["D5"], plc.errors) == (5, [])  # as long as there is power nothing is lost
    plc.power_cycle()
    assert (plc["D5"], plc["M5"], plc["Y7"], plc.forced) == (0, 0, 0, {})
    assert codes(plc) == [43, 44, 45]
    assert (plc["SM3"], plc["SD3"], plc.running, plc.lamps["ERR"]) == (1, 43, True, "flashing")
    assert plc.clock_time == datetime(2000, 1, 1)


@pytest.mark.parametrize("state", ["present", "failing"])
def test_with_a_battery_nothing_is_lost(state):
    plc = retaining()
    plc.battery = state
    plc.power_cycle()
    assert (plc["D5"], plc["M5"], plc["Y7"], plc.errors) == (5, 1, 1, [])
    assert plc.clock_time == datetime(2024, 5, 14, 10, 20, 30)


def test_a_battery_changed_without_power_loses_everything_and_with_power_nothing():
    plc = retaining()
    plc.battery = "absent"
    plc.battery = "present"
    plc.power_cycle()
    assert plc["D5"] == 5
    plc.power_off()
    plc.battery = "absent"
    plc.battery = "present"
    plc.power_on()
    assert (plc["D5"], codes(plc)) == (0, [43, 44, 45])


def test_no_battery_mode_loses_the_same_and_reports_nothing():
    plc = retaining(no_battery=True)
    plc.battery = "absent"
    assert plc["SM7"] == 1
    plc.power_cycle()
    assert (plc["D5"], plc.forced, plc.errors, plc["SM3"], plc.lamps["ERR"]) == (0, {}, [], 0, "off")


def test_a_short_failure_needs_no_battery():
    plc = retaining()
    plc.battery = "absent"
    plc.power_cycle(off_ms=8)
    assert (plc["D5"], plc.errors) == (5, [])


def test_ec10_has_no_battery_and_keeps_in_its_eeprom():
    plc = plc_with(model="EC10", retain={"D": [(0, 9)]})
    plc["D5"] = 5
    plc.power_cycle()
    assert (plc["D5"], plc.battery, plc.lamps["BAT"], plc.errors) == (5, "", "off", [])
    with pytest.raises(EcsimError, match="EC10 has no battery"):
        plc.battery = "absent"


def test_an_unknown_battery_is_refused():
    plc = plc_with()
    with pytest.raises(EcsimError, match="the battery is 'empty'; choose present or failing or absent"):
        plc.battery = "empty"
    assert plc.battery == "present"


def test_the_clock_of_ec10_bridges_a_hundred_hours():
    # Table 2-1: 100 hours without power
    for hours, kept in ((100, True), (101, False)):
        plc = plc_with(model="EC10")
        plc.clock_time = datetime(2024, 5, 14)
        plc.power_cycle(off_ms=hours * 3_600_000)
        assert (plc.clock_time.year == 2024) is kept


# -- errors and their parts (2.4.2, appendix 6) -----------------------------------------------------------------------

HARDWARE = {"SRAM": 10, "FLASH": 11, "port": 12, "clock chip": 13, "I2C": 14, "main unit I/O": 20}
PASSING = {"I/O module": 21, "special module": 22, "clock": 23, "EEPROM": 24, "analog channels": 25, "module configuration": 26}
FILES = {"program": 40, "system block": 41, "data block": 42}
LOST = {"retained data": 43, "force table": 44}


@pytest.mark.parametrize(("part", "code"), HARDWARE.items())
def test_damaged_hardware_stops_until_it_is_repaired_and_the_power_was_off(part, code):
    plc = plc_with(model="EC10")
    plc.scan()
    plc.damage(part)
    assert (plc.running, plc["SM3"], plc["SD3"], plc.lamps["ERR"], codes(plc)) == (False, 1, code, "on", [code])
    plc.power_cycle()
    assert (plc.running, plc["SD3"]) == (False, code)
    plc.repair(part)
    assert (plc["SM3"], plc["SD3"]) == (1, code)
    plc.power_cycle()
    assert (plc.running, plc["SM3"], plc["SD3"], plc.lamps["ERR"], plc.errors) == (True, 0, 0, "off", [])


@pytest.mark.parametrize("act", ["run", "load"])
def test_a_repaired_main_unit_is_found_whole_at_run_and_after_a_download_too(act):
    # Appendix 1: SM190 is cleared by STOP -> RUN without the error and by a download
    plc = plc_with(model="EC10")
    plc.damage("main unit I/O")
    assert plc["SM190"] == 1
    plc.run()
    assert (plc.running, plc["SM190"]) == (False, 1)
    plc.repair("main unit I/O")
    plc.load(COUNTING) if act == "load" else plc.run()
    assert (plc["SM190"], plc["SD3"]) == (0, 0)


@pytest.mark.parametrize(("part", "code"), PASSING.items())
def test_passing_errors_flash_and_go_by_themselves(part, code):
    plc = plc_with(model="EC10")
    plc.damage(part)
    plc.scan()
    assert (plc.running, plc["SM3"], plc["SD3"], plc.lamps["ERR"], codes(plc)) == (True, 1, code, "flashing", [code])
    plc.repair(part)
    assert (plc["SM3"], plc["SD3"], plc.lamps["ERR"], plc.errors) == (0, 0, "off", [])


@pytest.mark.parametrize(
    ("part", "relay"),
    [("main unit I/O", "SM190"), ("I/O module", "SM191"), ("special module", "SM192"), ("clock", "SM193"), ("clock chip", "SM193")],
)
@pytest.mark.parametrize("model", MODELS)
def test_errors_of_the_bus_and_of_the_clock_have_relays_on_both_models(model, part, relay):
    plc = plc_with(model=model)
    assert plc[relay] == 0
    plc.damage(part)
    assert plc[relay] == 1
    plc.repair(part)
    plc.power_cycle()
    assert plc[relay] == 0


@pytest.mark.parametrize(("part", "code"), FILES.items())
def test_a_damaged_file_is_found_at_run_and_stays_until_another_one_comes(part, code):
    plc = plc_with()
    plc.damage(part)
    plc.scan(2)
    assert (plc.running, plc["SM3"]) == (True, 0)  # nobody has looked yet
    plc.stop()
    plc.run()
    assert (plc.running, plc["SM3"], plc["SD3"], plc.lamps["ERR"]) == (False, 1, code, "on")
    plc.power_cycle()
    assert (plc.running, plc["SD3"]) == (False, code)
    with pytest.raises(EcsimError, match=f"the {part} cannot be repaired: download a"):
        plc.repair(part)
    if part == "program":
        plc.load(COUNTING)
    else:
        plc.load("\n".join(["PROGRAM MAIN", COUNTING, "END_PROGRAM"]))  # a program alone brings no system block
        assert plc["SD3"] == code
        plc.format()
    assert (plc["SM3"], plc["SD3"], plc.errors) == (0, 0, [])
    plc.run()
    assert plc.running


@pytest.mark.parametrize("part", FILES)
def test_a_damaged_file_is_found_at_power_up(part):
    plc = plc_with()
    plc.damage(part)
    plc.power_cycle()
    assert (plc.running, plc["SD3"]) == (False, FILES[part])
    plc.format()
    plc.run()
    assert (plc.running, plc["SM3"]) == (True, 0)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(("part", "code"), LOST.items())
@pytest.mark.parametrize("way", ["devices", "reset", "power_cycle", "format"])
def test_lost_data_flash_until_they_are_cleared_or_a_check_is_good(model, part, code, way):
    plc = plc_with(model=model, retain={"D": [(5, 5)]})
    plc["D5"] = 5
    plc.force("Y7", 1)
    plc.damage(part)
    plc.scan()
    assert plc.errors == []
    plc.power_cycle()
    assert (plc.running, plc["SD3"], plc.lamps["ERR"]) == (True, code, "flashing")
    assert (plc["D5"], plc.forced) == ((0, {"Y7": 1}) if part == "retained data" else (5, {}))
    if way in ("devices", "format"):
        plc.stop()
        plc.clear("devices") if way == "devices" else plc.format()
    else:
        getattr(plc, way)()
    assert (plc["SM3"], plc["SD3"], plc.errors) == (0, 0, [])


def test_a_force_writes_a_new_force_table():
    plc = plc_with()
    plc.damage("force table")
    plc.damage("retained data")
    plc.power_cycle()
    assert codes(plc) == [43, 44]
    plc.force("Y0", 1)
    assert codes(plc) == [43]


def test_lost_user_information_lights_no_lamp_and_goes_with_a_download():
    plc = plc_with()
    plc.damage("user information")
    plc.power_cycle()
    assert (plc.running, plc["SM3"], plc["SD3"], plc.lamps["ERR"]) == (True, 1, 45, "off")
    plc.reset()
    assert plc["SD3"] == 45
    plc.load(COUNTING)
    assert (plc["SM3"], plc["SD3"]) == (0, 0)


@pytest.mark.parametrize(("part", "code"), [("program translation", 60), ("instruction", 62), ("operand", 63)])
@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_a_program_that_cannot_be_executed_stops_with_an_execution_error(part, code, engine):
    plc = plc_with(run=False)
    plc.engine = engine
    plc.damage(part)
    for _ in range(2):
        plc.run()
        plc.scan()
        assert (plc.running, plc["SD20"], plc["SM20"], plc["SM3"], plc.lamps["ERR"]) == (False, code, 1, 0, "on")
        assert (plc["D0"], codes(plc)) == (0, [code])
    plc.load(COUNTING)
    plc.run()
    plc.scan()
    assert (plc.running, plc["D0"], plc.lamps["ERR"], plc.errors) == (True, 1, "off", [])


def test_an_instruction_damaged_in_run_is_met_in_the_next_scan():
    plc = plc_with()
    plc.scan(2)
    plc.damage("instruction")
    assert plc.running
    plc.scan()
    assert (plc.running, plc["D0"], plc["SD20"]) == (False, 2, 62)


def test_the_watchdog_lights_the_lamp_until_run():
    plc = plc_with("LD X0\nFOR 30000\nLD SM0\nADD D0 1 D0\nNEXT", watchdog_ms=5)
    plc["X0"] = 1
    plc.scan()
    assert (plc.lamps, codes(plc)) == ({"RUN": "off", "ERR": "on", "BAT": "off"}, [61])
    plc["X0"] = 0
    plc.run()
    assert plc.lamps == {"RUN": "on", "ERR": "off", "BAT": "off"}


def test_execution_errors_that_let_the_program_run_light_no_lamp():
    plc = plc_with("LD SM0\nDIV D0 D1 D2")
    plc.scan()
    assert (codes(plc), plc.lamps["ERR"], plc["SM3"], plc.system_error) == ([69], "off", 0, 0)


def test_sd3_shows_the_gravest_error_and_then_the_next_one():
    plc = plc_with(model="EC10")
    plc.damage("user information")
    plc.damage("retained data")
    plc.power_cycle()
    plc.damage("clock")
    plc.damage("SRAM")
    assert (codes(plc), plc["SD3"]) == ([10, 23, 43, 45], 10)
    plc.repair("SRAM")
    plc.power_cycle()
    assert codes(plc) == [23, 45]  # the retained data were found whole
    plc.repair("clock")
    assert codes(plc) == [45]


@pytest.mark.parametrize("model", MODELS)
def test_every_part_of_a_model_can_be_damaged_and_reports_its_code(model):
    for part, code in plc_with(model=model).health.parts.items():
        plc = plc_with(model=model)
        plc.damage(part)
        plc.power_cycle()
        plc.scan()
        assert code in codes(plc), part
        error = next(error for error in plc.errors if error.code == code)
        assert error.meaning
        assert error.remedy
        assert str(error) == f"{code}: {error.meaning} (manual appendix 6)"


def test_an_unknown_part_is_refused_with_the_known_ones():
    plc = plc_with()
    with pytest.raises(EcsimError, match="EC20 has no part 'EEPROM' to be damaged; it has clock chip, main unit I/O"):
        plc.damage("EEPROM")
    with pytest.raises(EcsimError, match="EC20 has no part 'fuse'"):
        plc.repair("fuse")
    assert plc.errors == []


def test_a_broken_eeprom_takes_nothing_in():
    text = "LD X0\nEROMWR D6000 2"
    for broken, kept in ((False, [3, 4]), (True, [0, 0])):
        plc = plc_with(text, "EC10")
        plc.set({"D6000": 3, "D6001": 4})
        if broken:
            plc.damage("EEPROM")
        plc["X0"] = 1
        plc.scan(3)
        plc.power_cycle()
        assert [plc["D6000"], plc["D6001"]] == kept


# -- modules (errors 21, 22, 26) --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("model", "base"), [("EC10", (24, 16)), ("EC20", (24, 16))])
@pytest.mark.parametrize(("module", "code", "relay"), [((8, 8), 21, "SM191"), ("4AD", 22, "SM192")])
def test_a_module_that_is_taken_off_flashes_until_it_is_back(model, base, module, code, relay):
    plc = Plc(model, io=[base, module])
    plc.run()
    taken = plc.modules.digital[0] if code == 21 else plc.modules[0]
    taken.remove()
    plc.scan()
    assert (plc.running, plc["SD3"], plc[relay], plc.lamps["ERR"]) == (True, code, 1, "flashing")
    taken.insert()
    assert (plc["SM3"], plc["SD3"], plc[relay], plc.errors) == (0, 0, 0, [])


def test_a_module_that_is_gone_at_power_up_is_no_error_any_longer():
    plc = Plc("EC20", io=[(24, 16), "4AD"])
    plc.modules[0].remove()
    assert codes(plc) == [22]
    plc.power_cycle()
    assert (plc.errors, len(plc.modules)) == ([], 0)


def test_another_module_than_the_system_block_has_is_an_error_of_ec10():
    plc = Plc("EC10", io=[(24, 16), "4DA"], system=SystemBlock(modules={0: {"kind": "4AD"}}))
    plc.run()
    assert (plc.running, plc["SD3"], plc.lamps["ERR"]) == (True, 26, "flashing")
    plc.modules[0] = "4AD"
    assert (plc["SD3"], plc.errors) == (0, [])


# -- the table --------------------------------------------------------------------------------------------------------


# Appendix 6, third column: what stops the program and lights the lamp, what lets it flash; all others do neither.
STOPPING = {10, 11, 12, 13, 14, 20, 40, 41, 42, 60, 61, 62, 63}
FLASHING = {21, 22, 23, 24, 25, 26, 43, 44}


def test_the_table_agrees_with_the_manual(root):
    rows = json.loads((root / "tests/facts/system.json").read_text(encoding="utf-8"))["errors"]
    printed = {row["code"]: row for row in rows if row["code"]}
    assert ERRORS.keys() == printed.keys()
    for code, row in printed.items():
        error = ERRORS[code]
        assert (error.kind, list(error.models)) == (row["class"], row["models"]), code
        assert error.stops is (code in STOPPING), code
        assert error.lamp == ("on" if code in STOPPING else "flashing" if code in FLASHING else "off"), code


# -- the way back ---------------------------------------------------------------------------------------------------


def test_a_snapshot_brings_switch_power_battery_and_damage_back():
    plc = plc_with()
    plc.scan(2)
    kept = plc.snapshot()
    plc.battery = "absent"
    plc.power_cycle()
    plc.damage("program")
    plc.damage("instruction")
    plc.switch = "OFF"
    plc.power_off()
    plc.restore(kept)
    assert (plc.switch, plc.powered, plc.battery, plc.running, plc.errors) == ("ON", True, "present", True, [])
    plc.scan()
    assert (plc.running, plc["D0"], plc["SM4"]) == (True, 3, 0)
    plc.stop()
    plc.run()
    assert plc.running


def test_a_step_back_repeats_what_was_done_to_switch_and_power():
    plc = plc_with("LD SM0\nINC D0\nLD SM2\nINC D1", retain={"D": [(0, 1)]}, power_loss_ms=30)
    session = Session(plc, name="states", speed=None)
    session.scan(4)
    session.post(lambda plc: plc.power_cycle(off_ms=20))
    session.scan(3)
    session.post(lambda plc: setattr(plc, "switch", "OFF"))
    session.scan(2)
    session.post(lambda plc: setattr(plc, "switch", "ON"))
    session.scan(5)
    seen = (plc["D0"], plc["D1"], plc.time_us, plc.scans)
    assert seen == (4 + 3 + 3 + 5, 1, 170_000, 14)
    session.scan(3)
    assert session.back(3)
    assert (plc["D0"], plc["D1"], plc.time_us, plc.scans) == seen
    assert session.back(7)
    assert (plc.running, plc["D0"], plc.scans) == (False, 10, 7)  # what was done before the next scan is done again


def test_a_session_begins_anew_with_the_switch_that_it_found():
    plc = plc_with()
    session = Session(plc, name="states", speed=None)
    session.post(lambda plc: setattr(plc, "battery", "absent"))
    session.post(lambda plc: setattr(plc, "switch", "OFF"))
    session.scan(2)
    session.reset()
    assert (plc.switch, plc.battery, plc.running, plc.errors) == ("ON", "present", True, [])


def test_the_page_of_errors_names_every_part(root):
    page = (root / "docs/errors.md").read_text(encoding="utf-8")
    for error in ERRORS.values():
        if error.part:
            assert f'| {error.code} | `"{error.part}"` | {error.meaning} |' in page
