"""What happens at the crossing when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Count, Do, Exercise, Lasts, Never, Scenario, Several, Within

from .picture import PICTURE
from .plant import Crossing

HAND_OVER = 2  # scans


def in_order(gaps, first):
    """Times from the gaps between them."""
    times = []
    for gap in gaps:
        first += gap
        times.append(round(first, 2))
    return tuple(times)


SCENARIOS = (
    Scenario(
        "traffic",
        "Cars come and people walk, now and then",
        seconds=240,
        choices={
            "cars": Several(Between(1.0, 8.0, usual=4.0), 30, 50),
            "walkers": Several(Between(0.5, 50.0, usual=30.0), 4, 6, usual=[14.0, 2.0, 45.0, 25.0]),
        },
        plant=lambda chosen: Crossing(in_order(chosen.cars, 0.0), in_order(chosen.walkers, 5.0)),
    ),
    Scenario(
        "early",
        "Somebody comes right after switching on",
        seconds=60,
        choices={"walker": Between(0.0, 9.0, usual=1.0)},
        plant=lambda chosen: Crossing((3.0, 20.0, 33.0), (chosen.walker,)),
    ),
    Scenario(
        "late",
        "Somebody comes when the walkers have just lost their green",
        seconds=90,
        choices={"after": Between(8.1, 18.0, usual=9.0)},
        plant=lambda chosen: Crossing((3.0, 20.0, 33.0, 50.0), (12.0, round(12.0 + 5.0 + chosen.after, 2))),
    ),
    Scenario("nobody", "Nobody wants to cross", seconds=60, plant=lambda chosen: Crossing((5.0, 30.0, 50.0), ()), draws=0),
    Scenario(
        "stuck",
        "The button sticks: the cars must still have their time",
        seconds=120,
        plant=lambda chosen: Crossing((5.0, 40.0, 80.0), ()),
        script=[Do(at=2.0, fail="button sticks")],
        draws=0,
    ),
)
PEOPLE = ("traffic", "early", "late")

RULES = (
    Never("never-both-green", "Cars and walkers never have green together", "CarGrn and WalkGrn", grace=1, needs="WalkGrn"),
    Never(
        "clear-lights",
        "Each light shows red or green, and not both",
        "CarRed and CarGrn or WalkRed and WalkGrn",
        grace=HAND_OVER,
        needs="WalkGrn",
    ),
    Never("no-dark", "No light is dark", "not (CarRed or CarYell or CarGrn) or not (WalkRed or WalkGrn)", grace=HAND_OVER),
    Never(
        "nobody-hurt",
        "No car drives while somebody is on the road, and nobody loses patience",
        "incidents",
        needs="WalkGrn",
        scenarios=PEOPLE,
    ),
    Within(
        "answers",
        "Who presses gets green",
        "Button and not WalkGrn and not CarRed",
        "WalkGrn",
        16.0,
        expected="Green for the walkers 10 s of the cars' green and 5 s of yellow and red later at the latest.",
    ),
    Within(
        "answers-late",
        "Who presses when the walkers' green has just ended gets the next one",
        "Button and not WalkGrn and CarRed",
        "WalkGrn",
        25.0,
    ),
    Never(
        "not-unasked",
        "Nobody gets green who has not pressed",
        "WalkGrn and count(Button) == 0",
        scenarios=("nobody",),
        needs="CarGrn",
    ),
    Count(
        "cars-have-their-time",
        "With nobody at the kerb the cars keep their green",
        "fall(CarGrn)",
        most=1,
        scenarios=("early",),
    ),
    Lasts("cars-green-time", "The cars have green for 10 s at least", "CarGrn", 9.9),
    Lasts("yellow-time", "Yellow before red lasts 3 s", "CarYell and not CarRed", 2.9, 3.2),
    Lasts(
        "clearing-time",
        "Before the walkers' green all have red for 2 s",
        "CarRed and WalkRed and between(fall(CarYell), WalkGrn)",
        1.9,
        2.2,
    ),
    Lasts("walk-time", "The walkers have green for 8 s", "WalkGrn", 7.9, 8.2),
    Lasts(
        "way-home",
        "After it all have red for 7 s",
        "CarRed and WalkRed and not CarYell and between(fall(WalkGrn), CarYell or CarGrn)",
        6.9,
        7.2,
    ),
    Lasts("red-yellow-time", "Red and yellow last 1 s", "CarRed and CarYell and between(fall(WalkGrn), CarGrn)", 0.9, 1.2),
    Within("yellow-first", "After the cars' green comes yellow", "fall(CarGrn)", "CarYell", 0.1),
    Within("green-again", "After red and yellow comes green", "fall(CarRed)", "CarGrn", 0.1),
    Within("sign-on", "The sign lights up with the press", "rise(Button) and not WalkGrn", "Wait", 0.1),
    Never(
        "sign-off", "The sign is dark when the walkers have green", "Wait and WalkGrn", grace=HAND_OVER, needs="WalkGrn", scenarios=PEOPLE
    ),
    Never("sign-true", "The sign lights up for nobody else", "Wait and count(Button) == 0", scenarios=("nobody",), needs="CarGrn"),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Pedestrian crossing",
    plant=Crossing,
    quantities=("passed", "crossed", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
