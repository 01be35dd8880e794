"""Projects: read from texts, files and folders, changed and written back; what is said about those that cannot be read."""

import builtins
import os
import stat
from pathlib import Path

import pytest

import ecsim
from ecsim import EcsimError, Plc, ProgramError, Project, SystemBlock
from ecsim import project as module
from ecsim.hardware.serial import PortSettings
from ecsim.protection import Passwords

LAMP = "LD X0\nOUT Y0\n"
TOML = """\
# the press in hall 3
model = "EC10"      # the small one
scan_ms = 5

[system]
watchdog_ms = 300   # the long recipe
hold_values = true
run_input = "X7"
interrupt_priority = { 26 = "high" }

# what outlives the night
[retain]
D = [["D100", "D149"]]
M = [[0, 9]]

[data_block]
D0 = 5              # pieces
"D2:DINT" = -100000
"D4:REAL" = 1.5

[stop_outputs]
mode = "configure"
Y0 = 1

[port1]
protocol = "freeport"
baud = 19200

[modules.0]
kind = "4AD"        # the oven
channels = [{ mode = 0, mean = "D100" }]

[passwords]
upload = "Sesam1"

[protected]
Add = "geheim"
"""


@pytest.fixture
def folder(tmp_path):
    """A project of two files and a plc.toml."""
    (tmp_path / "plc.toml").write_text('model = "EC10"\nscan_ms = 5\n')
    (tmp_path / "main.il").write_text(f"PROGRAM MAIN\n{LAMP}LD X1\nCALL Add 2\nEND_PROGRAM\n")
    (tmp_path / "subs.il").write_text("SUBROUTINE Add\nVAR_INPUT A : INT\nLD SM0\nADD D0 #A D0\nEND_SUBROUTINE")
    return tmp_path


@pytest.fixture
def press(folder):
    """The same with a plc.toml that sets a bit of everything."""
    (folder / "plc.toml").write_text(TOML)
    return folder


def contents(folder):
    return {path.name: path.read_text() for path in folder.iterdir()}


def test_a_text_is_a_program_by_itself():
    assert Project.of(LAMP) == Project({"": LAMP})
    assert Project.of("").files == {"": ""}
    assert Project.of("LD X0 // see a/b.il").files == {"": "LD X0 // see a/b.il"}


@pytest.mark.parametrize("as_text", [True, False])
def test_a_path_is_read(tmp_path, as_text):
    path = tmp_path / "lamp.IL"
    path.write_text(LAMP)
    assert Project.of(str(path) if as_text else path) == Project({"lamp.IL": LAMP}, "lamp.IL")


def test_a_folder_is_all_its_files_and_settings(folder):
    project = Project.of(folder)
    assert list(project.files) == ["main.il", "subs.il"]
    assert (project.name, project.model, project.scan_ms, project.system) == (folder.name, "EC10", 5, None)
    assert repr(project) == f"<Project {folder.name}, EC10, 2 files>"


def test_every_setting_of_a_folder_is_read(press):
    project = Project.read(press)
    assert project.system == SystemBlock(
        retain={"D": [(100, 149)], "M": [(0, 9)]},
        hold_values=True,
        data_block={"D0": 5, "D2:DINT": -100_000, "D4:REAL": 1.5},
        stop_outputs="configure",
        stop_output_table={"Y0": 1},
        watchdog_ms=300,
        run_input="X7",
        interrupt_priority={26: "high"},
        modules={0: {"kind": "4AD", "channels": [{"mode": 0, "mean": "D100"}]}},
        port1=PortSettings("freeport", baud=19200),
    )
    assert (project.passwords, project.protected) == (Passwords(upload="Sesam1"), {"Add": "geheim"})


def test_a_folder_is_loaded(folder):
    plc = Plc("EC10", input_filter_ms=0)
    plc.load(folder)
    plc.run()
    plc["X1"] = 1
    plc.scan(3)
    assert plc["D0"] == 6


