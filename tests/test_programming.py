"""What the programming software does with a PLC (2.4): upload, clear, format, passwords, reading registers, information."""

from datetime import datetime

import pytest

import ecsim
from ecsim import EcsimError, Plc, ProgramError, Project, SystemBlock
from ecsim.assembler.printer import print_program
from ecsim.protection import Passwords

MINUTE = 60_000
CALLING = """\
VAR_GLOBAL
  Lamp AT Y0 // shows it
END_VAR

PROGRAM MAIN
LD    X0
OUT   Lamp
LD    SM0
CALL  Secret 3
END_PROGRAM

SUBROUTINE Secret
VAR_INPUT A : INT
LD    SM0
MOV   #A D0
END_SUBROUTINE
"""


def machine(model="EC20", **settings):
    return Plc(model, input_filter_ms=0, **settings)


def locked(**passwords):
    """A PLC with passwords, and a subroutine that one closes."""
    plc = machine()
    plc.load(Project({"main.il": CALLING}, passwords=Passwords(**passwords), protected={"Secret": "sub7"}))
    return plc


# -- download and upload ----------------------------------------------------------------------------------------------


def test_what_was_downloaded_can_be_uploaded_written_and_downloaded_again(tmp_path):
    system = SystemBlock(data_block={"D5": 7}, watchdog_ms=150, retain={"D": [(0, 3)]})
    plc = machine("EC10", scan_ms=4)
    plc.load(Project({"a.il": "LD X0\nOUT Y0\n// the end\n"}, system=system))
    plc.upload().write(tmp_path)
    other = Plc("EC10")
    other.load(tmp_path)
    assert (other.scan_ms, other.system.data_block, other.system.watchdog_ms, other.system.input_filter_ms) == (4, {"D5": 7}, 150, 0)
    assert other.upload().files == {"a.il": "LD X0\nOUT Y0\n// the end\n"}


def test_an_upload_is_a_copy():
    plc = machine()
    plc.upload().system.data_block["D0"] = 5
    assert plc.system.data_block == {}


def test_a_text_and_a_program_are_uploaded_as_a_file():
    plc = machine()
    plc.load("LD X0\nOUT Y0")
    assert plc.upload().files == {"main.il": "LD X0\nOUT Y0"}
    plc.load(ecsim.compile("LD X1\nOUT Y0"))
    assert plc.upload().files == {"main.il": "LD X1\nOUT Y0"}


def test_a_download_stops_the_plc_and_one_that_fails_does_not():
    plc = machine()
    plc.load("LD X0\nOUT Y0")
    plc.run()
    with pytest.raises(ProgramError):
        plc.load(Project({"main.il": "LD X0\nOUT X0"}, system=SystemBlock(watchdog_ms=9)))
    assert (plc.running, plc.system.watchdog_ms) == (True, 200)
    plc.load("LD X1\nOUT Y0")
    assert not plc.running


def test_devices_keep_their_values_through_a_download():
    plc = machine()
    plc["D0"] = 5
    plc.load("LD X0\nOUT Y0")
    assert plc["D0"] == 5
    plc.run()
    assert plc["D0"] == 0


# -- passwords --------------------------------------------------------------------------------------------------------


def test_an_upload_asks_for_its_password():
    plc = locked(upload="Sesam1")
    with pytest.raises(EcsimError, match=r"the upload is closed by a password; give it with unlock\('upload', password\)"):
        plc.upload()
    with pytest.raises(EcsimError, match="this is not the password of upload; upper and lower case count, 9 more tries"):
        plc.unlock("upload", "sesam1")
    plc.unlock("upload", "Sesam1")
    assert plc.upload().model == "EC20"


def test_a_download_and_a_monitor_ask_for_theirs():
    plc = locked(download="d1", monitor="m1")
    program = plc.program
    with pytest.raises(EcsimError, match="the download is closed by a password"):
        plc.load("LD X0\nOUT Y0")
    with pytest.raises(EcsimError, match="the monitor is closed by a password"):
        plc.monitor("D0")
    assert plc.program is program
    plc.unlock("monitor", "m1")
    assert plc.monitor("D0")["D0"].value == 0
    plc.unlock("download", "d1")
    plc.load("LD X0\nOUT Y0")
    assert plc.program is not program


