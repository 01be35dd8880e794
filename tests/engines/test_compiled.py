"""The generated Python: readable, cut into pieces, with a map back to the student's line."""

import gc
import linecache
import re

import pytest

from ecsim.engines.compiled import CHUNK
from ecsim.plc import Plc


def source(text):
    """What a program becomes."""
    plc = Plc("EC20")
    plc.load(text)
    return plc._engine.source


def body(text):
    """The lines of the main program without its head."""
    return [line.strip() for line in source(text).splitlines()[1:] if line.strip()]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LD X0\nOR Y0\nANI X1\nOUT Y0", ["# line 1", "Y[0] = (X[0] or Y[0]) and not X[1]"]),
        ("LD X0\nSET M0\nSET M1", ["# line 1", "f1 = X[0]", "if f1:", "M[0] = True", "M[1] = True"]),
        ("LD X0\nMOV D0 D1", ["# line 1", "if X[0]:", "D[1] = D[0]"]),
        ("LD X0\nAND X1\nLD X2\nAND X3\nORB\nOUT Y0", ["# line 1", "Y[0] = X[0] and X[1] or X[2] and X[3]"]),
    ],
)
def test_a_rung_becomes_a_line_of_python(text, expected):
    assert body(text) == expected


def test_the_lists_that_a_function_uses_are_its_parameters():
    assert source("LD X0\nOUT Y0").startswith("def unit_0(X=X, Y=Y):")


def test_a_long_program_is_cut_between_rungs():
    text = source("\n".join(f"LD X0\nAND M{n}\nOUT Y{n % 256:o}" for n in range(1000)))
    sizes = [part.count("# line") * 3 for part in re.split(r"^def ", text, flags=re.MULTILINE)[1:]]
    assert len(sizes) >= 3000 // CHUNK
    assert max(sizes) <= CHUNK + 3


def test_a_step_that_is_not_active_costs_two_tests():
    lines = body("LD SM1\nSET S0\nSTL S0\nOUT Y0\nTON T0 5\nLD X0\nOUT S0\nRET")
    place = lines.index("if S[0]:")
    slot = re.fullmatch(r"(E\[\d+\]) = True", lines[place + 1])[1]
    assert f"elif {slot}:" in lines
    assert lines[lines.index(f"elif {slot}:") + 1] == f"{slot} = False"


def test_the_source_can_be_read_while_its_plc_lives():
    plc = Plc("EC20")
    plc.load("LD X0\nOUT Y0")
    name = plc._engine.filename
    assert linecache.getline(name, 3).strip() == "Y[0] = X[0]"
    del plc
    gc.collect()
    assert linecache.getline(name, 3) == ""


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
@pytest.mark.parametrize("jump", ["", "LD X7\nCJ 1\nLBL 1\n"], ids=["without jumps", "with a jump"])
def test_a_bug_of_ours_names_the_students_line(engine, jump):
    text = f"{jump}// one\nLD SM0\nOUT Y0\n\nLD SM0\nADD D0 1 D1\nLD SM0\nOUT Y1"
    plc = Plc("EC20")
    plc.load(text)
    plc.engine = engine
    plc.run()
    plc.memory.lists["D"][0] = "no number"  # only a bug could do that
    line = text.split("\n").index("ADD D0 1 D1") + 1
    with pytest.raises(RuntimeError, match=r"a bug of ecsim met in the program's line (\d+): TypeError") as raised:
        plc.scan()
    told = int(re.search(r"line (\d+)", str(raised.value))[1])
    assert told in (line - 1, line)  # the rung's line where a rung is one statement


def test_a_program_with_jumps_becomes_segments():
    text = source("LD X0\nCJ 1\nLD X1\nOUT Y0\nLBL 1\nLD X2\nOUT Y1")
    assert text.count("def unit_0_") == 2
    assert "unit_0_parts = (unit_0_0, unit_0_1,)" in text
