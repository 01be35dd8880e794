"""A PLC in a file: opened again it goes on as if nothing had happened, and the file is there as a whole or not at all (docs/saving.md)."""

import json
import subprocess
import sys
import zipfile
from datetime import datetime

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ecsim import EcsimError, Plc, Project, SystemBlock, saved
from ecsim.hardware.modules import Module

from .engines.random_programs import random_program
from .engines.side_by_side import WATCHDOG_MS, disturb

QUICK = settings(max_examples=30, suppress_health_check=list(HealthCheck), database=None)
COUNTING = "LD SM0\nINC D0\nOUT Y0"


def whole_state(plc):
    """Everything that a file keeps, as plain data."""
    kept = plc.snapshot()
    del kept["program"], kept["trace"]
    return saved.encode(kept)


def reopened(plc, path):
    """The PLC after a way through a file."""
    plc.save(path)
    return Plc.open(path)


class Both:
    """A PLC that goes on and the one from its file, with the same things done to both."""

    def __init__(self, plc):
        self.plcs = {"going on": plc}

    def each(self, act):
        refused = []
        for plc in self.plcs.values():
            try:
                act(plc)
            except EcsimError as error:
                refused.append(str(error))
        assert len(set(refused)) <= 1
        assert len(refused) in (0, len(self.plcs))


def outside(both, chance):
    """What comes from outside: levels, values and forces; now and then switch, power, battery, signals and damage."""
    disturb(both, chance)
    acts = (
        lambda plc: setattr(plc, "switch", chosen[0]), lambda plc: plc.power_cycle(), lambda plc: plc.power_cycle(off_ms=chosen[1]),
        lambda plc: setattr(plc, "battery", "absent"), lambda plc: plc.pulse("X0", 3, 25), lambda plc: plc.quadrature("X0", "X1", 4, 1, 60),
        lambda plc: plc.square("X2", 333), lambda plc: plc.signal("X5", [(3, 1), (8, 0), (21, 1)]), lambda plc: plc.wire("Y0", "X3"),
        lambda plc: plc.damage(chosen[2]), lambda plc: plc.power_off(), lambda plc: plc.power_on(), lambda plc: plc.run(),
        lambda plc: plc.reset(), lambda plc: setattr(plc, "engine", chosen[3]), lambda plc: setattr(plc, "dc24", False),
    )  # fmt: skip
    chosen = (chance.choice(("ON", "TM", "OFF")), chance.choice((3, 15, 200)), chance.choice(("program", "clock", "retained data")),
              chance.choice(("compiled", "stepping")))  # fmt: skip
    if chance.random() < 0.25:
        both.each(chance.choice(acts))


@QUICK
@given(st.randoms(use_true_random=False), st.sampled_from(("EC10", "EC20")))
def test_a_reopened_plc_goes_on_like_the_one_that_was_saved(tmp_path_factory, chance, model):
    path = tmp_path_factory.getbasetemp() / "machine.plc"
    retain = {"D": [(0, 20)], "M": [(0, 9)]}
    system = SystemBlock(watchdog_ms=WATCHDOG_MS, retain=retain, hold_values=chance.random() < 0.3, run_input=chance.choice((None, "X7")))
    plc = Plc(model, scan_ms=chance.choice((10, 1, 7.3, None)), input_filter_ms=chance.choice((0, 8)), system=system)
    plc.load(random_program(chance, 3, model))
    plc.run()
    both = Both(plc)
    for _ in range(chance.randint(0, 8)):
        outside(both, chance)
        plc.scan()
    both.plcs["opened"] = opened = reopened(plc, path)
    assert (whole_state(opened), opened.system, opened.engine) == (whole_state(plc), plc.system, plc.engine)
    for _ in range(6):
        outside(both, chance)
        both.each(lambda plc: plc.scan(2))
        assert whole_state(opened) == whole_state(plc)


FAST = """PROGRAM MAIN
LD SM1
SET SM66
MOV 3 SD66
EI
LD SM0
HCNT C236 50
DHSCS 5 C236 Y10
SPD X1 20 D100
PLSY 1000 30000 Y0
LD X5
TONR T252 500
LD SM0
TON T0 5
END_PROGRAM
INTERRUPT I EVENT 26
LD SM0
INC D9
END_INTERRUPT"""


@pytest.mark.parametrize("scans", [1, 2, 7, 30])
def test_counters_pulses_and_timed_interrupts_go_on_in_the_middle(tmp_path, scans):
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(FAST)
    plc.run()
    plc.square("X0", 777)
    plc.wire("Y0", "X1")
    plc.scan(scans)
    plc.force("M7", 1)
    opened = reopened(plc, tmp_path / "a.plc")
    for each in (plc, opened):
        each.scan(25)
    assert whole_state(opened) == whole_state(plc)
    assert opened["C236"] > 0
    assert opened["D100"] > 0
    assert opened.forced == {"M7": 1}


