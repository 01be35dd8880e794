"""The PID loop against its formulas in fractions and in a loop with a plant; the waveforms against straight lines."""

import math
from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ecsim

OPERAND_ERROR = 64
PID = "LD X0\nPID D0 D1 D10 D2"
ORDINARY = {"D10": 100, "D11": 1, "D12": 0, "D13": 100, "D14": 0, "D15": 0, "D16": 0}
WHOLE = st.integers(-32768, 32767)


def away_from_zero(number):
    """The nearest whole number, halves away from zero."""
    return int(math.copysign(math.floor(abs(number) + Fraction(1, 2)), number))


class Model:
    """A PID loop as 6.11.1 prints it, in exact fractions; the first sample starts the filter and stands for those before it."""

    def __init__(self, ts, reverse, alpha, kp, ti, kd, td):
        self.ts, self.sign, self.alpha, self.kp = ts, -1 if reverse else 1, Fraction(alpha, 100), Fraction(kp, 100)
        self.ti, self.kd, self.td = ti * 100, Fraction(kd, 100), td * 10
        self.pv = None
        self.ev = self.d = 0

    def sample(self, sv, pv, mv):
        if self.pv is None:
            self.pv = self.pv_before = Fraction(pv)
        filtered = pv + self.alpha * (self.pv - pv)
        ev = self.sign * (self.pv - sv)
        below = self.ts + self.kd * self.td
        d = Fraction(self.td) / below * self.sign * (filtered + self.pv_before - 2 * self.pv) + self.kd * self.td / below * self.d
        change = self.kp * (ev - self.ev + (Fraction(self.ts, self.ti) * ev if self.ti else 0) + d)
        self.pv, self.pv_before, self.ev, self.d = filtered, self.pv, ev, d
        return max(-32768, min(mv + change, 32767))


def start(plc, **values):
    """A fresh loop under ordinary settings."""
    plc.stop()
    plc.run()
    plc.set({"X0": 1} | ORDINARY | values)
    return plc


@settings(max_examples=50)
@given(
    measured=st.lists(st.integers(-2000, 2000), min_size=1, max_size=12),
    setpoint=st.integers(-2000, 2000),
    reverse=st.booleans(),
    alpha=st.integers(0, 99),
    kp=st.integers(1, 400),
    ti=st.integers(0, 50),
    kd=st.integers(0, 100),
    td=st.integers(0, 50),
)
def test_the_output_follows_the_formulas(running, measured, setpoint, reverse, alpha, kp, ti, kd, td):
    plc = start(running(PID), D0=setpoint, D10=10, D11=int(reverse), D12=alpha, D13=kp, D14=ti, D15=kd, D16=td)
    model, output = Model(10, reverse, alpha, kp, ti, kd, td), Fraction(0)
    for value in measured:
        plc["D1"] = value
        plc.scan()
        output = model.sample(setpoint, value, output)
        near_a_half = abs(output - away_from_zero(output)) > Fraction(4999, 10000)
        assert plc["D2"] == away_from_zero(output) or (near_a_half and abs(plc["D2"] - output) < Fraction(5001, 10000))


@pytest.mark.parametrize("reverse", [0, 1])
def test_a_loop_brings_its_plant_to_the_set_point(running, reverse):
    """An oven that goes to the output's temperature in a second, or a cold store that the output cools down from 1500."""
    plc = start(running(PID), D0=600, D11=0b100000 | reverse, D13=80, D14=12, D27=1000, D28=0)
    temperature = 0.0 if reverse else 1500.0
    for _ in range(3000):
        plc["D1"] = round(temperature)
        plc.scan()
        aim = plc["D2"] if reverse else 1500 - plc["D2"]
        temperature += (aim - temperature) * 0.01
    assert abs(temperature - 600) < 2
    assert plc["D2"] == pytest.approx(600 if reverse else 900, abs=3)


def test_a_filtered_disturbance_moves_the_output_less(running):
    changes = []
    for alpha in (0, 50, 90):
        plc = start(running(PID), D0=500, D1=500, D10=10, D12=alpha)
        plc.scan(2)
        plc["D1"] = 300
        plc.scan(2)
        changes.append(plc["D2"])
    assert changes == [200, 100, 20]


def test_clearing_the_internal_registers_begins_the_loop_anew(running):
    plc = start(running(PID), D0=1000, D1=600)
    plc.scan()
    assert (plc["D2"], plc["D17"]) == (400, 1)
    plc.scan(5)
    assert (plc["D2"], plc["D17"]) == (400, 1)
    plc.set({"D2": 0, "D17": 0})
    plc.scan()
    assert (plc["D2"], plc["D17"]) == (400, 1)


