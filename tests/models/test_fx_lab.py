"""An H2U goes through what every PLC goes through: saving, history, the command line, the lab's panels, completion."""

import subprocess
import sys

import pytest

import ecsim
from ecsim import Session

PROGRAM = """
LD X0
OUT Y17
LD M8013
OUT T0 K10
LD T0
OUT C0 K5
LD M8000
MOV K3 Z0
MOV D8010 D10Z0
RS D100 K3 D200 K4
OUT C235 K9
OUT C255 K100
EI
LD M8002
SET S0
STL S0
OUT Y1
LD X1
SET S20
STL S20
OUT Y2
RET
FEND
I610
LD M8000
INC D0
IRET
"""


def machine():
    """A PLC in RUN with a bit of everything."""
    plc = ecsim.Plc("H2U", input_filter_ms=0)
    plc.load(PROGRAM)
    plc.run()
    return plc


def test_a_saved_one_goes_on_where_it_was(tmp_path):
    plc = machine()
    plc["X0"] = 1
    plc.pulse("X0", 30, ms=200)
    plc.scan(7)
    plc.save(tmp_path / "plc")
    other = ecsim.Plc.open(tmp_path / "plc")
    assert other.model.name == "H2U"
    plc.scan(60)
    other.scan(60)
    assert other.memory.snapshot() == plc.memory.snapshot()
    assert other["D0"] == 67


def test_a_session_goes_back_and_comes_to_the_same():
    session = Session(machine())
    session.scan(5)
    session.set("X1", 1)
    session.scan(40)
    there = session.plc.memory.snapshot()
    session.back(30)
    assert session.plc["D0"] == 15
    session.scan(30)
    assert session.plc.memory.snapshot() == there
    session.stop()


def test_a_shell_runs_it(tmp_path):
    path = tmp_path / "p.il"
    path.write_text(PROGRAM, encoding="utf-8")
    done = subprocess.run([sys.executable, "-m", "ecsim", "run", "--model", "H2U", path, "--ms", "100"], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("H2U RUN")
    assert "  Y17    0" in done.stdout


@pytest.mark.parametrize("panel", ["unit", "devices", "timers", "ladder", "chart", "trace", "editor"])
def test_each_panel_shows_it(panel):
    lab_of = pytest.importorskip("ecsim_widgets").Lab
    lab = lab_of(machine())
    shown = lab.panel(panel)
    assert shown.parts
    for part in shown.parts.values():
        assert part.layout() is not None
        assert part.frame() is not None
    if panel == "unit":
        layout = shown.parts["unit"].layout()
        assert layout["model"] == "H2U"
        assert [row["device"] for row in layout["outputs"]][7:9] == ["Y7", "Y10"]
    lab.session.stop()


def test_the_unused_device_that_is_offered_is_told_with_the_runs_of_its_area():
    assist = pytest.importorskip("ecsim_widgets.assist")
    offered = {option.text: option for option in assist.Place("LD M0\nOUT M", 11, ecsim.Plc("H2U").model).options()}
    assert offered["M1"].about == "the first one unused, of M0 to M3071 and M8000 to M8255"