def test_system_block_and_data_block_come_with_the_download(press):
    plc = Plc("EC10", input_filter_ms=0, system=SystemBlock(constant_scan_ms=20, retain={"S": [(0, 9)]}))
    plc.load(press)
    plc.run()
    plc["X1"] = 1
    plc.scan()
    assert (plc["D0"], plc["D2:DINT"], plc["D4:REAL"], plc["SD34"], plc.time_us) == (7, -100_000, 1.5, 300, 5_000)
    assert (plc.system.constant_scan_ms, plc.system.retain) == (0, {"D": [(100, 149)], "M": [(0, 9)]})  # as a whole
    assert plc.system.input_filter_ms == 0  # the project says nothing about it
    plc.stop()
    assert plc["Y0"] == 1


def test_base_unit_and_modules_are_those_of_the_project(press):
    text = TOML.replace("scan_ms = 5", 'io = [[24, 16], [8, 8], "4AD"]  # cabinet 2\nscan_ms = 5')
    (press / "plc.toml").write_text(text)
    plc = Plc("EC10")
    plc.load(press)
    assert (plc["SD7"], plc["SD8"], plc["SD10"]) == (1, 1, 24 << 8 | 16)
    plc.run()
    plc.scan()
    assert plc.errors == []
    with pytest.raises(EcsimError, match="X40 has no terminal"):
        plc["X40"] = 1
    plc.unlock("upload", "Sesam1")
    project = plc.upload()
    assert project.io == [(24, 16), (8, 8), "4AD"]
    project.write(press / "copy")
    assert Project.read(press / "copy").io == [[24, 16], [8, 8], "4AD"]
    former = Project.read(press)
    former.write(press)
    assert (press / "plc.toml").read_text() == text
    former.io = ((24, 16), "4DA")
    former.write(press)
    assert (press / "plc.toml").read_text() == text.replace('[8, 8], "4AD"', '"4DA"')


def test_a_download_changes_no_hardware_that_there_is(press):
    (press / "plc.toml").write_text('model = "EC10"\nio = [[24, 16], "4AD"]\n')
    plc = Plc("EC10", io=(10, 6))
    plc.load(press)
    assert plc.modules.io == [(10, 6)]
    bare = Plc("EC20")
    bare.modules.add("4DA")
    bare.load(Project({"main.il": LAMP}, io=(24, 16)))
    assert (bare["SD8"], bare["SD10"]) == (1, 0)


def test_hardware_that_there_is_not_leaves_everything_as_it_was():
    plc = Plc("EC20")
    program = plc.program
    with pytest.raises(EcsimError, match="EC20 has no base unit"):
        plc.load(Project({"main.il": LAMP}, io=[(24, 16, 3)]))
    with pytest.raises(EcsimError, match="EC20 has room for 8 modules"):
        plc.load(Project({"main.il": LAMP}, io=[(24, 16), *["4AD"] * 9]))
    assert (plc.program, plc.modules.io, len(plc.modules)) == (program, None, 0)


def test_the_name_of_a_folder_alone_is_a_path(press, monkeypatch):
    monkeypatch.chdir(press.parent)
    assert Project.of(press.name).model == "EC10"
    assert Project.of("LD X0").files == {"": "LD X0"}


@pytest.mark.parametrize("toml", ["constant_scan_ms = 600\nwatchdog_ms = 600", "watchdog_ms = 0\nconstant_scan_ms = 1000"])
def test_a_long_constant_scan_goes_with_a_long_watchdog(folder, toml):
    (folder / "plc.toml").write_text(f"[system]\n{toml}\n")
    system = Project.read(folder).system
    assert f"constant_scan_ms = {system.constant_scan_ms}" in toml
    assert f"watchdog_ms = {system.watchdog_ms}" in toml


@pytest.mark.parametrize("toml", ["constant_scan_ms = 600\nwatchdog_ms = 599", "constant_scan_ms = 201"])
def test_a_constant_scan_above_the_watchdog_is_refused(folder, toml):
    (folder / "plc.toml").write_text(f"[system]\n{toml}\n")
    with pytest.raises(ProgramError, match=r"above the watchdog's (599|200); raise watchdog_ms"):
        Project.read(folder)


def test_variables_have_a_file_of_their_own(folder):
    (folder / "variables.il").write_text("VAR_GLOBAL\nStart AT X0 // button\nEND_VAR\n")
    (folder / "main.il").write_text("LD Start\nOUT Y0\n")
    assert ecsim.compile(folder).names() == {"X0": "Start"}