def test_a_value_given_by_hand_is_where_the_loop_goes_on(running):
    plc = start(running(PID), D0=1000, D1=900, D10=10, D14=1)
    plc.scan()
    assert plc["D2"] == 110
    plc["D2"] = 500
    plc.scan()
    assert plc["D2"] == 510


def test_samples_keep_their_distance_whatever_the_scan(running):
    plc = start(running(PID), D0=100, D1=0, D10=25, D14=10)
    taken = []
    for scan in range(20):
        before = plc["D17"]
        plc.scan()
        if plc["D17"] != before:
            taken.append(10 * scan)
    assert taken == [0, 30, 50, 80, 100, 130, 150, 180]


def test_one_instruction_with_an_index_serves_many_loops(running):
    text = "LD SM0\nMOV 0 Z0\nFOR 3\nLD SM0\nPID D0Z0 D1Z0 D10Z0 D2Z0\nADD Z0 100 Z0\nNEXT"
    plc = running(text)
    plc.stop()
    plc.run()
    for loop in range(3):
        plc.set({f"D{100 * loop + int(name[1:])}": value for name, value in ORDINARY.items()})
        plc.set({f"D{100 * loop}": 1000, f"D{100 * loop + 1}": 900, f"D{100 * loop + 10}": 10 * (loop + 1), f"D{100 * loop + 14}": 1})
    plc.scan(7)
    assert [plc["D2"], plc["D102"], plc["D202"]] == [100 + 7 * 10, 100 + 4 * 20, 100 + 3 * 30]


def test_alarms_stay_until_the_next_sample_and_are_cleared_by_a_quiet_one(running):
    plc = start(running(PID), D0=500, D1=500, D10=10, D11=0b111, D25=50, D26=40, D27=150, D28=50)
    seen = []
    for value in (500, 560, 560, 520, 480, 480, 480):
        plc["D1"] = value
        plc.scan()
        seen.append((plc["D2"], plc["D29"]))
    assert seen == [(0, 0), (0, 0b1), (-60, 0b1000), (-60, 0), (-20, 0), (20, 0), (20, 0)]


def test_without_alarms_their_register_is_not_written(running):
    plc = start(running(PID), D29=77)
    plc.scan(30)
    assert plc["D29"] == 77


@pytest.mark.parametrize(
    "wrong",
    [{"D10": 0}, {"D12": 100}, {"D13": 0}, {"D14": -1}, {"D15": 101}, {"D16": -1}, {"D11": 33, "D27": -1}, {"D11": 2, "D26": -1}],
    ids=str,
)
def test_a_setting_outside_its_range_is_an_operand_error_until_it_is_repaired(running, wrong):
    plc = start(running(PID), D0=1000, D1=600, D2=5, **wrong)
    plc.scan(3)
    assert (plc["D2"], plc["D17"], plc["SM20"], plc["SD20"]) == (5, 0, 1, OPERAND_ERROR)
    plc.set(ORDINARY)
    plc.scan()
    assert (plc["D2"], plc["SM20"]) == (405, 0)


@pytest.mark.parametrize("program", [PID, "LD X0\nTRIANGLE 0 1000 D2 7 M0"])
def test_both_engines_and_a_snapshot_go_on_with_the_same_state(program):
    def run(switches, restores):
        plc = ecsim.Plc("EC20", input_filter_ms=0)
        plc.load(program)
        plc.run()
        plc.set({"X0": 1} | ORDINARY | {"D0": 500, "D10": 20, "D12": 30, "D14": 7, "D15": 40, "D16": 9})
        outputs = []
        for scan in range(40):
            if scan in switches:
                plc.tracing = not plc.tracing
            if scan in restores:
                snapshot = plc.snapshot()
                plc["D1"] = 4000
                plc.scan(9)
                plc.restore(snapshot)
            plc["D1"] = scan * scan % 97
            plc.scan()
            outputs.append(plc["D2"])
        return outputs

    plain = run((), ())
    assert len(set(plain)) > 5
    assert run((5, 18, 19), ()) == plain
    assert run((11,), (7, 20, 33)) == plain


# -- waveforms ----------------------------------------------------------------------------------------------------


def line(first, last, steps):
    """The points of a straight line, both ends included, halves rounded up."""
    return [math.floor(first + Fraction((last - first) * place, steps) + Fraction(1, 2)) for place in range(steps + 1)]


