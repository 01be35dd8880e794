"""H1U and H2U as machines: special relays and registers of RUN, STOP, errors and time, retention, damage."""

from datetime import datetime

import pytest

import ecsim
from ecsim import EcsimError, Session, SystemBlock

both_models = pytest.mark.parametrize("model", ["H1U", "H2U"])
both_engines = pytest.mark.parametrize("engine", ["compiled", "stepping"])
FAULTY = "LD X0\nMOV K9000 Z0\nMOV K1 D0Z0"


def machine(text="LD M8000\nOUT Y0", model="H2U", engine="compiled", **settings):
    """A PLC in RUN with a program, inputs without filter."""
    plc = ecsim.Plc(model, input_filter_ms=0, **settings)
    plc.engine = engine
    plc.load(text)
    plc.run()
    return plc


def values(plc, *names):
    return [plc[name] for name in names]


# -- RUN and STOP -----------------------------------------------------------------------------------------------------------


@both_models
@both_engines
def test_the_run_relays_and_their_opposites(model, engine):
    plc = machine("LD M8000\nINC D0\nLDI M8001\nINC D1\nLD M8002\nINC D2\nLDI M8003\nINC D3", model, engine)
    assert values(plc, "M8000", "M8001", "M8002", "M8003") == [1, 0, 1, 0]
    plc.scan(4)
    assert values(plc, "D0", "D1", "D2", "D3") == [4, 4, 1, 1]
    assert values(plc, "M8000", "M8001", "M8002", "M8003") == [1, 0, 0, 1]
    plc.stop()
    assert values(plc, "M8000", "M8001", "M8002", "M8003") == [0, 1, 0, 1]
    plc.run()
    assert values(plc, "M8000", "M8001", "M8002", "M8003") == [1, 0, 1, 0]


def test_a_new_machine_in_stop_shows_so():
    assert values(ecsim.Plc("H2U"), "M8000", "M8001", "M8002", "M8003", "D8000", "D8002") == [0, 1, 0, 1, 200, 24]


@both_models
def test_stop_clears_what_is_not_retained_and_run_begins_with_outputs_off(model):
    plc = machine("LD X0\nSET M5\nSET Y1\nSET S30\nMOV K7 D5\nOUT C5 K1\nOUT T5 K1\nLD M8002\nINC D0", model)
    plc["X0"] = 1
    plc.scan(30)
    assert values(plc, "M5", "Y1", "S30", "D5", "C5", "T5:BOOL", "D0") == [1, 1, 1, 7, 1, 1, 1]
    plc.stop()
    assert values(plc, "M5", "Y1", "S30", "D5", "C5", "T5", "T5:BOOL", "D0") == [0] * 8
    plc.set({"D5": 9, "M6": 1})
    plc.run()
    assert values(plc, "D5", "M6", "Y1") == [9, 1, 0]


def test_with_hold_memory_all_stays_at_stop_outputs_too():
    plc = machine("LD X0\nOUT M8033\nLD M8000\nOUT Y1\nMOV K7 D5\nOUT T0 K32000")
    plc["X0"] = 1
    plc.scan(101)
    assert plc["T0"] == 10
    plc.stop()
    assert values(plc, "Y1", "D5", "T0", "M8033") == [1, 7, 10, 1]
    plc.run()
    assert values(plc, "Y1", "D5") == [0, 7]
    plc["X0"] = 0
    plc.scan()
    plc.stop()
    assert values(plc, "Y1", "D5", "T0") == [0, 0, 0]


def test_stop_turns_off_what_programs_say_by_special_relays_and_leaves_registers():
    plc = machine("LD X0\nSET M8161\nSET M8050\nSET M8200\nLD M8000\nMOV K300 D8000\nSET M8020")
    plc["X0"] = 1
    plc.scan(2)
    assert values(plc, "M8161", "M8050", "M8200", "M8020", "D8000") == [1, 1, 1, 1, 300]
    plc.stop()
    assert values(plc, "M8161", "M8050", "M8200", "M8020", "D8000") == [0, 0, 0, 0, 300]
    plc.power_cycle()
    assert plc["D8000"] == 200


# -- retention --------------------------------------------------------------------------------------------------------------

RETAINED = {  # area -> the first and last retained numbers
    "H2U": {"M": [(500, 3071)], "S": [(500, 999)], "T": [(246, 255)], "C": [(100, 199), (220, 255)], "D": [(200, 7999)]},
    "H1U": {"M": [(384, 1535)], "S": [(128, 999)], "T": [(246, 255)], "C": [(16, 199), (220, 255)], "D": [(128, 7999)]},
}


