"""The machine: RUN and STOP, power, the scan circle, its special relays and registers, time, loading, snapshots.

The tests of the input filter, the clock relays and the error record stand in tests/hardware, those of the system block's
settings in test_system_block.py, those of endless programs in test_endless_programs.py.
"""

import pytest

import ecsim
from ecsim import Plc, SystemBlock
from ecsim.assembler import assemble
from ecsim.errors import EcsimError, ProgramError

MODELS = ["EC10", "EC20"]


def running(text="", model="EC20", scan_ms=10, tracing=False, **system):
    """A PLC in RUN with a program; no input filter."""
    plc = Plc(model, scan_ms=scan_ms, system=SystemBlock(**({"input_filter_ms": 0} | system)))
    plc.load(text)
    plc.tracing = tracing
    plc.run()
    return plc


# -- RUN and STOP (2.1.6) -----------------------------------------------------------------------------------------

CELLS = ("Y0", "M0", "S20", "T0", "T0:BOOL", "C0", "C0:BOOL", "C200", "D0", "V0", "Z0", "LM0")


def filled(**system):
    """A PLC in STOP whose cells are all 1."""
    plc = Plc("EC20", system=SystemBlock(**system))
    plc.set(dict.fromkeys(CELLS, 1))
    return plc


def values(plc):
    """The cells that are not 0."""
    return [name for name in CELLS if plc[name]]


def test_a_new_plc_is_powered_and_in_stop():
    plc = Plc()
    assert (plc.model.name, plc.running, plc.time_us, plc.scans) == ("EC20", False, 0, 0)
    assert (plc["SM0"], plc["SM2"], plc["SD0"]) == (0, 1, 20)
    assert repr(plc) == "<Plc EC20 STOP, 0 steps>"


def test_stop_to_run_clears_what_is_not_retained():
    plc = filled()
    plc.run()
    assert values(plc) == []


@pytest.mark.parametrize(("model", "areas"), [("EC10", "DMSC"), ("EC20", "DMSCT")])
def test_stop_to_run_keeps_the_retained_ranges(model, areas):
    plc = Plc(model, system=SystemBlock(retain={area: [(2, 4)] for area in areas}))
    names = [f"{area}{n}" for area in areas for n in range(1, 6)]
    plc.set(dict.fromkeys(names, 1))
    plc.run()
    assert [name for name in names if plc[name]] == [f"{area}{n}" for area in areas for n in (2, 3, 4)]


def test_a_retained_counter_keeps_value_and_contact():
    plc = running("LD X0\nCTU C0 2\nLD C0\nOUT Y0", retain={"C": [(0, 0)]})
    for level in (1, 0, 1, 0):
        plc["X0"] = level
        plc.scan()
    plc.stop()
    plc.run()
    plc.scan()
    assert (plc["C0"], plc["C0:BOOL"], plc["Y0"]) == (2, 1, 1)


def test_held_values_survive_stop_to_run_but_no_loss_of_power():
    plc = filled(hold_values=True)
    plc.run()
    assert values(plc) == list(CELLS)
    plc.power_cycle()
    assert values(plc) == []


def test_the_data_block_comes_before_held_values_and_after_retained_ones():
    plc = Plc(
        "EC20",
        system=SystemBlock(data_block={"D0": 7, "D2": -3, "D4:DINT": 100_000, "D6:REAL": 1.5}, hold_values=True, retain={"D": [(2, 2)]}),
    )
    plc.set({"D0": 1, "D2": 2, "D3": 3})
    plc.run()
    assert [plc[name] for name in ("D0", "D2", "D3", "D4:DINT", "D6:REAL")] == [7, 2, 3, 100_000, 1.5]


def test_a_data_block_that_is_not_valid_is_not_loaded():
    plc = Plc("EC20", system=SystemBlock(data_block={"D0": 7}, data_block_valid=False))
    plc.run()
    assert plc["D0"] == 0


