"""Free choices: drawn alike everywhere, and made simpler towards the usual."""

from random import Random

import pytest

from ecsim import EcsimError
from ecsim.grading import Between, OneOf, Several
from ecsim.grading.choices import draw, simpler, usual

CHOICES = {"t": Between(0.5, 4.0, usual=1.0), "n": Between(1, 9, digits=0), "p": OneOf("A", "B", "C"), "s": Several(OneOf("A", "B"), 1, 3)}


def test_the_usual_values():
    assert usual(CHOICES) == {"t": 1.0, "n": 1, "p": "A", "s": ["A"]}


def test_a_seed_gives_the_same_values_and_another_one_others():
    assert draw(CHOICES, "x/1") == draw(CHOICES, "x/1")
    assert len({str(draw(CHOICES, f"x/{number}")) for number in range(20)}) > 15


def test_drawn_values_lie_within_their_bounds_and_reach_the_ends():
    drawn = [draw(CHOICES, str(number)) for number in range(300)]
    assert {one["p"] for one in drawn} == {"A", "B", "C"}
    assert {len(one["s"]) for one in drawn} == {1, 2, 3}
    assert {one["n"] for one in drawn} == set(range(1, 10))
    assert min(one["t"] for one in drawn) == 0.5
    assert max(one["t"] for one in drawn) == 4.0


@pytest.mark.parametrize("name", CHOICES)
def test_making_simpler_comes_to_the_usual_and_ends(name):
    choice = CHOICES[name]
    value, steps = choice.draw(Random(4)), 0
    while True:
        nearer = list(choice.simpler(value))
        assert value not in nearer
        if not nearer:
            break
        value, steps = nearer[-1], steps + 1
        assert steps < 200
    assert value == choice.usual


def test_all_at_once_is_tried_first_then_one_at_a_time():
    values = {"t": 3.0, "n": 1, "p": "B", "s": ["A"]}
    found = list(simpler(CHOICES, values))
    assert found[0] == usual(CHOICES)
    assert {**values, "t": 1.0} in found
    assert {**values, "p": "A"} in found
    assert all(sum(one[name] != values[name] for name in values) == 1 for one in found[1:])


@pytest.mark.parametrize("wrong", [lambda: Between(1, 0), lambda: Between(0, 1, usual=2), lambda: OneOf(), lambda: Several(OneOf(1), 3, 2)])
def test_choices_that_cannot_be_are_refused(wrong):
    with pytest.raises(EcsimError):
        wrong()
