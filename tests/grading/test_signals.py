"""Conditions over lanes: what each function means, scan by scan, and what is refused."""

import pytest

from ecsim import EcsimError
from ecsim.grading.signals import combine, condition, intervals, rises, value_at


def row(text):
    """A signal written as one sign a scan: "0011"."""
    return [(scan, int(value)) for scan, value in enumerate(text)]


def scans(signal, length):
    """A signal as text, one sign a scan."""
    return "".join(str(int(value_at(signal, scan))) for scan in range(length))


LANES = {
    "A": row("0110011101"),
    "B": row("0000100001"),
    "N": row("0123456789"),
    "Z": row("1100000000"),
}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("A", "0110011101"),
        ("not A", "1001100010"),
        ("A or B", "0110111101"),
        ("A and not B", "0110011100"),
        ("N >= 4 and N < 7", "0000111000"),
        ("N % 3 == 2", "0010010010"),
        ("rise(A)", "0100010001"),
        ("fall(A)", "0001000010"),
        ("rise(Z)", "0000000000"),
        ("fall(Z)", "0010000000"),
        ("between(rise(A), B)", "0111011110"),
        ("between(A, 0)", "0111111111"),
        ("held(A, 0.01)", "0010001100"),
        ("held(A, 0.02)", "0000000100"),
        ("held(Z, 0.01)", "0100000000"),
        ("count(A)", "0111122223"),
        ("taken(N, A)", "0111155559"),
        ("count(A) == 2 and not A", "0000000010"),
    ],
)
def test_a_condition_scan_by_scan(text, expected):
    assert scans(condition(text).over(LANES.__getitem__, 0.01), 10) == expected


def test_a_signal_holds_between_its_changes():
    assert combine(lambda a, b: a + b, [[(0, 1), (5, 2)], [(0, 10), (3, 20), (5, 30)]]) == [(0, 11), (3, 21), (5, 32)]
    assert combine(lambda a: a > 1, [[(0, 1), (5, 2), (7, 3)]]) == [(0, False), (5, True)]


def test_intervals_are_cut_at_the_end():
    assert intervals([(0, 0), (2, 1), (4, 0), (7, 1)], 10) == [(2, 4), (7, 10)]
    assert intervals([(0, 1)], 3) == [(0, 3)]
    assert rises([(0, 1), (2, 0), (5, 1)]) == [5]


def test_a_condition_knows_its_lanes_in_order():
    assert condition("Drain and between(rise(Main), AddA or Drain)").lanes == ("Drain", "Main", "AddA")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("A and", "cannot be read"),
        ("open('x')", "calls 'open'; known are rise"),
        ("A.real", "holds 'A.real'"),
        ("[1, 2]", "may compare, calculate and join lanes"),
        ("between(A)", "between takes 2 conditions"),
        ("held(A, B)", "takes a number of seconds, not 'B'"),
        ("rise()", "rise takes 1 condition"),
        ("(lambda: 1)", "holds"),
    ],
)
def test_what_is_no_condition_is_named(text, words):
    with pytest.raises(EcsimError) as refused:
        condition(text)
    assert words in str(refused.value)


def test_an_unknown_lane_is_named_with_those_that_there_are(conveyor_trace):
    with pytest.raises(EcsimError, match=r"no lane 'Motor'.*AtEntry.*delivered"):
        conveyor_trace.signal("Motor and Gate")


def test_a_name_and_its_device_are_one_lane(conveyor_trace):
    assert conveyor_trace.signal("Gate") == conveyor_trace.signal("Y0")
    assert len(conveyor_trace.intervals("Gate")) >= 3
