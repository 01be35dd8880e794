"""I/O configuration: base units, extension modules and their terminals, special modules that answer or do not, state."""

import json

import pytest

import ecsim
from ecsim.hardware.modules import DigitalModule, Module

EC20 = [(24, 16), (8, 8), (16, 0), "4AD"]


def refused(call, *words):
    """The message of an EcsimError that names all these words."""
    with pytest.raises(ecsim.EcsimError) as error:
        call()
    for word in words:
        assert word in str(error.value)


def running(il, model="EC20", **settings):
    plc = ecsim.Plc(model, input_filter_ms=0, **settings)
    plc.load(il)
    plc.run()
    return plc


# -- which terminals there are ------------------------------------------------------------------------------------


def test_without_a_configuration_every_input_has_a_terminal():
    plc = running("LD X377\nOUT Y377")
    plc["X377"] = 1
    plc.scan()
    assert plc["Y377"] == 1
    assert [plc[f"SD{number}"] for number in (7, 8, 10, 11, 12)] == [0, 0, 0, 0, 0]


# 24 inputs are X0 to X27; the module of 8 begins with X30, that of 16 with X40; 16 outputs are Y0 to Y17, 8 more Y20 to Y27
@pytest.mark.parametrize(("name", "there"), [("X27", True), ("X30", True), ("X37", True), ("X40", True), ("X57", True), ("X60", False)])
def test_numbers_go_on_from_unit_to_unit(name, there):
    plc = ecsim.Plc("EC20", io=EC20)
    if there:
        plc[name] = 1
        assert plc.inputs.terminals[int(name[1:], 8)]
    else:
        refused(lambda: plc.__setitem__(name, 1), "X60 has no terminal", "X0 to X27", "X30 to X37", "X40 to X57")


def test_a_module_begins_with_a_multiple_of_eight():
    plc = ecsim.Plc("EC20", io=[(10, 6), (4, 4)])
    plc["X11"] = plc["X20"] = plc["X23"] = 1
    for name in ("X12", "X17", "X24"):
        refused(lambda name=name: plc.__setitem__(name, 1), f"{name} has no terminal", "X0 to X11 and X20 to X23")
    assert plc.modules.digital[0].first == {"X": 0o20, "Y": 0o10}


def test_nothing_is_written_when_one_of_several_has_no_terminal():
    plc = ecsim.Plc("EC20", io=(10, 6))
    refused(lambda: plc.set({"X0": 1, "D0": 5, "X12": 1}), "X12")
    assert (plc.inputs.terminals[0], plc["D0"]) == (False, 0)


def test_a_string_of_inputs_and_signals_need_terminals_too():
    plc = ecsim.Plc("EC20", io=(10, 6))
    plc["K2X0"] = 3
    refused(lambda: plc.__setitem__("K4X0", 3), "X12 has no terminal")
    refused(lambda: plc.pulse("X12"), "X12 has no terminal")
    refused(lambda: plc.wire("Y0", "X12"), "X12 has no terminal")


def test_registers_tell_what_is_there():
    plc = running("LD SM0\nNOP", io=EC20)
    assert [plc[f"SD{number}"] for number in (7, 8)] == [2, 1]
    assert plc["SD10"] == 24 * 256 + 16
    assert plc["SD11"] == (8 + 16) * 256 + 8
    assert plc["SD12"] == 0
    assert ecsim.Plc("EC10", io=(16, 14))["SD12"] == 2 * 256 + 1
    assert ecsim.Plc("EC10", io=(14, 10))["SD12"] == 0


