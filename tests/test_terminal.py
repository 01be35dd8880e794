"""`ecsim run`: what the view shows, what the keys do, how a run without a view ends; and the view in a real terminal."""

import os
import re
import select
import subprocess
import sys

import pytest

from ecsim import EcsimError, Plc, Session
from ecsim.cli import main
from ecsim.terminal import Console, assign, condition, heading, page, sections

PROGRAM = """\
VAR_GLOBAL
  Start AT X0
  Speed AT D10
END_VAR
PROGRAM MAIN
LD Start
TON T0 5
LD T0
OUT Y0
LD SM0
INC D0
LD X1
CTU C0 3
LD SM1
SET S0
STL S0
OUT Y1
RET
LD M0
MOV 5 Speed
END_PROGRAM
"""


@pytest.fixture
def session():
    plc = Plc(input_filter_ms=0)
    plc.load(PROGRAM)
    plc.run()
    session = Session(plc, name="terminal", speed=None)
    yield session
    session.stop()


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "plc.toml").write_text("input_filter_ms = 0\n")
    (tmp_path / "main.il").write_text(PROGRAM)
    return tmp_path


def shown(session):
    return {line.device: (line.name, line.text) for lines in sections(session.plc).values() for line in lines}


# -- the view ---------------------------------------------------------------------------------------------------------


def test_the_view_has_the_devices_that_the_program_names(session):
    session.plc["X0"] = 1
    session.scan(51)
    session.plc.force("X1", 1)
    session.scan(1)
    assert list(sections(session.plc)) == ["Inputs", "Outputs", "Steps", "Relays", "Timers", "Counters", "Registers"]
    assert shown(session) == {
        "X0": ("Start", "1 ●"), "X1": ("", "1 ● forced"), "Y0": ("", "1 ●"), "Y1": ("", "1 ●"), "S0": ("", "1 ●"), "M0": ("", "0"),
        "T0": ("", "5 ●"), "C0": ("", "1"), "D0": ("", "52"), "D10": ("Speed", "0"),
    }  # fmt: skip


def test_the_heading_has_state_time_and_scans(session):
    session.scan(3)
    assert heading(session) == "EC20 RUN   0.030 s   3 scans of 10 ms   RUN on"
    session.plc.stop()
    assert heading(session).startswith("EC20 STOP   0.030 s")


def test_errors_stand_below():
    plc = Plc()
    plc.load("LD SM0\nDIV D0 D1 D2")
    plc.run()
    session = Session(plc, name="terminal", speed=None)
    session.scan(1)
    assert page(session).split("Errors\n  ")[1].startswith("69: ")


def test_the_page_is_aligned(session):
    assert "Registers\n  D0          0\n  D10  Speed  0" in page(session)


# -- keys -------------------------------------------------------------------------------------------------------------


def test_keys_pause_scan_go_back_and_end(session):
    console = Console(session)
    session.run()
    console.press(" ")
    assert session.state == "paused"
    scans = session.plc.scans
    console.press("ss")
    assert session.plc.scans == scans + 2
    console.press("b")
    assert session.plc.scans == scans + 1
    console.press(" ")
    assert session.state == "running"
    console.press("q")
    assert console.ended


def test_back_beyond_what_is_remembered_is_told(session):
    console = Console(session)
    console.press("b")
    assert console.foot == "this is as far back as is remembered"


def test_a_name_turns_an_input_over(session):
    console = Console(session)
    console.press("x0")
    assert console.foot == "> x0"
    console.press("\r")
    assert (session.plc.inputs.terminals[0], console.foot) == (True, "x0 = 1")
    console.press("X0\n")
    assert session.plc.inputs.terminals[0] is False
    console.press(":start\r")
    assert session.plc.inputs.terminals[0] is True


