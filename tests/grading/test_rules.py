"""Rules on runs written down by hand: when each is kept, broken and tried, at which scan it breaks, and what it says."""

import pytest

from ecsim import EcsimError
from ecsim.grading import Count, Custom, Lasts, Never, Order, Within
from ecsim.grading.rules import check
from ecsim.grading.run import Trace


def trace(end=None, cut=False, **lanes):
    """A run with scans of 100 ms; each lane is a text, one sign a scan."""
    length = end or len(next(iter(lanes.values())))
    rows = [(tuple(bool(int(text[scan])) for text in lanes.values()),) for scan in range(length)]
    return Trace(0.1, length, list(range(length)), rows, {name: (0, place) for place, name in enumerate(lanes)}, {}, cut=cut)


def broken(rule, run):
    """The scan at which a rule is known to be broken, None when it is kept."""
    finding = rule.judge(run).finding
    return finding.scan if finding else None


# ---- never -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("a", "grace", "scan"),
    [("00000", 0, None), ("00100", 0, 2), ("00100", 1, None), ("00110", 1, 3), ("0101010", 1, None), ("11100", 2, 2), ("00011", 2, None)],
)
def test_never_breaks_when_it_holds_longer_than_the_grace(a, grace, scan):
    assert broken(Never("n", "Never", "A", grace), trace(A=a)) == scan


def test_never_is_tried_when_what_it_needs_has_come():
    rule = Never("n", "Never", "A and B", needs="B")
    assert not rule.judge(trace(A="0110", B="0000")).tried
    assert rule.judge(trace(A="0110", B="1000")).tried
    assert Never("n", "Never", "A").judge(trace(A="000")).tried


def test_never_tells_how_long_it_held():
    finding = Never("n", "Never", "A and not B", 1).judge(trace(A="0011111111111111111111111100", B="0" * 28)).finding
    assert (finding.since, finding.scan, finding.until) == (2, 3, 26)
    assert finding.words == "A on, B off for 2.40 s."


# ---- within ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("a", "b", "scan"),
    [
        ("0100000", "0000100", None),  # on the last scan that is allowed
        ("0100000", "0000010", 4),
        ("0100000", "0000000", 4),
        ("0100000", "0100000", None),  # at once
        ("0100000", "1111111", None),  # already there
        ("0000100", "0000000", None),  # the run ends before the time is over
        ("1100000", "0000000", None),  # ON from the start is no rise
        ("0110010000", "0010000000", 8),  # the second time it does not come
    ],
)
def test_an_answer_must_come_in_time(a, b, scan):
    assert broken(Within("w", "Within", "A", "B", 0.3), trace(A=a, B=b)) == scan


def test_an_answer_is_not_asked_for_when_it_is_excused():
    rule = Within("w", "Within", "A", "B", 0.3, unless="E")
    assert broken(rule, trace(A="0100000", B="0000000", E="0001000")) is None
    assert broken(rule, trace(A="0100000", B="0000000", E="0000010")) == 4


def test_within_is_tried_when_it_was_asked():
    rule = Within("w", "Within", "A", "B", 0.3)
    assert not rule.judge(trace(A="000", B="111")).tried
    assert rule.judge(trace(A="010", B="111")).tried


def test_within_tells_how_late_the_answer_was():
    finding = Within("w", "Within", "A", "B", 0.1).judge(trace(A="0110000", B="0000011")).finding
    assert (finding.since, finding.scan, finding.until) == (1, 2, 5)
    assert finding.words == "B came only after 4 scans (0.400 s): B off, A on."


# ---- lasts -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("a", "least", "most", "scan"),
    [
        ("01110000", 0.3, None, None),
        ("01100000", 0.3, None, 3),
        ("00000011", 0.3, None, None),  # the run ends first
        ("01110000", 0.0, 0.3, None),
        ("01111000", 0.0, 0.3, 4),
        ("01110110", 0.3, None, 7),
    ],
)
def test_a_stretch_lasts_so_long(a, least, most, scan):
    assert broken(Lasts("l", "Lasts", "A", least, most), trace(A=a)) == scan


