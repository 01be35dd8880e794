"""Special modules, potentiometers, the input filter, immediate refresh and the EEPROM."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ecsim
from ecsim.hardware.modules import Module
from ecsim.system import SystemBlock


def running_plc(il, model="EC20", **settings):
    plc = ecsim.Plc(model, **settings)
    plc.load(il)
    plc.run()
    return plc


# -- special modules ----------------------------------------------------------------------------------------------


@given(words=st.lists(st.integers(-0x8000, 0x7FFF), min_size=6, max_size=6))
def test_what_is_written_to_a_module_is_read_from_it(running, words):
    plc = running("LD SM0\nTO 2 4 D0 4\nDTO 2 8 D4 1\nFROM 2 4 D100 6\nDFROM 2 4 D200 3")
    plc.modules[2] = Module(10)
    plc.set({f"D{place}": word for place, word in enumerate(words)})
    plc.scan()
    assert [plc[f"D{100 + place}"] for place in range(6)] == words
    assert [plc[f"D{200 + place}"] for place in range(6)] == words
    assert plc.modules[2].buffers == [0, 0, 0, 0, *words]


@pytest.mark.parametrize("line", ["FROM 3 8 D100 3", "DFROM 3 9 D100 1", "TO 3 10 D100 1", "DTO 3 0 D100 6"])
def test_a_buffer_that_a_module_has_not_is_error_78_and_nothing_moves(line):
    plc = running_plc(f"LD SM0\n{line}")
    plc.modules[3] = Module(10)
    plc["D100"] = 7
    plc.scan()
    assert (plc["SD20"], plc["SD25"], plc["D100"]) == (78, 3, 7)
    assert plc.modules[3].buffers == [0] * 10


def test_a_module_pulled_out_is_error_73():
    plc = running_plc("LD SM0\nFROM 1 0 D100 1")
    plc.modules[1] = Module(1)
    plc.scan()
    assert (plc["SD20"], plc["SD25"]) == (0, 255)
    del plc.modules[1]
    plc.scan()
    assert (plc["SD20"], plc["SD25"]) == (73, 1)


def test_a_snapshot_holds_the_buffers():
    plc = running_plc("LD M0\nTO 0 0 D0 1")
    plc.modules[0] = Module(1)
    before = plc.snapshot()
    plc.set({"M0": 1, "D0": 5})
    plc.scan()
    assert plc.modules[0].buffers == [5]
    plc.restore(before)
    assert plc.modules[0].buffers == [0]


def test_the_rack_has_eight_places_for_modules():
    plc = ecsim.Plc("EC20")
    assert len(plc.modules) == 0
    for place, module in ((8, Module(1)), (0, "4XY"), (0, 7)):
        with pytest.raises(ecsim.EcsimError):
            plc.modules[place] = module
    with pytest.raises(ecsim.EcsimError, match="the rack is empty"):
        plc.modules[0]


# -- potentiometers -----------------------------------------------------------------------------------------------


@given(first=st.integers(0, 255), second=st.integers(0, 255))
def test_a_potentiometer_is_read_where_it_stands(running, first, second):
    plc = running("LD SM0\nVRRD 0 D0\nVRRD 1 D1\nVRRD 2 D2")
    plc.pots[0], plc.pots[1] = first, second
    plc["D2"] = 9
    plc.scan()
    assert [plc["D0"], plc["D1"], plc["D2"]] == [first, second, 0]
    assert list(plc.pots) == [first, second]


@pytest.mark.parametrize(("number", "value"), [(2, 0), (-1, 0), (0, 256), (0, -1), (0, 1.5)])
def test_a_potentiometer_that_cannot_be_is_refused(number, value):
    with pytest.raises(ecsim.EcsimError, match="potentiometer"):
        ecsim.Plc("EC10").pots[number] = value


def test_a_snapshot_holds_the_potentiometers():
    plc = ecsim.Plc("EC10")
    plc.pots[1] = 200
    before = plc.snapshot()
    plc.pots[1] = 100
    plc.restore(before)
    assert plc.pots[1] == 200


# -- inputs -------------------------------------------------------------------------------------------------------


def delay_ms(plc):
    """How long X0 takes to be seen, in scans of 1 ms."""
    plc["X0"] = 1
    waited = 0
    while not plc["Y0"]:
        plc.scan()
        waited += 1
    plc["X0"] = 0
    plc.advance(ms=100)
    return waited - 1


@pytest.mark.parametrize(
    ("model", "asked", "given"),
    [("EC20", 30, 30), ("EC20", 65535, 64), ("EC20", 0, 0), ("EC10", 31, 16), ("EC10", 7, 0), ("EC10", 1000, 64)],
)
def test_the_filter_is_what_was_asked_for_or_the_next_shorter(model, asked, given):
    plc = running_plc("LD M0\nREFF D0\nLD X0\nOUT Y0", model, scan_ms=1)
    plc.set({"M0": 1, "D0:WORD": asked})
    plc.scan()
    assert delay_ms(plc) == given


def test_the_filter_of_the_system_block_comes_back_at_run():
    plc = running_plc("LD M0\nREFF 40\nLD X0\nOUT Y0", scan_ms=1, input_filter_ms=20)
    plc["M0"] = 1
    plc.scan()
    plc["M0"] = 0
    assert (delay_ms(plc), plc["SD35"]) == (40, 20)
    plc.stop()
    plc.run()
    assert delay_ms(plc) == 20


def test_a_longer_filter_holds_for_a_level_that_waits_already():
    plc = running_plc("LD M0\nREFF 50\nLD X0\nOUT Y0", scan_ms=1, input_filter_ms=10)
    plc["X0"] = 1
    plc.advance(ms=5)
    plc["M0"] = 1
    plc.advance(ms=40)
    assert plc["Y0"] == 0
    plc.advance(ms=10)
    assert plc["Y0"] == 1


def test_a_snapshot_holds_the_filter():
    plc = running_plc("LD M0\nREFF 50\nLD X0\nOUT Y0", scan_ms=1, input_filter_ms=10)
    before = plc.snapshot()
    plc["M0"] = 1
    plc.scan()
    plc.restore(before)
    assert delay_ms(plc) == 10


def test_an_immediate_refresh_takes_its_own_group_only():
    plc = running_plc("LD M0\nREF X10 8\nLD X10\nOUT Y0\nLD X0\nOUT Y1", scan_ms=1, input_filter_ms=0)
    plc["M0"] = 1
    plc.scan()
    plc.inputs.terminals[0] = plc.inputs.terminals[8] = True  # the wiring changes while the program runs
    plc.scan()
    assert (plc["Y0"], plc["Y1"]) == (1, 0)


@pytest.mark.parametrize(
    ("line", "message"),
    [("REF X1 8", "group of eight"), ("REF Y0 12", "multiple of 8"), ("REF Y0 264", "8 to 256"), ("REF X370 16", "reaches beyond X377")],
)
def test_points_that_are_no_groups_of_eight_are_refused(line, message):
    with pytest.raises(ecsim.ProgramError, match=message):
        ecsim.compile(f"LD M0\n{line}", "EC20")


# -- the EEPROM ---------------------------------------------------------------------------------------------------


@pytest.fixture
def saving():
    """An EC10 that saves D0 registers from D6000 on when M0 rises, and D6016 when M1 rises."""
    plc = running_plc("LD M0\nEROMWR D6000 D0\nLD M1\nEROMWR D6016 1", "EC10", scan_ms=2)
    plc["D0"] = 3
    return plc


def test_a_write_takes_five_milliseconds(saving):
    assert saving["SM196"] == 1
    saving["M0"] = 1
    saving.scan()
    assert saving["SM196"] == 0
    saving.scan()
    assert saving["SM196"] == 0
    saving.scan()
    assert saving["SM196"] == 1


def test_a_second_write_meanwhile_is_not_carried_out(saving):
    saving.set({"M0": 1, "D6000": 1, "D6002": 3, "D6016": 9})
    saving.scan()
    saving["M1"] = 1
    saving.scan()
    assert saving.eeprom.cells == {6000: 1, 6001: 0, 6002: 3}
    saving["M1"] = 0
    saving.scan(3)
    saving["M1"] = 1
    saving.scan()
    assert saving.eeprom.cells[6016] == 9
    assert saving["SD20"] == 0


@pytest.mark.parametrize(
    ("start", "count", "legal"), [(6984, 15, True), (6985, 15, False), (6000, 0, True), (6000, 16, False), (6000, -1, False)]
)
def test_the_block_lies_in_its_area(start, count, legal):
    plc = running_plc(f"LD M0\nEROMWR D{start} D0", "EC10")
    plc.set({"M0": 1, "D0": count})
    plc.scan()
    assert plc["SD20"] == (0 if legal else 64)
    assert len(plc.eeprom.cells) == (count if legal else 0)


def test_saved_registers_win_over_the_data_block_and_held_values_but_not_over_retained_ones():
    block = SystemBlock(retain={"D": [(6001, 6001)]}, hold_values=True, data_block={"D6000": 50, "D6001": 51, "D6002": 52})
    plc = running_plc("LD M0\nEROMWR D6000 3", "EC10", system=block)
    plc.set({"D6000": 1, "D6001": 2, "D6002": 3, "M0": 1})
    plc.scan()
    plc.set({"D6000": 10, "D6001": 20, "D6002": 30})
    plc.stop()
    plc.run()
    assert [plc["D6000"], plc["D6001"], plc["D6002"]] == [1, 20, 3]


def test_a_write_lengthens_a_modelled_scan():
    plc = running_plc("LD M0\nEROMWR D6000 1", "EC10", scan_ms=None)
    plc.scan()
    idle = plc.time_us
    plc["M0"] = 1
    plc.scan()
    assert plc.time_us - idle >= 5000