def test_a_password_that_was_given_counts_until_others_are_downloaded():
    plc = locked(upload="u1")
    plc.unlock("upload", "u1")
    plc.load("LD X0\nOUT Y0")
    plc.upload()
    plc.load(Project({"main.il": "LD X0\nOUT Y0"}, passwords=Passwords(upload="u1")))
    with pytest.raises(EcsimError, match="closed by a password"):
        plc.upload()


def test_a_forbidden_upload_is_refused_with_the_password_too():
    plc = locked(upload="u1", forbid_upload=True)
    plc.unlock("upload", "u1")
    with pytest.raises(EcsimError, match="the upload was forbidden with the last download; download again with forbid_upload = false"):
        plc.upload()
    plc.load(Project({"main.il": "LD X0\nOUT Y0"}, passwords=Passwords(upload="u1")))
    plc.unlock("upload", "u1")
    assert plc.upload().files


def test_ten_wrong_passwords_in_a_row_lock_the_entry_for_five_minutes():
    plc = locked(upload="u1", monitor="m1")
    for tries in range(9):
        with pytest.raises(EcsimError, match=f"{9 - tries} more tries"):
            plc.unlock("upload", "wrong")
    with pytest.raises(EcsimError, match="10 wrong ones lock the entry for 5 minutes"):
        plc.unlock("Secret", "wrong")
    with pytest.raises(EcsimError, match="no password is taken for another 300 s of simulated time"):
        plc.unlock("monitor", "m1")
    plc.power_cycle()
    plc.advance(ms=5 * MINUTE - 1000)
    with pytest.raises(EcsimError, match="for another 1 s"):
        plc.unlock("monitor", "m1")
    plc.advance(ms=1000)
    plc.unlock("monitor", "m1")
    with pytest.raises(EcsimError, match="9 more tries"):
        plc.unlock("upload", "wrong")


def test_a_lock_ends_where_a_step_back_leads_before_it():
    plc = locked(monitor="m1")
    before = plc.snapshot()
    plc.advance(ms=60 * MINUTE)
    for _ in range(10):
        with pytest.raises(EcsimError, match="not the password"):
            plc.unlock("monitor", "wrong")
    plc.restore(before)
    plc.unlock("monitor", "m1")


@pytest.mark.parametrize(("what", "password"), [(5, "u1"), ("upload", 5), (None, None), ("upload", b"u1")])
def test_what_is_no_text_is_no_try(what, password):
    plc = locked(upload="u1")
    with pytest.raises(EcsimError, match="both are texts"):
        plc.unlock(what, password)
    with pytest.raises(EcsimError, match="9 more tries"):
        plc.unlock("upload", "wrong")


def test_a_right_password_begins_the_count_anew():
    plc = locked(upload="u1")
    for _ in range(3):
        for _ in range(9):
            with pytest.raises(EcsimError, match="more tries"):
                plc.unlock("upload", "wrong")
        plc.unlock("upload", "u1")


def test_a_closed_subroutine_runs_but_its_text_stays_in_the_machine(tmp_path):
    plc = locked()
    plc.run()
    plc.scan()
    assert plc["D0"] == 3
    text = plc.upload().files["main.il"]
    assert "MOV" not in text
    assert "SUBROUTINE Secret\nVAR_INPUT A : INT\nCLOSED BY " in text
    assert "Lamp AT Y0" in text
    assert "sub7" not in text


def test_a_closed_subroutine_is_carried_to_another_machine_unread(tmp_path):
    locked().upload().write(tmp_path)
    other = machine()
    other.load(tmp_path)
    other.run()
    other.scan()
    assert (other["D0"], other.program.unit("Secret").closed) == (3, True)
    assert "MOV" not in other.upload().files["main.il"]
    other.unlock("Secret", "sub7")
    assert other.upload().files["main.il"].endswith("SUBROUTINE Secret\nVAR_INPUT A : INT\n\nLD    SM0\nMOV   #A D0\nEND_SUBROUTINE\n")


