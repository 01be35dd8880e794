"""The table of watched devices: adding, formats, order, completion."""

import pytest
from ecsim_widgets.table import Row, Table, looks

from ecsim import EcsimError, Plc
from ecsim.devices import Device
from ecsim.values import BOOL, DINT, DWORD, INT, REAL, WORD


@pytest.fixture
def table(rig):
    """An empty table of a running PLC."""
    return Table(rig.plc, rig.point)


def shown(table):
    return [table.rows[number].name for number in table.order()]


def test_every_way_to_look_at_a_register():
    assert list(looks((INT, WORD, DINT, DWORD, REAL))) == [
        "decimal", "hex", "binary", "octal", "text", "unsigned", "decimal 32", "hex 32", "binary 32", "octal 32", "text 32", "unsigned 32", "real",
    ]  # fmt: skip
    assert list(looks((BOOL,))) == ["bit"]
    assert list(looks((DINT, DWORD, BOOL))) == ["decimal", "hex", "binary", "octal", "text", "unsigned", "contact"]


def test_devices_names_and_ranges_are_added_in_the_order_of_their_numbers(table):
    table.add("Start D0")
    table.add("X6-X11")  # octal
    table.add("D4\N{EN DASH}8:REAL")
    assert shown(table) == ["X5", "D0", "X6", "X7", "X10", "X11", "D4:REAL", "D6:REAL", "D8:REAL"]


def test_what_is_there_already_is_not_added_twice(table):
    first = table.add("D0-D2")
    assert table.add("D1") == [first[1]]
    assert shown(table) == ["D0", "D1", "D2"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("D9999", "D9999"),
        ("Nobody", "no device"),
        ("D5-D1", "range"),
        ("D0-X5", "range"),
        ("", "name a device"),
        ("D0 Q1", "Q1"),
        ("C198-C202:INT", "C202"),
        ("X0:REAL", "REAL"),
    ],
)
def test_what_cannot_be_added_is_refused_and_nothing_is_added(table, text, words):
    with pytest.raises(EcsimError, match=words):
        table.add(text)
    assert table.rows == {}


def test_all_registers_fit_but_a_table_has_an_end(table):
    assert len(table.add("D0-D7999")) == 8000
    table.add("M0-M1999 D0-D7998:DINT X0-X377 Y0-Y377 T0-T255 C0-C255 S0-S991")
    with pytest.raises(EcsimError, match="20,000"):
        table.add("T0-T255:BOOL D1-D7998:WORD")
    assert len(table.rows) == 8000 + 2000 + 4000 + 512 + 512 + 992


@pytest.mark.parametrize(
    ("look", "text", "name"),
    [
        ("decimal", "-2", "D0"),
        ("unsigned", "65534", "D0:WORD"),
        ("hex", "16#FFFE", "D0"),
        ("binary", "2#1111111111111110", "D0"),
        ("octal", "8#177776", "D0"),
        ("decimal 32", "-131071", "D0:DINT"),  # -2 * 65536 + 1
        ("hex 32", "16#FFFE0001", "D0:DINT"),
    ],
)
def test_a_value_in_every_format(rig, look, text, name):
    rig.plc.set({"D0": -2, "D1": 1})
    row = Row(rig.plc, Device("D", 0), INT)
    row.look_as(look)
    assert (row.text(), row.name) == (text, name)


def test_a_real_and_a_text(rig):
    rig.plc["D0:REAL"] = -12.5
    rig.plc["D2"] = 0x4241
    real, text = Row(rig.plc, Device("D", 0), REAL), Row(rig.plc, Device("D", 2), INT, "text")
    assert (real.text(), real.look, real.bits()) == ("-12.5", "real", 0xC1480000)  # IEEE 754
    assert text.text() == "'AB'"


def test_a_look_that_does_not_suit_is_refused_and_the_row_stays(rig):
    for device, look in ((Device("M", 0), "hex"), (Device("D", 7999), "real")):
        row = Row(rig.plc, device, rig.plc.memory.types(device)[0])
        before = row.look
        with pytest.raises(EcsimError):
            row.look_as(look)
        assert row.look == before


def test_rows_are_found_by_device_name_and_comment(table):
    table.add("X0-X7 Y0 T0")
    for find, found in (("sta", ["X5"]), ("BUTTON", ["X5"]), ("settle", ["T0"]), ("x7", ["X7"]), ("lamp", ["Y0"]), ("zzz", [])):
        table.arrange(find=find)
        assert shown(table) == found


def test_rows_are_sorted_by_device_name_and_value(table):
    table.add("D10 D9 X5 D2")
    table.plc.set({"D10": 1, "D9": 3, "D2": 2})
    table.arrange(sort="device")
    assert shown(table) == ["D2", "D9", "D10", "X5"]
    table.arrange(sort="value", down=True)
    assert shown(table) == ["D9", "D2", "D10", "X5"]
    table.plc["X5"] = 1
    table.plc["D10"] = 9
    assert shown(table) == ["D9", "D2", "D10", "X5"]  # nothing moves by itself
    table.arrange(sort="name")
    assert shown(table)[0] == "X5"
    table.arrange()
    assert shown(table) == ["D10", "D9", "X5", "D2"]