def test_a_file_leaves_nothing_open_for_the_next_one(folder):
    (folder / "main.il").write_text("PROGRAM MAIN\nLD X0\nOUT Y0 /* lamp\n")
    with pytest.raises(ProgramError) as refused:
        ecsim.compile(folder)
    assert [(p.source, p.line, p.message) for p in refused.value.problems] == [
        ("main.il", 1, "PROGRAM MAIN has no end"),
        ("main.il", 3, "a comment is not closed"),
    ]


def test_a_folder_of_another_model_is_refused(folder):
    with pytest.raises(EcsimError, match=r"is a project for EC10, this is an EC20; make a Plc\('EC10'\)"):
        Plc("EC20").load(folder)


def test_a_missing_file_is_named():
    with pytest.raises(EcsimError, match=r"there is no file nowhere/press\.il; give the path of an \.il file or a project folder"):
        Plc().load("nowhere/press.il")
    with pytest.raises(EcsimError, match=r"there is no folder nowhere; give the path of a project folder with plc\.toml and \*\.il"):
        Project.read("nowhere")


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
    assert Project.of(folder).files == {"a.il": LAMP}


# -- a plc.toml that cannot be used -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("toml", "line", "says"),
    [
        ("model = EC20", 1, 'this is no TOML: Invalid value; write lines like model = "EC20"'),
        ("scan_ms = 5\n\n[system\n", 3, "this is no TOML: "),
        ("modell = 'EC20'", 1, "there is no setting 'modell'; known are model, io, scan_ms, input_filter_ms, system"),
        ("io = 5", 1, "io is 5; write (inputs, outputs) of a base unit"),
        ("io = [24, 17]", 1, "EC20 has no base unit [24, 17]; choose (inputs, outputs) of (10, 6), (14, 10)"),
        ("io = [[24, 16], '9AD']", 1, "EC20 has no special module '9AD'; it has"),
        ("model = 'EC10'\n\nio = [[24, 16], [200, 0]]", 3, "EC10 has at most 128 points"),
        ("model = 20", 1, "model is 20; choose EC10 or EC20"),
        ("model = []", 1, "model is []; choose EC10 or EC20"),
        ("model = 'EC10'\nscan_ms = 'fast'", 2, "scan_ms is 'fast'; it is a number from 0.001 to 60000"),
        ("scan_ms = true", 1, "scan_ms is True"),
        ("input_filter_ms = []", 1, "input_filter_ms is []; EC20 takes 0 to 60"),
        ("input_filter_ms = true", 1, "input_filter_ms is True; EC20 takes 0 to 60"),
        ("model = 'EC10'\n\ninput_filter_ms = 10", 3, "EC10 takes 0, 8, 16, 32 or 64"),
        ("system = 5", 1, "system is 5; it is a table: write [system] and its settings below"),
        ("[sistem]\nwatchdog_ms = 1", 1, "there is no setting 'sistem'; known are model"),
        ("[system]\n# so\nwatchdog = 1", 3, "[system] has no setting 'watchdog'; known are hold_values"),
        ("[system]\nwatchdog_ms = 1001", 2, "watchdog_ms is 1001; it is a number from 0 to 1000"),
        ("[system]\ninterrupt_priority = 5", 2, "interrupt_priority is 5; write events and levels"),
        ("[system]\ninterrupt_priority = { x = 'high' }", 2, "interrupt_priority names event 'x'"),
        ("[system]\nrun_input = 3", 2, "'3' is no device of EC20"),
        ("[retain]\nD = [0, 5]", 2, "retain of D is [0, 5]; write ranges, for example D = [[100, 199]]"),
        ("[retain]\nM = [[0, 5]]\nD = [['M0', 'M5']]", 3, "retain names D from 'M0' to 'M5'; write numbers from 0 to 7999"),
        ("[data_block]\nD0 = 1\nD1 = 70000", 3, "70000 does not fit into D1"),
        ("[data_block]\nD0 = 1\nD1 = 'x'", 3, "D1 takes a whole number, not 'x'"),
        ("[data_block]\n'D0:DINT' = 1\nD1 = 7", 3, "data_block sets D1 twice, by D0:DINT and by D1; leave one out"),
        ("[stop_outputs]\nmode = 'off'", 2, "stop_outputs is 'off'; choose disable or freeze or configure"),
        ("[stop_outputs]\nX0 = 1", 2, "stop_output_table names X0; it holds Y devices"),
        ("[port1]\nspeed = 9600", 2, "[port1] has no setting 'speed'; known are protocol"),
        ("[port0]\nprotocol = 'modbus master'", 2, "the protocol of port 0 is 'modbus master'; choose "),
        ("model = 'EC20'\n[modules.0]\nmode = 1", 3, "modules names place 0, which the system block of EC20 has not"),
        ("[modules]\nx = 1", 2, "modules: place x is set to 1; write its settings by name"),
        ("model = 'EC10'\n[modules]\n0 = 1", 3, "modules: place 0 is set to 1; write its settings by name"),
        ("model = 'EC10'\n[modules.0]\nkind = 5", 3, "its kind as text"),
        ("model = 'EC10'\n[modules.0]\nkind = '4AD'\nspeed = 1", 4, "modules: place 0 has no setting 'speed'; known are kind and channels"),
        ("[passwords]\nupload = 'much too long'", 2, "the upload password cannot be 'much too long'; take up to 8 letters and digits"),
        ("[passwords]\nprint = 'x'", 2, "[passwords] has no setting 'print'; known are upload, download, monitor, forbid_upload"),
        ("[protected]\nAdd = ''", 2, "the password of Add cannot be ''; take up to 16 letters and digits"),
    ],
)
def test_a_broken_plc_toml_names_line_and_remedy_and_changes_nothing(folder, toml, line, says):
    (folder / "plc.toml").write_text(toml)
    before = contents(folder)
    plc = Plc("EC10", system=SystemBlock(watchdog_ms=77))
    program = plc.program
    with pytest.raises(ProgramError) as refused:
        plc.load(folder)
    (problem,) = refused.value.problems
    assert (problem.source, problem.line) == ("plc.toml", line)
    assert says in str(problem)
    assert (plc.program, plc.scan_ms, plc.system, contents(folder)) == (program, 10, SystemBlock(watchdog_ms=77), before)