# -- what cannot be -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("model", "io", "words"),
    [
        ("EC20", (24, 14), ("no base unit (24, 14)", "(40, 40)")),
        ("EC10", (40, 40), ("no base unit (40, 40)", "(36, 24)")),
        ("EC20", "24/16", ("write (inputs, outputs)",)),
        ("EC20", [], ("write (inputs, outputs)",)),
        ("EC20", ["4AD"], ("no base unit '4AD'",)),
        ("EC20", [(24, 16), "5AM"], ("no special module '5AM'", "4AD")),
        ("EC20", [(24, 16), (0, 0)], ("without inputs and outputs",)),
        ("EC20", [(24, 16), (-8, 8)], ("-8 is no number of points",)),
        ("EC20", [(24, 16), 8], ("8 is no module",)),
        ("EC20", [(24, 16), *["4AD"] * 9], ("room for 8 modules",)),
        ("EC10", [(24, 16), *["4AD"] * 4, (8, 8)], ("room for 4 modules",)),
        ("EC10", [(36, 24), (32, 32), (8, 0)], ("at most 128 points", "132")),
        ("EC20", [(40, 40), (128, 0), (96, 0)], ("no more X", "X0 to X377")),
    ],
)
def test_what_the_model_has_not_is_refused_with_what_it_has(model, io, words):
    refused(lambda: ecsim.Plc(model, io=io), *words)


def test_an_io_module_needs_a_base_unit():
    plc = ecsim.Plc("EC20")
    refused(lambda: plc.modules.add((8, 8)), "needs a base unit", "io=(10, 6)")
    assert plc.modules.add("4AD") is plc.modules[0]


def test_a_module_hangs_on_one_bus_once():
    plc = ecsim.Plc("EC20", io=(24, 16))
    module = plc.modules.add(DigitalModule(8, 0))
    refused(lambda: plc.modules.add(module), "already")
    refused(lambda: ecsim.Plc("EC20", io=(24, 16)).modules.add(module), "already")
    refused(Module(4).remove, "not on the bus", "plc.modules.add")


def test_lists_as_a_file_has_them_are_taken_too():
    plc = ecsim.Plc("EC20", io=[[24, 16], [8, 8], "EC20-4DA"])
    assert (plc.modules.base, len(plc.modules.digital), plc.modules[0].kind) == ((24, 16), 1, "4DA")
    assert ecsim.Plc("EC20", io=[24, 16]).modules.base == (24, 16)


# -- immediate refresh --------------------------------------------------------------------------------------------


def test_a_refresh_of_points_that_are_not_there_is_error_75_and_refreshes_nothing():
    plc = running("LD M0\nREF X0 16\nLD M1\nREF X0 24\nLD M2\nREF Y10 8", io=(10, 6))
    plc["M0"] = 1  # X0 to X17: both groups have a point at least
    plc.scan()
    assert (plc["SD20"], plc["SD26"]) == (0, 255)
    plc["M1"] = 1  # X20 to X27 is group 2
    plc.scan()
    assert (plc["SD20"], plc["SD26"], plc["SM20"]) == (75, 2, 1)
    plc.set({"M1": 0, "M2": 1})  # Y10 to Y17 is group 1
    plc.scan()
    assert plc["SD26"] == 1


def test_a_failed_refresh_leaves_the_inputs_of_the_scan():
    plc = running("LD M1\nREF X0 24\nLD X0\nOUT Y0", io=(10, 6))
    plc["M1"] = 1
    plc.scan()
    plc.inputs.terminals[0] = True  # the wiring changes while the program runs
    plc.scan()
    assert (plc["SD20"], plc["Y0"]) == (75, 0)


def test_a_refresh_beyond_a_removed_module_is_error_75():
    plc = running("LD SM0\nREF X30 8", io=EC20)
    plc.scan()
    assert plc["SD20"] == 0
    plc.modules.digital[0].remove()
    plc.scan()
    assert (plc["SD20"], plc["SD26"]) == (75, 3)


# -- modules that do not answer -----------------------------------------------------------------------------------


def test_a_special_module_that_was_removed_does_not_answer_until_it_is_back():
    plc = running("LD SM0\nFROM 1 0 D0 1", io=[(24, 16), "4AD", "4AD"])
    plc.scan()
    assert (plc["SD20"], plc["SD25"], plc["SM192"]) == (0, 255, 0)
    plc.modules[1].remove()
    plc.scan()
    assert (plc["SD20"], plc["SD25"], plc["SM192"]) == (74, 1, 1)
    assert plc.running
    plc.modules[1].insert()
    plc.scan()
    assert (plc["SM20"], plc["SM192"]) == (0, 0)


