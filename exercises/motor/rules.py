"""What happens to the drive when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Never, OneOf, Scenario, Within

from .picture import PICTURE
from .plant import Motor

TURNS = "(RunF or RunR)"
OFF = "(not StopPB or not Healthy)"
READY = Do({"StopPB": 1}, at=0.0)  # the stop button is not pressed
PRESS_S = 0.2


def press_stop(**when):
    """The stop button, pressed for a moment."""
    return [Do({"StopPB": 0}, **when), Do({"StopPB": 1}, after=PRESS_S)]


SCENARIOS = (
    Scenario(
        "one-way",
        "Started, stopped, and started again",
        seconds=16,
        choices={"way": OneOf("Forward", "Reverse"), "runs": Between(0.3, 5.0, usual=3.0), "pressed": Between(0.05, 1.0, usual=0.2)},
        script=lambda chosen: [
            READY,
            Do({chosen.way: 1}, at=1.0, hold=chosen.pressed),
            *press_stop(after=chosen.pressed + chosen.runs),
            Do({chosen.way: 1}, after=2.0, hold=chosen.pressed),
        ],
    ),
    Scenario(
        "other-way",
        "The button of the other direction is pressed while the motor turns; then it is stopped and reversed",
        seconds=16,
        choices={
            "way": OneOf("Forward", "Reverse"),
            "after": Between(0.02, 3.0, usual=1.5),
            "pressed": Between(0.05, 1.0, usual=0.2),
            "pause": Between(0.2, 3.0, usual=1.0),
        },
        script=lambda chosen: [
            READY,
            Do({chosen.way: 1}, at=1.0, hold=PRESS_S),
            Do({other(chosen.way): 1}, after=PRESS_S + chosen.after, hold=chosen.pressed),
            *press_stop(after=chosen.pressed + 1.0),
            Do({other(chosen.way): 1}, after=chosen.pause, hold=PRESS_S),
            Do({chosen.way: 1}, after=2.0, hold=PRESS_S),
        ],
    ),
    Scenario(
        "together",
        "Both buttons are pressed together, and let go one after the other",
        seconds=12,
        choices={"first": OneOf("Forward", "Reverse"), "apart": Between(0.0, 0.3, usual=0.1)},
        script=lambda chosen: [
            READY,
            Do({"Forward": 1, "Reverse": 1}, at=1.0),
            Do({chosen.first: 0}, after=1.0),
            Do({other(chosen.first): 0}, after=chosen.apart),
            *press_stop(after=2.0),
            Do({chosen.first: 1}, after=1.0, hold=PRESS_S),
        ],
    ),
    Scenario(
        "stopped",
        "Buttons are pressed while Stop is held",
        seconds=10,
        choices={"way": OneOf("Forward", "Reverse")},
        script=lambda chosen: [
            Do({"StopPB": 0}, at=0.0),
            Do({chosen.way: 1}, at=1.0, hold=PRESS_S),
            Do({"StopPB": 1}, at=3.0),
            Do({chosen.way: 1}, at=5.0, hold=PRESS_S),
        ],
        draws=1,
    ),
    Scenario(
        "overload",
        "The shaft jams until the overload relay trips; later it is free and cool again",
        seconds=55,
        choices={"way": OneOf("Forward", "Reverse"), "after": Between(0.1, 4.0, usual=2.0)},
        script=lambda chosen: [
            READY,
            Do({chosen.way: 1}, at=1.0, hold=PRESS_S),
            Do(after=chosen.after, fail="jammed"),
            Do(when="not Healthy", after=3.0, mend="jammed"),
            Do(when="Healthy", after=4.0, set={chosen.way: 1}, hold=PRESS_S),
        ],
        draws=2,
    ),
    Scenario(
        "overload-other-way",
        "The same in reverse",
        seconds=20,
        script=[
            READY,
            Do({"Reverse": 1}, at=1.0, hold=PRESS_S),
            Do(after=2.0, fail="jammed"),
        ],
        draws=0,
    ),
)


def other(way):
    """The button of the other direction."""
    return {"Forward": "Reverse", "Reverse": "Forward"}[way]


RULES = (
    Never("never-both", "The contactors are never ON together", "RunF and RunR", needs="RunF or RunR"),
    Never("no-short", "There is no short circuit", "incidents", needs="RunF or RunR"),
    Within(
        "starts",
        "A press of Forward starts the motor forward",
        "rise(Forward) and not Reverse and StopPB and Healthy and not RunR",
        "RunF",
        0.1,
        unless=OFF,
    ),
    Within(
        "starts-reverse",
        "A press of Reverse starts it in reverse",
        "rise(Reverse) and not Forward and StopPB and Healthy and not RunF",
        "RunR",
        0.1,
        unless=OFF,
    ),
    Never(
        "holds",
        "It turns until StopPB or the overload relay opens",
        "(fall(RunF) or fall(RunR)) and StopPB and Healthy",
        needs=TURNS,
        expected="RunF and RunR stay on until StopPB or Healthy goes off, whatever else is pressed.",
    ),
    Never("stops", "It does not turn while Stop is pressed", f"{TURNS} and not StopPB", grace=1, needs=f"count{TURNS} > 0 and not StopPB"),
    Never(
        "overload",
        "It does not turn while the overload relay is open",
        f"{TURNS} and not Healthy",
        grace=1,
        needs="not Healthy",
    ),
    Never(
        "no-restart",
        "It starts by a button and not by itself",
        f"{TURNS} and not between(Forward or Reverse, {OFF})",
        grace=1,
        needs=f"count{TURNS} > 0 and not {TURNS}",
        expected="No contactor ON from Stop or an overload to the next press of a button.",
    ),
    Never(
        "together",
        "Both buttons pressed in the same moment start nothing",
        f"{TURNS} and between(rise(Forward) and rise(Reverse), not Forward or not Reverse)",
        grace=1,
        needs="Forward and Reverse",
        scenarios=("together",),
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Reversing drive",
    plant=Motor,
    quantities=("speed", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