def test_run_to_stop_keeps_the_values():
    plc = running("LD SM0\nINC D0\nSET M0\nOUT Y0\nSET S20\nTON T0 1")
    plc.scan(20)
    plc.stop()
    plc.scan(3)
    assert [plc[name] for name in ("D0", "M0", "S20", "T0:BOOL", "SM0")] == [20, 1, 1, 1, 0]


@pytest.mark.parametrize(
    ("system", "outputs"),
    [({}, (0, 0, 0)), ({"stop_outputs": "freeze"}, (1, 0, 0)), ({"stop_outputs": "configure", "stop_output_table": {"Y1": 1}}, (0, 1, 0))],
)
def test_outputs_in_stop_do_what_the_system_block_says(system, outputs):
    plc = running("LD SM0\nOUT Y0", **system)
    plc.scan()
    plc.stop()
    plc.scan()
    assert (plc["Y0"], plc["Y1"], plc["Y2"]) == outputs


def test_a_loss_of_power_clears_what_is_not_retained_and_runs_again():
    plc = running("LD SM1\nINC D0\nLD SM2\nINC D1\nLD SM0\nSET M1", retain={"D": [(0, 1)]})
    plc.scan(3)
    assert (plc["D0"], plc["D1"]) == (1, 1)
    plc["M2"] = 1
    plc.power_cycle()
    assert plc.running
    assert plc["M2"] == 0
    plc.scan(3)
    assert (plc["D0"], plc["D1"]) == (2, 2)


def test_run_in_run_and_stop_in_stop_do_nothing():
    plc = running("LD SM1\nINC D0")
    plc.scan(2)
    plc.run()
    plc.scan(2)
    assert plc["D0"] == 1
    plc.stop()
    plc["Y0"] = 1
    plc.stop()
    assert plc["Y0"] == 1


def test_timers_begin_anew_after_stop():
    plc = running("LD SM0\nTON T0 5\nTON T252 300", hold_values=True)
    plc.scan(31)
    assert (plc["T0"], plc["T252"]) == (3, 300)
    plc.stop()
    plc.scan(100)
    plc.run()
    plc.scan(11)
    assert plc["T0"] == 1  # 5.4.1, rule 4: the first execution begins at 0
    assert plc["T252"] == 100


def test_an_edge_counts_as_off_before_the_first_scan():
    plc = running("LD X0\nEU\nINC D0\nLD X0\nCTU C0 9\nLD X0\nED\nINC D1", hold_values=True)
    plc["X0"] = 1
    plc.scan(2)
    plc.stop()
    plc.run()
    plc.scan(2)
    assert (plc["D0"], plc["C0"], plc["D1"]) == (2, 2, 0)


# -- special relays and registers (appendices 1 and 2) -------------------------------------------------------------


def test_first_scan_and_power_up_are_on_for_one_scan():
    plc = running("LD SM1\nINC D0\nLD SM2\nINC D1\nLD SM0\nINC D2")
    plc.scan(5)
    assert (plc["D0"], plc["D1"], plc["D2"]) == (1, 1, 5)
    plc.stop()
    plc.run()
    plc.scan(5)
    assert (plc["D0"], plc["D1"]) == (1, 0)  # no power-up this time


def test_power_up_stays_on_until_a_program_has_run():
    plc = Plc()
    plc.scan(3)
    assert plc["SM2"] == 1
    plc.run()
    assert (plc["SM1"], plc["SM2"]) == (1, 1)
    plc.scan()
    assert (plc["SM1"], plc["SM2"]) == (0, 0)


@pytest.mark.parametrize(("model", "type_code"), [("EC10", 10), ("EC20", 20)])
def test_the_type_of_the_plc_is_in_sd0_and_its_capacity_in_sd2(model, type_code):
    plc = Plc(model)
    assert (plc["SD0"], plc["SD1"], plc["SD2"], plc["SD25"], plc["SD26"]) == (type_code, 100, 12, 255, 255)


