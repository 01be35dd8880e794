"""Changing a program in RUN (2.4.3): what may differ, what stays, and the way back across it."""

import random

import pytest

import ecsim
from ecsim import EcsimError, Plc, ProgramError, Project, Session
from ecsim.assembler import assemble
from ecsim.editing import keep_memory, refusals
from ecsim.protection import Passwords

WHOLE = """\
VAR_GLOBAL
  Lamp AT Y0
END_VAR

PROGRAM MAIN
LD X0
OUT Lamp
LD X1
CALL Add 2
END_PROGRAM

SUBROUTINE Add
VAR_INPUT A : INT
VAR_TEMP B : BOOL
LD SM0
ADD D0 #A D0
END_SUBROUTINE

INTERRUPT Tick EVENT 26
LD SM0
INC D9
END_INTERRUPT
"""


def running(text, model="EC20"):
    plc = Plc(model, input_filter_ms=0)
    plc.load(text)
    plc.run()
    return plc


# -- what may be changed ----------------------------------------------------------------------------------------------


def test_main_program_subroutine_and_interrupt_program_are_changed_in_run():
    plc = running(WHOLE)
    plc.scan()
    new = WHOLE.replace("LD X0", "LDI X0").replace("ADD D0 #A D0", "ADD D0 #A D0\nINC D0").replace("INC D9", "ADD D9 10 D9")
    assert plc.edit(new) is plc.program
    plc["X1"] = 1
    plc.scan()
    assert (plc.running, plc["Y0"], plc["D0"]) == (True, 1, 3)
    plc.interrupts.enabled = True
    plc["SM66"], plc["SD66"] = 1, 5
    plc.scan(3)
    assert plc["D9"] == 60  # every 5 of 30 ms


def test_titles_comments_and_the_order_of_units_may_change():
    plc = running(WHOLE)
    parts = WHOLE.split("\n\n")
    plc.edit("\n\n".join([parts[0].replace("Y0", "Y0 // shines"), parts[1].replace("LD X1", "// count\nLD X1"), parts[3], parts[2]]))
    plc.scan()
    assert plc.running


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("Lamp AT Y0", "Lamp AT Y1", r"the global variables differ \(lamp\)"),
        ("  Lamp AT Y0", "  Lamp AT Y0\n  Bell AT Y1", r"the global variables differ \(bell\)"),
        ("VAR_TEMP B : BOOL", "VAR_TEMP B : INT", r"the variables of Add differ \(b\)"),
        ("VAR_TEMP B : BOOL\n", "", r"the variables of Add differ \(b\)"),
        ("VAR_INPUT A : INT", "VAR_IN_OUT A : INT", r"the variables of Add differ \(a\)"),
        ("EVENT 26", "EVENT 27", "Tick was the interrupt program Tick of event 26 and is the interrupt program Tick of event 27"),
        (
            "INTERRUPT Tick",
            "INTERRUPT Tock",
            "the interrupt program Tick of event 26 is missing; the interrupt program Tock of event 26 is new",
        ),
        ("END_INTERRUPT\n", "END_INTERRUPT\nSUBROUTINE More\nLD SM0\nINC D1\nEND_SUBROUTINE", "the subroutine More is new"),
    ],
)
def test_variables_and_the_set_of_units_are_not_changed_in_run(old, new, says):
    plc = running(WHOLE)
    plc["X0"] = 1
    plc.scan()
    program, files = plc.program, plc.upload().files
    changed = WHOLE.replace(old, new).replace("CALL Add 2", "CALL Add D5" if "IN_OUT" in new else "CALL Add 2")
    with pytest.raises(EcsimError, match=rf"this cannot be changed in RUN: {says}; stop\(\) and load\(\) it"):
        plc.edit(changed)
    plc.scan()
    assert (plc.program, plc.running, plc["Y0"], plc.upload().files) == (program, True, 1, files)


def test_a_program_with_an_error_changes_nothing():
    plc = running(WHOLE)
    program = plc.program
    with pytest.raises(ProgramError, match="X0"):
        plc.edit(WHOLE.replace("OUT Lamp", "OUT X0"))
    with pytest.raises(EcsimError, match="compiled for EC10, this is an EC20"):
        plc.edit(assemble("LD X0\nOUT Y0", "EC10"))
    assert plc.program is program


def test_in_stop_there_is_nothing_to_change_in_run():
    plc = running(WHOLE)
    plc.stop()
    with pytest.raises(EcsimError, match=r"the PLC is in STOP, so nothing is changed in RUN; load\(\) the program"):
        plc.edit(WHOLE)


def test_a_change_asks_for_the_password_of_the_download_and_keeps_units_closed():
    plc = Plc()
    plc.load(Project({"a.il": WHOLE}, passwords=Passwords(download="d1"), protected={"Add": "s1"}))
    plc.run()
    with pytest.raises(EcsimError, match="the download is closed by a password"):
        plc.edit(WHOLE)
    plc.unlock("download", "d1")
    plc.edit(WHOLE.replace("LD X0", "LD X2"))
    assert (plc.program.unit("Add").closed, plc.program.unit("MAIN").closed) == (True, False)


