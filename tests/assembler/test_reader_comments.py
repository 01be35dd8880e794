"""Comments of the two kinds, and what looks like the beginning of one inside the other."""

import pytest

from ecsim.assembler import assemble


@pytest.mark.parametrize(
    "text", ["//* note\nLD X0\nOUT Y0", "LD X0 //* note\nOUT Y0", "LD X0 // (* note\nOUT Y0", "LD X0\nOUT Y0 // a /* b"]
)
def test_a_line_comment_may_hold_the_begin_of_a_block_comment(text):
    assert [i.mnemonic for i in assemble(text, "EC20").instructions] == ["LD", "OUT"]


def test_a_block_comment_may_hold_slashes():
    assert [i.mnemonic for i in assemble("LD X0 /* a // b */\nOUT Y0", "EC20").instructions] == ["LD", "OUT"]
