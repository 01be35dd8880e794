"""What both engines must do alike where programs go unusual ways. Every test runs on each of them."""

import pytest

from ecsim import Plc, SystemBlock
from ecsim.errors import ProgramError


@pytest.fixture(params=["compiled", "stepping", "traced"])
def run(request):
    """A PLC in RUN with a program, on one of the engines."""

    def make(text, watchdog_ms=200, scan_ms=10, model="EC20", **devices):
        plc = Plc(model, scan_ms=scan_ms, input_filter_ms=0, system=SystemBlock(watchdog_ms=watchdog_ms))
        plc.load(text)
        if request.param == "traced":
            plc.tracing = True
        else:
            plc.engine = request.param
        plc.run()
        plc.set(devices)
        return plc

    return make


def call(body, *, main="LD SM0\nCALL SBR_1", variables=""):
    """A main program and a subroutine."""
    return f"PROGRAM MAIN\n{main}\nEND_PROGRAM\nSUBROUTINE SBR_1\n{variables}\n{body}\nEND_SUBROUTINE"


@pytest.mark.parametrize("text", ["LD X0\nNOP", "LD SM0\nMC 0\nLD X0\nNOP\nMCR 0\nLD SM0\nOUT Y0", "STL S0\nLD X0\nNOP\nRET"])
def test_a_rung_that_does_nothing_is_a_program(run, text):
    run(text).scan(2)


def test_a_loop_keeps_its_count_while_a_subroutine_with_a_loop_is_called(run):
    jump = "LD X7\nCJ 1\nLD SM0\nINC D9\nLBL 1"  # units with jumps are compiled in another way
    main = f"LD SM0\nFOR 5\nLD SM0\nCALL SBR_1\nINC D0\nNEXT\n{jump}"
    plc = run(call(f"LD SM0\nFOR 2\nLD SM0\nINC D1\nNEXT\n{jump}", main=main))
    plc.scan()
    assert (plc["D0"], plc["D1"]) == (5, 10)


def test_stop_within_a_subroutine_hands_its_results_over_and_ends_the_scan(run):
    main = "LD SM0\nCALL SBR_1 7 D0\nLD SM0\nINC D1"
    plc = run(call("LD SM0\nMOV #A #B\nSTOP\nINC D2", main=main, variables="VAR_INPUT A : INT\nVAR_OUTPUT B : INT"))
    plc.scan()
    assert not plc.running
    assert (plc["D0"], plc["D1"], plc["D2"]) == (7, 0, 0)
    assert plc["V0"] == 0


def test_stop_within_a_subroutine_holds_when_its_result_cannot_be_stored(run):
    main = "LD SM0\nCALL SBR_1 D7999Z0\nLD SM0\nINC D1"
    plc = run(call("LD SM0\nSTOP", main=main, variables="VAR_OUTPUT B : INT"), Z0=1)
    plc.scan()
    assert not plc.running
    assert plc["D1"] == 0
    assert plc["SD20"] == 65


def time_us(run, text):
    """How long the one scan of a program takes."""
    plc = run(text, watchdog_ms=1000, scan_ms=None)
    plc.scan()
    assert plc.running
    return plc.time_us


@pytest.mark.parametrize("jump", ["\nLD SM0\nCJ 1\nLBL 1", ""], ids=["with a jump", "without"])
def test_each_turn_of_a_loop_takes_the_time_of_its_steps(run, jump):
    # LD 1, ADD 7, NEXT 1: 9 steps of 90 ns a turn.
    few, many = (time_us(run, f"LD SM0\nFOR {turns}\nLD SM0\nADD D0 1 D0\nNEXT{jump}") for turns in (5000, 15000))
    assert many - few == 10000 * 9 * 90 // 1000


def test_a_loop_that_is_left_has_taken_the_turn_in_which_it_was_left(run):
    # LD 1, INC 3, LD= 5, CJ 3, NEXT 1: 13 steps a turn.
    loop = "LD SM0\nFOR 20000\nLD SM0\nINC D0\nLD= D0 {}\nCJ 1\nNEXT\nLBL 1"
    assert time_us(run, loop.format(9000)) - time_us(run, loop.format(8000)) == 1000 * 13 * 90 // 1000


def test_a_way_back_takes_the_time_of_what_it_repeats(run):
    # LBL 3, LD 1, INC 3, LD< 5, CJ 3: 15 steps a turn.
    back = "LBL 1\nLD SM0\nINC D0\nLD< D0 {}\nCJ 1"
    assert time_us(run, back.format(9000)) - time_us(run, back.format(8000)) == 1000 * 15 * 90 // 1000


def test_a_contact_that_clears_an_error_comes_after_the_contacts_before_it(run):
    # SM20 is ON until the compare contact, an application instruction, is executed: the first block has seen it ON.
    plc = run("LD SM1\nMOV D7999Z0 D1\nLD SM20\nLD= D0 5\nORB\nOUT Y0\nLD SM20\nOUT Y1", Z0=1)
    plc.scan()
    assert (plc["Y0"], plc["Y1"]) == (1, 0)
    assert plc["SD20"] == 65


def test_a_loop_without_flow_does_not_look_at_its_count(run):
    plc = run("LD X0\nFOR D7999Z0\nLD SM0\nINC D0\nNEXT", Z0=1)
    plc.scan()
    assert plc["SD20"] == 0
    plc["X0"] = 1
    plc.scan()
    assert plc["SD20"] == 65
    assert plc["D0"] == 0


def test_the_scan_times_go_on_after_a_step_back(run):
    plc = run("LD X0\nFOR 30000\nLD SM0\nADD D0 1 D0\nNEXT", watchdog_ms=1000, scan_ms=None)
    plc.scan(2)
    before = plc.snapshot()
    plc["X0"] = 1
    plc.scan()
    assert plc["SD30"] == 24  # 30,000 turns of 9 steps, 90 ns each
    plc.restore(before)
    plc.scan()
    assert plc["SD30"] == 1


def test_devices_in_a_row_that_leave_their_area_are_refused(run):
    with pytest.raises(ProgramError, match="'X377' reaches beyond X377"):
        run("LD SM0\nABS X377 M10 D100")  # it reads X377 and the two behind it