def test_a_sealed_text_may_be_in_a_change_in_run():
    plc = locked()
    plc.run()
    project = plc.upload()
    project.files["main.il"] = project.files["main.il"].replace("OUT   Lamp", "OUT   Y1")
    plc.edit(project)
    plc["X0"] = 1
    plc.scan()
    assert (plc["Y1"], plc["D0"], plc.program.unit("Secret").closed) == (1, 3, True)


def test_errors_beside_a_sealed_unit_have_their_own_lines(tmp_path):
    project = locked().upload()
    project.files["main.il"] += "SUBROUTINE Last\nLD SM0\nBAD D0\nEND_SUBROUTINE\n"
    line = project.files["main.il"].splitlines().index("BAD D0") + 1
    with pytest.raises(ProgramError, match=f"main.il: line {line}, column 1: 'BAD' is no instruction"):
        Plc().load(project)


@pytest.mark.parametrize("spoilt", ["CLOSEDx", "CLOSED %%%%", "CLOSED TU9WICAgI0EgRD", "CLOSED /w==", "CLOSED BY %"])
def test_a_spoilt_sealed_text_is_told_and_changes_nothing(spoilt):
    project = locked().upload()
    head, _, _ = project.files["main.il"].partition("CLOSED BY")
    project.files["main.il"] = f"{head}{spoilt}\nEND_SUBROUTINE\n"
    plc = machine()
    program = plc.program
    with pytest.raises(ProgramError, match="is no instruction"):
        plc.load(project)
    assert plc.program is program


CALLING_FX = """VAR_GLOBAL
  Lamp AT Y0
END_VAR

LD X0
OUT Lamp
P1
LD M8000
CALL P10
FEND

// the secret
P10 // called
LD M8000
MOV K3 D0
SRET

I101
LD M8000
INC D1
IRET
END
"""


@pytest.mark.parametrize("closed", [["P10"], ["MAIN"], ["I101"], ["P10", "I101"], ["MAIN", "P10", "I101"]])
def test_closed_units_between_labels_are_carried_to_another_machine_unread(closed):
    plc = Plc("H2U", input_filter_ms=0)
    project = Project({"main.il": CALLING_FX}, protected=dict.fromkeys(closed, "sub7"))
    plc.load(project)
    text = plc.upload().files["main.il"]
    assert not {"PROGRAM", "SUBROUTINE", "INTERRUPT"} & set(text.split())
    assert ("MOV" in text, "INC" in text, "CALL" in text) == ("P10" not in closed, "I101" not in closed, "MAIN" not in closed)
    assert "sub7" not in text
    other = Plc("H2U", input_filter_ms=0)
    other.load(Project({"main.il": text}))
    assert [unit.name for unit in other.program.units if unit.closed] == closed
    other.run()
    other["X0"] = 1
    other.scan()
    assert (other["D0"], other["Y0"]) == (3, 1)
    for name in closed:
        other.unlock(name, "sub7")
    opened = other.upload().files["main.il"]
    assert print_program(ecsim.compile(opened, "H2U")) == print_program(ecsim.compile(CALLING_FX, "H2U"))


# -- what an upload has of names and comments (2.1.5, error 45) ------------------------------------------------------------


def test_an_upload_without_user_information_has_no_names_and_comments():
    plc = machine()
    plc.load("VAR_GLOBAL\nLamp AT Y0 // shows it\nEND_VAR\n// the lamp\nLD X0 // a switch\nOUT lamp\nMOV 3 D0")
    plc.battery = "absent"
    plc.power_cycle()
    assert 45 in [error.code for error in plc.errors]
    assert plc.upload().files == {"main.il": "PROGRAM MAIN\nLD    X0\nOUT   Y0\nMOV   3 D0\nEND_PROGRAM\n"}
    plc.stop()
    plc["X0"] = 1
    plc.run()
    plc.scan()
    assert (plc["Y0"], plc["D0"]) == (1, 3)
    text = "LD X0 // again\nOUT Y0"
    plc.load(text)
    assert plc.upload().files == {"main.il": text}


def test_closed_units_stay_closed_in_such_an_upload():
    plc = locked()
    plc.damage("user information")
    text = plc.upload().files["main.il"]
    assert ("Lamp" in text, "OUT   Y0" in text, "MOV" in text) == (False, True, False)
    other = machine()
    other.load(plc.upload())
    other.run()
    other.scan()
    assert other["D0"] == 3


