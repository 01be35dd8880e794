"""What happens to the pallet lift when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Count, Do, Exercise, Never, OneOf, Order, Scenario, Several, Within

from .picture import PICTURE
from .plant import GATE, Conveyor

ARMED = "between(rise(Start), Emerg)"  # from a press of Start to the emergency switch
UNDER_WAY = "between(rise(InLift), fall(Leaving) or Emerg)"  # a pallet is on the lift or leaves
PRESS_S = 0.2

SCENARIOS = (
    Scenario(
        "pallets",
        "Pallets come at changing distances",
        seconds=100,
        choices={
            "start": Between(0.5, 4.0, usual=1.0),
            "first": Between(0.5, GATE, usual=1.8),
            "distances": Several(Between(0.0, 5.0), 2, 4, usual=[0.5, 3.0]),
        },
        plant=lambda chosen: Conveyor(tuple(chosen.distances), chosen.first),
        script=lambda chosen: [Do({"Start": 1}, at=chosen.start, hold=PRESS_S)],
        until="delivered >= 3",
    ),
    Scenario(
        "close",
        "Pallets come one touching the other, and the first waits at the gate before Start",
        seconds=60,
        plant=lambda chosen: Conveyor((0.0,), GATE),
        script=[Do({"Start": 1}, at=5.0, hold=PRESS_S)],
        until="delivered >= 2",
    ),
    Scenario(
        "emergency",
        "The emergency switch is pressed in the middle of it, and later Start again",
        seconds=60,
        choices={
            "moment": OneOf("Rollers", "LiftL", "Gate", "Leaving", "InLift", "Across"),
            "after": Between(0.0, 1.5, usual=0.3),
            "pressed": Between(0.3, 3.0, usual=1.0),
            "held": OneOf(False, True),
        },
        script=lambda chosen: [
            Do({"Start": 1}, at=1.0, hold=None if chosen.held else PRESS_S),
            Do({"Emerg": 1}, when=chosen.moment, after=chosen.after, hold=chosen.pressed),
            Do({"Start": 0}, after=chosen.pressed + 2.0),
            Do({"Start": 1}, after=0.5, hold=PRESS_S),
            Do(after=3.0),
        ],
        draws=8,
    ),
)
NORMAL = ("pallets", "close")

RULES = (
    Never(
        "waits-for-start",
        "Nothing moves before Start, and after the emergency switch not before a new press of Start",
        f"(Gate or LiftL or LiftR or Rollers or BeltL or BeltR) and not {ARMED}",
        grace=2,
        needs="BeltL",
        expected="No output ON before Start is pressed, and none from the emergency switch to the next press of Start.",
    ),
    Within("belts-run", "From Start on both belts run", f"rise(Start) and not Emerg and {ARMED}", "BeltL and BeltR", 0.5, unless="Emerg"),
    Never(
        "belts-stay",
        "The belts run without a break",
        f"between(BeltL and BeltR, Emerg) and {ARMED} and not (BeltL and BeltR)",
        grace=2,
        needs="BeltL and BeltR",
        expected="Both belts ON from Start to the emergency switch.",
    ),
    Within(
        "lets-in",
        "A pallet at the entrance is let in when no other one is under way",
        f"AtEntry and {ARMED} and not {UNDER_WAY}",
        "Gate",
        1.0,
        unless="Emerg",
        expected="The gate goes down within 1 s.",
    ),
    Never(
        "one-at-a-time",
        "The gate opens for no pallet while the one before it is on its way from X1 to the falling edge of X4",
        f"Gate and {UNDER_WAY}",
        grace=2,
        needs="Gate",
        expected="Gate off from the moment InLift comes ON until Leaving has gone OFF again, but for the scan of a hand-over.",
    ),
    Within(
        "lifts", "Both lifts go up when the pallet is fully on the left lift", f"rise(InLift) and {ARMED}", "LiftL and LiftR", 1.0, "Emerg"
    ),
    Within("rolls", "With both lifts up the rollers turn", f"rise(Up) and {ARMED}", "Rollers", 1.0, unless="Emerg"),
    Never(
        "lifts-stay",
        "The lifts stay up until the pallet is across",
        f"between(rise(Up) and {ARMED}, Across or Emerg) and not (LiftL and LiftR)",
        grace=2,
        needs="Up",
        expected="Both lifts ON from the moment they are up until Across.",
    ),
    Never(
        "rollers-up",
        "The rollers turn only while the lifts are up",
        "Rollers and not Up",
        grace=2,
        needs="Rollers",
        expected="Rollers off while Up is off, but for the scan of a hand-over.",
    ),
    Within(
        "lowers",
        "Both lifts go down when the pallet is across",
        f"rise(Across) and {ARMED}",
        "not LiftL and not LiftR",
        1.0,
        unless="Emerg",
    ),
    Order(
        "sequence",
        "Gate, lifts up, rollers, lifts down: in this order, once for each pallet",
        ("Gate", "LiftL or LiftR", "Rollers", "not LiftL and not LiftR and between(Rollers, Gate or Emerg)"),
        restart="Emerg",
        expected="Gate, then the lifts, then the rollers, then the lifts down, and from the start again.",
    ),
    Never(
        "nothing-amiss", "No pallet tips, runs into another one or is caught by the gate", "incidents", needs="Leaving", scenarios=NORMAL
    ),
    Count(
        "goes-on",
        "One pallet after the other is delivered, without another Start",
        "fall(Leaving)",
        least=2,
        scenarios=NORMAL,
        expected="Two pallets and more have left the machine.",
    ),
    Never(
        "emergency",
        "The emergency switch stops everything",
        "Emerg and (Gate or LiftL or LiftR or Rollers or BeltL or BeltR)",
        grace=2,
        needs="Emerg and not BeltL",
        expected="No output ON while the emergency switch is pressed.",
    ),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Pallet lift",
    plant=Conveyor,
    quantities=("delivered", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
