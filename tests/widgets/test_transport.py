"""Run control: each key is one call, each figure comes from the PLC or its session."""

from ecsim_widgets.transport import Transport


def test_one_scan_is_one_scan(rig):
    Transport(rig).receive("scan", {})
    assert rig.run()["scan"] == 1


def test_next_step_scans_until_a_step_changes(rig):
    transport = Transport(rig)
    transport.receive("next_step", {})
    assert rig.active() == ["S0"]
    rig.put("X0", 1)
    transport.receive("next_step", {})
    assert rig.active() == ["S20"]


def test_back_is_one_scan_back(rig):
    transport = Transport(rig)
    rig.session.scan(5)
    transport.receive("back", {})
    assert (rig.run()["scan"], rig.run()["time_us"]) == (4, 40_000)


def test_there_is_no_way_back_before_the_first_scan(rig):
    assert rig.run()["can_back"] is False
    rig.session.scan(1)
    assert rig.run()["can_back"] is True


def test_reset_begins_anew_in_run(rig):
    rig.put("X0", 1)
    rig.session.scan(5)
    Transport(rig).receive("reset", {})
    assert (rig.run()["scan"], rig.run()["time_us"], rig.run()["mode"]) == (0, 0, "RUN")
    assert rig.terminal("X0") == 0


def test_run_and_pause_are_the_sessions_state(rig):
    transport = Transport(rig)
    transport.receive("run", {})
    assert rig.run()["state"] == "running"
    transport.receive("pause", {})
    assert rig.run()["state"] == "paused"
    rig.session.stop()
    assert rig.run()["state"] == "stopped"


def test_a_failed_session_tells_why_it_does_not_run(rig):
    rig.session.state, rig.session.error = "failed", ZeroDivisionError("in the plant")
    Transport(rig).receive("run", {})
    assert rig.run()["error"] == "ZeroDivisionError: in the plant"
    assert "reset" in rig.run()["refused"]


def test_the_speed_is_times_real_time_and_none_is_as_fast_as_possible(rig):
    transport = Transport(rig)
    transport.receive("speed", {"value": 0.25})
    assert rig.session.speed == rig.run()["speed"] == 0.25
    transport.receive("speed", {"value": None})
    assert rig.session.speed is rig.run()["speed"] is None


def test_the_stamp_is_the_plcs_scan_and_time(rig):
    rig.session.scan(25)
    run = rig.run()
    assert (run["scan"], run["time_us"], run["scan_us"]) == (25, 250_000, 10_000)


def test_the_last_24_scan_times_are_kept(rig):
    rig.session.scan(40)
    assert rig.run()["recent"] == [10_000] * 24
    assert Transport(rig).layout()["watchdog_ms"] == 200


def test_the_machine_can_be_disconnected(make_rig, shuttle):
    rig = make_rig(shuttle)
    transport = Transport(rig)
    assert transport.layout()["plant"] is True
    transport.receive("plant", {"on": False})
    assert rig.run()["plant"] is False
    transport.receive("plant", {"on": True})
    assert rig.run()["plant"] is True


def test_without_a_plant_there_is_nothing_to_disconnect(rig):
    assert Transport(rig).layout()["plant"] is False
    rig.connect(True)
    assert rig.run()["plant"] is None


def test_a_fault_of_the_machine_is_told_with_its_code(make_rig):
    rig = make_rig(program="LBL 0\nLD SM0\nCJ 0\n")
    rig.session.scan()
    assert rig.run()["mode"] == "STOP"
    assert rig.run()["fault"].startswith("Error 61, ")
    assert rig.plc.lamps == {"RUN": "off", "ERR": "on", "BAT": "off"}


def test_the_bar_shows_step_changes_breakpoints_and_where_memory_begins(rig):
    transport = Transport(rig)
    transport.receive("break_add", {"text": "S20"})
    rig.session.scan(5)
    rig.put("X0", 1)
    rig.session.scan(100)
    frame = transport.frame()
    assert frame["first"] == 0
    assert frame["events"] == [[1, "step", "S0"], [6, "breakpoint", "S20"], [6, "step", "S20"]]
    assert frame["breaks"] == [["S20", 1, 1, ""]]
    assert rig.run()["hit"] == ""  # nothing runs, so nothing was stopped
    rig.session.state = "paused"
    assert rig.run()["hit"] == "S20"


def test_the_past_is_shown_without_losing_what_came_later(rig):
    transport = Transport(rig)
    rig.session.scan(40)
    transport.receive("seek", {"scan": 10})
    assert (rig.run()["scan"], rig.run()["back"], rig.run()["back_us"]) == (10, 30, 300_000)
    transport.receive("seek", {"scan": 35.0})
    assert (rig.run()["scan"], rig.run()["back"]) == (35, 5)
    transport.receive("seek", {"scan": 900})
    assert (rig.run()["scan"], rig.run()["back"]) == (40, 0)
    transport.receive("seek", {"scan": -5})
    transport.receive("scan", {})
    assert (rig.run()["scan"], rig.run()["back"]) == (1, 0)


def test_a_breakpoint_that_cannot_be_read_is_refused_in_words(rig):
    transport = Transport(rig)
    transport.receive("break_add", {"text": "D0 >"})
    assert "is no condition" in transport.frame()["problem"]
    assert transport.frame()["breaks"] == []
    transport.receive("break_add", {"text": "D0 > 5"})
    transport.receive("break_enable", {"text": "D0 > 5", "on": False})
    assert (transport.frame()["problem"], transport.frame()["breaks"]) == ("", [["D0 > 5", 0, 0, ""]])
    transport.receive("break_remove", {"text": "D0 > 5"})
    assert transport.frame()["breaks"] == []


def test_a_step_back_is_named_as_the_past(rig):
    rig.session.scan(9)
    Transport(rig).receive("back", {})
    assert rig.run()["back"] == 1