def test_a_module_that_does_not_answer_is_a_system_error_that_stops_nothing_and_clears_itself():
    plc = running("LD SM0\nNOP", "EC10", io=[(24, 16), (8, 8), "4AD"])
    plc.modules.digital[0].remove()
    assert ([error.code for error in plc.errors], plc["SM3"], plc["SD3"]) == ([21], 1, 21)
    plc.modules[0].remove()
    assert ([error.code for error in plc.errors], plc.lamps["ERR"], plc.running) == ([21, 22], "flashing", True)
    plc.modules.digital[0].insert()
    plc.modules[0].insert()
    assert (plc.errors, plc["SM3"], plc["SD3"], plc.lamps["ERR"]) == ([], 0, 0, "off")


def test_ec10_names_the_module_that_does_not_answer():
    plc = running("LD SM0\nNOP", "EC10", io=[(24, 16), (8, 8), (8, 8), "4AD", "4DA"])
    plc.modules.digital[1].remove()
    plc.modules[1].remove()
    assert [plc[name] for name in ("SM191", "SM192", "SD191", "SD192")] == [1, 1, 1, 1]
    plc.modules.digital[1].insert()
    assert [plc[name] for name in ("SM191", "SM192", "SD191", "SD192")] == [0, 1, 0, 1]


def test_the_alarm_stays_through_stop_and_run():
    plc = running("LD SM0\nNOP", io=[(24, 16), "4AD"])
    plc.modules[0].remove()
    plc.stop()
    plc.run()
    assert plc["SM192"] == 1


def test_power_up_forgets_what_was_removed_and_counts_anew():
    plc = ecsim.Plc("EC20", io=[(24, 16), (8, 8), (16, 0), "4AD", "4DA"])
    plc.modules[0].remove()
    plc.modules.digital[0].remove()
    plc.power_cycle()
    assert plc.modules[0].kind == "4DA"
    assert plc.modules.digital[0].first["X"] == 0o30
    assert [plc[f"SD{number}"] for number in (7, 8)] == [1, 1]
    assert plc["SM192"] == 0


def test_a_removed_io_module_takes_its_terminals_along():
    plc = ecsim.Plc("EC20", io=EC20)
    plc.modules.digital[0].remove()
    refused(lambda: plc.__setitem__("X30", 1), "X0 to X27 and X40 to X57")
    plc["X40"] = 1  # the others keep their numbers


# -- state --------------------------------------------------------------------------------------------------------


def test_a_snapshot_of_the_bus_is_plain_data_that_another_plc_understands():
    plc = ecsim.Plc("EC20", io=[*EC20, "4DA"])
    plc.modules.add(Module(3)).write(0, [7, 8, 9])
    plc.modules[0].volts[2] = 5
    plc.modules[1].remove()
    plc.advance(ms=35)
    copy = json.loads(json.dumps(plc.modules.snapshot()))
    other = ecsim.Plc("EC20")
    other.modules.restore(copy)
    assert other.modules.snapshot() == plc.modules.snapshot()
    assert other.modules[0].volts[2] == 5
    assert other.modules[2].buffers == [7, 8, 9]
    refused(lambda: other.__setitem__("X60", 1), "X0 to X27")


def test_going_back_keeps_the_modules_that_one_holds():
    plc = ecsim.Plc("EC20", io=EC20)
    module = plc.modules[0]
    module.volts[0] = 1
    before = plc.snapshot()
    module.volts[0] = 2
    module.remove()
    plc.restore(before)
    assert plc.modules[0] is module
    assert (module.present, module.volts[0]) == (True, 1)


class Odd(Module):
    """A module that ecsim does not know."""

    kind = "odd"


def test_a_module_of_a_kind_of_ones_own_has_to_be_there():
    plc, other = ecsim.Plc("EC20"), ecsim.Plc("EC20")
    plc.modules.add(Odd(2)).write(0, [1, 2])
    refused(lambda: other.modules.restore(plc.modules.snapshot()), "'odd'", "plc.modules[0]")
    other.modules.add(Odd(2))
    other.modules.restore(plc.modules.snapshot())
    assert other.modules[0].buffers == [1, 2]
