"""What a user expects of the objects at hand: short representations, paths wherever a program is asked for, bounded memory."""

import pytest

import ecsim
from ecsim import EcsimError, Plc, Recording


def test_objects_show_themselves_in_a_line():
    program = ecsim.compile("PROGRAM MAIN\nLD X0\nTON T0 10\nEND_PROGRAM")
    assert repr(program.instructions[1]) == "<Instruction 1: TON T0 10>"
    assert repr(program.instructions[1].definition) == "<Definition of TON, 5.4.1>"
    assert repr(program.main) == "<Unit MAIN, 2 instructions in 1 network>"
    assert repr(Plc().memory) == "<Memory of an EC20>"


def test_an_unknown_unit_is_told_with_the_known_ones():
    with pytest.raises(EcsimError, match="no unit 'SBR_1'; it has MAIN"):
        ecsim.compile("LD X0\nOUT Y0").unit("SBR_1")


def test_compile_takes_a_path_and_a_project_folder(tmp_path):
    (tmp_path / "main.il").write_text("LD M2047\nOUT Y0", encoding="utf-8")
    (tmp_path / "plc.toml").write_text('model = "EC10"', encoding="utf-8")
    assert ecsim.compile(tmp_path).model.name == "EC10"
    assert ecsim.compile(str(tmp_path / "main.il"), "EC10").steps == 3
    with pytest.raises(ecsim.ProgramError, match="EC20 has no M2047"):
        ecsim.compile(tmp_path, "EC20")


@pytest.mark.parametrize("program", [None, 5, "there/is/none", "none.il", "a\0b.il"])
def test_what_is_no_program_is_refused_in_words(program):
    with pytest.raises(EcsimError):
        ecsim.compile(program)


def test_a_recording_forgets_the_oldest_of_very_many_changes(monkeypatch):
    monkeypatch.setattr("ecsim.record.KEEP", 100)
    plc = Plc()
    plc.load("LD SM0\nINC D0")
    plc.run()
    recording = Recording(plc, "D0")
    for _ in range(1000):
        plc.scan()
        recording.sample()
    assert 75 <= len(recording) <= 100
    assert recording.changes("D0")[-1] == (plc.time_us, 1000)


def test_local_bits_stay_bits_when_a_call_clears_them():
    plc = Plc()
    plc.load("PROGRAM MAIN\nLD SM0\nCALL S1\nLD LM0\nOUT Y0\nEND_PROGRAM\nSUBROUTINE S1\nLD SM0\nSET LM0\nEND_SUBROUTINE")
    plc.run()
    plc.scan()
    assert set(map(type, plc.memory.lists["LM"])) == {bool}
    assert plc.memory.lists["Y"][0] is False
