"""The cell magic %%il: what a cell gives, what it does with a lab, and what is completed in it."""

import gc

import pytest
from ecsim_widgets import Lab
from IPython.core.error import UsageError
from IPython.core.interactiveshell import InteractiveShell

from ecsim.errors import EcsimError
from ecsim.views.ladder import Ladder

GOOD = "LD X0\nOUT Y0\n"


@pytest.fixture(scope="module")
def shell():
    shell = InteractiveShell()
    shell.run_line_magic("load_ext", "ecsim_widgets")
    return shell


@pytest.fixture
def il(shell):
    """Run a cell of %%il."""
    yield lambda line, cell=GOOD: shell.run_cell_magic("il", line, cell)
    for name in ("test", "lab"):
        if lab := Lab.named(name):
            lab.close()


def test_a_cell_is_its_ladder(il):
    drawing = il("")
    assert isinstance(drawing, Ladder)
    assert len(drawing) == 1


def test_a_named_lab_is_made_and_stands_until_it_is_run(il):
    lab = il("--lab test --model EC10")
    assert isinstance(lab, Lab)
    assert (lab.plc.model.name, lab.plc.program.source, lab.session.state) == ("EC10", GOOD, "stopped")


def test_run_makes_a_lab_that_runs(il):
    lab = il("--run")
    assert lab is Lab.named("lab")
    assert (lab.session.state, lab.plc.running) == ("running", True)


def test_a_lab_that_is_there_gets_the_program(il, capsys):
    lab = il("--lab test --run")
    assert il("--lab test", "LD X0\nAND X1\nOUT Y0") is None
    assert capsys.readouterr().out.startswith("Changed in RUN: 1 new instruction")
    lab.session.pause()
    assert Lab.named("test") is lab
    lab.session.scan()
    assert len(lab.plc.program.instructions) == 3


def test_errors_are_marked_in_the_cell_and_the_lab_goes_on(il):
    lab = il("--lab test --run")
    with pytest.raises(EcsimError) as error:
        il("--lab test", "LD X0\nOUT X9 // no\nFOO")
    lines = error.value._render_traceback_()
    plain = [line.replace("\x1b[31m", "").replace("\x1b[0m", "") for line in lines]
    assert plain[0] == "The program has 2 errors:"
    assert plain[1] == "   2  OUT X9 // no"
    assert plain[2].startswith("          ^^ ")
    assert plain[3] == "   3  FOO"
    assert lab.plc.program.source == GOOD


@pytest.mark.filterwarnings("error")
def test_a_wrong_program_makes_no_lab_and_leaves_nothing_behind(il):
    with pytest.raises(EcsimError):
        il("--lab test --run", "OUT X0")
    gc.collect()
    assert Lab.named("test") is None


@pytest.mark.parametrize("line", ["--model EC99", "--lab test --model EC10", "--speed 3"])
def test_what_cannot_be_asked_for_is_refused_in_words(il, line):
    il("--lab test --model EC20")
    with pytest.raises(UsageError):
        il(line)


def completed(shell, text):
    return [found.text for found in shell.Completer.completions(text, len(text))]


def test_a_cell_completes_instructions_and_names(shell):
    from IPython.core.completer import provisionalcompleter

    with provisionalcompleter():
        assert "TON" in completed(shell, "%%il\nLD X0\nTO")
        assert completed(shell, "%%il --model EC20\nVAR_GLOBAL\nStart AT X5\nEND_VAR\nPROGRAM MAIN\nLD Sta") == ["Start"]
        assert "TON" not in completed(shell, "TO")  # a cell of Python is Python's
