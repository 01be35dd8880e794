"""Timers and counters in use, from a running program."""

from ecsim_widgets.rig import Rig
from ecsim_widgets.timers import Timers

from ecsim.plc import Plc
from ecsim.session import Session


def test_a_row_for_each_timer_and_counter_with_name_kind_base_and_steps(rig):
    layout = Timers(rig).layout()
    timer, counter = layout["rows"]
    assert (timer["device"], timer["name"], timer["kind"], timer["base"]) == ("T0", "Settle", "TON", "100 ms")
    assert (counter["device"], counter["kind"], counter["base"]) == ("C0", "CTU", "")
    assert len(timer["steps"].split(", ")) == 2  # where it is driven and where it is read
    assert (layout["timers"], layout["counters"]) == (256, 256)


def test_a_running_timer_shows_value_preset_contact_and_words(rig):
    timers = Timers(rig)
    rig.plc["X0"] = 1
    rig.session.scan(2)  # S20 is active
    rig.plc["X0"] = 0
    rig.session.scan(30)
    frame = timers.frame()
    assert frame["T0"] in (2, 3)
    assert (frame["T0.preset"], frame["T0.on"], frame["T0.is"]) == (5, 0, "run")
    assert frame["T0.say"].endswith("to go*")
    assert frame["C0"] == 1


def test_the_active_step_has_its_elapsed_and_its_usual_time(rig):
    timers = Timers(rig)
    rig.session.scan(3)
    assert [step[0] for step in timers.frame()["steps"]] == ["S0"]
    rig.plc["X0"] = 1
    rig.session.scan(3)
    device, name, elapsed_us, usual_us, scans, _ = timers.frame()["steps"][0]
    assert (device, name, usual_us) == ("S20", "hold it", 0)
    assert (elapsed_us, scans) == (elapsed_us // 10_000 * 10_000, elapsed_us // 10_000)
    rig.plc["X0"] = 0
    rig.session.scan(60)  # 500 ms in S20, then S0
    usual_us, times = rig.times.usual["S20"]
    assert times == 1
    assert abs(usual_us - 510_000) <= 20_000


def test_a_preset_in_a_register_is_the_registers_value(make_rig):
    rig = make_rig(program="LD X0\nTON T200 D5\n")
    rig.plc["D5"] = 123
    assert Timers(rig).frame()["T200.preset"] == 123


def test_a_program_without_timers_has_no_rows(make_rig):
    assert Timers(make_rig(program="LD X0\nOUT Y0")).layout()["rows"] == []


def test_a_high_speed_counter_has_its_inputs_its_preset_of_32_bits_and_a_frequency(make_rig):
    rig = make_rig(program="LD SM0\nHCNT C236 D10\n")
    timers = Timers(rig)
    (row,) = timers.layout()["rows"]
    assert (row["device"], row["kind"], row["base"], row["base_us"]) == ("C236", "HCNT", "X0", 0)  # table 8-1
    rig.plc["D10:DINT"] = 1_000_000
    rig.session.scan(2)
    rig.plc.square("X0", hz=4000)
    for _ in range(50):
        rig.session.scan()
        frame = timers.frame()
    assert frame["C236.preset"] == 1_000_000
    assert abs(frame["C236"] - 2000) <= 4  # 4,000 a second for half a second
    assert frame["C236.say"].endswith("to go, 4.0 kHz")


def test_an_up_down_counter_says_which_relay_makes_it_count_down(make_rig):
    rig = make_rig(program="LD X0\nDCNT C200 400\nLD X1\nOUT SM200\n")
    timers = Timers(rig)
    assert timers.layout()["rows"][0]["base"] == ""
    for level in (1, 0):
        rig.plc["X0"] = level
        rig.session.scan()
    assert (timers.frame()["C200"], timers.frame()["C200.say"]) == (1, "399 to go")
    rig.plc["X1"] = 1
    rig.session.scan(2)
    for level in (1, 0, 1, 0):
        rig.plc["X0"] = level
        rig.session.scan()
    assert (timers.frame()["C200"], timers.frame()["C200.say"]) == (-1, "*SM200 on*, counts down")


def test_a_ring_counter_says_so(make_rig):
    assert Timers(make_rig(program="LD X0\nCTR C1 4\n")).layout()["rows"][0]["base"] == "ring"


def test_coils_of_the_fx_family_are_told_by_the_class_of_their_number():
    plc = Plc("H2U", scan_ms=10, input_filter_ms=0)
    plc.load("LD X0\nOUT T250 K20\nLD X1\nOUT C200 K-3\nLD X2\nOUT C0 K5")
    plc.run()
    rig = Rig(plc, Session(plc))
    rows = Timers(rig).layout()["rows"]
    assert [(row["device"], row["kind"], row["unit"], row["signed"]) for row in rows] == [
        ("T250", "OUT", "timer", False),
        ("C0", "OUT", "counter", False),
        ("C200", "OUT", "counter", True),
    ]
    rig.plc.set({"X0": 1, "X1": 1, "X2": 1, "M8200": 1})
    rig.session.scan(51)  # the first one starts the timer
    frame = Timers(rig).frame()
    assert (frame["T250"], frame["T250.preset"], frame["C0"], frame["C200"], frame["C200.preset"]) == (5, 20, 1, -1, -3)
    assert frame["C200.say"].startswith("*M8200 on*")