def test_a_closed_subroutine_opens_with_its_password():
    plc = locked()
    with pytest.raises(EcsimError, match="not the password of Secret"):
        plc.unlock("secret", "sub8")
    plc.unlock("secret", "sub7")
    assert plc.upload().files == {"main.il": CALLING}


# -- clear and format -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("what", ["devices", "program", "data block"])
def test_nothing_is_cleared_in_run(what):
    plc = machine(system=SystemBlock(data_block={"D0": 5}))
    plc.load("LD X0\nOUT Y0")
    plc.run()
    with pytest.raises(EcsimError, match=rf"the {what} can be cleared in STOP only; stop\(\) the PLC first"):
        plc.clear(what)
    assert (plc["D0"], plc.program.steps) == (5, 2)


@pytest.mark.parametrize("act", [lambda plc: plc.clear("devices"), lambda plc: plc.format()])
def test_the_ports_stay_idle_when_all_is_cleared(act):
    plc = machine()
    act(plc)
    assert (plc["SM114"], plc["SM124"]) == (1, 1)


def test_clearing_the_devices_spares_program_settings_inputs_and_forces():
    plc = machine("EC10", system=SystemBlock(retain={"D": [(100, 109)]}))
    plc.load("LD X0\nTON T0 1\nLD SM0\nCTU C0 1")
    plc["X0"] = 1
    plc.run()
    plc.scan(20)
    plc.set({"D100": 4, "M5": 1, "S20": 1, "Z1": 3})
    plc.force("Y3", 1)
    plc.stop()
    plc.clear("devices")
    assert [plc[name] for name in ("D100", "M5", "S20", "Z1", "T0", "T0:BOOL", "C0", "C0:BOOL")] == [0] * 8
    assert (plc["X0"], plc["Y3"], plc["SD0"], plc.program.steps) == (1, 1, 10, 12)
    plc.run()
    plc.scan(11)
    assert plc["T0:BOOL"] == 1


def test_without_a_program_the_plc_runs_nothing():
    plc = machine(system=SystemBlock(watchdog_ms=90))
    plc.load("LD SM0\nOUT Y0")
    plc.clear("program")
    plc.run()
    plc.scan()
    assert (plc["Y0"], plc.program.steps, plc.system.watchdog_ms, plc.upload().files) == (0, 0, 90, {"main.il": ""})


def test_without_a_data_block_registers_begin_at_0():
    plc = machine(system=SystemBlock(data_block={"D0": 5}, watchdog_ms=90))
    plc.clear("data block")
    plc.run()
    assert (plc["D0"], plc.system.watchdog_ms) == (0, 90)


def test_a_format_leaves_nothing_but_the_unit():
    plc = locked(upload="u1", download="d1")
    plc.unlock("download", "d1")
    plc.load(Project({"main.il": "LD X0\nOUT Y0"}, system=SystemBlock(data_block={"D0": 5}, watchdog_ms=90)))
    plc.force("Y3", 1)
    plc["D7"] = 7
    plc.format()
    assert (plc.program.steps, plc.system, plc.forced, plc["D7"], plc["Y3"]) == (0, SystemBlock(), {}, 0, 0)
    assert plc.upload().files == {"main.il": ""}
    plc.load("LD X0\nOUT Y0")


def test_a_format_needs_stop_and_no_lock():
    plc = machine(system=SystemBlock(format_lock=True))
    plc.load("LD X0\nOUT Y0")
    with pytest.raises(EcsimError, match="the system block locks the format; download one with format_lock = false first"):
        plc.format()
    plc.load(Project({"main.il": "LD X0\nOUT Y0"}, system=SystemBlock()))
    plc.run()
    with pytest.raises(EcsimError, match="in STOP only"):
        plc.format()
    plc.stop()
    plc.format()
    assert plc.program.steps == 0


def test_only_three_things_can_be_cleared():
    with pytest.raises(EcsimError, match="'all' cannot be cleared; choose devices, program, data block"):
        Plc().clear("all")


# -- registers, information -------------------------------------------------------------------------------------------