def test_what_was_changed_is_uploaded(tmp_path):
    plc = running("LD X0\nOUT Y0")
    (tmp_path / "main.il").write_text("LD X1\nOUT Y0")
    plc.edit(tmp_path)
    assert plc.upload().files == {"main.il": "LD X1\nOUT Y0"}
    (tmp_path / "more.il").write_text("// nothing yet\n")
    plc.edit(tmp_path)
    assert plc.upload().files == {"main.il": "LD X1\nOUT Y0", "more.il": "// nothing yet\n"}
    plc.edit("LD X3\nOUT Y0")
    assert plc.upload().files == {"main.il": "LD X3\nOUT Y0"}
    plc.edit(ecsim.compile("LD X2\nOUT Y0"))
    assert plc.upload().files == {"main.il": "LD X2\nOUT Y0"}


# -- what stays -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_timers_go_on_and_counters_see_no_edge(engine):
    text = "LD X0\nTON T0 10\nLD X0\nCTU C0 5\nLD X0\nEU\nINC D0\n"
    plc = running(text)
    plc.engine = engine
    plc["X0"] = 1
    plc.scan(51)  # 500 ms since the first execution
    plc.edit("LD M0\nEU\nINC D5\n" + text + "LD T0\nOUT Y5\n")
    plc.scan(49)
    assert (plc["T0"], plc["C0"], plc["D0"], plc["Y5"]) == (9, 1, 1, 0)
    plc.scan(1)
    assert (plc["T0"], plc["C0"], plc["D0"], plc["Y5"]) == (10, 1, 1, 1)
    assert plc.engine == engine


def test_a_new_edge_contact_begins_as_in_the_first_scan():
    plc = running("LD X0\nOUT Y0")
    plc["X0"] = 1
    plc.scan(5)
    plc.edit("LD X0\nOUT Y0\nLD X0\nEU\nINC D0\nLD X0\nED\nINC D1")
    plc.scan(3)
    assert (plc["D0"], plc["D1"]) == (1, 0)


def test_every_device_keeps_its_value():
    plc = running("LD X0\nOUT Y0\nLD SM0\nMOV 7 D1")
    plc["X0"] = 1
    plc.scan(2)
    plc.set({"M3": 1, "D100": -4, "Z2": 9, "C0": 12})
    before = plc.memory.snapshot()
    plc.edit("LD X1\nOUT Y1")
    after = plc.memory.snapshot()
    assert {name: values for name, values in after.items() if name != "E"} == {name: v for name, v in before.items() if name != "E"}
    plc.scan()
    assert (plc["Y0"], plc["D1"], plc["M3"]) == (1, 7, 1)  # what drove them is gone; they stay as they were


def test_active_steps_stay_active_and_clear_their_outputs_when_they_end():
    chart = "LD SM1\nSET S0\nSTL S0\nOUT Y0\nLD X0\nSET S20\nSTL S20\nOUT Y1\nLD X1\nOUT S0\nRET\n"
    plc = running(chart)
    plc.scan()
    plc["X0"] = 1
    plc.scan(2)
    assert (plc["S0"], plc["S20"], plc["Y0"], plc["Y1"]) == (0, 1, 0, 1)
    plc.edit(chart.replace("OUT Y1\n", "OUT Y1\nOUT Y2\n").replace("LD SM1\n", "LD X5\nEU\nINC D0\nLD SM1\n"))
    plc.scan()
    assert (plc["S20"], plc["Y1"], plc["Y2"]) == (1, 1, 1)
    plc["X0"], plc["X1"] = 0, 1
    plc.scan(2)
    assert (plc["S0"], plc["S20"], plc["Y0"], plc["Y1"], plc["Y2"]) == (1, 0, 1, 0, 0)


def test_a_pulse_output_goes_on_and_one_whose_instruction_is_gone_ends():
    pulses = "LD SM0\nPLSY 1000 0 Y0\n"
    plc = running(pulses)
    plc.scan(3)
    plc.edit("LD X5\nEU\nINC D0\n" + pulses)
    plc.scan(10)
    sent = plc["SD50:DINT"]
    assert 128 <= sent <= 131
    assert plc["SM82"] == 1
    plc.edit("LD X5\nEU\nINC D0\n")
    plc.scan(10)
    assert plc["SM82"] == 0
    assert plc["SD50:DINT"] <= sent + 1


