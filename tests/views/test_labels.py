"""What the parts of a program are called."""

import pytest

import ecsim
from ecsim.views.labels import Labels, contact_words
from ecsim.views.rungs import rungs


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("LD X1", "X1, normally open"),
        ("LDI X1", "X1, normally closed"),
        ("BLD D0 3", "D0.3, normally open"),
        ("BLDI K4M0 D1", "K4M0.D1, normally closed"),
        ("LD< D0 12", "D0 < 12"),
    ],
)
def test_a_contact_is_told_in_words(line, words):
    unit = ecsim.compile(f"{line}\nOUT Y0", "EC20").main
    (rung,) = rungs(unit)
    contact = rung.flow.items[0]
    assert contact_words(contact.word, Labels(unit)) == words
