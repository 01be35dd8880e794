"""The chart's panel: which steps are active, what they do and wait for, which were taken."""

import re

import pytest
from ecsim_widgets.chart import Chart
from ecsim_widgets.ladder import Ladder

from ecsim import EcsimError


@pytest.fixture
def holding(rig):
    """A rig with the machine in S20."""
    rig.session.scan(3)
    rig.put("X0", 1)
    rig.session.scan(2)
    rig.put("X0", 0)
    rig.session.scan(4)
    return rig


def test_every_step_has_its_name_outputs_and_followers(rig):
    steps = Chart(rig).layout()["steps"]
    assert list(steps) == ["S0", "S20"]
    assert steps["S20"] == {"name": "hold it", "outputs": [["", "Y2"], ["Settle", "T0"]], "ways": [["S0"]], "then": ["S0"]}


def test_the_active_step_tells_what_it_does_and_waits_for(holding):
    frame = Chart(holding).frame()
    assert frame["active"] == ["S20"]
    assert frame["S20:class"] == "step active"
    now = frame["S20.now"]
    assert now["outputs"] == [["", "Y2", 1], ["Settle", "T0", 0]]
    assert now["waits"] == [[("Settle", "T0", "on")]]
    assert now["elapsed_us"] == now["scans"] * 10_000 > 0


def test_a_step_that_is_not_active_says_nothing_of_now(holding):
    assert "S0.now" not in Chart(holding).frame()


def test_the_log_tells_the_steps_taken_and_why(holding):
    newest = Chart(holding).frame()["log"][0]
    assert newest[1:] == ["S0", "S20", "X0 on"]


def test_a_step_back_takes_the_log_back(holding):
    chart = Chart(holding)
    holding.session.back(6)
    frame = chart.frame()
    assert frame["active"] == ["S0"]
    assert [entry[2] for entry in frame["log"]] == ["S0"]


def test_a_drawing_is_laid_out_for_the_pages_width(rig):
    panel = Chart(rig)
    panel.receive("fit", {"width": 640})
    sheet = panel.frame()["sheet"]
    assert ' width="640"' in sheet["svg"]
    panel.receive("fit", {"width": 640})
    assert panel.frame()["sheet"] is sheet


def test_the_ladder_shows_the_power_of_the_last_scan(rig):
    ladder = Ladder(rig)
    coil = next(i.position for i in rig.instructions if str(i) == "OUT Lamp")
    rig.session.scan()
    assert ladder.frame()[f"e{coil}:class"] == "coil open"
    rig.put("X5", 1)
    rig.session.scan(2)
    assert ladder.frame()[f"e{coil}:class"] == "coil flow"


def test_the_ladder_knows_where_each_step_begins(rig):
    ladder = Ladder(rig)
    steps = ladder.layout()["steps"]
    assert list(steps) == ["S0", "S20"]
    assert [str(ladder.drawing.entries[number].words[0]) for number in steps.values()] == ["STL S0", "STL S20"]


def test_the_ladder_is_laid_out_for_the_pages_width(rig):
    ladder = Ladder(rig)
    ladder.receive("fit", {"width": 640})
    sheet = ladder.frame()["sheet"]
    assert ' width="640"' in sheet["svg"]
    ladder.receive("fit", {"width": 640})
    assert ladder.frame()["sheet"] is sheet


def test_a_breakpoint_is_set_on_a_step_and_taken_away(rig):
    chart = Chart(rig)
    chart.receive("break", {"step": "S20"})
    assert [point.text for point in rig.session.breakpoints] == ["S20"]
    assert chart.frame()["breaks"] == {"S20": 1}
    assert chart.frame()["kS20:class"] == "breakpoint"
    rig.session.breakpoints.enable("S20", False)
    assert chart.frame()["kS20:class"] == "breakpoint off"
    chart.receive("break", {"step": "S20"})
    assert (len(rig.session.breakpoints), chart.frame()["kS20:class"]) == (0, "breakpoint none")
    with pytest.raises(EcsimError, match="no step 'X0'"):
        chart.receive("break", {"step": "X0"})


def test_held_transitions_fire_by_hand(rig):
    chart = Chart(rig)
    rig.session.scan(2)
    chart.receive("hold", {"on": True})
    rig.put("X0", 1)
    rig.session.scan(3)
    assert (chart.frame()["active"], chart.frame()["held"]) == (["S0"], 1)
    chart.receive("fire", {"step": "S0"})
    assert chart.frame()["active"] == ["S20"]
    assert chart.frame()["log"][0][1:3] == ["S0", "S20"]
    chart.receive("fire", {"step": "S0"})
    assert "S0 is not active" in rig.run()["refused"]
    chart.receive("hold", {"on": False})
    assert chart.frame()["held"] == 0