def test_only_what_has_changed_since_or_is_forced(table):
    table.add("D0-D9")
    table.arrange(only="changed")
    assert shown(table) == []
    table.plc["D3"] = 5
    table.look_again()
    table.plc["D3"] = 0
    table.look_again()
    assert shown(table) == ["D3"]  # it has changed, though it is again what it was
    table.plc.force("D5", 1)
    table.arrange(only="forced")
    assert shown(table) == ["D5"]
    table.plc.unforce()
    table.look_again()
    assert shown(table) == []


def test_a_double_word_is_forced_with_one_of_its_registers(rig):
    row = Row(rig.plc, Device("D", 4), DINT)
    rig.plc.force("D5", 1)
    assert row.forced(rig.plc.memory.forces())
    rig.plc.unforce()
    rig.plc.force("D6", 1)
    assert not row.forced(rig.plc.memory.forces())


def test_what_was_cleared_can_be_put_back(table):
    table.add("D0-D3")
    table.clear()
    assert (shown(table), table.can_put_back) == ([], True)
    table.put_back()
    assert shown(table) == ["D0", "D1", "D2", "D3"]
    assert table.add("D1") == [2]
    table.clear()
    table.add("D7")
    assert not table.can_put_back  # nothing new is lost


def test_completion_offers_names_devices_in_use_and_whole_areas(table):
    assert ("Start", "X5", "start button") in table.offers("st")
    assert ("Settle", "T0", "") in table.offers("D0 set")
    assert ("Y2", "", "") in table.offers("y")
    assert ("D0-D7999", "", "all 8,000 of them") in table.offers("d")
    assert ("D0-D99", "", "100 devices") in table.offers("d0-d99")
    assert ("D77", "", "") in table.offers("D77")
    assert table.offers("") == table.offers("D0 ") == []


def test_a_table_that_nobody_has_touched_follows_the_program(make_rig):
    rig = make_rig()
    assert shown(rig.table) == ["X5", "Y0", "T0"]
    rig.plc.load("LD X1\nMOV 5 D7\nOUT Y3")
    rig.read_program()
    assert shown(rig.table) == ["X1", "Y3", "D7"]
    rig.table.add("D9")
    rig.plc.load("LD X2\nOUT Y4")
    rig.read_program()
    assert shown(rig.table) == ["X1", "Y3", "D7", "D9"]


def test_a_table_may_be_given(make_rig):
    assert shown(make_rig(devices=["D0-D2", "Start"]).table) == ["D0", "D1", "D2", "X5"]


# -- analog terminals ----------------------------------------------------------------------------------------------


@pytest.fixture
def analog():
    """The table of an EC20 with a 4AD and a 4DA."""
    plc = Plc("EC20", io=[(24, 16), "4AD", "4DA"])
    return Table(plc, lambda device: ("Level", "level of the tank") if device == "AI0.0" else ("", ""))


def test_an_analog_terminal_is_a_row_with_its_signal(analog):
    (number,) = analog.add("ai0.0:MA")
    row = analog.rows[number]
    assert (row.name, str(row.device), row.look, row.text()) == ("AI0.0:mA", "AI0.0", "mA", "none")
    analog.plc["AI0.0:mA"] = 12.5
    assert row.text() == "12.5"
    analog.add("AI0.0:V D0 AO1.3:V")
    assert shown(analog) == ["AI0.0:mA", "AI0.0:V", "D0", "AO1.3:V"]
    assert [analog.rows[n].text() for n in analog.order()] == ["12.5", "none", "0", "0"]


@pytest.mark.parametrize(("text", "words"), [("AI0.7:V", "channel 7"), ("AI3.0:V", "place 3"), ("AO1.0:C", "degrees"), ("AI0.0", "AI0.0")])
def test_a_terminal_that_is_not_there_is_refused_in_words(analog, text, words):
    with pytest.raises(EcsimError, match=words):
        analog.add(text)
    assert analog.rows == {}


def test_terminals_are_offered_by_their_first_letters(analog):
    assert analog.offers("ai0.0") == [("AI0.0:V", "", "Level"), ("AI0.0:mA", "", "Level")]
    assert analog.offers("D0 ao1.3:v") == [("AO1.3:V", "", "analog output")]


def test_terminals_are_sorted_and_found_as_devices_are(analog):
    analog.add("D0 AO1.0:V AI0.2:V AI0.0:V")
    analog.plc["D0"], analog.plc["AI0.2:V"] = 3, 2.5
    analog.arrange(sort="device")
    assert shown(analog) == ["AI0.0:V", "AI0.2:V", "AO1.0:V", "D0"]
    analog.arrange(sort="value")
    assert shown(analog) == ["AI0.0:V", "AO1.0:V", "AI0.2:V", "D0"]  # without a signal, 0 V, 2.5 V, 3
    analog.arrange(find="level")
    assert shown(analog) == ["AI0.0:V"]
    analog.arrange(only="changed")
    analog.plc["AI0.0:V"] = 1
    analog.look_again()
    assert shown(analog) == ["AI0.0:V"]  # those without a signal have not changed


def test_a_terminal_whose_module_has_gone_has_no_signal(analog):
    (number,) = analog.add("AI0.0:V")
    analog.plc["AI0.0:V"] = 1
    del analog.plc.modules[0]
    assert analog.rows[number].text() == "none"


def test_a_terminal_has_one_look(analog):
    (number,) = analog.add("AI0.0:V")
    with pytest.raises(EcsimError, match="row of its own"):
        analog.look_as(number, "hex")
