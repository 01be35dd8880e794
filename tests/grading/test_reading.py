"""Reading tasks: answers are held against what the program does, and the answers of the mixer against its statement."""

import pytest
from ecsim_exercises.mixer.read import READING

from ecsim import EcsimError

RIGHT = {  # from the manual's text and the machine's rates: 5 and 20 minutes, A first, A again, then B
    "waiting": "S0",
    "washing": {"Water", "Drain"},
    "wash": 300,
    "adding": {"AddA"},
    "stirring": 1200,
    "second": "S21",
    "washes": 2,
    "b": 1,
}


def test_the_right_answers_are_right():
    answered = READING.check(RIGHT)
    assert answered.right, str(answered)
    assert answered.score == (8, 8)


@pytest.mark.parametrize(
    ("name", "wrong"),
    [
        ("waiting", "S20"),
        ("washing", {"Water"}),
        ("wash", 30),
        ("adding", {"AddB"}),
        ("stirring", 1199),
        ("second", "S20"),
        ("washes", 3),
        ("b", 0),
    ],
)
def test_each_wrong_answer_is_found_and_told_where_to_look(name, wrong):
    answered = READING.check(RIGHT | {name: wrong})
    assert [row[0] for row in answered.rows if not row[2]] == [name]
    assert answered.score == (7, 8)
    (words,) = [row[3] for row in answered.rows if not row[2]]
    assert words == "not so. " + next(question.hint for question in READING.questions if question.name == name)


def test_what_is_not_answered_is_not_right():
    answered = READING.check({"b": 1})
    assert answered.score == (1, 8)
    assert "[ ] wash: not answered yet" in str(answered)
    assert "1 of 8 right" in answered._repr_html_()


def test_an_answer_of_another_form_is_refused():
    with pytest.raises(EcsimError, match="answer to washing is 'Water'; it is to be a set of names out of Water, Main"):
        READING.check({"washing": "Water"})
    with pytest.raises(EcsimError, match="answer to wash is '5 min'; it is to be a number"):
        READING.check({"wash": "5 min"})
    with pytest.raises(EcsimError, match="no question 'rinse'; there are waiting, washing"):
        READING.check({"rinse": 1})


def test_an_answer_is_told_when_it_is_asked_for():
    assert READING.show("washing") == "Water, Drain"
    assert READING.show("stirring").startswith("1200")
    with pytest.raises(EcsimError, match="no question 'rinse'"):
        READING.show("rinse")


def test_the_statement_carries_the_questions():
    assert all(f"**{question.name}**: {question.words}" in READING.statement for question in READING.questions)
