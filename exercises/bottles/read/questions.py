"""What is asked about the bottle machine's program."""

from pathlib import Path

from ecsim.grading import Scenario
from ecsim.grading.reading import HowLong, HowOften, Reading, What, Which

from ..plant import BottleMachine
from ..rules import EXERCISE

OUTPUTS = ("Table", "Capper", "Labeller", "Reject")
BOTTLES = ("good", "good", "bad cap", "gap", "good", "bad label", "good")

READING = Reading(
    folder=Path(__file__).parent,
    title="Bottle machine: read",
    exercise=EXERCISE,
    scenario=Scenario(
        "seven",
        "Seven places, then empty ones",
        seconds=40,
        plant=lambda chosen: BottleMachine((*BOTTLES, *("gap",) * 9)),
        until="turned >= 12",
        tail=1.5,
    ),
    questions=(
        What("begin", "Which step is active at 0.5 s?", "The cylinders are home at power-on. What does S0 wait for?", lane="Step", at=0.5),
        Which(
            "first",
            "Which outputs are ON at 1.3 s? The table has reached its first station at 1 s.",
            "No bottle has been judged yet. What is M3 then, and what does S26 make of it?",
            at=1.3,
            among=OUTPUTS,
        ),
        HowLong(
            "stroke",
            "For how many seconds is the capper ON, the first time?",
            "What ends S21, and what does Y1 do in S22?",
            condition="Capper",
        ),
        HowLong(
            "stand",
            "For how many seconds does the table stand at the second station, with bottle 1 at the capper?",
            "The three branches run side by side: which is the longest, out and back?",
            condition="turned == 2 and not Table",
            give=0.15,
        ),
        Which(
            "fourth",
            "Which outputs are ON when the table stands at the fourth station and the capper has begun?",
            "Bottle 3 is at the capper, 2 at the labeller, 1 at the reject cylinder. What did S29 make of the marks?",
            at="turned == 4 and Capper and not Table",
            among=OUTPUTS,
        ),
        HowOften("caps", "How often does the capper work in the whole run?", "Once for each bottle that comes.", event="Capper"),
        HowOften("labels", "How often does the labeller work?", "M2 is the mark of a bottle whose cap was straight.", event="Labeller"),
        What(
            "passed",
            "How many bottles have left by the exit at the end?",
            "One has a crooked cap, one a wrong label.",
            lane="passed",
            at="turned == 12",
        ),
        HowOften(
            "rejects",
            "How often does the reject cylinder work, at the twelve stations of the run?",
            "M3 is OFF for a faulty bottle, and for what else?",
            event="Reject",
        ),
    ),
)
