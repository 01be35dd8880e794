"""What happens to the star-delta drive when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Lasts, Never, Order, Scenario, Within

from .picture import PICTURE
from .plant import StarDelta

OFF = "(not StopPB or not Healthy)"
ANY = "(Line or Star or Delta)"
READY = Do({"StopPB": 1}, at=0.0)  # the stop button is not pressed
PRESS_S = 0.2


def press_stop(**when):
    """The stop button, pressed for a moment."""
    return [Do({"StopPB": 0}, **when), Do({"StopPB": 1}, after=PRESS_S)]


SCENARIOS = (
    Scenario(
        "run",
        "Started, run in delta, stopped, and started again",
        seconds=30,
        choices={"pressed": Between(0.05, 8.0, usual=0.2), "runs": Between(6.0, 9.0, usual=7.0), "pause": Between(0.1, 3.0, usual=1.0)},
        script=lambda chosen: [
            READY,
            Do({"Start": 1}, at=1.0, hold=chosen.pressed),
            *press_stop(after=max(chosen.pressed, chosen.runs) + 1.0),
            Do({"Start": 1}, after=chosen.pause, hold=PRESS_S),
        ],
    ),
    Scenario(
        "stopped-early",
        "Stopped while it still runs up, and started again",
        seconds=20,
        choices={"after": Between(0.2, 5.3, usual=2.0), "pause": Between(0.05, 2.0, usual=0.5)},
        script=lambda chosen: [
            READY,
            Do({"Start": 1}, at=1.0, hold=PRESS_S),
            *press_stop(after=chosen.after),
            Do({"Start": 1}, after=chosen.pause, hold=PRESS_S),
        ],
    ),
    Scenario(
        "overload",
        "The shaft jams in delta until the overload relay trips; later it is free and cool again",
        seconds=70,
        choices={"after": Between(0.1, 9.0, usual=7.0)},
        script=lambda chosen: [
            READY,
            Do({"Start": 1}, at=1.0, hold=PRESS_S),
            Do(after=chosen.after, fail="jammed"),
            Do(when="not Healthy", after=2.0, mend="jammed"),
            Do(when="Healthy", after=4.0, set={"Start": 1}, hold=PRESS_S),
        ],
        draws=2,
    ),
    Scenario(
        "held",
        "Start is pressed while Stop is held",
        seconds=8,
        script=[Do({"StopPB": 0}, at=0.0), Do({"Start": 1}, at=1.0, hold=PRESS_S), Do({"StopPB": 1}, at=3.0)],
        draws=0,
    ),
)
NORMAL = ("run", "stopped-early")

RULES = (
    Never("never-both", "Star and delta are never ON together", "Star and Delta", needs="Star"),
    Never("nothing-amiss", "No short circuit and no fuse", "incidents", needs="Delta", scenarios=NORMAL),
    Within("starts", "A press of Start closes line and star", "rise(Start) and StopPB and Healthy", "Line and Star", 0.1, unless=OFF),
    Lasts("star-time", "It runs up in star for 5 s", "Line and Star", 4.95, 5.08, unless=OFF),
    Lasts(
        "pause",
        "Between star and delta both are off for 50 ms to 0.5 s",
        "Line and not Star and not Delta and between(fall(Star), Delta or not Line)",
        0.05,
        0.5,
        unless=OFF,
    ),
    Within("delta-follows", "After star comes delta", "fall(Star) and StopPB and Healthy", "Delta", 0.5, unless=OFF),
    Never(
        "holds",
        "It runs until Stop or the overload relay opens",
        "(fall(Line) or fall(Delta)) and StopPB and Healthy",
        needs="Line",
        expected="Line and Delta stay on until StopPB or Healthy goes off.",
    ),
    Never("stops", "Nothing is on while Stop is pressed", f"{ANY} and not StopPB", grace=1, needs="not StopPB"),
    Never("overload", "Nothing is on while the overload relay is open", f"{ANY} and not Healthy", grace=1, needs="not Healthy"),
    Never(
        "no-restart",
        "It starts by the button and not by itself",
        f"{ANY} and not between(Start, {OFF})",
        grace=1,
        needs="count(Line) > 0 and not Line",
        expected="No contactor ON from Stop or an overload to the next press of Start.",
    ),
    Order("sequence", "Star first, then delta", ("Star", "Delta"), restart="not Line", expected="Line and star, then delta."),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Star-delta",
    plant=StarDelta,
    quantities=("speed", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
