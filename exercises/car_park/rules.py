"""What happens to the car park when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Custom, Do, Exercise, Never, OneOf, Scenario, Several

from .picture import PICTURE
from .plant import PLACES, CarPark, Visit

FREE = "not Outer and not Inner"
COMES_OUT = "((Outer or Inner) and not taken(Outer, Outer or Inner))"
ANSWER = 20  # scans: 0.2 s
PARTS = {"early": 0.04, "middle": 0.5, "late": 0.96}  # of a car's way: in the first barrier, in both, in the last one
KINDS = {
    "in": Visit(),
    "out": Visit(comes="park", goes="street"),
    "bus in": Visit("bus"),
    "bus out": Visit("bus", "park", "street"),
    "walks in": Visit("walker"),
    "walks out": Visit("walker", "park", "street"),
    **{f"in and back {part}": Visit(goes="street", turns=(at,)) for part, at in PARTS.items()},
    **{f"out and back {part}": Visit(comes="park", turns=(1 - at,)) for part, at in PARTS.items()},
    "in after all": Visit(turns=(0.96, 0.5)),
    "in at last": Visit(turns=(0.5, 0.04)),
    "out after all": Visit(comes="park", goes="street", turns=(0.04, 0.5)),
    "out at last": Visit(comes="park", goes="street", turns=(0.5, 0.96)),
}


def park(kinds, pause=0.5, **options):
    """The machine with these visits, by their names."""
    return CarPark(tuple(KINDS[kind]._replace(pause_s=pause) for kind in kinds), **options)


def busy_day():
    """The machine to look at and to try programs on: all kinds of visits, twice over."""
    return park([*KINDS, *KINDS], 1.5, inside=1)


def counts(trace):
    """Cars, 0.3 s after both barriers are free, must be what went in less what went out, never below 0, and 0 after Zero."""
    happened = [(scan, 1) for scan, value in trace.lane("entered") if value]
    happened += [(scan, -1) for scan, value in trace.lane("left") if value]
    happened += [(scan, 0) for scan, _ in trace.intervals("Zero")]
    happened.sort()
    cars, place = 0, 0
    for start, end in trace.intervals(f"held({FREE} and not Zero, 0.3)"):
        while place < len(happened) and happened[place][0] <= start:
            cars = max(0, cars + happened[place][1]) if happened[place][1] else 0
            place += 1
        for first, last in trace.intervals(f"Cars != {cars}"):
            if first < end and last > start:
                yield max(first, start), max(first, start), f"Cars was not {cars}."


SCENARIOS = (
    Scenario(
        "day",
        "Cars and buses come and go, some turn back, people walk through",
        seconds=150,
        choices={
            "kinds": Several(
                OneOf(*KINDS), 8, 12, usual=["in", "bus in", "walks in", "out", "in and back middle", "walks out", "bus out", "in"]
            ),
            "pause": Between(0.4, 3.0, usual=0.5),
            "inside": Between(0, 2, usual=1, digits=0),
        },
        plant=lambda chosen: park(chosen.kinds, chosen.pause, inside=chosen.inside),
        draws=4,
    ),
    Scenario(
        "turning-back",
        "One car after the other turns back, in each place",
        seconds=85,
        plant=lambda chosen: park(
            ["in", *(f"{way} and back {part}" for way in ("in", "out") for part in PARTS), "in after all", "out after all", "out"],
            0.4,
            inside=2,
        ),
        draws=0,
    ),
    Scenario(
        "second-thoughts",
        "Cars turn back and then go on after all",
        seconds=75,
        plant=lambda chosen: park(
            ["in after all", "in at last", "out after all", "in", "out at last", "in", "walks out", "walks in", "out"], 0.4
        ),
        draws=0,
    ),
    Scenario(
        "rush",
        "More cars come than there are places, and one driver does not obey the sign",
        seconds=95,
        choices={"pause": Between(0.4, 2.0, usual=0.5)},
        plant=lambda chosen: CarPark(
            (
                *(Visit(pause_s=chosen.pause) for _ in range(5)),
                Visit(pause_s=chosen.pause, obeys=False),
                Visit(comes="park", goes="street", pause_s=chosen.pause),
                Visit(pause_s=chosen.pause),
                *(Visit(comes="park", goes="street", pause_s=chosen.pause) for _ in range(2)),
                Visit("bus", pause_s=chosen.pause),
            )
        ),
        draws=2,
    ),
    Scenario(
        "attendant",
        "Cars stand inside that nobody counted; the attendant sets the count to zero",
        seconds=60,
        choices={"turned": Between(0.1, 1.0, usual=0.3)},
        plant=lambda chosen: CarPark(
            (
                Visit(comes="park", goes="street"),
                Visit(comes="park", goes="street"),
                *(Visit() for _ in range(2)),
                Visit(pause_s=4.0),
                Visit(comes="park", goes="street"),
            ),
            inside=3,
        ),
        script=lambda chosen: [Do({"Zero": 1}, when="entered >= 2", after=2.0, hold=chosen.turned)],
        draws=1,
    ),
)

RULES = (
    Custom(
        "counts",
        "Cars tells how many are inside",
        counts,
        watch=("Cars", "Outer", "Inner"),
        needs="Cars > 0",
        expected="Cars is one more for each that went in, one fewer for each that went out, 0.3 s after both barriers are free.",
    ),
    Never("not-below-zero", "Cars is never below 0", "Cars < 0 or Cars > 1000", needs="Cars > 0"),
    Never("full", "The sign tells that the park is full", f"Cars >= {PLACES} and not Full", grace=ANSWER, needs=f"Cars >= {PLACES}"),
    Never("not-full", "It does not while there is a place", f"Cars < {PLACES} and Full", grace=ANSWER, needs=f"Cars >= {PLACES}"),
    Never("no-place", "Nobody drives in and finds no place", "incidents", needs="turned_away", scenarios=("rush",)),
    Never(
        "warns",
        "The lamp warns while something comes out",
        f"{COMES_OUT} and not Warn",
        grace=ANSWER,
        needs=COMES_OUT,
        expected="Warn ON within 0.2 s when Inner is interrupted first, until both are free.",
    ),
    Never(
        "warns-only-then",
        "It does not warn of what comes in",
        f"Warn and not {COMES_OUT}",
        grace=ANSWER,
        needs="count(Warn) > 0 and Outer",
        expected="Warn OFF when Outer was interrupted first, and within 0.2 s of both free.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Car park",
    plant=busy_day,
    quantities=("entered", "left", "inside", "turned_away", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