def test_everything_beside_the_program_is_in_the_file(tmp_path):
    block = SystemBlock(retain={"D": [(0, 9)]}, data_block={"D20": 7}, watchdog_ms=150, run_input="X10", power_loss_ms=40)
    plc = Plc("EC20", scan_ms=3, system=block, io=[(24, 16), (8, 8), "4AD"])
    plc.load("VAR_GLOBAL\nMotor AT Y0 // the belt\nEND_VAR\nPROGRAM MAIN\nLD X0\nOUT Motor\nEND_PROGRAM")
    plc.run()
    plc.clock_time = datetime(2024, 5, 14, 10, 20, 30)
    plc.pots[1] = 99
    plc.modules[0].volts[2] = 2.5
    plc.force("D3", 42)
    plc.switch = "TM"
    plc.battery = "failing"
    plc.damage("clock")
    plc.scan(20)
    opened = reopened(plc, tmp_path / "a.plc")
    assert (opened.switch, opened.battery, opened.running, opened.scans, opened.time_us) == ("TM", "failing", True, 20, 60_000)
    assert (opened.system, opened.forced, opened.pots[1], opened.clock_time) == (plc.system, {"D3": 42}, 99, plc.clock_time)
    assert [error.code for error in opened.errors] == [23]
    assert opened.lamps == plc.lamps
    assert opened.program.source == plc.program.source
    assert opened.names == {"Y0": "Motor"}
    assert opened.modules[0].buffers == plc.modules[0].buffers
    assert opened.modules.terminals == plc.modules.terminals
    assert opened["D20"] == 7


def test_the_eeprom_and_a_plc_without_power_are_kept(tmp_path):
    plc = Plc("EC10", input_filter_ms=0)
    plc.load("LD X0\nEROMWR D6000 2")
    plc.run()
    plc.set({"D6000": 3, "X0": 1})
    plc.scan(3)
    plc.power_off()
    opened = reopened(plc, tmp_path / "a.plc")
    assert not opened.powered
    opened.power_on()
    assert (opened.running, opened["D6000"]) == (True, 3)


def test_a_program_changed_in_run_goes_on_with_its_memory(tmp_path):
    plc = Plc(input_filter_ms=0)
    plc.load("LD X0\nEU\nINC D0\nLD X1\nEU\nINC D1")
    plc.run()
    plc.set({"X0": 1, "X1": 1})
    plc.scan(2)
    plc.edit("LD X2\nEU\nINC D2\nLD X0\nEU\nINC D0\nLD X1\nEU\nINC D1")
    plc.scan()
    opened = reopened(plc, tmp_path / "a.plc")
    for each in (plc, opened):
        each["X2"] = 1
        each.scan(3)
    assert [opened[name] for name in ("D0", "D1", "D2")] == [1, 1, 1]
    assert whole_state(opened) == whole_state(plc)


def test_passwords_and_files_of_a_project_are_kept(tmp_path):
    folder = tmp_path / "project"
    folder.mkdir()
    (folder / "main.il").write_text("PROGRAM MAIN\nLD M0\nCALL SBR_1\nEND_PROGRAM\n", encoding="utf-8")
    (folder / "sub.il").write_text("SUBROUTINE SBR_1\nLD SM0\nINC D0\nEND_SUBROUTINE\n", encoding="utf-8")
    plc = Plc()
    plc.load(folder)
    plc.protection.passwords.upload = "secret"
    opened = reopened(plc, tmp_path / "a.plc")
    with pytest.raises(EcsimError, match="closed by a password"):
        opened.upload()
    opened.unlock("upload", "secret")
    assert list(opened.upload().files) == ["main.il", "sub.il"]


def test_a_unit_that_a_password_closes_stays_closed(tmp_path):
    text = "LD M0\nCALL A\nCALL B\nSUBROUTINE A\nLD SM0\nINC D0\nEND_SUBROUTINE\nSUBROUTINE B\nLD SM0\nINC D1\nEND_SUBROUTINE\n"
    plc = Plc()
    plc.load(Project({"main.il": text}, protected={"A": "secret", "B": "other"}))
    plc.unlock("B", "other")
    opened = reopened(plc, tmp_path / "a.plc")
    assert [opened.program.unit(name).closed for name in "AB"] == [True, False]
    assert "INC   D0" not in opened.upload().files["main.il"]
    opened.unlock("A", "secret")
    assert opened.upload().files == {"main.il": text}


def test_the_same_state_gives_the_same_file(tmp_path):
    for name in "ab":
        plc = Plc()
        plc.load(COUNTING)
        plc.run()
        plc.scan(3)
        plc.save(tmp_path / name)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


# -- files that cannot be opened, places that cannot be written -----------------------------------------------------


@pytest.fixture
def file(tmp_path):
    """A good file of a PLC that has counted to 5."""
    plc = Plc()
    plc.load(COUNTING)
    plc.run()
    plc.scan(5)
    plc.save(tmp_path / "machine.plc")
    return tmp_path / "machine.plc"