def test_a_value_is_written_and_typing_can_be_corrected_and_given_up(session):
    console = Console(session)
    console.press("D0=17\x7f6\r")
    assert session.plc["D0"] == 16
    console.press("M0\x1b\r")
    assert session.plc["M0"] == 0
    assert console.foot.startswith("q quit   space pause")
    console.press(":\r")
    assert console.entry is None


@pytest.mark.parametrize(
    ("keys", "says"),
    [
        ("x999\r", "x999"),
        ("D0=fast\r", "'fast' is no number; write D0=5"),
        ("D0=99999\r", "does not fit into D0"),
        ("D5\r", "D5 is no bit that could be turned over; write D5=5"),
    ],
)
def test_what_cannot_be_written_is_told_and_changes_nothing(session, keys, says):
    before = session.plc.memory.snapshot()
    console = Console(session)
    console.press(keys)
    assert says in console.foot
    assert (session.plc.memory.snapshot(), session.error) == (before, None)


# -- a run without a view ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "holds"),
    [("D0", True), ("M0", False), ("D0=4", True), ("D0 = 0x4", True), ("D0!=4", False), ("D0>3", True), ("D0>=5", False), ("D0<=4", True),
     ("D0<4", False), ("Speed=0", True), ("D2:REAL>1.4", True)],
)  # fmt: skip
def test_conditions(session, text, holds):
    session.plc["D0"], session.plc["D2:REAL"] = 4, 1.5
    assert condition(session.plc, text)() is holds


@pytest.mark.parametrize("text", ["", "Q0", "D0=x", "Nobody>5"])
def test_a_condition_that_asks_nothing_is_refused(session, text):
    with pytest.raises(EcsimError):
        condition(session.plc, text)


def test_a_bit_alone_is_turned_over(session):
    assert assign(session.plc, "X0") == ("X0", 1)
    assert assign(session.plc, "T0:BOOL") == ("T0:BOOL", 1)
    session.plc["M0"] = 1
    assert assign(session.plc, "M0") == ("M0", 0)
    assert assign(session.plc, "D0:REAL = 2.5") == ("D0:REAL", 2.5)


def test_a_run_prints_what_came_of_it(folder, capsys):
    assert main(["run", str(folder), "--ms", "1000", "--set", "X0=1", "--set", "D0=-100"]) == 0
    printed = capsys.readouterr().out
    assert printed.startswith("EC20 RUN   1.000 s   100 scans of 10 ms")
    assert "T0         50" not in printed
    assert re.search(r"Y0 +1 ●\n", printed)
    assert re.search(r"D0 +0\n", printed)


def test_a_run_ends_when_the_condition_holds(folder, capsys):
    assert main(["run", str(folder), "--until", "D0>=7"]) == 0
    assert "7 scans" in capsys.readouterr().out


def test_a_condition_that_never_holds_ends_with_1(folder, capsys):
    assert main(["run", str(folder), "--ms", "50", "--until", "Y0"]) == 1
    assert capsys.readouterr().out.endswith("Y0 did not come true\n")


def test_an_error_that_stops_the_plc_ends_with_1(tmp_path, capsys):
    (tmp_path / "a.il").write_text("LBL 1\nLD SM0\nCJ 1\n")
    assert main(["run", str(tmp_path / "a.il"), "--ms", "50"]) == 1
    assert re.search(r"STOP .*ERR on", capsys.readouterr().out)


def test_an_error_that_stops_nothing_ends_with_0(tmp_path, capsys):
    (tmp_path / "plc.toml").write_text('model = "EC10"\n[modules.0]\nkind = "4AD"\n')
    (tmp_path / "main.il").write_text("LD SM0\nINC D0\n")
    assert main(["run", str(tmp_path), "--ms", "50"]) == 0
    out = capsys.readouterr().out
    assert "26: the special modules are not those of the system block" in out
    assert "EC10 RUN" in out