def test_a_timer_that_nothing_drives_any_longer_stands_still():
    plc = running("LD SM0\nTON T252 500\nLD SM0\nTON T0 50\nLD X0\nOUT Y0")
    plc.scan(21)
    plc.edit("LD X0\nOUT Y0\nLD T252\nOUT Y1")
    values = plc["T252"], plc["T0"]
    plc.scan(100)
    assert (plc["T252"], plc["T0"], plc["T252:BOOL"]) == (*values, 0)
    plc.edit("LD X0\nOUT Y0\nLD SM0\nTON T0 50")
    plc.scan()
    assert plc["T0"] == 0  # it begins anew (5.4.1, rule 4)


def test_forced_devices_stay_forced():
    plc = running("LD X0\nOUT Y0")
    plc.force("Y0", 1)
    plc.force("D0", 7)
    plc.edit("LD X1\nOUT Y0\nLD SM0\nMOV 3 D0")
    plc.scan()
    assert (plc["Y0"], plc["D0"]) == (1, 7)


# -- places in memory -------------------------------------------------------------------------------------------------


def places(program):
    """Every place in memory that an instruction or a step of a program has."""
    found = [place for i in program.instructions for place in (i.slot, i.pulse) if place >= 0]
    waiting = [node for unit in program.units for node in unit.nodes]
    while waiting:
        node = waiting.pop()
        waiting += getattr(node, "nodes", [])
        found += [node.slot] if getattr(node, "kind", "") == "STL" else []
    return found


def test_no_two_instructions_get_one_place_however_often_a_program_changes():
    dice = random.Random(5)
    rungs = [f"LD X{n % 8}\nEU\nINC D{n}\n" for n in range(12)] + [f"LD M{n}\nCTU C{n} 5\n" for n in range(8)]
    program = assemble("".join(rungs[:5]), "EC20")
    for _ in range(50):
        new = assemble("".join(dice.sample(rungs, dice.randrange(1, 15))), "EC20")
        former = {str(i): i.slot for i in program.instructions if i.slot >= 0 and str(i).startswith("CTU")}
        kept, gone = keep_memory(program, new)
        taken = places(new)
        assert len(set(taken)) == len(taken)
        assert max(taken) < new.slots <= 20 + 20
        assert kept <= set(taken)
        staying = {str(i) for i in program.instructions} - {str(i) for i in gone}
        assert all(former[str(i)] == i.slot for i in new.instructions if str(i) in former and str(i) in staying and i.slot in kept)
        program = new


def test_the_same_program_keeps_every_place():
    old, new = assemble(WHOLE, "EC20"), assemble(WHOLE, "EC20")
    assert refusals(old, new) == []
    kept, gone = keep_memory(old, new)
    assert (gone, places(old), set(places(old))) == ([], places(new), kept)


# -- the way back -----------------------------------------------------------------------------------------------------


def test_a_session_goes_back_across_a_change_and_forward_again():
    plc = running("LD SM0\nINC D0")
    session = Session(plc, name="changed", speed=None)
    session.scan(150)
    session.post(lambda plc: plc.edit("LD SM0\nADD D0 100 D0"))
    session.scan(3)
    assert plc["D0"] == 450
    assert session.back(2)
    assert plc["D0"] == 250
    session.scan(1)
    assert plc["D0"] == 350
    assert session.back(20)
    assert (plc["D0"], str(plc.program.instructions[1])) == (132, "INC D0")
    session.scan(5)
    assert plc["D0"] == 137


def test_a_reset_goes_back_in_time_and_leaves_the_program_changed():
    plc = running("LD SM0\nINC D0")
    session = Session(plc, name="reset", speed=None)
    session.scan(5)
    session.edit("LD SM0\nADD D0 100 D0")
    session.scan(5)
    session.reset()
    session.scan(2)
    assert (plc.time_us, plc["D0"], str(plc.program.instructions[1])) == (20_000, 200, "ADD D0 100 D0")


def test_a_session_goes_on_after_a_change_that_is_refused():
    plc = running(WHOLE)
    session = Session(plc, name="refused", speed=None)
    session.scan(2)
    with pytest.raises(EcsimError, match="the subroutine Add is missing"):
        session.edit("LD X0\nOUT Y0")
    session.edit(WHOLE.replace("LD X0", "LDI X0"))
    session.scan(1)
    assert (plc["Y0"], session.error) == (1, None)


def test_a_snapshot_of_before_the_change_is_restored_with_its_program():
    plc = running("LD X0\nTON T0 100\nLD X0\nEU\nINC D0")
    plc["X0"] = 1
    plc.scan(20)
    snapshot = plc.snapshot()
    plc.edit("LD X1\nOUT Y0\nLD X0\nTON T0 100")
    plc.scan(20)
    plc.restore(snapshot)
    assert plc.program is snapshot["program"]
    plc.scan(81)
    assert (plc["T0"], plc["D0"]) == (10, 1)
    plc.load("LD X0\nOUT Y0")
    with pytest.raises(EcsimError, match="the snapshot was taken with another program; load that one first"):
        plc.restore(snapshot)
