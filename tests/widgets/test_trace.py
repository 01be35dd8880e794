"""The trace panel: message -> scope, scope -> frame; no browser."""

import base64
import gzip
import re

import pytest
from ecsim_widgets.trace import LEFT, Trace

STEPS = """PROGRAM MAIN
LD X0
EU
OUT Y1
LD SM1
SET S0
// wait
STL S0
LD X0
SET S20
// hold
STL S20
OUT Y2
LD X1
OUT S0
RET
LD SM0
INC D0
MOV D0 D5
END_PROGRAM"""


@pytest.fixture
def trace(make_rig):
    """Ten scans of 10 ms with X0 on from scan 3 to 5: Y1 is on in scan 3 alone."""
    made = Trace(make_rig(program=STEPS, traced=["X0", "Y1", "S", "D0"]))
    for scan in range(1, 11):
        made.rig.session.set("X0", int(3 <= scan <= 5))
        made.rig.session.scan()
    return made


def markup(trace, lane):
    """What is drawn of one lane, all pieces together."""
    frame = trace.frame()
    place = [each.name for each in trace.scope.lanes].index(lane)
    return "".join(frame[f"k{slot}.{place}:markup"] for slot in range(9))


def test_lanes_are_those_that_were_asked_for(trace):
    assert [(lane.name, lane.style) for lane in trace.scope.lanes] == [("X0", "bit"), ("Y1", "bit"), ("S", "steps"), ("D0", "curve")]


def test_without_a_choice_the_wired_points_and_the_steps_are_shown(make_rig, shuttle):
    assert [lane.name for lane in Trace(make_rig(shuttle)).scope.lanes] == ["X0", "X5", "Y0", "S"]
    assert [lane.name for lane in Trace(make_rig(program="LD X3\nOUT Y4")).scope.lanes] == ["X3", "Y4"]


def test_a_pulse_of_one_scan_is_a_pin_at_every_zoom(trace):
    for span in (800_000, 4_000_000, 400_000_000):
        trace.receive("look", {"begin": 0, "span": span})
        assert markup(trace, "Y1").count('class="pin"') == 1, span


def test_a_frame_tells_the_values_of_now_and_at_the_cursors(trace):
    frame = trace.frame()
    assert (frame["va0:text"], frame["va2:text"], frame["va3:text"], frame["ha:text"]) == ("0", "S20", "10", "now")
    trace.receive("cursor", {"letter": "A", "at": 30_000})
    trace.receive("cursor", {"letter": "B", "at": 60_000})
    frame = trace.frame()
    assert [frame[f"va{lane}:text"] for lane in range(4)] == ["1", "1", "S20", "3"]
    assert [frame[f"vb{lane}:text"] for lane in range(4)] == ["0", "0", "S20", "6"]
    assert frame["ga0:class"] == "bv on"
    assert frame["between"] == "30 ms · 3 scans"
    assert frame["cA:aria-valuetext"] == "0.030000 s"


def test_a_cursor_tells_a_screen_reader_its_second_and_the_ends_of_the_window(trace):
    trace.receive("look", {"begin": 10_000, "span": 100_000})
    assert trace.frame()["cA:aria-valuenow"] is None  # it has not been placed
    trace.receive("cursor", {"letter": "A", "at": 30_000})
    frame = trace.frame()
    assert [float(frame[f"cA:aria-value{word}"]) for word in ("min", "now", "max")] == [0.01, 0.03, 0.11]


def test_a_cursor_is_caught_by_an_edge_nearby(trace):
    trace.receive("look", {"begin": 0, "span": 100_000})
    a_pixel = trace.scope.span_us / trace.plot
    trace.receive("cursor", {"letter": "A", "at": 30_000 + 5 * a_pixel})
    assert trace.scope.cursors["A"] == 30_000
    trace.receive("cursor", {"letter": "A", "at": 34_900})
    assert trace.scope.cursors["A"] == 34_900
    trace.receive("cursor", {"letter": "A", "at": None})
    assert trace.scope.cursors["A"] is None


def test_cursors_go_from_edge_to_edge_and_take_a_held_window_along(trace):
    trace.receive("look", {"begin": 0, "span": 8_000})
    trace.receive("edge", {"letter": "A", "forward": True, "lane": 0})
    assert trace.scope.cursors["A"] == 30_000
    begin, span = trace.scope.window()
    assert begin <= 30_000 <= begin + span
    trace.receive("edge", {"letter": "A", "forward": True, "lane": 0})
    assert trace.scope.cursors["A"] == 60_000
    trace.receive("edge", {"letter": "A", "forward": False, "lane": 1})
    assert trace.scope.cursors["A"] == 40_000


def test_a_trigger_holds_the_window_around_its_moment(trace):
    trace.receive("zoom", {"factor": 0.02, "at": 0})
    trace.receive("arm", {"text": "x0 rises and D0 > 11"})
    assert trace.frame()["armed"] is True
    trace.rig.session.set("X0", 1)
    trace.rig.session.scan()  # D0 is 11
    assert trace.scope.armed
    trace.rig.session.set("X0", 0)
    trace.rig.session.scan()
    trace.rig.session.set("X0", 1)
    trace.rig.session.scan(30)
    assert trace.scope.hit_us == 130_000
    begin, span = trace.scope.window()
    assert span == 80_000
    assert begin == 130_000 - 20_000  # a quarter lies before
    frame = trace.frame()
    assert (frame["armed"], frame["hit"], frame["following"]) == (False, "0.130 s", False)
    assert frame["trig:transform"] == f"translate({LEFT + trace.plot // 4} 0)"
    trace.receive("arm", {"text": ""})
    assert trace.frame()["hit"] == ""