@both_models
@pytest.mark.parametrize("off", ["stop", "power"])
def test_each_area_keeps_its_retained_devices(model, off):
    plc = machine(model=model)
    last = {"M": 3071 if model == "H2U" else 1535, "S": 999, "T": 255, "C": 255, "D": 7999}
    lists = plc.memory.lists
    for area, end in last.items():
        lists[area][: end + 1] = [True if area in "MS" else 3] * (end + 1)
    lists["V"][:], lists["Z"][:] = [3] * 8, [3] * 8
    if off == "stop":
        plc.stop()
    else:
        plc.switch = "OFF"
        plc.power_cycle()
    for area, end in last.items():
        kept = {number for first, final in RETAINED[model][area] for number in range(first, final + 1)}
        assert {number for number in range(end + 1) if lists[area][number]} == kept, area
    assert lists["V"] == lists["Z"] == [0] * 8


def test_h2u_may_be_told_other_ranges_where_they_are_changeable():
    plc = machine(system=SystemBlock(retain={"M": [(10, 19)], "D": []}))
    plc.set({"M9": 1, "M10": 1, "M19": 1, "M500": 1, "M1024": 1, "D200": 5, "D512": 5, "S500": 1, "C100": 3})
    plc.stop()
    assert values(plc, "M9", "M10", "M19", "M500", "M1024") == [0, 1, 1, 0, 1]
    assert values(plc, "D200", "D512", "S500", "C100") == [0, 5, 1, 3]


@pytest.mark.parametrize(
    ("model", "settings", "words"),
    [
        ("H1U", {"retain": {"M": [(0, 9)]}}, "retain has 1 ranges of M; H1U takes 0"),
        ("H2U", {"retain": {"M": [(3000, 3072)]}}, "write numbers from 0 to 3071"),
        ("H2U", {"retain": {"D": [(0, 8000)]}}, "write numbers from 0 to 7999"),
        ("H2U", {"retain": {"X": [(0, 1)]}}, "H2U cannot retain X"),
        ("H2U", {"hold_values": True}, "H2U has no such setting; M8033 does that"),
        ("H2U", {"constant_scan_ms": 20}, "set M8039 and write the time into D8039"),
        ("H2U", {"stop_outputs": "freeze"}, "or stay with M8033 ON"),
        ("H2U", {"interrupt_priority": {101: "high"}}, "all interrupts have the same"),
    ],
)
def test_settings_that_it_does_not_have_are_refused(model, settings, words):
    with pytest.raises(EcsimError, match=words.replace("(", r"\(")):
        ecsim.Plc(model, system=SystemBlock(**settings))


def test_a_lost_memory_keeps_nothing():
    plc = machine()
    plc["D512"] = 7
    plc.battery = "absent"
    plc.power_cycle()
    assert values(plc, "D512", "M8005") == [0, 1]
    assert plc.running


# -- errors -----------------------------------------------------------------------------------------------------------------


@both_models
@both_engines
def test_an_operation_error_stands_in_m8067_and_d8067_and_is_latched(model, engine):
    plc = machine("LD X1\nMOV K1 D1\n" + FAULTY, model, engine)
    plc.scan()
    assert values(plc, "M8067", "D8067", "M8004", "D8004", "M8068") == [0, 0, 0, 0, 0]
    plc["X0"] = 1
    plc.scan()
    assert values(plc, "M8067", "D8067", "M8004", "D8004", "M8068") == [1, 6706, 1, 8067, 1]
    assert [error.code for error in plc.errors] == [6706]
    plc.set({"X0": 0, "X1": 1})
    plc.scan()
    assert values(plc, "M8067", "D8067", "M8004", "D8004", "M8068") == [0, 6706, 0, 0, 1]
    plc.set({"X0": 1, "X1": 0})
    plc.scan()
    plc.stop()
    assert values(plc, "M8067", "D8067", "M8068") == [1, 6706, 1]
    plc.run()
    assert values(plc, "M8067", "D8067", "M8004", "D8004", "M8068") == [0, 0, 0, 0, 1]
    assert plc.errors == []
    plc.power_cycle()
    assert plc["M8068"] == 0


@both_models
def test_a_servo_that_does_not_answer_leaves_the_other_special_devices_alone(model):
    plc = machine("LD X0\nDABS X10 Y10 D0", model)
    plc["X0"] = 1
    plc.until("M8067", timeout_ms=10_000)
    assert values(plc, "D8067", "M8004", "D8004", "D8000", "M8000") == [6760, 1, 8067, 200, 1]
    assert [error.code for error in plc.errors] == [6760]


def test_a_program_may_reset_the_latch():
    plc = machine(FAULTY + "\nLD X1\nRST M8068")
    plc["X0"] = 1
    plc.scan()
    plc.set({"X0": 0, "X1": 1})
    plc.scan()
    assert values(plc, "M8067", "M8068") == [1, 0]