def test_special_devices_get_their_initial_values_at_run_but_for_the_pulse_counts():
    plc = Plc()
    plc.set({"SM40": 1, "SM80": 1, "SD66": 5})
    plc.memory.lists["SD"][50:56] = [1, 2, 3, 4, 5, 6]
    plc.run()
    assert [plc[name] for name in ("SM40", "SM80", "SD66")] == [0, 0, 0]
    assert [plc[f"SD{n}"] for n in range(50, 56)] == [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize("name", ["SM0", "SM15", "SM20", "SD0", "SD20", "SD34", "SD19:DINT"])
def test_what_the_system_writes_cannot_be_written_from_outside(name):
    plc = running()
    before = plc[name]
    with pytest.raises(EcsimError, match=f"{name} cannot be written: the system writes it"):
        plc[name] = 1
    assert plc[name] == before


@pytest.mark.parametrize(("scan_ms", "shown"), [(1, 1), (1.4, 1), (1.5, 2), (10, 10), (49.9, 50)])
def test_scan_times_are_shown_in_milliseconds(scan_ms, shown):
    plc = running("LD SM0\nINC D0", scan_ms=scan_ms)
    plc.scan(3)
    assert (plc["SD30"], plc["SD31"], plc["SD32"]) == (shown, shown, shown)


def test_least_and_greatest_scan_time_are_kept():
    plc = running("LD M0\nFOR D0\nLD SM0\nADD D1 1 D1\nNEXT", scan_ms=None, watchdog_ms=1000)
    seen = []
    for turns in (30_000, 0, 12_000):
        plc.set({"M0": 1, "D0": turns})
        plc.scan()
        seen.append((plc["SD30"], plc["SD31"], plc["SD32"]))
    # 9 steps of 90 ns a turn: 24.3 ms, the shortest scan 1 ms, 9.7 ms
    assert seen == [(24, 24, 24), (1, 1, 24), (10, 1, 24)]


def test_a_constant_scan_is_told_and_lasts_as_long_as_set():
    plc = running("LD SM0\nINC D0", scan_ms=None, constant_scan_ms=25, watchdog_ms=100)
    plc.scan(4)
    assert plc.time_us == 100_000
    assert (plc["SM8"], plc["SD33"], plc["SD34"], plc["SD30"]) == (1, 25, 100, 25)


def test_a_program_longer_than_the_constant_scan_takes_its_own_time():
    plc = running("LD SM0\nFOR 30000\nLD SM0\nADD D1 1 D1\nNEXT", scan_ms=None, constant_scan_ms=5, watchdog_ms=200)
    plc.scan()
    assert plc["SD30"] == 24


def test_the_input_filter_is_told_in_sd35():
    assert Plc("EC20")["SD35"] == 10
    assert Plc("EC10")["SD35"] == 8
    assert Plc("EC20", input_filter_ms=33)["SD35"] == 33


# -- the scan circle (2.1.2) --------------------------------------------------------------------------------------


def test_an_input_set_between_two_scans_is_seen_by_the_next_one():
    plc = running("LD X0\nOUT Y0")
    plc["X0"] = 1
    assert plc["X0"] == 0  # the image takes it over at the refresh
    plc.scan()
    assert (plc["X0"], plc["Y0"]) == (1, 1)


def test_an_input_does_not_change_within_a_scan_and_stays_until_it_is_set_again():
    plc = running("LD X0\nOUT Y0\nLD SM0\nMOV K1X0 D0")
    plc["X0"] = 1
    plc.scan(5)
    assert (plc["Y0"], plc["D0"]) == (1, 1)


def test_in_stop_the_program_rests_and_inputs_and_time_go_on():
    plc = running("LD SM0\nINC D0")
    plc.scan(2)
    plc.stop()
    plc["X0"] = 1
    plc.scan(3)
    assert (plc["D0"], plc["X0"], plc.time_us, plc.scans) == (2, 1, 50_000, 5)


def test_a_coil_is_seen_by_the_rungs_behind_it_in_the_same_scan():
    plc = running("LD M0\nOUT Y0\nLD SM0\nOUT M0\nLD M0\nOUT Y1")
    plc.scan()
    assert (plc["Y0"], plc["Y1"]) == (0, 1)
    plc.scan()
    assert plc["Y0"] == 1


# -- time ---------------------------------------------------------------------------------------------------------


def test_a_scan_takes_its_period():
    plc = running(scan_ms=7)
    plc.scan(3)
    assert (plc.time_us, plc.scans) == (21_000, 3)


@pytest.mark.parametrize(
    ("scan_ms", "pieces", "total_ms"),
    [(10, [3] * 100, 300), (10, [33, 7, 60], 100), (7, [10] * 70, 700), (2.5, [1] * 333, 333), (10, [0.5] * 99, 49.5)],
)
def test_time_asked_for_in_pieces_does_not_drift(scan_ms, pieces, total_ms):
    in_pieces, at_once = running(scan_ms=scan_ms), running(scan_ms=scan_ms)
    for ms in pieces:
        in_pieces.advance(ms=ms)
    at_once.advance(ms=total_ms)
    assert in_pieces.time_us == at_once.time_us
    assert 0 <= in_pieces.time_us - total_ms * 1000 < scan_ms * 1000


def test_the_scans_that_begin_within_the_time_are_done():
    plc = running("LD SM0\nINC D0")
    plc.advance(ms=95)
    assert (plc["D0"], plc.time_us) == (10, 100_000)
    plc.advance(ms=5)
    assert plc["D0"] == 10
    plc.advance(ms=1)
    assert plc["D0"] == 11


def test_a_timer_is_as_exact_as_the_scan_allows():
    plc = running("LD X0\nTON T0 10", scan_ms=10)
    plc.scan(3)
    plc["X0"] = 1
    plc.scan(100)
    assert plc["T0:BOOL"] == 0
    plc.scan()
    assert plc["T0:BOOL"] == 1


def test_until_gives_the_time_it_took():
    plc = running("LD SM0\nTON T0 10")
    assert plc.until("T0:BOOL", timeout_ms=2000) == 1010  # the hundred and first scan has just been done
    assert plc.until("T0:BOOL") == 0


def test_until_waits_for_any_value():
    plc = running("LD SM0\nINC D0")
    assert plc.until("D0", value=7) == 70


def test_until_says_what_did_not_happen():
    plc = running()
    with pytest.raises(EcsimError, match="Y0 did not become 1 within 100 ms of simulated time; it is 0"):
        plc.until("Y0", timeout_ms=100)
    assert plc.time_us == 100_000


# -- the watchdog (2.1.4, error 61) --------------------------------------------------------------------------------

LOOP = "LD SM0\nFOR {}\nLD SM0\nADD D0 1 D0\nNEXT\nLD SM0\nSET M0"
BACK = "LBL 1\nLD SM0\nDINC D10\nLDD< D10 {}\nCJ 1\nLD SM0\nSET M0"


@pytest.mark.parametrize("tracing", [False, True], ids=["compiled", "stepping"])
@pytest.mark.parametrize("text", [LOOP, BACK], ids=["FOR", "CJ"])
def test_a_program_that_takes_too_long_is_stopped(text, tracing):
    # A turn of either takes about 1 us: 9 or 18 steps of 90 ns. 1,000 turns are within 5 ms, 10,000 are not.
    plc = running(text.format(1_000), watchdog_ms=5, tracing=tracing)
    plc.scan()
    assert (plc.running, plc["M0"], plc["SD20"]) == (True, 1, 0)
    plc = running(text.format(10_000), watchdog_ms=5, tracing=tracing)
    plc.scan()
    assert (plc.running, plc["M0"], plc["SD20"], plc["SM20"]) == (False, 0, 61, 1)
    assert [error.code for error in plc.errors] == [61]
    assert "watchdog" in str(plc.errors[0])


def test_the_watchdog_looks_at_each_scan_for_itself():
    plc = running(LOOP.format(4_000), watchdog_ms=5)
    plc.scan(50)
    assert plc.running


def test_wdt_begins_the_watchdogs_time_again():
    text = "\n".join([LOOP.format(4_000)] * 2)
    assert running(text, watchdog_ms=5).scan() is None
    without, with_wdt = (running(body, watchdog_ms=5) for body in (text, text.replace("SET M0\n", "SET M0\nWDT\n", 1)))
    without.scan()
    with_wdt.scan()
    assert (without.running, with_wdt.running) == (False, True)


def test_a_plc_that_was_stopped_by_its_watchdog_runs_again():
    plc = running("LD X0\nFOR 30000\nLD SM0\nADD D0 1 D0\nNEXT", watchdog_ms=5)
    plc["X0"] = 1
    plc.scan()
    assert not plc.running
    plc["X0"] = 0
    plc.run()
    plc.scan(3)
    assert plc.running
    assert plc.errors == []


@pytest.mark.parametrize("tracing", [False, True], ids=["compiled", "stepping"])
def test_the_stop_instruction_ends_the_scan_and_the_run(tracing):
    plc = running("LD X0\nSTOP\nLD SM0\nINC D0\nOUT Y0", tracing=tracing)
    plc.scan(2)
    plc["X0"] = 1
    plc.scan(2)
    assert (plc.running, plc["D0"], plc["Y0"], plc["SM0"]) == (False, 2, 0, 0)
    assert plc.errors == []


# -- loading ------------------------------------------------------------------------------------------------------


def test_a_program_that_does_not_compile_leaves_the_loaded_one_running():
    plc = running("VAR_GLOBAL\nLamp AT Y0\nEND_VAR\nPROGRAM MAIN\nLD SM0\nINC D0\nLD X0\nEU\nINC D1\nEND_PROGRAM")
    plc["X0"] = 1
    plc.scan(2)
    before = plc.program
    for text in ("LD X0", "LD X0\nOUT X1", "NONSENSE"):
        with pytest.raises(ProgramError):
            plc.load(text)
    assert plc.program is before
    assert plc.running
    plc.scan(3)
    assert (plc["D0"], plc["D1"], plc["Lamp"]) == (5, 1, 0)


def test_a_download_stops_a_running_plc_and_keeps_its_values():
    plc = running("LD SM0\nINC D0\nOUT Y0")
    plc.scan(3)
    plc.load("LD SM0\nINC D1")
    assert (plc.running, plc["D0"], plc["Y0"]) == (False, 3, 0)
    plc.run()
    plc.scan(2)
    assert (plc["D0"], plc["D1"]) == (0, 2)


def test_load_gives_the_program_and_takes_one():
    plc = Plc()
    program = plc.load("LD X0\nOUT Y0")
    assert plc.program is program
    other = Plc()
    other.load(program)
    assert other.program is program
    assert repr(program) == "<Program EC20, 1 unit, 2 steps>"


def test_a_program_of_another_model_is_refused():
    with pytest.raises(EcsimError, match="the program was compiled for EC10, this is an EC20; compile it for EC20"):
        Plc("EC20").load(assemble("LD X0\nOUT Y0", "EC10"))


def test_a_load_of_something_else_is_refused():
    with pytest.raises(EcsimError, match="a program is a text, a path, a Project or a Program, not int"):
        Plc().load(5)


def test_the_public_compile_tells_all_errors():
    with pytest.raises(ProgramError) as error:
        ecsim.compile("LD X9\nOUT X0", "EC10")
    assert len(error.value.problems) == 2
    assert ecsim.compile("LD X177\nOUT Y0", "EC10").model.name == "EC10"
    assert ecsim.compile("LD X377\nOUT Y0").model.name == "EC20"


def test_an_unknown_model_is_told_with_the_known_ones():
    with pytest.raises(EcsimError, match="there is no model 'EC30'; ecsim knows EC10, EC20, H1U, H2U"):
        Plc("EC30")
    assert Plc("ec10").model.name == "EC10"


def test_an_unknown_engine_is_told_with_the_known_ones():
    with pytest.raises(EcsimError, match="there is no engine 'fast'; choose compiled or stepping"):
        Plc().engine = "fast"


# -- the engines --------------------------------------------------------------------------------------------------


def test_the_engine_may_change_between_any_two_scans():
    plc = running("LD X0\nEU\nINC D0\nLD SM0\nTON T0 3\nCTU C0 5\nLD SM15\nCTU C1 99")
    plc["X0"] = 1
    for scan in range(40):
        plc.engine = ("compiled", "stepping")[scan % 2]
        plc.scan()
    assert (plc["D0"], plc["T0"], plc["C0"], plc["C1"]) == (1, 3, 1, 20)


def test_tracing_records_flow_contacts_and_writes():
    plc = running("LD X0\nAND X1\nOUT Y0\nLDI X0\nOUT Y1", tracing=True)
    plc["X0"] = 1
    plc.scan()
    trace = plc.trace
    assert trace.flow == [True, False, False, False, False]
    assert trace.closed == [True, False, None, False, None]
    assert trace.writes == []
    plc["X1"] = 1
    plc.scan()
    assert [(write.position, write.device, write.old, write.new) for write in plc.trace.writes] == [(2, "Y0", 0, 1)]


def test_there_is_no_trace_before_the_first_traced_scan():
    plc = running("LD X0\nOUT Y0")
    plc.scan()
    assert plc.trace is None
    assert plc.engine == "compiled"
    plc.tracing = True
    assert plc.engine == "stepping"
    plc.tracing = False
    assert plc.engine == "compiled"


# -- snapshots ----------------------------------------------------------------------------------------------------

EVERYTHING = """PROGRAM MAIN
LD SM1
SET S0
SET SM66
MOV 3 SD66
EI
STL S0
OUT Y0
LD X0
SET S20
STL S20
TON T1 2
LD T1
OUT S0
RET
LD SM12
EU
INC D0
LD X1
TONR T252 500
LD SM15
CTU C0 30000
LD X2
ED
INC D2
END_PROGRAM
INTERRUPT I EVENT 26
LD SM0
INC D9
END_INTERRUPT"""


def drive(plc, chance, scans):
    """Random levels on the inputs, a scan each; all that can be seen afterwards."""
    for _ in range(scans):
        plc["X0"], plc["X1"], plc["X2"] = (chance.randint(0, 1) for _ in range(3))
        plc.scan()
    return {name: list(values) for name, values in plc.memory.lists.items()} | {
        "time": plc.time_us,
        "scans": plc.scans,
        "running": plc.running,
    }


@pytest.mark.parametrize("filter_ms", [0, 10])
@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_a_snapshot_restored_goes_on_in_the_same_way(engine, filter_ms):
    import random

    plc = running(EVERYTHING, input_filter_ms=filter_ms)
    plc.engine = engine
    drive(plc, random.Random(1), 57)
    kept = plc.snapshot()
    first = drive(plc, random.Random(2), 130)
    drive(plc, random.Random(3), 77)
    plc.restore(kept)
    assert drive(plc, random.Random(2), 130) == first


def test_a_snapshot_of_run_brings_a_stopped_plc_back_into_run():
    plc = running("LD X0\nSTOP\nLD SM0\nINC D0")
    plc.scan(2)
    kept = plc.snapshot()
    plc["X0"] = 1
    plc.scan()
    assert not plc.running
    plc.restore(kept)
    plc.scan()
    assert (plc.running, plc["D0"]) == (True, 3)


def test_restoring_twice_gives_the_same_twice():
    plc = running("LD SM0\nINC D0")
    kept = plc.snapshot()
    for _ in range(2):
        plc.restore(kept)
        plc.scan(3)
        assert plc["D0"] == 3


def test_a_run_is_the_same_every_time():
    import random

    first, second = (drive(running(EVERYTHING), random.Random(5), 300) for _ in range(2))
    assert first == second