def test_a_stretch_may_be_cut_short_for_a_reason():
    rule = Lasts("l", "Lasts", "A", 0.3, unless="E")
    assert broken(rule, trace(A="01100", E="00010")) is None
    assert broken(rule, trace(A="01100", E="00001")) == 3


# ---- order and count -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lanes", "scan"),
    [
        ({"A": "010000", "B": "001000", "C": "000100"}, None),
        ({"A": "010001", "B": "001000", "C": "000100"}, None),
        ({"A": "010000", "B": "000100", "C": "001000"}, 2),
        ({"A": "010100", "B": "001000", "C": "000001"}, 3),
        ({"A": "010000", "B": "010000", "C": "010000"}, None),  # all in one scan is in order
    ],
)
def test_events_come_in_order(lanes, scan):
    assert broken(Order("o", "Order", ("A", "B", "C")), trace(**lanes)) == scan


def test_an_order_begins_anew_after_a_restart():
    rule = Order("o", "Order", ("A", "B"), restart="R")
    assert broken(rule, trace(A="010010", B="000001", R="001000")) is None
    assert broken(rule, trace(A="010010", B="000001", R="000000")) == 4
    assert not rule.judge(trace(A="010010", B="000000", R="001000")).tried


@pytest.mark.parametrize(
    ("a", "least", "most", "cut", "scan"),
    [
        ("0101", 2, None, False, None),
        ("0100", 2, None, False, 3),
        ("0100", 2, None, True, None),
        ("010101", 0, 2, True, 5),
        ("0101", 0, 2, False, None),
    ],
)
def test_an_event_comes_so_often(a, least, most, cut, scan):
    assert broken(Count("c", "Count", "A", least, most), trace(A=a, cut=cut)) == scan


def test_an_event_is_counted_in_each_stretch():
    rule = Count("c", "Count", "A", 1, 1, within="W")
    assert broken(rule, trace(A="0010000100", W="0111001110")) is None
    assert broken(rule, trace(A="0010000000", W="0111001110")) == 9
    assert broken(rule, trace(A="0101000000", W="0111100000")) == 3
    assert broken(rule, trace(A="0010000000", W="0111001111")) is None  # the last stretch is not over


# ---- custom, words, refusals ------------------------------------------------------------------------------------------


def test_a_function_may_judge():
    def look(run):
        for start, end in run.intervals("A"):
            if (end - start) % 2:
                yield start, end, f"{end - start} scans"

    rule = Custom("odd", "A is on for an even number of scans", look, watch=("A",), needs="A")
    assert rule.judge(trace(A="0110")) == (True, None)
    assert rule.judge(trace(A="0000")).tried is False
    assert rule.judge(trace(A="011011100")).finding[:2] == (7, 4)


@pytest.mark.parametrize(
    ("rule", "demand"),
    [
        (Never("n", "W", "A and B", 1), "Never A and B, but for one scan."),
        (Within("w", "W", "A", "B", 2, unless="C"), "B within 2 s of A, unless C."),
        (Lasts("l", "W", "A", 5, 6), "A for at least 5 s and at most 6 s."),
        (Order("o", "W", ("A", "B")), "A, then B."),
        (Count("c", "W", "A", 1, 2, within="B"), "A at least once, at most 2 times while B."),
        (Never("n", "W", "A", expected="As it is said."), "As it is said."),
    ],
)
def test_what_is_expected_is_said_in_words(rule, demand):
    assert rule.demand == demand


def test_a_chart_marks_what_is_at_fault_alone():
    assert Never("n", "W", "Gate and between(InLift, Leaving)").marked == ("Gate",)
    assert Within("w", "W", "rise(A)", "B and C", 1).marked == ("B", "C")
    assert Never("n", "W", "rise(A)").marked == ("A",)


def test_two_rules_of_one_name_are_refused():
    with pytest.raises(EcsimError, match="two rules have the name 'n'"):
        check([Never("n", "W", "A"), Never("n", "W", "B")])
    with pytest.raises(EcsimError, match="cannot be read"):
        check([Never("n", "W", "A and")])