def test_a_scan_that_is_too_long_stops_with_6105():
    plc = machine("LD M8000\nMOV K1 D8000\nWDT\nFOR K3000\nLD M8000\nMOV K3 D0\nNEXT")
    plc.scan()
    assert not plc.running
    assert values(plc, "M8061", "D8061", "M8004", "D8004", "M8067") == [1, 6105, 1, 8061, 0]
    assert (plc.stopped_by, plc.lamps["ERR"]) == (6105, "on")
    assert [(error.code, error.remedy) for error in plc.errors] == [(6105, "shorten the program or raise D8000")]
    plc["D8000"] = 200
    plc.load("LD M8000\nOUT Y0")
    plc.run()
    plc.scan()
    assert values(plc, "M8061", "D8061", "M8004", "Y0") == [0, 0, 0, 1]


def test_a_damaged_program_keeps_it_in_stop():
    plc = machine()
    plc.stop()
    plc.damage("program")
    plc.run()
    assert not plc.running
    assert values(plc, "M8064", "D8064", "M8004", "D8004") == [1, 6401, 1, 8064]
    assert (plc.system_error, [error.code for error in plc.errors]) == (6401, [6401])
    plc.load("LD M8000\nOUT Y0")
    plc.run()
    assert plc.running
    assert values(plc, "M8064", "D8064", "M8004", "D8004") == [0, 0, 0, 0]


def test_m8030_puts_the_battery_lamp_out():
    plc = machine("LD X0\nOUT M8030")
    plc.battery = "failing"
    plc.scan()
    assert (plc["M8005"], plc.lamps["BAT"]) == (1, "on")
    plc["X0"] = 1
    plc.scan()
    assert (plc["M8005"], plc.lamps["BAT"]) == (1, "off")


# -- time -------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("relay", "period_ms"), [("M8011", 10), ("M8012", 100), ("M8013", 1000), ("M8014", 60_000)])
def test_the_clocks_are_on_for_the_second_half_of_their_period(relay, period_ms):
    plc = machine(f"LD {relay}\nINC D0", scan_ms=2.5 if period_ms == 10 else period_ms / 20)
    scans = 4 if period_ms == 10 else 20
    plc.scan(3 * scans)
    assert plc["D0"] == 3 * scans / 2


@both_models
def test_scan_times_are_noted_in_tenths_of_a_millisecond(model):
    plc = machine(model=model, scan_ms=12.5)
    plc.scan(2)
    plc.scan_ms = 12.5
    assert values(plc, "D8010", "D8011", "D8012") == [125, 125, 125]
    assert plc.information["scan_ms"] == 12.5


def test_with_m8039_a_scan_waits_for_the_time_in_d8039():
    plc = machine("LD X0\nOUT M8039\nLD M8000\nMOV K25 D8039\nINC D0")
    plc.advance(ms=100)
    assert values(plc, "D0", "D8010") == [10, 100]
    plc["X0"] = 1
    plc.advance(ms=100)
    assert values(plc, "D0", "D8010", "D8011", "D8012") == [14, 250, 100, 250]
    plc["X0"] = 0
    plc.advance(ms=100)
    assert plc["D0"] == 24


def test_the_constant_scan_holds_where_scans_are_modelled_too_and_not_in_stop():
    plc = machine("LD M8000\nOUT M8039\nMOV K30 D8039", scan_ms=None)
    plc.scan(2)
    before = plc.time_us
    plc.scan()
    assert plc.time_us - before == 30_000
    plc.stop()
    assert plc.period_us < 30_000


def test_the_watchdog_is_200_ms_and_counts_anew_from_wdt():
    long = "FOR K10000\nLD M8000\n" + "MOV K3 D0\n" * 20 + "NEXT"
    plc = machine(f"LD X0\nMOV K500 D8000\nWDT\n{long}")
    assert plc["D8000"] == 200
    plc["X0"] = 1
    plc.scan(3)
    assert plc.running
    assert plc["D8000"] == 500
    plc.stop()
    plc["D8000"] = 200
    plc["X0"] = 0
    plc.run()
    plc.scan()
    assert plc["D8061"] == 6105


def test_the_real_time_clock_stands_in_d8013_to_d8019():
    plc = machine()
    plc.clock_time = datetime(2024, 2, 29, 23, 59, 58)
    plc.advance(ms=1010)
    assert [plc[f"D{number}"] for number in range(8013, 8020)] == [59, 59, 23, 29, 2, 2024, 4]
    plc.advance(ms=1000)
    assert [plc[f"D{number}"] for number in range(8013, 8020)] == [0, 0, 0, 1, 3, 2024, 5]