def seen(plc, scans, **values):
    """D10 and M0 after each scan from a new flow on."""
    plc.set({"X0": 0, **values})
    plc.scan()
    plc["X0"] = 1
    points = []
    for _ in range(scans):
        plc.scan()
        points.append((plc["D10"], plc["M0"]))
    return points


@given(first=WHOLE, last=WHOLE, steps=st.integers(1, 12))
def test_a_ramp_is_a_straight_line_that_ends(running, first, last, steps):
    points = seen(running("LD X0\nRAMP D0 D1 D10 D2 M0"), steps + 4, D0=first, D1=last, D2=steps)
    assert [value for value, _ in points] == [*line(first, last, steps), last, last, last]
    assert [ready for _, ready in points] == [first == last] * steps + [1] * 4


@given(first=WHOLE, last=WHOLE, steps=st.integers(1, 12))
def test_teeth_follow_each_other_without_a_pause(running, first, last, steps):
    points = seen(running("LD X0\nHACKLE D0 D1 D10 D2 M0"), 3 * (steps + 1), D0=first, D1=last, D2=steps)
    assert [value for value, _ in points] == 3 * line(first, last, steps)
    assert [ready for _, ready in points] == 3 * ([first == last] * steps + [1])


@given(first=WHOLE, last=WHOLE, steps=st.integers(1, 12))
def test_a_triangle_goes_there_and_back(running, first, last, steps):
    points = seen(running("LD X0\nTRIANGLE D0 D1 D10 D2 M0"), 4 * steps + 1, D0=first, D1=last, D2=steps)
    way = line(first, last, steps)
    assert [value for value, _ in points] == [first, *2 * (way[1:] + way[-2::-1])]
    assert [ready for _, ready in points] == [first == last, *2 * ([first == last] * (2 * steps - 1) + [1])]


@given(first=WHOLE, last=WHOLE, steps=st.integers(1, 30))
def test_the_steps_of_a_ramp_differ_by_one_at_most(running, first, last, steps):
    values = [value for value, _ in seen(running("LD X0\nRAMP D0 D1 D10 D2 M0"), steps + 1, D0=first, D1=last, D2=steps)]
    strides = {after - before for before, after in pairwise(values)}
    assert max(strides) - min(strides) <= 1


@pytest.mark.parametrize("name", ["RAMP", "HACKLE", "TRIANGLE"])
def test_without_flow_the_output_is_free_and_the_state_cleared_once(running, name):
    plc = running(f"LD X0\n{name} 0 100 D10 2 M0")
    assert seen(plc, 3)[1:] == [(50, 0), (100, int(name != "TRIANGLE"))]
    plc["X0"] = 0
    plc.scan()
    assert (plc["D10"], plc["M0"]) == (100, 0)
    plc.set({"D10": 7, "M0": 1})
    plc.scan(3)
    assert (plc["D10"], plc["M0"]) == (7, 1)


@pytest.mark.parametrize("name", ["RAMP", "HACKLE", "TRIANGLE"])
def test_no_steps_are_an_operand_error_only_while_there_is_flow(running, name):
    plc = running(f"LD X0\n{name} 0 100 D10 D2 M0")
    seen(plc, 2, D2=2)
    plc.set({"D2": 0, "M0": 1})
    plc.scan()
    assert (plc["D10"], plc["M0"], plc["SM20"], plc["SD20"]) == (50, 1, 1, OPERAND_ERROR)
    plc["X0"] = 0
    plc.scan()
    assert (plc["D10"], plc["M0"], plc["SM20"]) == (50, 0, 0)


def test_an_index_that_leads_away_when_the_flow_goes_is_reported_once(running):
    plc = running("LD X0\nRAMP 0 100 D10Z0 5 M0\nLD SM20\nINC D90")
    plc["Z0"] = 0
    seen(plc, 3)
    plc.set({"X0": 0, "Z0": -50})
    plc.scan(4)
    assert (plc["D90"], plc["SD20"]) == (1, 65)


def test_the_hundred_and_first_waveform_is_named():
    lines = [f"RAMP 0 9 D{number} 5 M{number}" for number in range(99)] + ["HACKLE 0 9 D200 5 M200", "TRIANGLE 0 9 D201 5 M201"]
    with pytest.raises(ecsim.ProgramError, match=r"line 102, column 1: .*TRIANGLE.* stand 101 times; at most 100 times together"):
        ecsim.compile("LD X0\n" + "\n".join(lines), "EC20")
