"""What happens at the garage when it is graded, and what every correct program does with the door."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Lasts, Never, Scenario, Within

from .picture import PICTURE
from .plant import Garage

PRESS_S = 0.3
MOVES = "(MoveUp or MoveDown)"
STEADY = [f"held({way} and {lamp}, 0.7)" for way in ("MoveUp", "MoveDown") for lamp in ("Lamp", "not Lamp")]


def press(**when):
    """The key, turned for a moment."""
    return Do({"Key": 1}, **when, hold=PRESS_S)


SCENARIOS = (
    Scenario(
        "car",
        "The door is opened for a car, and closes by itself",
        seconds=60,
        choices={"comes": Between(3.0, 25.0, usual=6.0), "pressed": Between(0.05, 3.0, usual=0.3)},
        plant=lambda chosen: Garage((chosen.comes,)),
        script=lambda chosen: [Do({"Key": 1}, at=2.0, hold=chosen.pressed)],
    ),
    Scenario(
        "key",
        "The key opens, stops, opens on, closes, and opens again",
        seconds=60,
        choices={"stop": Between(0.5, 6.0, usual=3.0), "turn": Between(0.5, 6.0, usual=3.0)},
        script=lambda chosen: [
            press(at=1.0),
            press(after=PRESS_S + chosen.stop),
            press(after=2.0),
            press(when="Open", after=2.0),
            press(after=PRESS_S + chosen.turn),
            press(when="Open", after=4.0),
        ],
    ),
    Scenario(
        "child",
        "Somebody steps into the doorway while the door closes",
        seconds=75,
        choices={"after": Between(0.1, 2.0, usual=1.0), "stays": Between(1.0, 12.0, usual=5.0)},
        script=lambda chosen: [
            press(at=1.0),
            press(when="Open", after=2.0),
            Do(when="MoveDown", after=chosen.after, fail="child"),
            Do(after=chosen.stays, mend="child"),
        ],
    ),
    Scenario(
        "in-the-way",
        "Somebody stands in the open doorway; the key is tried, and the 20 s begin anew when he goes",
        seconds=75,
        choices={"comes": Between(1.0, 18.0, usual=12.0), "stays": Between(2.0, 10.0, usual=4.0)},
        script=lambda chosen: [
            press(at=1.0),
            Do(when="Open", after=chosen.comes, fail="child"),
            press(after=1.0),
            Do(after=chosen.stays, mend="child"),
        ],
    ),
)

RULES = (
    Never("one-way", "The motor is never driven both ways", "MoveUp and MoveDown", needs="MoveUp"),
    Never("waits-for-key", "Nothing moves before the key is used", f"{MOVES} and count(Key) == 0", grace=1, needs="MoveUp"),
    Within("opens", "A press opens the closed door", "rise(Key) and count(Key) == 1", "MoveUp", 0.2),
    Never(
        "opens-fully",
        "One press, however long, opens it all the way",
        "not MoveUp and between(MoveUp, Open)",
        grace=2,
        needs="MoveUp",
        scenarios=("car", "in-the-way"),
    ),
    Within("opens-on", "A press opens the door that was stopped", "rise(Key) and count(Key) == 3", "MoveUp", 0.2, scenarios=("key",)),
    Within("key-stops", "A press stops the opening door", "rise(Key) and count(Key) == 2", "not MoveUp", 0.2, scenarios=("key",)),
    Never(
        "stays-stopped",
        "It stays where it was stopped until the next press",
        f"{MOVES} and count(Key) == 2",
        grace=2,
        needs="count(Key) == 2",
        scenarios=("key",),
    ),
    Within("closes", "A press closes the open door", "rise(Key) and count(Key) == 4", "MoveDown", 0.2, scenarios=("key",)),
    Within("turns", "A press opens the closing door again", "rise(Key) and count(Key) == 5", "MoveUp", 0.6, scenarios=("key",)),
    Within(
        "closes-by-itself",
        "After 20 s with nothing in the way it closes",
        "rise(held(Open and Barrier, 20))",
        "MoveDown",
        0.5,
        unless="Key or not Barrier",
    ),
    Never(
        "waits",
        "It does not close earlier by itself",
        "rise(MoveDown) and not held(Open and Barrier, 19.8)",
        needs="MoveDown",
        scenarios=("car",),
    ),
    Never(
        "waits-anew",
        "The 20 s begin anew when something was in the way",
        "rise(MoveDown) and not held(Barrier, 19.8) and not Key",
        needs="count(MoveDown) > 0",
        scenarios=("in-the-way",),
    ),
    Never("not-in-the-way", "It does not close while something is in the way", "MoveDown and not Barrier", grace=1, needs="not Barrier"),
    Within(
        "opens-again",
        "The barrier opens the closing door again",
        "fall(Barrier) and count(MoveDown) > 0 and not Open",
        "MoveUp",
        0.6,
        scenarios=("child",),
    ),
    Never("nobody-hurt", "Nobody is hit, and nothing is bent", "incidents", needs="MoveDown"),
    Never("stops-open", "The motor stops when the door is open", "MoveUp and Open", grace=1, needs="Open"),
    Never(
        "stops-closed", "The motor stops when the door is closed", "MoveDown and Closed", grace=1, needs="count(MoveDown) > 0 and Closed"
    ),
    Never(
        "stays-closed",
        "Closed, it stays so until the next press",
        f"{MOVES} and between(rise(Closed), rise(Key))",
        grace=2,
        needs="rise(Closed)",
    ),
    Never("lamp", "The lamp blinks while the door moves", " or ".join(STEADY), needs="Lamp"),
    Lasts(
        "lamp-beat",
        "It blinks once a second",
        f"between(rise(Lamp) and held({MOVES}, 0.1), fall(Lamp))",
        0.4,
        0.6,
        unless="not (held(MoveUp, 0.1) or held(MoveDown, 0.1))",
    ),
    Never("lamp-off", "The lamp is dark while the door stands", f"Lamp and held(not {MOVES}, 0.1)", needs="Lamp"),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Garage door",
    plant=lambda: Garage((20.0, 70.0, 95.0)),
    quantities=("place", "through", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