def rewritten(path, change):
    """The file with another content of its parts."""
    with zipfile.ZipFile(path) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    change(parts)
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)


def with_head(**changes):
    """A change of the first part."""
    return lambda parts: parts.update({saved.HEAD: json.dumps(json.loads(parts[saved.HEAD]) | changes)})


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda path: path.unlink(), "there is no file"),
        (lambda path: path.write_text("LD X0\nOUT Y0"), "is no file of a PLC, or it is damaged"),
        (lambda path: path.write_bytes(b""), "is no file of a PLC, or it is damaged"),
        (lambda path: path.write_bytes(path.read_bytes()[:-30]), "is no file of a PLC, or it is damaged"),
        (lambda path: rewritten(path, lambda parts: parts.pop(saved.HEAD)), "holds no PLC; open a file that Plc.save has written"),
        (lambda path: rewritten(path, with_head(format="zip")), "holds no PLC"),
        (lambda path: rewritten(path, with_head(version=2)), "has version 2, this ecsim reads version 1"),
        (lambda path: rewritten(path, lambda parts: parts.update({"program/main.il": "LD X0\nOUT Y1"})), "was changed by hand"),
        (lambda path: rewritten(path, lambda parts: parts.pop(saved.STATE)), "was changed by hand"),
        (lambda path: (path.unlink(), path.mkdir()), "cannot be read"),
    ],
)  # fmt: skip
def test_a_file_that_is_none_says_what_is_wrong(file, spoil, says):
    spoil(file)
    with pytest.raises(EcsimError, match=says):
        Plc.open(file)


def test_a_file_of_another_ecsim_says_so(file):
    texts, kept = saved._read(file)
    del kept["settings"]["dict"][0]
    settings, state = saved.decode(kept["settings"]), saved.decode(kept["state"])
    saved.write(file, texts, {"settings": settings, "state": state})
    with pytest.raises(EcsimError, match="was written by another ecsim, which keeps other things: KeyError: 'model'"):
        Plc.open(file)


@settings(max_examples=60, suppress_health_check=list(HealthCheck), database=None)
@given(st.randoms(use_true_random=False))
def test_a_file_with_changed_bytes_opens_unchanged_or_not_at_all(tmp_path_factory, chance):
    path = tmp_path_factory.getbasetemp() / "changed.plc"
    plc = Plc()
    plc.load(COUNTING)
    plc.run()
    plc.scan(5)
    plc.save(path)
    content = bytearray(path.read_bytes())
    for _ in range(chance.randint(1, 4)):
        content[chance.randrange(len(content))] = chance.randrange(256)
    path.write_bytes(content)
    try:
        opened = Plc.open(path)
    except EcsimError:
        return
    assert whole_state(opened) == whole_state(plc)


class Heater(Module):
    """A module that ecsim does not know."""

    kind = "heater"


def test_what_cannot_be_kept_is_refused_and_the_former_file_stays(file):
    before = file.read_bytes()
    plc = Plc.open(file)
    plc.modules[0] = Heater(4)
    with pytest.raises(EcsimError, match="the special module 'heater' of place 0"):
        plc.save(file)
    plc = Plc.open(file)
    plc.eeprom.cells = {0: object()}
    with pytest.raises(EcsimError, match="cannot be kept in a file; it is a object, no plain data"):
        plc.save(file)
    assert file.read_bytes() == before


def test_a_place_that_cannot_be_written_is_told_and_leaves_nothing_behind(tmp_path, file):
    plc = Plc.open(file)
    with pytest.raises(EcsimError, match="cannot be written: No such file or directory; the former file is as it was"):
        plc.save(tmp_path / "nowhere" / "machine.plc")
    folder = tmp_path / "folder"
    folder.mkdir()
    with pytest.raises(EcsimError, match="cannot be written"):
        plc.save(folder)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "machine.plc"]


def test_opening_takes_no_class_that_is_not_on_the_list():
    for value in ({"object": ["Popen", {"args": ["true"]}]}, {"object": ["Plc", {}]}, {"eval": "1"}, {"dict": 5}):
        with pytest.raises((LookupError, ValueError, TypeError)):
            saved.decode(value)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text() | st.binary(),
    lambda inner: st.lists(inner) | st.lists(inner).map(tuple) | st.dictionaries(st.integers() | st.text(), inner)
    | st.sets(st.integers()) | st.frozensets(st.integers()),
)  # fmt: skip


@given(VALUES)
def test_values_come_back_type_and_all(value):
    back = saved.decode(json.loads(json.dumps(saved.encode(value))))
    assert back == value
    assert type(back) is type(value)


def test_a_file_is_whole_whenever_the_process_is_killed(root):
    done = subprocess.run(
        [sys.executable, str(root / "bench" / "kill_while_saving.py"), "200"], capture_output=True, text=True, timeout=120, cwd=root
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("200 kills")
    assert "every file opened" in done.stdout
