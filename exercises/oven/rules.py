"""What happens to the oven when it is graded, and what every correct program does with it."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

from ecsim.grading import Between, Custom, Do, Exercise, Never, OneOf, Scenario, Within
from ecsim.grading.run import Trace

from .picture import PICTURE
from .plant import Oven

NEAR = "(Temp >= Goal - 20 and Temp <= Goal + 20)"
STEADY = f"held({NEAR}, 60)"
REST_S = 1.9  # the relay rests so long from one start to the next; 2 s in the statement
GOALS = Between(120.0, 200.0, usual=180.0, digits=0)
MIDDLE = 1600  # between the two goals of a scenario
LOW, HIGH = Between(120.0, 140.0, usual=130.0, digits=0), Between(180.0, 200.0, usual=190.0, digits=0)


def begin(goal):
    """The goal on the screen, and the switch ON a second later."""
    return [Do({"Goal": round(10 * goal)}, at=0.0), Do({"On": 1}, at=1.0)]


def press(**when):
    """The button Reset, pressed for a moment."""
    return Do({"Reset": 1}, **when, hold=0.5)


SCENARIOS = (
    Scenario(
        "warm-up",
        "The cold oven is switched on",
        seconds=960,
        choices={"goal": GOALS, "room": Between(10.0, 30.0, usual=20.0, digits=0)},
        plant=lambda chosen: Oven(chosen.room),
        script=lambda chosen: begin(chosen.goal),
        draws=1,
    ),
    Scenario(
        "goal",
        "Another goal is set on the screen",
        seconds=1180,
        choices={"low": LOW, "high": HIGH, "first": OneOf("low", "high")},
        plant=lambda chosen: Oven(warm=chosen.low - 30),
        script=lambda chosen: [
            *begin(chosen.low if chosen.first == "low" else chosen.high),
            Do({"Goal": round(10 * (chosen.high if chosen.first == "low" else chosen.low))}, at=500.0),
        ],
        draws=1,
    ),
    Scenario(
        "door",
        "The door stands open for a while",
        seconds=1080,
        choices={"goal": GOALS, "open_s": Between(10.0, 40.0, usual=30.0, digits=0)},
        plant=lambda chosen: Oven(warm=chosen.goal - 30),
        script=lambda chosen: [
            *begin(chosen.goal),
            Do(fail="door open", at=400.0),
            Do(mend="door open", at=400.0 + chosen.open_s),
        ],
        draws=1,
    ),
    Scenario(
        "switch",
        "It is switched off on its way and on again, also with the door open",
        seconds=120,
        choices={"off": Between(5.0, 40.0, usual=20.0, digits=1)},
        script=lambda chosen: [
            *begin(180.0),
            Do({"On": 0}, at=1.0 + chosen.off),
            Do({"On": 1}, at=60.0),
            Do(fail="door open", at=75.0),
            Do({"On": 0}, at=80.0),
            Do({"On": 1}, at=90.0),
            Do(mend="door open", at=100.0),
        ],
        draws=1,
    ),
    Scenario(
        "welded",
        "The relay stays closed; Reset is tried too early, and again when the relay is mended",
        seconds=500,
        choices={"goal": GOALS, "welds": Between(20.0, 60.0, usual=30.0, digits=0)},
        plant=lambda chosen: Oven(warm=chosen.goal),
        script=lambda chosen: [
            *begin(chosen.goal),
            Do(fail="relay welded", at=chosen.welds),
            press(when="Temp > 2530", after=2.0),
            Do(mend="relay welded", when="Temp < 2400"),
            Do({"On": 0}, after=3.0),
            Do({"On": 1}, after=3.0),
            press(after=3.0),
        ],
        draws=1,
    ),
    Scenario(
        "no-sensor",
        "The sensor's wire breaks; Reset is tried too early, and again when it is mended",
        seconds=150,
        choices={"breaks": Between(10.0, 40.0, usual=30.0, digits=1)},
        plant=lambda chosen: Oven(warm=100.0),
        script=lambda chosen: [
            *begin(180.0),
            Do(fail="sensor broken", at=chosen.breaks),
            press(at=50.0),
            Do(mend="sensor broken", at=60.0),
            press(at=75.0),
        ],
        draws=1,
    ),
    Scenario(
        "lamp",
        "The heater is dead, the temperature stands still, and the goal goes round it by tenths of a degree",
        seconds=35,
        choices={"still": Between(140.0, 180.0, usual=150.0, digits=1)},
        plant=lambda chosen: Oven(room=chosen.still),
        script=lambda chosen: [
            Do(fail="element broken", at=0.0),
            *begin(chosen.still),
            *[Do({"Goal": round(10 * chosen.still) + more}, at=5.0 * place) for place, more in enumerate((20, 21, -20, -21, 0), 1)],
        ],
        draws=1,
    ),
    Scenario(
        "limit",
        "It stands at 250.0 degrees, no more and no less",
        seconds=10,
        plant=lambda chosen: Oven(room=250.0),
        script=begin(180.0),
    ),
)


def relay_rests(trace: Trace) -> Iterator[tuple[int, int, str]]:
    """Two starts of the heater that follow each other too fast; the first one behind switch or door stands alone."""
    heated = [start for start, _ in trace.intervals("Heater")]
    for begin, end in trace.intervals("Main and Door"):
        starts = [start for start in heated if begin <= start < end][1:]
        for before, after in pairwise(starts):
            seconds = (after - before) * trace.period_s
            if seconds < REST_S:
                yield before, after, f"Heater turned ON again after {seconds:.1f} s."


RULES = (
    Within("heats", "Switched on, a cold oven heats", "rise(On) and Door and Temp < Goal - 100 and not Alarm", "Heater and Main", 5.0),
    Within(
        "reaches",
        "It reaches its goal and stays within 2 degrees of it",
        "rise(On) and Temp < Goal - 200",
        STEADY,
        600 + 60,
        scenarios=("warm-up",),
        expected="Within 2.0 degrees of the goal for a minute, from 10 minutes behind the start on at the latest.",
    ),
    Never(
        "overshoot",
        "It does not overshoot by more than 10 degrees",
        "Temp > Goal + 100",
        scenarios=("warm-up", "door"),
        needs=STEADY,
        expected="Never more than 10.0 degrees above the goal.",
    ),
    Never(
        "overshoot-goal",
        "It does not overshoot a higher goal by more than 10 degrees either",
        f"Temp > Goal + 100 and Goal > {MIDDLE}",
        scenarios=("goal",),
        needs=STEADY,
        expected="Never more than 10.0 degrees above the goal.",
    ),
    Never(
        "holds",
        "It holds its temperature within 2 degrees",
        f"not {NEAR} and count({STEADY}) > 0",
        scenarios=("warm-up",),
        needs=STEADY,
        expected="Once it was within 2.0 degrees of the goal for a minute, it stays there.",
    ),
    Within(
        "follows",
        "It follows another goal",
        f"On and (rise(Goal > {MIDDLE}) or fall(Goal > {MIDDLE})) and count({NEAR}) > 0",
        STEADY,
        600 + 60,
        scenarios=("goal",),
        expected="Within 2.0 degrees of the new goal for a minute, from 10 minutes behind the change on at the latest.",
    ),
    Within(
        "recovers",
        "Behind the door it comes back",
        "rise(Door) and On and Temp < Goal - 100",
        STEADY,
        480 + 60,
        scenarios=("door",),
        expected="Within 2.0 degrees of the goal for a minute, from 8 minutes behind the closing of the door on at the latest.",
    ),
    Custom(
        "relay",
        "The relay turns ON at most once in 2 s",
        relay_rests,
        watch=("Heater",),
        needs="fall(Heater)",
        expected="2 s at least from one start of Heater to the next.",
    ),
    Never("door", "With the door open nothing heats", "Heater and held(not Door, 0.5)", needs="count(Heater) > 0 and not Door"),
    Never("off", "Switched off, nothing heats", "(Heater or Main) and held(not On, 0.3)", needs="count(Main) > 0 and not On"),
    Within(
        "on-again",
        "Switched on again, it heats again",
        "rise(On) and count(On) > 1 and Door and not Alarm",
        "Heater and Main",
        5.0,
        scenarios=("switch",),
    ),
    Within(
        "cut-off",
        "From 250 degrees on, and without its sensor, the heat is cut off",
        "Temp >= 2500",
        "Alarm and not Main and not Heater",
        1.0,
        expected="Alarm ON, Main and Heater OFF within 1 s of 250.0 degrees.",
    ),
    Never("burns", "Nothing burns", "incidents", needs="Temp > Goal"),
    Never("alarm-off", "While Alarm is ON nothing heats", "held(Alarm, 0.3) and (Heater or Main)", needs="Alarm"),
    Never(
        "alarm-stays",
        "Alarm stays ON until Reset is pressed",
        "fall(Alarm) and not Reset",
        needs="Alarm",
    ),
    Never(
        "alarm-cause",
        "Alarm stays ON as long as its cause lasts",
        "not Alarm and held(Temp >= 2500, 1.2)",
        needs="Alarm and Reset",
    ),
    Never("no-alarm", "There is no alarm without a cause", "rise(Alarm) and Temp < 2450", needs="Main"),
    Within(
        "resets",
        "With the cause gone Reset ends the alarm",
        "rise(Reset) and Temp < 2450",
        "not Alarm",
        0.5,
        scenarios=("welded", "no-sensor"),
    ),
    Within("goes-on", "Then it heats again", "fall(Alarm) and On", "Main", 1.0),
    Never(
        "ready-lit",
        "Ready is lit while it has its temperature",
        f"not Ready and held(Main and {NEAR}, 1.5)",
        needs="Ready",
        expected="Ready ON within 1.5 s, while Main is ON and the goal is missed by 2.0 degrees at most.",
    ),
    Never(
        "ready-dark",
        "Ready is dark while it has not",
        f"Ready and held(not Main or not {NEAR}, 1.5)",
        needs="Ready",
        expected="Ready OFF within 1.5 s, while Main is OFF or the goal is missed by more than 2.0 degrees.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Oven",
    plant=Oven,
    quantities=("incidents",),
    scenarios=SCENARIOS,
    rules=RULES,
    scan_ms=100,
    picture=PICTURE,
)
