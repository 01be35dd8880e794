"""A project folder: its problems stand where the files have them, its settings hold."""

import pytest

import ecsim
from ecsim import EcsimError, Plc
from ecsim.cli import main


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "main.il").write_text("PROGRAM MAIN\nLD X0\nCALL Add 2\nEND_PROGRAM\n", encoding="utf-8")
    (tmp_path / "subs.il").write_text("SUBROUTINE Add\nVAR_INPUT A : INT\nLD SM0\nADD D0 #A D0\nEND_SUBROUTINE\n", encoding="utf-8")
    return tmp_path


def test_a_problem_names_the_file_and_its_own_line(folder):
    with (folder / "subs.il").open("a", encoding="utf-8") as file:
        file.write("SUBROUTINE Main\nLD SM0\nINC D9000\nEND_SUBROUTINE\n")
    with pytest.raises(ecsim.ProgramError) as refused:
        ecsim.compile(folder)
    assert [(p.source, p.line, p.column) for p in refused.value.problems] == [("subs.il", 6, 12), ("subs.il", 8, 5)]
    assert refused.value.problems[0].hint == "it stands in line 1 of main.il already"


def test_loading_and_checking_tell_the_same_place(folder, capsys):
    (folder / "subs.il").write_text("SUBROUTINE Add\nVAR_INPUT A : INT\nLD SM0\nADDD D0 #A D0\nEND_SUBROUTINE", encoding="utf-8")
    with pytest.raises(ecsim.ProgramError, match=r"subs\.il: line 4, column 1: 'ADDD' is no instruction"):
        Plc().load(folder)
    assert main(["check", str(folder)]) == 1
    assert "subs.il: line 4, column 1" in capsys.readouterr().out


def test_the_settings_of_a_project_hold_from_its_download_on(folder):
    (folder / "plc.toml").write_text('model = "EC10"\nscan_ms = 5\ninput_filter_ms = 16\n', encoding="utf-8")
    plc = Plc("EC10")
    plc.load(folder)
    plc.run()
    plc.scan(2)
    assert (plc.time_us, plc["SD30"], plc["SD35"]) == (10_000, 5, 16)


def test_a_setting_that_the_model_does_not_have_changes_nothing(folder):
    plc = Plc("EC10")
    program = plc.program
    (folder / "plc.toml").write_text('model = "EC10"\nscan_ms = 5\ninput_filter_ms = 10\n', encoding="utf-8")
    with pytest.raises(EcsimError, match="EC10 takes 0, 8, 16, 32 or 64"):
        plc.load(folder)
    assert (plc.program, plc.scan_ms) == (program, 10)
