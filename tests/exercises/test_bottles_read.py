"""The bottle machine to be read: the answers follow from the statement's times and bottles."""

from ecsim_exercises.bottles.read import READING

RIGHT = {
    "begin": "S33",
    "first": {"Reject"},  # nothing has been judged, so the mark is OFF
    "stroke": 0.6,
    "stand": 1.2,  # out and back of the capper
    "fourth": {"Capper", "Labeller"},  # bottle 1 is good and stays
    "caps": 6,  # seven places, one gap
    "labels": 5,  # and one crooked cap
    "passed": 4,  # and one wrong label
    "rejects": 8,  # twelve stations without those four
}


def test_the_right_answers_are_right():
    answered = READING.check(RIGHT)
    assert answered.right, str(answered)
    assert answered.score == (9, 9)


def test_the_programs_to_be_read_and_to_be_written_are_the_same_but_for_their_first_line():
    assert READING.program.splitlines()[1:] == READING.exercise.solution.splitlines()[1:]
