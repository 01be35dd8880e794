"""The clock and its instructions against Python's datetime."""

import operator
from datetime import date, datetime, timedelta

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import ecsim

MOMENTS = st.datetimes(datetime(2000, 1, 1), datetime(2099, 12, 30)).map(lambda moment: moment.replace(microsecond=0))
TIMES = st.tuples(st.integers(-1, 25), st.integers(-1, 61), st.integers(-1, 61))
NEAR_DATES = st.tuples(st.integers(2003, 2005), st.integers(0, 13), st.integers(0, 32))
SIGNS = {"<": operator.lt, "<=": operator.le, "<>": operator.ne, "=": operator.eq, ">": operator.gt, ">=": operator.ge}


def put(plc, first, values):
    plc.set({f"D{first + place}": value for place, value in enumerate(values)})


def block(plc, first, count):
    return [plc[f"D{first + place}"] for place in range(count)]


def registers(moment):
    """What the clock shows at a moment: Sunday is 0."""
    return [moment.year, moment.month, moment.day, moment.hour, moment.minute, moment.second, moment.isoweekday() % 7]


def legal(time):
    return 0 <= time[0] <= 23 and 0 <= time[1] <= 59 and 0 <= time[2] <= 59


# -- the clock ----------------------------------------------------------------------------------------------------


@pytest.fixture
def plc():
    plc = ecsim.Plc("EC20", scan_ms=10)
    plc.load("LD M0\nTWR D0\nLD SM0\nTRD D20")
    plc.run()
    return plc


def test_a_new_plc_begins_at_a_fixed_moment(plc):
    assert plc.clock_time == datetime(2000, 1, 1)
    plc.scan()
    assert block(plc, 20, 7) == [2000, 1, 1, 0, 0, 0, 6]


@given(moment=MOMENTS, later=st.integers(0, 100_000))
@example(moment=datetime(2004, 2, 28, 23, 59, 58), later=3)
@example(moment=datetime(2099, 12, 30, 23, 59, 59), later=1)
def test_the_clock_goes_with_simulated_time(moment, later):
    plc = ecsim.Plc("EC20", scan_ms=1000)
    plc.load("LD SM0\nTRD D20")
    plc.run()
    plc.clock_time = moment
    plc.clock[0] += later * 1_000_000
    plc.scan()
    assert block(plc, 20, 7) == registers(moment + timedelta(seconds=later))
    assert [plc[f"SD{100 + place}"] for place in range(7)] == block(plc, 20, 7)


def test_after_2099_comes_2000(plc):
    plc.clock_time = datetime(2099, 12, 31, 23, 59, 59)
    plc.advance(ms=1500)
    assert block(plc, 20, 6) == [2000, 1, 1, 0, 0, 0]


def test_setting_the_clock_begins_a_second(plc):
    plc.advance(ms=730)
    put(plc, 0, [2008, 5, 14, 10, 20, 30, 3])
    plc["M0"] = 1
    plc.scan()
    plc["M0"] = 0
    plc.advance(ms=980)
    assert plc["D25"] == 30
    plc.advance(ms=20)
    assert plc["D25"] == 31


def test_a_weekday_that_does_not_fit_is_kept_and_counted_on(plc):
    put(plc, 0, [2008, 5, 14, 23, 59, 59, 6])  # a Wednesday
    plc["M0"] = 1
    plc.scan()
    assert plc["D26"] == 6
    plc["M0"] = 0
    plc.advance(ms=1500)
    assert block(plc, 20, 7) == [2008, 5, 15, 0, 0, 0, 0]


@pytest.mark.parametrize(
    "wrong",
    [[1999, 1, 1, 0, 0, 0, 0], [2100, 1, 1, 0, 0, 0, 0], [2003, 2, 29, 0, 0, 0, 0], [2004, 1, 1, 24, 0, 0, 0], [2004, 1, 1, 0, 0, 0, 7]],
)
def test_an_illegal_moment_is_error_76_and_leaves_the_clock(plc, wrong):
    plc.clock_time = datetime(2020, 6, 7, 8, 9, 10)
    put(plc, 0, wrong)
    plc["M0"] = 1
    plc.scan()
    assert (plc["SM20"], plc["SD20"]) == (0, 76)  # TRD, executed correctly, has cleared SM20
    assert block(plc, 20, 7) == [2020, 6, 7, 8, 9, 10, 0]


def test_the_clock_runs_in_stop_and_through_a_power_cycle(plc):
    plc.clock_time = datetime(2020, 1, 1)
    plc.stop()
    plc.advance(ms=5000)
    assert plc["SD105"] in (4, 5)
    plc.power_cycle()
    plc.scan()
    assert block(plc, 20, 6) == [2020, 1, 1, 0, 0, 5]