def test_registers_are_read_back_into_a_data_block():
    plc = machine()
    plc.set({"D100": -3, "D101": 44, "D104": 9})
    project = plc.upload()
    project.system.data_block = {"D0": 1, "D101": 5} | plc.read_data("D100", 3)
    plc.load(project)
    plc.run()
    assert [plc[f"D{n}"] for n in (0, 100, 101, 102, 104)] == [1, -3, 44, 0, 0]


@pytest.mark.parametrize(
    ("first", "count", "says"),
    [
        ("D0", 501, "501 registers from D0; read from 1 to 500 at a time"),
        ("D0", 0, "0 registers from D0"),
        ("D7990", 11, "11 registers from D7990; read from 1 to 10 at a time"),
        ("D0", 1.5, "1.5 registers"),
        ("M0", 5, "M0 is no D register; a data block holds D devices"),
    ],
)
def test_more_registers_than_the_machine_gives_are_refused(first, count, says):
    with pytest.raises(EcsimError, match=says):
        Plc().read_data(first, count)


def test_five_hundred_registers_are_read_at_once():
    assert list(Plc().read_data("D7500", 500)) == [f"D{n}" for n in range(7500, 8000)]


def test_the_plc_tells_of_itself():
    plc = machine("EC10", scan_ms=7)
    plc.load("LD X0\nOUT Y0")
    plc.clock_time = datetime(2024, 5, 6, 7, 8, 9)
    plc.force("Y1", 1)
    plc.run()
    plc.scan(3)
    told = plc.information
    assert {key: told[key] for key in ("model", "state", "steps", "capacity", "scan_ms", "least_scan_ms", "watchdog_ms", "forced")} == {
        "model": "EC10", "state": "RUN", "steps": 2, "capacity": 12000, "scan_ms": 7, "least_scan_ms": 7, "watchdog_ms": 200, "forced": 1,
    }  # fmt: skip
    assert (told["clock"], told["errors"], told["firmware"]) == (datetime(2024, 5, 6, 7, 8, 9, 21_000), [], 1.0)


# -- interrupts of high priority --------------------------------------------------------------------------------------


@pytest.mark.parametrize(("priority", "order"), [({}, [1, 2, 3]), ({2: "high"}, [3, 1, 2]), ({1: "high", 2: "high", 0: "low"}, [2, 3, 1])])
def test_requests_of_high_priority_are_served_first(priority, order):
    plc = machine(system=SystemBlock(interrupt_priority=priority))
    routines = "".join(f"INTERRUPT I{n} EVENT {n}\nLD SM0\nINC D0\nMOV {n + 1} D1Z0\nINC Z0\nEND_INTERRUPT\n" for n in range(3))
    enable = "".join(f"LD SM1\nSET SM4{n}\n" for n in range(3))
    plc.load(f"PROGRAM MAIN\nLD SM1\nEI\n{enable}END_PROGRAM\n{routines}")
    plc.run()
    plc.scan()
    for event in range(3):
        plc.interrupts.fire(event)
    plc.scan()
    assert [plc["D1"], plc["D2"], plc["D3"]] == order


@pytest.mark.parametrize(
    ("project", "says"),
    [
        (Project("LD X0"), "files of a project is 'LD X0'; it is a dict"),
        (Project({"a.il": 5}), "the file 'a.il' of a project is 5; it is a text"),
        (Project({"a.il": "LD X0\nOUT Y0"}, system={"watchdog_ms": 5}), "system of a project is .*; it is a SystemBlock"),
        (Project({"a.il": "LD X0\nOUT Y0"}, passwords="abc"), "passwords of a project is 'abc'; it is a Passwords"),
    ],
)
def test_a_project_of_other_things_is_told_and_changes_nothing(project, says):
    plc = machine()
    program, system = plc.program, plc.system
    with pytest.raises(EcsimError, match=says):
        plc.load(project)
    assert (plc.program, plc.system) == (program, system)


@pytest.mark.parametrize("act", [lambda plc: plc.clear(["devices"]), lambda plc: plc.damage(["program"]), lambda plc: plc.repair({})])
def test_what_is_no_name_is_told(act):
    with pytest.raises(EcsimError, match=r"cannot be cleared|has no part"):
        act(machine())
