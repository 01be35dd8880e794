"""The scan microscope: what it keeps of a scan, and what it shows at each place in it; no browser."""

import pytest
from ecsim_widgets.microscope import Microscope

# Two steps, each with an output of its own; X0 hands over.
HANDOVER = """VAR_GLOBAL
  Left AT Y0
  Right AT Y1
END_VAR
PROGRAM MAIN
LD SM1
SET S0
STL S0
OUT Left
LD X0
SET S20
STL S20
OUT Right
LD X1
OUT S0
RET
END_PROGRAM"""


@pytest.fixture
def micro(make_rig):
    """A microscope over the chart, paused after two scans."""
    made = Microscope(make_rig(program=HANDOVER))
    made.rig.session.scan(2)
    return made


def points(frame):
    """Each output as (image of the program, terminal)."""
    return {device: (image, terminal) for device, _, image, terminal in frame["points"]}


def go(micro, place):
    micro.receive("go", {"place": place})
    return micro.frame()


def test_a_scan_begins_with_the_input_latch_and_ends_with_the_output_refresh(micro):
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan()
    frame = micro.frame()
    assert (frame["phase"], frame["place"], frame["scan"]) == ("input", 0, 3)
    assert frame["words"] == "The inputs are latched: X0 goes on."
    n = frame["n"]
    assert [go(micro, place)["phase"] for place in (1, n, n + 1, n + 2)] == ["program", "program", "housekeeping", "output"]
    assert frame["last"] == n + 2
    assert go(micro, 99)["place"] == n + 2
    assert go(micro, -5)["place"] == 0


def test_the_hand_over_of_one_scan_is_seen(micro):
    """7.4.1(5): in the scan in which the second step is reached the first one's output is still on."""
    assert points(go(micro, micro.last)) == {"Y0": (1, 1), "Y1": (0, 0)}
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan()
    micro.frame()
    assert points(go(micro, micro.last - 1)) == {"Y0": (1, 1), "Y1": (1, 0)}
    frame = go(micro, micro.last)
    assert points(frame) == {"Y0": (1, 1), "Y1": (1, 1)}
    assert frame["words"] == "The outputs are refreshed: Right Y1 goes on."
    micro.rig.session.scan()
    micro.frame()
    frame = go(micro, micro.last)
    assert points(frame) == {"Y0": (0, 0), "Y1": (1, 1)}
    assert frame["words"] == "The outputs are refreshed: Left Y0 goes off."


def test_each_instruction_tells_its_flow_and_what_it_wrote(micro):
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan()
    micro.frame()
    told = [go(micro, place)["words"] for place in range(1, micro.last - 1)]
    assert "LD X0: power flows, nothing changes." in told
    handover = told.index("SET S20: power flows, S20 goes from 0 to 1 and S0 goes from 1 to 0.")
    assert told.index("OUT Right: power flows, Right Y1 goes from 0 to 1.") > handover > told.index("LD X0: power flows, nothing changes.")
    assert "LD X1: no power, nothing changes." in told


def test_the_ladder_shows_the_memory_of_that_place_and_one_lit_instruction(micro):
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan()
    micro.frame()
    position = next(each.position for each in micro.rig.instructions if str(each) == "SET S20")
    place = next(number for number, entry in enumerate(micro.trace.order, 1) if entry[0] == position)
    before, after = go(micro, place - 1), go(micro, place)
    lit = [key for key, value in after.items() if key.endswith(":class") and str(value).endswith(" here")]
    assert lit == [f"e{position}:class"]
    assert "flow" in after[f"e{position}:class"]
    assert before[f"e{position}:class"] == "coil open"
    assert before[f"e{position}:aria-label"].endswith(", not yet executed")
    assert micro._memory_at(place - 1).lists["S"][20] == 0
    assert micro._memory_at(place).lists["S"][20] == 1
    assert micro.rig.plc["S20"] == 1


def test_writes_stand_in_their_order_and_are_done_here_or_later(micro):
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan()
    micro.frame()
    micro.receive("write", {"by": 1})
    frame = micro.frame()
    assert [(device, old, new, state) for _, _, device, _, old, new, state in frame["writes"]] == [
        ("S20", "0", "1", "here"),
        ("S0", "1", "0", "here"),
        ("Y1", "0", "1", "later"),
    ]
    micro.receive("write", {"by": 1})
    assert [row[-1] for row in micro.frame()["writes"]] == ["done", "done", "here"]
    micro.receive("write", {"by": 1})
    assert micro.frame()["phase"] == "output"
    micro.receive("write", {"by": -1})
    assert [row[-1] for row in micro.frame()["writes"]] == ["done", "done", "here"]


def test_the_next_scan_is_taken_on_demand(micro):
    go(micro, 3)
    micro.receive("next", {})
    frame = micro.frame()
    assert (frame["scan"], frame["place"]) == (3, 0)
    assert micro.rig.plc.scans == 3


def test_a_step_back_shows_the_scan_that_is_then_the_last(micro):
    micro.rig.session.set("X0", 1)
    micro.rig.session.scan(3)
    assert micro.frame()["scan"] == 5
    micro.rig.session.back(2)
    assert micro.frame()["scan"] == 3
    assert points(go(micro, micro.last)) == {"Y0": (1, 1), "Y1": (1, 1)}


def test_each_turn_of_a_loop_is_a_place_of_its_own(make_rig):
    made = Microscope(make_rig(program="LD SM0\nFOR 3\nLD SM0\nINC D0\nNEXT"))
    made.rig.session.scan()
    made.frame()
    told = [go(made, place)["words"] for place in range(1, made.last - 1)]
    counted = [words for words in told if words.startswith("INC D0")]
    assert [words.partition("D0 goes ")[2] for words in counted] == ["from 0 to 1.", "from 1 to 2.", "from 2 to 3."]


def test_without_a_scan_it_says_what_to_do(make_rig):
    made = Microscope(make_rig(program=HANDOVER))
    assert made.frame()["words"] == "Take the next scan to see it slowed down."
    made.rig.plc.stop()
    assert made.frame()["words"] == "The PLC is in STOP: no program is executed."
    made.receive("write", {"by": 1})
    assert made.frame()["place"] == 0
