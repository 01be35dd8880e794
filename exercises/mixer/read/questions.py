"""What is asked about the mixer's program."""

from pathlib import Path

from ecsim.grading.reading import HowLong, HowOften, Reading, What, Which

from ..rules import EXERCISE

OUTPUTS = ("Water", "Main", "AddA", "AddB", "Drain", "Stirrer")

READING = Reading(
    folder=Path(__file__).parent,
    title="Mixer: read",
    exercise=EXERCISE,
    scenario=EXERCISE.scenarios[0],
    questions=(
        What("waiting", "Which step is active at 3 s?", "Look at what SM1 does.", lane="Step", at=3.0),
        Which("washing", "Which outputs are ON at 100 s?", "A batch was started at 6 s: is it the first one?", at=100.0, among=OUTPUTS),
        HowLong("wash", "For how many seconds is the water on, the first time?", "T0 counts in 100 ms.", condition="Water", give=0.3),
        Which(
            "adding",
            "Which outputs are ON when the weight reaches 2,100 kg for the first time?",
            "Which step follows the main material when the product is A?",
            at="Weight >= 2100",
            among=OUTPUTS,
        ),
        HowLong(
            "stirring", "For how many seconds does the stirrer turn, each time?", "Read the preset of T1.", condition="Stirrer", give=0.3
        ),
        What(
            "second",
            "Which step becomes active when the second batch is started?",
            "What does Last hold by then, and which of the two transitions of S0 is true?",
            lane="Step",
            at="count(Main) == 2",
        ),
        HowOften("washes", "How often is the vessel washed in the whole run?", "Three batches: A, A, B.", event="Water and Drain"),
        HowOften("b", "How often does additive B come?", "One branch is taken in each batch.", event="AddB"),
    ),
)
