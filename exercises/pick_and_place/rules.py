"""What happens to the arm when it is graded, and what every correct program does with it."""

from pathlib import Path

from ecsim.grading import Between, Do, Exercise, Lasts, Never, Scenario, Several, Within

from .picture import PICTURE
from .plant import Arm

READY = Do({"Auto": 1}, at=0.2)
TRAVELS = "(GoRight or GoLeft)"
FETCHES = "between(Auto and PartIn and AtLeft and IsUp, not AtLeft or fall(IsDown))"
HAND_OVER = 2  # scans: one for the switch to arrive, one for the step to hand over
ANSWER_S = 0.2
SHAPES = {"pauses": Several(Between(0.05, 4.0, usual=1.0), 1, 3), "clears": Between(0.1, 7.0, usual=1.0)}


def arm(chosen):
    """The machine as it was chosen."""
    return Arm(tuple(chosen.pauses), chosen.clears)


SCENARIOS = (
    Scenario(
        "parts",
        "Four parts, one after the other",
        seconds=60,
        choices=SHAPES,
        plant=arm,
        script=[READY],
        until="placed >= 4 and AtLeft",
        tail=3.0,
    ),
    Scenario(
        "anywhere",
        "The arm stands somewhere on its rail when it is switched on",
        seconds=20,
        choices={"carriage": Between(0.0, 1.0, usual=0.6)},
        plant=lambda chosen: Arm((1.0,), 1.0, chosen.carriage),
        script=[Do({"Auto": 1}, at=2.0)],
        until="placed >= 1 and AtLeft",
        draws=2,
    ),
    Scenario(
        "occupied",
        "Somebody is slow to take the parts away",
        seconds=50,
        choices={"clears": Between(6.0, 15.0, usual=8.0)},
        plant=lambda chosen: Arm((0.1,), chosen.clears),
        script=[READY],
        until="placed >= 3 and AtLeft",
        draws=2,
    ),
    Scenario(
        "slips",
        "A part slips out of the gripper as it closes, once or twice",
        seconds=30,
        choices={"seconds": Between(1.0, 3.6, usual=1.1), **SHAPES},
        plant=arm,
        script=lambda chosen: [
            READY,
            Do(fail="slips", when="placed >= 1"),
            Do(mend="slips", when="Grip and AtLeft and IsDown", after=chosen.seconds),
        ],
        until="placed >= 2 and AtLeft",
        draws=2,
    ),
    Scenario(
        "switched-off",
        "Auto is switched off with a part in the gripper, and on again later",
        seconds=30,
        choices={"after": Between(0.0, 5.0, usual=1.0), "off": Between(8.0, 10.0, usual=9.0)},
        plant=lambda chosen: Arm((0.5,), 1.0),
        script=lambda chosen: [READY, Do({"Auto": 0}, when="Gripped", after=chosen.after), Do({"Auto": 1}, after=chosen.off)],
        until="placed >= 2 and AtLeft",
        draws=3,
    ),
    Scenario(
        "off-at-first",
        "Parts wait, and Auto is not switched on yet",
        seconds=16,
        script=[Do({"Auto": 1}, at=5.0)],
        until="placed >= 1 and AtLeft",
        draws=0,
    ),
)

RULES = (
    Never("travels-up", "The carriage travels only while the arm is up", f"{TRAVELS} and not IsUp", grace=HAND_OVER, needs=TRAVELS),
    Never("one-way", "It is never driven both ways", "GoRight and GoLeft", needs="GoRight"),
    Never(
        "stops-at-the-end",
        "It does not drive against an end",
        "(GoRight and AtRight) or (GoLeft and AtLeft)",
        grace=HAND_OVER,
        needs=TRAVELS,
    ),
    Never("nothing-amiss", "Nothing is hit, and no part falls or is set on another one", "incidents", needs="Gripped"),
    Never(
        "with-a-part",
        "It travels to the right with a part only",
        "GoRight and not Gripped",
        grace=HAND_OVER,
        needs="GoRight or (IsUp and Grip)",
    ),
    Within(
        "comes-to-the-nest",
        "It goes above the nest and waits there",
        "Auto and IsUp and not Gripped and not AtLeft",
        "GoLeft",
        ANSWER_S,
        unless="not Auto",
    ),
    Never(
        "goes-on",
        "It does not stop on its way",
        f"Auto and IsUp and not AtLeft and not AtRight and not {TRAVELS}",
        grace=20,
        needs=f"IsUp and not AtLeft and not AtRight and {TRAVELS}",
    ),
    Within(
        "fetches",
        "A part in the nest is fetched",
        "Auto and PartIn and AtLeft and IsUp and not Gripped",
        "Down",
        ANSWER_S,
        unless="not Auto",
    ),
    Never(
        "nothing-to-fetch",
        "Above the nest it goes down for a part only, and in automatic only",
        f"Down and AtLeft and not {FETCHES}",
        needs="AtLeft and not Auto",
        expected="Down above the nest only while Auto and PartIn are ON.",
    ),
    Never(
        "down-at-the-ends", "It goes down above nest and place only", "Down and not AtLeft and not AtRight", grace=HAND_OVER, needs="Down"
    ),
    Never(
        "nothing-to-set-down",
        "It goes down to the place with a part only",
        "rise(Down) and AtRight and not Gripped",
        needs="Down and AtRight",
    ),
    Never("still", "Nothing moves before Auto is first switched on", f"({TRAVELS} or Down or Grip) and count(Auto) == 0", needs="Down"),
    Within("grips", "Down in the nest it grips", "AtLeft and IsDown and not Gripped", "Grip", ANSWER_S),
    Never("grips-below", "It does not close before it is down", "rise(Grip) and not IsDown", needs="Grip"),
    Lasts(
        "slipped",
        "It grips for 1 s, and opens if nothing was gripped",
        "Grip and AtLeft and IsDown and not Gripped",
        0.97,
        1.2,
        unless="Gripped",
        expected="Grip until Gripped, but for 1 s at most.",
    ),
    Within("gives-up", "A part that slipped is let go of, and the arm goes up", "fall(Grip) and AtLeft and IsDown", "not Down", ANSWER_S),
    Within("lifts", "What is gripped is lifted", "Gripped and AtLeft and IsDown", "not Down", ANSWER_S),
    Within("brings", "What is lifted goes to the right", "Gripped and AtLeft and IsUp", "GoRight", ANSWER_S),
    Never(
        "waits",
        "It does not go down while the place is not free",
        "rise(Down) and AtRight and not Free",
        needs="AtRight and Gripped and not Free",
    ),
    Within("sets-down", "It goes down when the place is free", "Gripped and AtRight and IsUp and Free", "Down", ANSWER_S),
    Never("opens", "Down on the place it opens", "AtRight and IsDown and Grip", grace=20, needs="AtRight and IsDown"),
    Lasts(
        "stays-open",
        "It goes up 0.3 s to 1 s after it has opened",
        "Down and AtRight and IsDown and not Grip",
        0.28,
        1.02,
        expected="Down for 0.3 s to 1 s after Grip went OFF above the place.",
    ),
    Within("brings-anyway", "Auto OFF: a part that is gripped is still brought", "Gripped and not Auto", "Free == 0 and not Gripped", 16.0),
    Within("returns", "From the place it goes back", "fall(Gripped) and AtRight and Auto", "AtLeft and IsUp", 4.5, unless="not Auto"),
)

EXERCISE = Exercise(
    folder=Path(__file__).parent,
    title="Pick and place",
    plant=Arm,
    quantities=("placed", "incidents"),
    scenarios=SCENARIOS,
    rules=RULES,
    picture=PICTURE,
)