def test_a_snapshot_holds_the_clock(plc):
    plc.clock_time = datetime(2020, 1, 1, 12)
    plc.scan()
    before = plc.snapshot()
    plc.advance(ms=3000)
    plc.clock_time = datetime(2030, 1, 1)
    plc.restore(before)
    plc.advance(ms=2000)
    assert plc["SD100"] == 2020
    assert plc["SD105"] in (1, 2)


@pytest.mark.parametrize("wrong", [datetime(1999, 12, 31), datetime(2100, 1, 1), "12:00", date(2020, 1, 1)])
def test_what_the_clock_cannot_show_is_refused(plc, wrong):
    with pytest.raises(ecsim.EcsimError, match="the clock"):
        plc.clock_time = wrong


# -- sums, the running-time meter, comparisons ----------------------------------------------------------------------


@pytest.mark.parametrize(("name", "sign", "relay"), [("TADD", 1, "SM181"), ("TSUB", -1, "SM182")])
@given(first=TIMES, second=TIMES)
@example(first=(23, 59, 59), second=(0, 0, 1))
@example(first=(1, 2, 3), second=(1, 2, 3))
def test_times_of_day_go_round_a_day(running, name, sign, relay, first, second):
    plc = running(f"LD SM0\n{name} D10 D20 D30")
    put(plc, 10, first)
    put(plc, 20, second)
    put(plc, 30, [-7, -8, -9])
    plc.scan()
    if not (legal(first) and legal(second)):
        assert (plc["SM20"], plc["SD20"], block(plc, 30, 3)) == (1, 64, [-7, -8, -9])
        return
    one, other = (timedelta(hours=h, minutes=m, seconds=s) for h, m, s in (first, second))
    exact = one + sign * other
    moment = datetime(2000, 1, 1) + exact % timedelta(days=1)
    assert block(plc, 30, 3) == [moment.hour, moment.minute, moment.second]
    assert plc[relay] == (not timedelta(0) <= exact < timedelta(days=1))
    assert plc["SM180"] == (exact % timedelta(days=1) == timedelta(0))


@pytest.mark.parametrize("sign", SIGNS)
@given(first=TIMES, second=TIMES, before=st.booleans())
def test_times_are_compared_in_order(running, sign, first, second, before):
    plc = running(f"LD SM0\nTCMP{sign} D10 D20 M0")
    put(plc, 10, first)
    put(plc, 20, second)
    plc["M0"] = before
    plc.scan()
    fits = legal(first) and legal(second)
    assert plc["M0"] == (SIGNS[sign](first, second) if fits else before)
    assert plc["SM20"] == (not fits)


def as_date(numbers):
    try:
        return date(*numbers)
    except ValueError:
        return None


@pytest.mark.parametrize("sign", SIGNS)
@given(first=NEAR_DATES, second=NEAR_DATES, before=st.booleans())
def test_dates_are_compared_in_order(running, sign, first, second, before):
    plc = running(f"LD SM0\nDCMP{sign} D10 D20 M0")
    put(plc, 10, first)
    put(plc, 20, second)
    plc["M0"] = before
    plc.scan()
    days = as_date(first), as_date(second)
    fits = None not in days
    assert plc["M0"] == (SIGNS[sign](*days) if fits else before)
    assert plc["SM20"] == (not fits)


@pytest.fixture(params=["compiled", "stepping"])
def meter(request):
    """A PLC whose HOUR runs while M0 is ON, in a structure that M1 opens."""
    plc = ecsim.Plc("EC20", scan_ms=10)
    plc.tracing = request.param == "stepping"
    plc.load("LD M1\nMC 0\nLD M0\nHOUR 1 D0 M10\nMCR 0")
    plc.run()
    plc["M1"] = 1
    return plc


def test_short_times_add_up(meter):
    for _ in range(150):
        meter["M0"] = 1
        meter.scan()
        meter["M0"] = 0
        meter.scan()
    assert meter["D1"] == 1  # 150 times 10 ms


def test_time_under_an_open_master_control_does_not_count(meter):
    meter["M0"] = 1
    meter.advance(ms=1500)
    meter["M1"] = 0
    meter.advance(ms=60_000)
    meter["M1"] = 1
    meter.advance(ms=1000)
    assert meter["D1"] == 2


def test_the_alarm_follows_the_hours_while_the_flow_is_on(meter):
    meter.set({"M0": 1, "D0": 0, "D1": 3599})
    meter.advance(ms=1020)
    assert (meter["D0"], meter["D1"], meter["M10"]) == (1, 0, 1)
    meter["D0"] = 0
    meter.scan()
    assert meter["M10"] == 0
    meter.set({"M0": 0, "M10": 1})
    meter.scan(3)
    assert meter["M10"] == 1