def test_a_run_has_the_base_unit_and_the_modules_of_the_project(tmp_path, capsys):
    (tmp_path / "plc.toml").write_text('model = "EC10"\nio = [[24, 16], [8, 8], "4AD"]\n[modules.0]\nkind = "4AD"\n')
    (tmp_path / "main.il").write_text("LD X30\nOUT Y20\nLD SM0\nMOV SD7 D0\nMOV SD8 D1\n")
    assert main(["run", str(tmp_path), "--ms", "50", "--set", "X30=1", "--until", "D1"]) == 0
    out = capsys.readouterr().out
    assert "Errors" not in out
    assert main(["run", str(tmp_path), "--ms", "50", "--set", "X40=1"]) == 2
    assert "X40 has no terminal" in capsys.readouterr().err


def test_a_program_with_errors_ends_with_1_and_lists_them(tmp_path, capsys):
    (tmp_path / "a.il").write_text("LD X0\nOUT X0\nTON T0")
    (tmp_path / "plc.toml").write_text("[system]\nwatchdog_ms = 9999\n")
    assert main(["run", str(tmp_path), "--ms", "5"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in lines] == ["a.il", "a.il", "plc.toml", "3 errors"]
    assert main(["check", str(tmp_path)]) == 1
    assert capsys.readouterr().out.splitlines() == lines


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["nowhere", "--ms", "5"], "there is no file nowhere"),
        (["{}", "--ms", "5", "--set", "Q1=1"], "'Q1' is no device"),
        (["{}", "--until", "Q1"], "'Q1' is no device"),
        (["{}"], "there is no terminal for a live view; give --ms or --until"),
    ],
)
def test_a_wrong_use_ends_with_2(folder, capsys, monkeypatch, arguments, says):
    monkeypatch.setattr(sys, "stdin", open(os.devnull))  # noqa: SIM115 - closed with the test
    assert main(["run", *(each.format(folder) for each in arguments)]) == 2
    assert says in capsys.readouterr().err


@pytest.mark.parametrize("number", ["0", "-5", "x", "inf", "nan"])
def test_a_time_that_does_not_go_on_ends_with_2(folder, number, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["run", str(folder), "--ms", number])
    assert ended.value.code == 2


# -- a real terminal --------------------------------------------------------------------------------------------------


class Terminal:
    """A pseudo-terminal with `ecsim run` in it."""

    def __init__(self, *arguments):
        import pty

        self.master, slave = pty.openpty()
        environment = os.environ | {"TERM": "xterm", "COLUMNS": "160", "LINES": "50"}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "ecsim", "run", *arguments],
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=environment,
            start_new_session=True,
        )
        os.close(slave)
        self.text = ""

    def until(self, pattern):
        """Read until something stands on the screen."""
        while not (found := re.search(pattern, re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", self.text))):
            assert select.select([self.master], [], [], 30)[0], f"{pattern} does not come: {self.text[-2000:]}"
            self.text += os.read(self.master, 65536).decode()
        self.text = ""
        return found

    def press(self, keys):
        os.write(self.master, keys.encode())

    def ended(self):
        while select.select([self.master], [], [], 0.2)[0]:
            try:
                if not os.read(self.master, 65536):
                    break
            except OSError:  # the other side is closed
                break
        return self.process.wait(timeout=30)


@pytest.mark.skipif(os.name != "posix", reason="needs a pseudo-terminal")
@pytest.mark.parametrize("options", [[], ["--plain"]], ids=["rich", "plain"])
def test_the_live_view_runs_pauses_and_takes_inputs(folder, options):
    terminal = Terminal(str(folder), "--speed", "5", *options)
    try:
        terminal.until(r"EC20 RUN   \d")
        terminal.press("x1\r")
        terminal.until(r"x1 = 1")
        terminal.until(r"C0 +1\b")
        terminal.press(" ")
        terminal.until(r"RUN \(paused\)")
        terminal.press("q")
        assert terminal.ended() == 0
    finally:
        terminal.process.kill()
        terminal.process.wait()
        os.close(terminal.master)
