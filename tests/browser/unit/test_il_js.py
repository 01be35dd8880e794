"""il.js: a line of instruction list as tokens."""

import pytest

pytestmark = pytest.mark.browser

LINES = {
    "LD X0": "op:LD device:X0",
    "  tonr t3, 16#1F // slow": "op:tonr device:t3 number:16#1F comment:// slow",
    "STL S20": "step:STL step:S20",
    "SET S21": "op:SET step:S21",
    "MOV K4M0 D0Z1": "op:MOV device:K4M0 device:D0Z1",
    "LD Start": "op:LD name:Start",
    "MOV -5 #OUT1": "op:MOV number:-5 name:#OUT1",
    "RMOV 1.5E3 D10": "op:RMOV number:1.5E3 device:D10",
    "INTERRUPT INT_1 EVENT 26": "keyword:INTERRUPT name:INT_1 keyword:EVENT number:26",
    "VAR_INPUT IN1 : INT": "keyword:VAR_INPUT name:IN1 keyword:: keyword:INT",
    "END_PROGRAM": "keyword:END_PROGRAM",
    "LD (* a *) X0 /* b": "op:LD comment:(* a *) device:X0 comment:/* b",
    "// LD X0": "comment:// LD X0",
    "%%il --lab a": "keyword:%%il --lab a",
}


def tokens(bench, line, before=()):
    """The tokens of a line as words, after other lines."""
    return bench.js(
        """([line, before]) => {
          let open;
          for (const each of before) ({ open } = ilTokens(each, open));
          const { tokens } = ilTokens(line, open);
          if (tokens.map(([, text]) => text).join('') !== line) throw new Error('the tokens are not the line');
          return tokens.filter(([kind]) => kind).map(([kind, text]) => `${kind}:${text}`).join(' ');
        }""",
        [line, list(before)],
    )


def test_a_line_is_its_words_by_their_kind(bench):
    assert {line: tokens(bench, line) for line in LINES} == LINES


def test_a_block_comment_goes_on_until_its_end(bench):
    assert tokens(bench, "LD X0 */ OUT Y0", ["/* begin", "more"]) == "comment:LD X0 */ op:OUT device:Y0"
    assert tokens(bench, "LD X0", ["/* one */"]) == "op:LD device:X0"
    assert tokens(bench, "*) LD X0", ["(*"]) == "comment:*) op:LD device:X0"


def test_a_table_of_variables_names_first_and_ends(bench):
    assert tokens(bench, "Start AT X5", ["VAR_GLOBAL"]) == "name:Start keyword:AT device:X5"
    assert tokens(bench, "LD X5", ["VAR_GLOBAL", "Start AT X5", "END_VAR"]) == "op:LD device:X5"