def test_all_that_is_wrong_is_told_together(press):
    (press / "plc.toml").write_text(TOML.replace("300", "3000").replace("D0 = 5", "D0 = 99999"))
    (press / "subs.il").write_text("SUBROUTINE Add\nVAR_INPUT A : INT\nLD SM0\nADDD D0 #A D0\nEND_SUBROUTINE")
    with pytest.raises(ProgramError) as refused:
        ecsim.compile(press)
    assert [(p.source, p.line) for p in refused.value.problems] == [("plc.toml", 6), ("plc.toml", 17), ("subs.il", 4)]


def test_a_password_for_a_unit_that_there_is_not_is_told(press):
    (press / "plc.toml").write_text(TOML.replace("Add =", "Sub ="))
    with pytest.raises(ProgramError, match=r"plc\.toml: line 37: the program has no unit 'Sub'; it has MAIN, Add"):
        ecsim.compile(press)


# -- writing ----------------------------------------------------------------------------------------------------------


def test_what_is_read_is_written_to_the_letter(press, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("copies") / "press"
    Project.read(press).write(elsewhere)
    assert contents(elsewhere) == contents(press)


def test_a_changed_value_keeps_comments_and_order(press):
    project = Project.read(press)
    project.scan_ms = 2.5
    project.system.watchdog_ms = 400
    project.system.data_block["D0"] = 6
    project.system.data_block["D9"] = 1
    del project.system.data_block["D2:DINT"]
    project.system.run_input = None
    project.system.no_battery = False
    project.system.port1 = PortSettings("freeport", baud=4800, parity="even")
    project.write(press)
    wanted = TOML
    for old, new in (
        ("scan_ms = 5", "scan_ms = 2.5"),
        ("watchdog_ms = 300", "watchdog_ms = 400"),
        ("D0 = 5 ", "D0 = 6 "),
        ('"D2:DINT" = -100000\n', ""),
        ('"D4:REAL" = 1.5\n', '"D4:REAL" = 1.5\nD9 = 1\n'),
        ('run_input = "X7"\n', ""),
        ("baud = 19200\n", 'baud = 4800\nparity = "even"\n'),
    ):
        assert old in wanted
        wanted = wanted.replace(old, new)
    assert (press / "plc.toml").read_text() == wanted
    assert Project.read(press).system == project.system


def test_a_project_made_from_nothing_is_written_and_read_again(tmp_path):
    system = SystemBlock(
        retain={"D": [(5, 9)]}, data_block={"D0": 1}, stop_output_table={"Y1": 1}, interrupt_priority={0: "high"},
        input_filter_ms=16, port0=PortSettings("modbus slave", station=4), modules={2: {"kind": "4DA"}, 3: {"kind": "4AD", "channels": [{"mode": 3}, {}, {"samples": 2, "mean": "D5"}]}}, format_lock=True,
    )  # fmt: skip
    project = Project(
        {"main.il": LAMP}, model="EC10", scan_ms=2, system=system, passwords=Passwords(monitor="abc"), protected={"MAIN": "x1"}
    )
    project.write(tmp_path / "new")
    again = Project.read(tmp_path / "new")
    assert (again.files, again.model, again.scan_ms, again.system) == (project.files, "EC10", 2, system)
    assert (again.passwords, again.protected) == (Passwords(monitor="abc"), {"MAIN": "x1"})


def test_a_module_that_is_taken_out_leaves_no_table(press):
    project = Project.read(press)
    project.system.modules = {1: {"kind": "4DA"}}
    project.write(press)
    assert Project.read(press).system.modules == {1: {"kind": "4DA"}}
    assert "[modules.0]" not in (press / "plc.toml").read_text()


def test_an_unchanged_project_needs_no_tomlkit_and_a_changed_one_says_that_it_does(press, monkeypatch):
    real = builtins.__import__
    monkeypatch.setattr(
        builtins, "__import__", lambda name, *a, **k: (_ for _ in ()).throw(ImportError) if name == "tomlkit" else real(name, *a, **k)
    )
    project = Project.read(press)
    project.files["main.il"] = project.files["main.il"].replace("X0", "X2")
    project.write(press)
    assert "X2" in (press / "main.il").read_text()
    before = contents(press)
    project.files["main.il"] = LAMP
    project.system.watchdog_ms = 5
    with pytest.raises(EcsimError, match=r"tomlkit, which is not installed; pip install ecsim\[project\]"):
        project.write(press)
    assert contents(press) == before


def test_files_that_are_gone_are_removed_and_strangers_are_not(folder):
    project = Project.read(folder)
    text = project.files.pop("subs.il")
    project.files["main.il"] += text
    project.write(folder)
    assert sorted(contents(folder)) == ["main.il", "plc.toml"]
    (folder / "mine.il").write_text(LAMP)
    with pytest.raises(EcsimError, match=r"holds mine\.il, which would become part of the project; choose another folder"):
        project.write(folder)
    assert (folder / "mine.il").read_text() == LAMP


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda p: p.files.update({"../main.il": LAMP}), "'../main.il' cannot be a file of a project; name it like main.il"),
        (lambda p: p.files.update({"main.txt": LAMP}), "'main.txt' cannot be a file"),
        (lambda p: p.files.clear(), "the project has no file"),
        (lambda p: setattr(p.system, "watchdog_ms", 2000), "watchdog_ms is 2000"),
        (lambda p: setattr(p, "scan_ms", 0), "scan_ms is 0"),
    ],
)
def test_what_could_not_be_read_again_is_not_written(press, change, says):
    project, before = Project.read(press), contents(press)
    change(project)
    with pytest.raises(EcsimError, match=says.replace(".", r"\.")):
        project.write(press)
    assert contents(press) == before


