"""A panel as a widget: what it sends, when, and what a message from the page does; no browser."""

import pytest
from ecsim_widgets.machine import Machine
from ecsim_widgets.panel import Panel
from ecsim_widgets.stream import Stream
from ecsim_widgets.timers import Timers
from ecsim_widgets.transport import Transport
from ecsim_widgets.unit import Unit


class Clock:
    """A clock that the test turns."""

    now_s = 50.0

    def __call__(self):
        return self.now_s


@pytest.fixture
def panel(rig, monkeypatch):
    """Run control, unit and timers of a rig; `sent` has the messages, `tell` is the page's voice."""
    made = Panel(rig, [Transport, Unit, Timers])
    made.sent, made.clock = [], Clock()
    made.stream = Stream(made.clock)
    monkeypatch.setattr(made, "send", made.sent.append)
    made.tell = lambda **message: made._receive(made, message, [])
    return made


def pass_time(panel, seconds):
    panel.clock.now_s += seconds


def test_the_description_names_the_parts_in_their_order(panel):
    assert panel.face["parts"] == ["transport", "unit", "timers"]
    assert panel.face["panels"]["unit"]["model"] == "EC20"


def test_nothing_is_sent_before_a_page_says_hello(panel):
    panel.rig.session.scan(5)
    assert panel.sent == []


def test_a_page_that_says_hello_gets_everything(panel):
    panel.tell(hello=True)
    message = panel.sent[-1]
    assert message["full"] is True
    assert message["state"]["unit"]["X0"] == 0
    assert message["state"]["run"]["mode"] == "RUN"


def test_a_second_page_gets_everything_too(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.rig.session.scan()
    panel.tell(hello=True)
    assert panel.sent[-1]["full"] is True
    assert panel.sent[-1]["state"]["run"]["scan"] == 1


def test_a_frame_has_only_what_has_changed(panel):
    panel.rig.session.scan()
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.rig.put("X3", 1)
    assert panel.sent[-1]["state"]["unit"] == {"X3": 1}
    assert "timers" not in panel.sent[-1]["state"]


def test_a_frame_without_change_is_not_sent(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.show()
    assert len(panel.sent) == 1


def test_frames_are_numbered(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.rig.session.scan()
    assert [message["n"] for message in panel.sent] == [1, 2]


def test_a_message_is_one_call_and_its_effect_is_shown_at_once(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.tell(part="unit", do="set", device="X0", on=1)
    assert panel.rig.terminal("X0") == 1
    assert panel.sent[-1]["state"]["unit"] == {"X0": 1}


def test_a_pulse_between_two_frames_is_told(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.rig.plc["X5"] = 1
    panel.rig.session.scan(4)
    assert panel.sent[-1]["pulsed"] == {"unit": ["Y1"]}


def test_a_page_that_asks_whether_somebody_is_here_is_answered(panel):
    panel.tell(ping=True)
    assert panel.sent == [{"n": 0}]


def test_the_last_state_follows_although_its_frame_was_too_early(panel):
    panel.tell(hello=True)
    panel.rig.put("X1", 1)  # no time has passed since the last frame
    assert len(panel.sent) == 1
    pass_time(panel, 1)
    panel._later.join(timeout=10)
    assert panel.sent[-1]["state"]["unit"] == {"X1": 1}


def test_a_program_that_is_loaded_while_it_runs_gets_a_new_description(panel):
    panel.tell(hello=True)
    pass_time(panel, 1)
    panel.rig.post(lambda plc: plc.load("LD X0\nTON T7 20"))
    message = panel.sent[-1]
    assert [row["device"] for row in message["layout"]["panels"]["timers"]["rows"]] == ["T7"]
    assert message["full"] is True
    assert message["state"]["timers"]["T7.preset"] == 20


def test_a_closed_panel_leaves_the_session(panel):
    panel.tell(hello=True)
    panel.close()
    pass_time(panel, 1)
    panel.rig.session.scan()
    assert len(panel.sent) == 1


def test_a_panel_may_show_one_part_alone(make_rig, shuttle, picture):
    rig = make_rig(shuttle, picture=picture, title="Shuttle")
    panel = Panel(rig, [Machine])
    assert panel.face["panels"]["machine"]["title"] == "Shuttle"
    assert 'id="EC0-part"' in panel.face["panels"]["machine"]["svg"]
    assert panel.last["machine"].items() >= {"part:transform": "translate(0 0)", "X0:class": ""}.items()


def test_the_picture_moves_with_its_plant(make_rig, shuttle, picture):
    rig = make_rig(shuttle, picture=picture)
    machine = Machine(rig)
    rig.plc["X5"] = 1
    rig.session.scan(8)
    assert machine.frame().items() >= {"part:transform": "translate(8 0)", "X0:class": "on"}.items()
