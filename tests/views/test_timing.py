"""Pieces of a timing diagram: what is drawn of a stretch of a signal, and what a crowded pixel shows."""

import re

import pytest

from ecsim.views.timing import Stretch, bit, bus, clock_text, curve, nice_range, ticks

WIDE = Stretch(0, 100_000, 1000)  # 100 px of 1 ms


def drawn(markup):
    """The path of each kind in some markup."""
    return dict(re.findall(r'<path class="([\w -]+)" d="([^"]*)"/>', markup))


def test_a_bit_is_a_thin_line_low_and_a_block_high():
    parts = drawn(bit([(0, 0), (20_000, 1), (60_000, 0)], WIDE, 1000))
    assert parts["bit-line"] == "M0 28H20M60 28H100M20 28V8M60 28V8"
    assert parts["hi-line"] == "M20 8H60"
    assert parts["hi-fill"] == "M20 8H60V28H20Z"
    assert "dense" not in parts
    assert "pin" not in parts


def test_what_begins_before_and_ends_behind_is_cut():
    parts = drawn(bit([(-50_000, 1), (120_000, 0)], WIDE, 1000))
    assert parts == {"hi-fill": "M0 8H100V28H0Z", "hi-line": "M0 8H100"}


def test_nothing_is_drawn_of_what_was_not_recorded():
    assert drawn(bit([(0, None), (40_000, 0)], WIDE, 1000)) == {"bit-line": "M40 28H100"}
    assert bit([], WIDE, 1000) == ""


@pytest.mark.parametrize("us_per_px", [500, 2000, 50_000])
def test_a_pulse_of_one_scan_is_a_pin_at_every_zoom(us_per_px):
    stretch = Stretch(0, 100 * us_per_px, us_per_px)
    middle = 50 * us_per_px
    parts = drawn(bit([(0, 0), (middle, 1), (middle + 1000, 0)], stretch, 1000))
    assert parts["pin"].startswith("M50") or parts["pin"].startswith("M51")
    assert "h10" in parts["pin-head"]
    assert "dense" not in parts


def test_a_pulse_of_one_scan_that_is_wide_enough_needs_no_pin():
    parts = drawn(bit([(0, 0), (40_000, 1), (60_000, 0)], WIDE, 20_000))
    assert "pin" not in parts
    assert parts["hi-line"] == "M40 8H60"


def test_edges_in_one_pixel_become_a_solid_bar():
    blinking = [(0, 0), *((30_000 + 100 * n, n % 2) for n in range(1, 101)), (70_000, 1)]
    parts = drawn(bit(blinking, WIDE, 100))
    assert parts["dense"] == "M30.1 8H40V28H30.1Z"
    assert parts["hi-line"] == "M70 8H100"


def test_a_short_break_does_not_swallow_the_blocks_beside_it():
    parts = drawn(bit([(0, 1), (50_000, 0), (50_100, 1)], WIDE, 100))
    assert parts["dense"] == "M50 8H51V28H50Z"
    assert parts["hi-line"] == "M0 8H50M50.1 8H100"


def test_a_curve_holds_each_value_until_the_next():
    assert drawn(curve([(0, 0), (25_000, 100), (50_000, 50)], WIDE, 0, 100)) == {"word-line": "M0 54H25V10H50V32H100"}


def test_a_pixel_with_many_values_shows_the_least_and_the_greatest():
    values = [(0, 50), *((10_000 + 100 * n, n) for n in range(1, 10)), (20_000, 0)]
    assert drawn(curve(values, WIDE, 0, 100)) == {"word-line": "M0 32H10.5V53.56V32V50.04H20V54H100"}  # 44 px for 100, from 54 upwards


def test_a_bus_crosses_where_its_value_changes():
    shapes, letters = bus([(-1000, 7), (40_000, 8), (97_000, 9)], WIDE, str)
    parts = drawn(shapes)
    assert "H36L40 19L36 30" in parts["bus"]
    assert "M40 19L44 8H93" in parts["bus"]
    assert parts["dense"] == "M97 8H100V30H97Z"
    assert re.findall(r">(\d+)</text>", letters) == ["8"]  # 7 began before: the panel itself writes it at the edge


def test_words_too_long_for_their_segment_are_left_out():
    assert not bus([(1000, 1)], WIDE, lambda value: "S20 S21 S22 S23 S24 S25")[1]


@pytest.mark.parametrize(
    ("least", "step", "text"),
    [(1, 1, "1.000000"), (90_000, 100_000, "1.0"), (110_000, 200_000, "1.0"), (300_000, 500_000, "1.0"), (700_000, 1_000_000, "1")],
)
def test_marks_stand_at_round_times(least, step, text):
    first, distance, _ = ticks(999_999 if step == 1 else 900_001, least)
    assert distance == step
    assert first % step == 0
    assert clock_text(1_000_000, step) == text


@pytest.mark.parametrize(("values", "scale"), [((0, 1842), (0, 2000)), ((-3, 7), (-5, 10)), ((0, 0), (0, 0)), ((0, 10), (0, 10))])
def test_a_curve_has_round_ends(values, scale):
    assert nice_range(*values) == scale