# -- outputs ----------------------------------------------------------------------------------------------------------------


class Lamp:
    """Something on Y0 that remembers what it got."""

    wiring = {"Y0": ("lamp", "a lamp")}

    def __init__(self):
        self.seen = []

    def step(self, seconds, outputs):
        self.seen.append(outputs["Y0"])
        return {}


def test_m8034_switches_the_terminals_off_and_leaves_the_program_alone():
    plc = machine("LD X0\nOR Y0\nOUT Y0\nLD X1\nOUT M8034\nLD Y0\nINC D0")
    lamp = Lamp()
    session = Session(plc, lamp)
    plc["X0"] = 1
    session.scan()
    plc["X0"] = 0
    session.scan()
    plc["X1"] = 1
    session.scan(3)
    assert plc["Y0"] == 1
    assert plc["D0"] == 5
    assert not any(plc.driven)
    plc["X1"] = 0
    session.scan()
    assert lamp.seen[-6:] == [1, 1, 0, 0, 0, 1]
    session.stop()


# -- what is written by whom -------------------------------------------------------------------------------------------------

READ_ONLY = [
    "M8000", "M8001", "M8002", "M8003", "M8004", "M8005", "M8011", "M8012", "M8013", "M8014", "M8046", "M8048",
    "M8060", "M8061", "M8064", "M8067", "M8246", "M8255",
    "D8002", "D8004", "D8010", "D8011", "D8012", "D8013", "D8019", "D8040", "D8047", "D8049", "D8061", "D8067",
]  # fmt: skip
WRITABLE = [
    "M8020", "M8021", "M8022", "M8024", "M8029", "M8030", "M8033", "M8034", "M8039", "M8040", "M8047", "M8049",
    "M8050", "M8056", "M8059", "M8068", "M8160", "M8161", "M8168", "M8170", "M8175", "M8195", "M8199", "M8200", "M8245",
    "D8000", "D8020", "D8039",
]  # fmt: skip


def write(name):
    return f"LD X0\nMOV K1 {name}" if name[0] == "D" else f"LD X0\nOUT {name}"


@both_models
@pytest.mark.parametrize("name", READ_ONLY)
def test_what_the_system_shows_is_read_only(model, name):
    with pytest.raises(ecsim.ProgramError, match=f"{name} is read only"):
        ecsim.compile(write(name), model)
    with pytest.raises(EcsimError, match="the system writes it"):
        ecsim.Plc(model)[name] = 1


@both_models
@pytest.mark.parametrize("name", WRITABLE)
def test_what_programs_tell_the_machine_is_writable(model, name):
    assert ecsim.compile(write(name), model).steps > 0


# -- areas ------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("model", "name", "words"),
    [
        ("H2U", "M3072", r"H2U has no M3072 \(M0 to M3071 and M8000 to M8255\)"),
        ("H2U", "M7999", "H2U has no M7999"),
        ("H2U", "M8256", "H2U has no M8256"),
        ("H1U", "M1536", r"H1U has no M1536 \(M0 to M1535 and M8000 to M8255\)"),
        ("H2U", "X400", r"H2U has no X400 \(X0 to X377\)"),
        ("H2U", "S1000", r"H2U has no S1000 \(S0 to S999\)"),
        ("H2U", "T256", r"H2U has no T256 \(T0 to T255\)"),
    ],
)
def test_devices_that_it_does_not_have_are_refused(model, name, words):
    with pytest.raises(ecsim.ProgramError, match=words):
        ecsim.compile(f"LD {name}\nOUT Y0", model)
    with pytest.raises(EcsimError, match=words):
        ecsim.Plc(model)[name]


def test_a_group_of_bits_ends_where_the_relays_end():
    with pytest.raises(ecsim.ProgramError, match="'K4M3060' reaches beyond M3071"):
        ecsim.compile("LD X0\nMOV K4M3060 D0", "H2U")
    assert ecsim.compile("LD X0\nMOV K4M3056 D0\nMOV K4M8170 D0", "H2U")


@both_engines
def test_an_index_leads_no_further_than_the_relays(engine):
    plc = machine("LD M8000\nMOV K72 Z0\nLD X0\nMOV K1 K1M3000Z0", engine=engine)
    plc["X0"] = 1
    plc.scan()
    assert values(plc, "M8067", "D8067") == [1, 6706]
    plc["X0"] = 0
    plc.load("LD M8000\nMOV K68 Z0\nLD X0\nMOV K1 K1M3000Z0")
    plc.run()
    plc["X0"] = 1
    plc.scan()
    assert values(plc, "M8067", "M3068") == [0, 1]
