"""What is asked about the pallet lift's program."""

from pathlib import Path

from ecsim.grading.reading import HowLong, HowOften, Reading, What, Which

from ..rules import EXERCISE

OUTPUTS = ("Gate", "LiftL", "LiftR", "Rollers", "BeltL", "BeltR")

READING = Reading(
    folder=Path(__file__).parent,
    title="Pallet lift: read",
    exercise=EXERCISE,
    scenario=EXERCISE.scenarios[0],
    questions=(
        Which("before", "Which outputs are ON at 0.5 s?", "What is Running before Start is pressed?", at=0.5, among=OUTPUTS),
        What(
            "waiting",
            "Which step is active at 3 s?",
            "Start was pressed at 1 s; the first pallet comes to the entrance at 3.8 s.",
            lane="Step",
            at=3.0,
        ),
        Which("belts", "Which outputs are ON at 3 s?", "Which outputs belong to no step?", at=3.0, among=OUTPUTS),
        Which(
            "lifting",
            "Which outputs are ON a tenth of a second after the first pallet is fully on the left lift?",
            "InLift ends S20. What holds the gate down in S20, and what raises the lifts in S21?",
            at="held(InLift, 0.1)",
            among=OUTPUTS,
        ),
        HowLong(
            "rolling", "For how many seconds do the rollers turn, each time?", "They carry the pallet from X1 to X3.", condition="Rollers"
        ),
        HowLong(
            "lifted",
            "For how many seconds is LiftL ON, each time?",
            "It is set in S21 and reset in S23: the time of two steps.",
            condition="LiftL",
        ),
        What(
            "next",
            "Which step is active a tenth of a second after the first pallet has left X4, with the second one at the entrance?",
            "S23 goes back to S0. What is S0 waiting for, and is it there?",
            lane="Step",
            at="held(not Leaving and count(Leaving) == 1, 0.1)",
        ),
        HowOften(
            "gates",
            "How often does the gate go down in the whole run, with the fourth pallet?",
            "The cycle ends with X4, not when the pallet has left the machine.",
            event="Gate",
        ),
    ),
)
