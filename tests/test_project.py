"""Programs from files and folders, and what is said about those that cannot be read."""

import os

import pytest

from ecsim import EcsimError, Plc, ProgramError
from ecsim.project import read_project, settings

LAMP = "LD X0\nOUT Y0\n"


@pytest.fixture
def folder(tmp_path):
    """A project of two files and a plc.toml."""
    (tmp_path / "plc.toml").write_text('model = "EC10"\nscan_ms = 5\n')
    (tmp_path / "main.il").write_text(f"PROGRAM MAIN\n{LAMP}LD X1\nCALL Add 2\nEND_PROGRAM\n")
    (tmp_path / "subs.il").write_text("SUBROUTINE Add\nVAR_INPUT A : INT\nLD SM0\nADD D0 #A D0\nEND_SUBROUTINE")
    return tmp_path


def test_a_text_is_a_program_by_itself():
    assert read_project(LAMP) == (LAMP, "", {})
    assert read_project("") == ("", "", {})
    assert read_project("LD X0 // see a/b.il")[0] == "LD X0 // see a/b.il"


@pytest.mark.parametrize("as_text", [True, False])
def test_a_path_is_read(tmp_path, as_text):
    path = tmp_path / "lamp.IL"
    path.write_text(LAMP)
    assert read_project(str(path) if as_text else path) == (LAMP, "lamp.IL", {})


def test_a_folder_is_all_its_files_and_settings(folder):
    text, name, chosen = read_project(folder)
    assert text.index("PROGRAM MAIN") < text.index("SUBROUTINE Add")
    assert (name, chosen) == (folder.name, {"model": "EC10", "scan_ms": 5})


def test_a_folder_is_loaded(folder):
    plc = Plc("EC10", input_filter_ms=0)
    plc.load(folder)
    plc.run()
    plc["X1"] = 1
    plc.scan(3)
    assert plc["D0"] == 6


def test_a_folder_of_another_model_is_refused(folder):
    with pytest.raises(EcsimError, match=r"is a project for EC10, this is an EC20; make a Plc\('EC10'\)"):
        Plc("EC20").load(folder)


def test_a_missing_file_is_named():
    with pytest.raises(EcsimError, match=r"there is no file nowhere/press\.il; give the path of an \.il file or a project folder"):
        Plc().load("nowhere/press.il")


def test_an_empty_folder_is_told_what_it_needs(tmp_path):
    with pytest.raises(EcsimError, match=r"holds no \.il file; put the program into .*main\.il"):
        Plc().load(tmp_path)


def test_a_file_of_another_encoding_is_told(tmp_path):
    path = tmp_path / "old.il"
    path.write_bytes(b"LD X0 // \xfcber\nOUT Y0")
    with pytest.raises(EcsimError, match=r"old\.il is no UTF-8 text \(byte 9\); save it as UTF-8"):
        Plc().load(path)


@pytest.mark.skipif(
    os.name == "nt" or not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the rights of files do not hold for this user"
)
def test_a_file_without_leave_to_read_is_told(tmp_path):
    path = tmp_path / "locked.il"
    path.write_text(LAMP)
    path.chmod(0)
    with pytest.raises(EcsimError, match=r"locked\.il cannot be read: "):
        Plc().load(path)


def test_a_folder_with_the_name_of_a_file_is_a_project(tmp_path):
    folder = tmp_path / "press.il"
    folder.mkdir()
    (folder / "a.il").write_text(LAMP)
    assert read_project(folder)[0] == LAMP


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        ("model = EC20", r"plc\.toml is no TOML: .*; write lines like model = \"EC20\""),
        ("modell = 'EC20'", "there is no setting 'modell'; known are model, scan_ms, input_filter_ms"),
        ("model = 20", "model is 20; expected text"),
        ("scan_ms = 'fast'", "scan_ms is 'fast'; expected a number"),
        ("scan_ms = true", "scan_ms is True; expected a number"),
        ("input_filter_ms = []", r"input_filter_ms is \[\]; expected a number"),
    ],
)
def test_a_broken_plc_toml_names_the_thing_and_the_remedy(folder, toml, says):
    (folder / "plc.toml").write_text(toml)
    with pytest.raises(EcsimError, match=says):
        Plc("EC10").load(folder)


def test_a_project_needs_no_plc_toml(folder):
    (folder / "plc.toml").unlink()
    assert settings(folder) == {}
    assert Plc("EC20").load(folder).steps > 0


def test_problems_name_the_file(folder):
    (folder / "main.il").write_text("LD X0\nOUT X1")
    with pytest.raises(ProgramError) as refused:
        Plc("EC10").load(folder)
    assert str(refused.value.problems[0]).startswith("main.il: line 2, column 5")
