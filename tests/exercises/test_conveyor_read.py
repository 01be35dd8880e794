"""The pallet lift to be read: the answers follow from the statement's times and lengths."""

from ecsim_exercises.conveyor.read import READING

RIGHT = {
    "before": set(),
    "waiting": "S0",
    "belts": {"BeltL", "BeltR"},
    "lifting": {"LiftL", "LiftR", "BeltL", "BeltR"},
    "rolling": 2.5,  # 1.5 m at 0.6 m/s
    "lifted": 3.7,  # and 1.2 s up before
    "next": "S20",
    "gates": 4,
}


def test_the_right_answers_are_right():
    answered = READING.check(RIGHT)
    assert answered.right, str(answered)
    assert answered.score == (8, 8)


def test_the_programs_to_be_read_and_to_be_written_are_the_same_but_for_their_first_line():
    assert READING.program.splitlines()[1:] == READING.exercise.solution.splitlines()[1:]