def test_a_step_is_set_and_reset_by_hand(rig):
    chart = Chart(rig)
    rig.session.scan(2)
    chart.receive("step", {"step": "S20", "on": True})
    assert chart.frame()["active"] == ["S0", "S20"]
    chart.receive("step", {"step": "S0", "on": False})
    assert chart.frame()["active"] == ["S20"]


# -- a large chart -------------------------------------------------------------------------------------------------


@pytest.fixture
def make_chain(make_rig):
    """Make a rig with a chain of steps, one below the other: 100 and more px for each, one in four or five of a band's 480 px."""

    def make(count):
        chain = [0, *range(20, 19 + count)]
        ways = zip(chain, [*chain[1:], 0], strict=True)
        lines = (f"STL S{here}\nOUT M{here}\nLD X{here % 2}\n{'SET' if there else 'OUT'} S{there}" for here, there in ways)
        text = "\n".join(lines)
        rig = make_rig(program=f"LD SM1\nSET S0\n{text}\nRET")
        rig.session.scan(2)
        return rig

    return make


def drawn(frame):
    """The numbers of the bands whose drawings are in a frame."""
    return {int(key.removeprefix("band.")) for key in frame if key.startswith("band.")}


def test_a_chart_of_sixty_steps_is_there_as_a_whole(make_chain):
    frame = Chart(make_chain(60)).frame()
    assert drawn(frame) == set(frame["live"]) == set(range(len(frame["sheet"]["bands"])))
    assert all(f"S{number}:class" in frame for number in (0, *range(20, 79)))
    assert all(f'id="EC0-S{number}"' in "".join(frame[f"band.{band}"] for band in frame["live"]) for number in (0, *range(20, 79)))


def test_of_a_large_chart_a_page_gets_what_it_looks_at(make_chain):
    rig = make_chain(330)
    chart = Chart(rig)
    first = chart.frame()
    sheet = first["sheet"]
    last = len(sheet["bands"]) - 1
    assert last == 64
    assert drawn(first) == set(range(6))
    assert len(str(first)) < 0.4 * sum(len(chart.sheet.band(number, "")) for number in range(last + 1))
    assert "S348:class" not in first
    _, top, band = sheet["steps"]["S348"]
    assert 480 * band <= top < 480 * (band + 1)
    assert sheet["bands"][band][0] <= top <= sheet["bands"][band][1]
    chart.receive("see", {"view": "a", "first": last - 3, "last": last + 9})
    frame = chart.frame()
    assert frame["looked"] == frame["live"] == [last - 3, last - 2, last - 1, last]
    assert 'data-device="S348"' in frame[f"band.{band}"]
    assert frame["S348:class"] == "step"
    assert "S0:class" not in frame
    rig.session.set_step("S348", True)
    assert chart.frame()["S348:class"] == "step active"
    for first in range(last):
        chart.receive("see", {"view": "a", "first": first, "last": first})
    assert drawn(chart.frame()) == set(range(last - 60, last))
    assert len(chart.frame()["live"]) == 16
    chart.receive("see", {"view": "a", "first": -5, "last": 10_000})
    assert chart.frame()["looked"] == list(range(40))


def test_the_lines_of_all_bands_are_those_of_the_whole_chart(make_chain):
    """Each line once, be it in a band or, as it is longer, in what is around them."""
    chart = Chart(make_chain(30))
    pieces = [chart.sheet.shell(), *(chart.sheet.band(number, "") for number in range(len(chart.sheet.bands)))]

    def lines(markup):
        paths = re.findall(r'class="link[ dbl]*" d="([^"]*)"', markup) + re.findall(r'd="([^"]*)" class="link', markup)
        return sorted(line for path in paths for line in path.split("M") if line)

    assert lines("".join(pieces)) == lines(chart.drawing.svg("", chart.width))
    assert len(lines("".join(pieces))) > 60


def test_what_was_looked_at_long_ago_has_no_entries_left(make_chain):
    rig = make_chain(100)
    chart = Chart(rig)
    assert chart.frame()["S0:class"] == "step active"
    for first in (4, 8, 12, 16, 20):
        chart.receive("see", {"view": "a", "first": first, "last": first + 3})
    rig.put("X0", 1)  # S0 and S20 are left one behind the other, S21 waits for X1
    rig.session.scan(2)
    frame = chart.frame()
    assert frame["active"] == ["S21"]
    assert "S0:class" not in frame
    assert 0 not in frame["live"]
    chart.receive("see", {"view": "a", "first": 0, "last": 3})
    assert (chart.frame()["S0:class"], chart.frame()["S21:class"]) == ("step", "step active")
    chart.receive("unsee", {"view": "a"})
    rig.put("X0", 0)
    rig.put("X1", 1)
    rig.session.scan(2)
    assert chart.frame()["S22:class"] == "step active"
    assert chart.frame()["looked"] == []
