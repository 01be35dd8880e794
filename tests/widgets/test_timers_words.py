"""What timers and counters do, in words."""

import pytest
from ecsim_widgets.timers import WORDS, duration


@pytest.mark.parametrize(
    ("units", "base_us", "text"),
    [(3, 100_000, "0.3 s"), (250, 10_000, "2.50 s"), (7, 1_000, "7 ms"), (1250, 1_000, "1.250 s"), (18204, 100_000, "1,820.4 s")],
)
def test_a_duration_is_as_precise_as_its_time_unit(units, base_us, text):
    assert duration(units, base_us) == text


@pytest.mark.parametrize(
    ("kind", "value", "preset", "on", "flow", "base_us", "said"),
    [
        ("TON", 0, 5, False, False, 100_000, ("off", "off")),
        ("TON", 3, 5, False, True, 100_000, ("run", "0.3 s, *0.2 s to go*")),
        ("TON", 250, 250, True, True, 10_000, ("done", "*done*, 2.50 s")),
        ("TONR", 18204, 32000, False, False, 100_000, ("held", "*held* at 1,820.4 s")),
        ("TONR", 18204, 32000, False, True, 100_000, ("run", "1,820.4 s, *1,379.6 s to go*")),
        ("TONR", 400, 300, True, False, 100_000, ("done", "*done*, 40.0 s")),
        ("TOF", 0, 30, True, True, 100_000, ("run", "*on*, waits for its input to go off")),
        ("TOF", 14, 30, True, False, 100_000, ("run", "1.4 s, *off in 1.6 s*")),
        ("TOF", 30, 30, False, False, 100_000, ("off", "off")),
        ("TMON", 7, 20, True, False, 1_000, ("run", "7 ms, *13 ms to go*")),
        ("CTU", 3, 12, False, False, 0, ("run", "9 to go")),
        ("CTU", 12, 12, True, False, 0, ("done", "*reached*")),
        ("CTR", 4, 4, True, False, 0, ("done", "*reached*, next edge makes 1")),
        ("DCNT", -180, 400, False, False, 0, ("run", "580 to go")),
    ],
)
def test_the_state_is_said_in_words(kind, value, preset, on, flow, base_us, said):
    assert WORDS[kind](value, preset, on, flow, base_us) == said