@pytest.mark.parametrize("failing", ["write", "replace"])
def test_a_failure_while_writing_leaves_every_file_whole(press, monkeypatch, failing):
    project, before = Project.read(press), contents(press)
    project.files = {name: text + "// more\n" for name, text in project.files.items()}

    def fail(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(module.os, {"write": "fsync", "replace": "replace"}[failing], fail)
    with pytest.raises(EcsimError, match="cannot be written: No space left on device"):
        project.write(press)
    assert contents(press) == before


@pytest.mark.parametrize("failing", ["replace", "unlink"])
def test_a_failure_in_the_middle_of_writing_brings_the_former_files_back(press, monkeypatch, failing):
    (press / "variables.il").write_text("VAR_GLOBAL\nStart AT X0\nEND_VAR\n")
    project, before = Project.read(press), contents(press)
    del project.files["variables.il"]
    project.files |= {
        "main.il": project.files["main.il"] + "// more\n",
        "subs.il": project.files["subs.il"] + "\n// more\n",
        "new.il": "// new\n",
    }
    if failing == "replace":
        replace = os.replace

        def once(source, target):
            if Path(target).name == "new.il":
                raise OSError(28, "No space left on device")
            replace(source, target)

        monkeypatch.setattr(module.os, "replace", once)
    else:
        unlink = Path.unlink
        monkeypatch.setattr(Path, "unlink", lambda path: os.rmdir(path) if path.name == "variables.il" else unlink(path))
    with pytest.raises(EcsimError, match=r"cannot be written: (No space left|Not a directory)"):
        project.write(press)
    assert contents(press) == before
    assert Project.read(press).files.keys() == {"main.il", "subs.il", "variables.il"}


def test_a_written_file_keeps_its_rights(press):
    (press / "main.il").chmod(0o640)
    project = Project.read(press)
    project.files["main.il"] += "// more\n"
    project.write(press)
    assert stat.S_IMODE((press / "main.il").stat().st_mode) == 0o640


def test_the_line_ends_of_other_systems_stay(press):
    (press / "main.il").write_bytes(b"LD X0\r\nOUT Y0\r\n")
    (press / "plc.toml").write_bytes(b'model = "EC10"\r\nscan_ms = 5\r\n')
    project = Project.read(press)
    project.scan_ms = 6
    project.write(press)
    assert (press / "main.il").read_bytes() == b"LD X0\r\nOUT Y0\r\n"
    assert (press / "plc.toml").read_bytes().splitlines() == [b'model = "EC10"', b"scan_ms = 6"]


def test_the_example_of_the_documentation_is_a_project(tmp_path):
    text = (Path(__file__).parent.parent / "docs" / "projects.md").read_text(encoding="utf-8")
    (tmp_path / "plc.toml").write_text(text.split("```toml\n")[1].split("```")[0])
    (tmp_path / "main.il").write_text("PROGRAM MAIN\nLD X0\nCALL SBR_1\nEND_PROGRAM\nSUBROUTINE SBR_1\nLD SM0\nINC D0\nEND_SUBROUTINE\n")
    project = Project.read(tmp_path)
    assert project.compile().unit("SBR_1").closed
    assert [line.split(" ")[0] for line in text.split("[system]")[1].split("[retain]")[0].splitlines()[1:-1]] == [
        "watchdog_ms", "constant_scan_ms", "hold_values", "data_block_valid", "power_loss_ms", "no_battery", "run_input",
        "interrupt_priority", "format_lock",
    ]  # fmt: skip
    usual = SystemBlock()
    named = project.system.watchdog_ms, project.system.constant_scan_ms, project.system.hold_values, project.system.format_lock
    assert named == (usual.watchdog_ms, usual.constant_scan_ms, usual.hold_values, usual.format_lock)


def test_the_name_of_a_file_may_tell_its_model(tmp_path):
    text = "LD M8000\nOUT T0 K5\n"
    (tmp_path / "answer.h2u.il").write_text(text)
    (tmp_path / "answer.il").write_text(text)
    assert ecsim.compile(tmp_path / "answer.h2u.il").model.name == "H2U"
    assert Project.of(tmp_path / "answer.il").model is None
    assert Project.spelled({"answer.h1u.il": text}).model == "H1U"
    assert Project.spelled({"a.h1u.il": text, "b.h2u.il": text}).model is None
    assert Project.spelled({"answer.h1u.il": text, "plc.toml": 'model = "H2U"\n'}).model == "H2U"
