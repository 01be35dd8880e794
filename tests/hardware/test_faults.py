"""SM20 to SM22 and SD20 to SD24: what an execution error leaves behind, and what clears it (2.4, appendix 6)."""

import pytest

from ecsim.plc import Plc

RANGE_ERROR = "LD M0\nMOV D7999Z0 D10"  # 65 while Z0 is 1
OPERAND_ERROR = "LD M1\nZRST M100 D1"  # 64 while D1 is negative
DIVISION_ERROR = "LD M2\nDIV D2 D3 D12"  # 69 while D3 is 0
STACK_ERROR = "LD M3\nPUSH D4 D20 D5"  # 70 while the size is 0
CLOCK_ERROR = "LD M4\nTWR D30"  # 76 with month 0
ALL = {"M0": 65, "M1": 64, "M2": 69, "M3": 70, "M4": 76}
PROGRAM = "\n".join([RANGE_ERROR, OPERAND_ERROR, DIVISION_ERROR, STACK_ERROR, CLOCK_ERROR, "LD M9\nMOV 1 D99"])


@pytest.fixture(params=["compiled", "stepping"])
def plc(request):
    """A PLC whose program fails in five ways, each with its own relay."""
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(PROGRAM)
    plc.engine = request.param
    plc.run()
    plc.set({"Z0": 1, "D1": -1})
    return plc


def fail(plc, *relays):
    """A scan in which the instructions of these relays are executed."""
    plc.set({relay: int(relay in relays) for relay in (*ALL, "M9")})
    plc.scan()


def record(plc):
    """SD20 to SD24, the newest first."""
    return [plc[f"SD{number}"] for number in range(20, 25)]


@pytest.mark.parametrize(
    ("relay", "flags"), [("M0", (1, 1, 0)), ("M1", (1, 0, 1)), ("M2", (1, 0, 0)), ("M3", (1, 0, 0)), ("M4", (1, 0, 0))]
)
def test_an_error_sets_its_relays_and_its_code(plc, relay, flags):
    fail(plc, relay)
    assert (plc["SM20"], plc["SM21"], plc["SM22"]) == flags
    assert record(plc) == [ALL[relay], 0, 0, 0, 0]
    assert plc.running


def test_only_another_code_is_pushed(plc):
    for relay in ("M0", "M0", "M2", "M2", "M0"):
        fail(plc, relay)
    assert record(plc) == [65, 69, 65, 0, 0]


def test_the_record_is_five_deep(plc):
    for relay in ("M0", "M1", "M2", "M3", "M4", "M0"):
        fail(plc, relay)
    assert record(plc) == [65, 76, 70, 69, 64]


def test_errors_of_one_scan_are_recorded_in_the_order_of_the_program(plc):
    fail(plc, "M0", "M2", "M4")
    assert record(plc) == [76, 69, 65, 0, 0]


def test_a_correct_application_instruction_clears_sm20_and_sm22_but_not_the_record(plc):
    fail(plc, "M1")
    fail(plc, "M9")
    assert (plc["SM20"], plc["SM22"]) == (0, 0)
    assert record(plc) == [64, 0, 0, 0, 0]


def test_without_a_correct_application_instruction_the_relays_stay(plc):
    fail(plc, "M1")
    fail(plc)
    assert (plc["SM20"], plc["SM22"]) == (1, 1)


def test_an_instruction_behind_the_error_clears_it_in_the_same_scan(plc):
    fail(plc, "M1", "M9")
    assert (plc["SM20"], plc["SM22"]) == (0, 0)
    assert plc["SD20"] == 64


def test_an_error_leaves_the_destination_as_it_was(plc):
    plc["D10"] = plc["D12"] = plc["D13"] = 5
    fail(plc, "M0", "M2")
    assert (plc["D10"], plc["D12"], plc["D13"]) == (5, 5, 5)


def test_the_errors_are_told_in_words(plc):
    fail(plc, "M0")
    fail(plc, "M2")
    assert [str(error) for error in plc.errors] == [
        "69: division by zero (manual appendix 6)",
        "65: the number of an operand's device is out of range (manual appendix 6)",
    ]


def test_run_clears_the_record(plc):
    fail(plc, "M0")
    plc.stop()
    assert plc["SD20"] == 65
    plc.run()
    assert record(plc) == [0, 0, 0, 0, 0]
    assert plc["SM20"] == 0