@pytest.mark.parametrize(
    ("verb", "values", "words"),
    [
        ("arm", {"text": "X0 jumps"}, "'X0 jumps' is no condition"),
        ("arm", {"text": "M99 rises"}, "M99 is not recorded; recorded are X0, Y1, S, D0"),
        ("add", {"names": "Q7"}, "Q7"),
        ("add", {"names": "D0"}, "D0 is recorded already"),
        ("export", {"form": "doc"}, "cannot be written as 'doc'"),
    ],
)
def test_what_is_refused_is_told_and_changes_nothing(trace, verb, values, words):
    before = trace.frame()
    trace.receive(verb, values)
    after = trace.frame()
    assert words in after.pop("said")
    before.pop("said")
    assert after == before
    trace.receive("follow", {"on": True})
    assert trace.frame()["said"] == ""


def test_lanes_come_go_and_move(trace):
    trace.receive("add", {"names": "m3, T0:bool C0"})
    assert [lane.name for lane in trace.scope.lanes[4:]] == ["M3", "T0:BOOL", "C0"]
    trace.receive("remove", {"lane": 1})
    trace.receive("move", {"lane": 2, "to": 0})
    assert [lane.name for lane in trace.scope.lanes] == ["D0", "X0", "S", "M3", "T0:BOOL", "C0"]
    assert trace.scope.recording.names == ["X0", "S", "D0", "M3", "T0:BOOL", "C0"]
    assert trace.frame()["va0:text"] == "10"
    trace.receive("style", {"lane": 0})
    assert trace.scope.lanes[0].style == "bus"
    with pytest.raises(ValueError, match="no lane 9"):
        trace.receive("remove", {"lane": 9})


def test_a_trigger_goes_with_the_lane_that_it_needs(trace):
    trace.receive("arm", {"text": "Y1 falls"})
    trace.receive("remove", {"lane": 1})
    assert not trace.scope.armed
    trace.rig.session.scan(3)
    assert trace.frame()["trigger"] == ""


def test_names_of_the_program_stand_for_their_devices(make_rig):
    made = Trace(make_rig())
    made.receive("add", {"names": "settle"})
    made.receive("arm", {"text": "START rises"})
    assert made.said == ""
    assert made.scope.lanes[-1].name == "T0"
    assert made.scope.trigger.text == "X5 rises"
    svg = made.frame()["svg"]
    assert re.search(r">Start</text><text[^>]*>X5<", svg)


def test_going_back_forgets_what_came_after(trace):
    drawn = markup(trace, "X0")
    trace.rig.session.set("X0", 1)
    trace.rig.session.scan(2)
    assert markup(trace, "X0") != drawn
    trace.rig.session.back(9)  # to the end of scan 3
    assert trace.scope.recording.changes("X0") == [(10_000, 0), (30_000, 1)]
    assert trace.scope.recording.times[-1] == 30_000
    assert markup(trace, "Y1").count('class="pin"') == 0  # it is still on
    assert trace.frame()["va3:text"] == "3"


def test_while_it_follows_the_window_goes_on_by_an_eighth(trace):
    trace.receive("zoom", {"factor": 0.02, "at": 0})
    assert trace.scope.window() == (20_000, 80_000)
    trace.rig.session.scan()
    assert trace.scope.window() == (30_000, 80_000)
    trace.receive("zoom", {"factor": 10, "at": 100_000})
    assert trace.scope.window() == (0, 800_000)
    pieces = [key for key, value in trace.frame().items() if key.endswith(":markup") and key.startswith("k") and value]
    before = trace.frame()
    trace.rig.session.scan()
    after = trace.frame()
    assert pieces
    assert {key for key in after if after[key] != before[key] and key.startswith("k")} <= {
        "k0.3:markup",
        "k1.3:markup",
    }  # D0 alone has changed


def test_what_is_too_fast_for_the_pixels_is_said(trace):
    trace.rig.session.scan(3000)
    trace.receive("look", {"begin": 0, "span": 400_000_000})
    assert "in a pixel: edges in one pixel are a solid bar" in trace.frame()["foot"]
    trace.receive("look", {"begin": 0, "span": 2_000_000})
    assert trace.frame()["foot"] == "200 scans shown, none left out"
    trace.receive("all", {})
    begin, span = trace.scope.window()
    assert begin <= 10_000
    assert begin + span >= trace.rig.plc.time_us


@pytest.mark.parametrize(("form", "beginning"), [("csv", b"time_s,scan,X0,Y1,S,D0\n"), ("vcd", b"$version ecsim"), ("png", b"\x89PNG")])
def test_everything_is_given_as_a_file(trace, form, beginning):
    answer = trace.receive("export", {"form": form})
    assert answer["name"] == f"trace.{form}"
    assert gzip.decompress(base64.b64decode(answer["packed"])).startswith(beginning)


def test_a_page_gets_the_answer_that_it_asked_for(make_rig):
    from ecsim_widgets.panel import Panel

    panel = Panel(make_rig(), [Trace])
    sent = []
    panel.send = sent.append
    panel._receive(panel, {"part": "trace", "do": "export", "form": "csv", "asked": 0.5}, [])
    assert sent[0]["asked"] == 0.5
    assert sent[0]["answer"]["name"] == "trace.csv"


def test_another_program_leaves_the_lanes(trace):
    trace.rig.plc.load("LD X0\nOUT Y1\nLD SM1\nSET S5\nSTL S5\nRET")
    trace.rig.plc.run()
    trace.rig.read_program()
    again = Trace(trace.rig)
    again.rig.session.scan()
    assert [lane.name for lane in again.scope.lanes] == ["X0", "Y1", "S", "D0"]
    assert again.frame()["va2:text"] == "S5"
