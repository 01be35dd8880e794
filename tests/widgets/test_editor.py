"""The editor's Python side: a message is one answer, and what was typed outlives the cell that shows it."""

import pytest
from ecsim_widgets.editor import Editor

SOURCE = "LD X0\nOUT Y0\nLD SM0\nINC D0\n"


@pytest.fixture
def rig(make_rig):
    Editor._desks.clear()
    return make_rig(program=SOURCE)


@pytest.fixture
def editor(rig):
    return Editor(rig)


def test_it_shows_the_source_of_the_program(editor):
    assert editor.layout() == {"source": SOURCE, "draft": None, "model": "EC20", "about": "6 steps"}


def test_what_is_typed_is_answered_under_its_number(editor):
    text = SOURCE + "OUT X9"
    editor.on_typed(text, len(text), 7)
    told = editor.frame()["help"]
    assert told["n"] == 7
    assert [mark[:3] for mark in told["marks"]] == [(5, 5, 2)]
    assert told["signature"]["mnemonic"] == "OUT"
    assert told["from"] == len(text) - 2


def test_a_run_is_a_change_in_the_plc(editor, rig):
    rig.session.scan(3)
    editor.on_run(SOURCE + "LD X1\nOUT Y1", 1)
    assert editor.frame()["said"]["refused"] is False
    assert rig.plc["D0"] == 3
    assert len(rig.plc.program.instructions) == 6


def test_a_wrong_program_is_refused_and_kept_as_a_draft(editor, rig):
    editor.on_run("LD X0\nOUT X1", 1)
    assert editor.frame()["said"]["words"].startswith("Not downloaded: 1 problem.")
    assert rig.plc.program.source == SOURCE
    assert editor.layout()["draft"] == "LD X0\nOUT X1"


def test_a_missing_password_is_told(editor, rig):
    rig.plc.protection.passwords.download = "secret"
    editor.on_run(SOURCE + "LD X1\nOUT Y1", 1)
    assert "password" in editor.frame()["said"]["words"]


def test_a_cell_that_runs_again_finds_the_draft_but_not_the_old_words(editor, make_rig):
    editor.on_run("LD X0\nOUT X1", 1)
    again = Editor(make_rig(program=SOURCE))
    assert again.layout()["draft"] == "LD X0\nOUT X1"
    assert again.frame() == {"help": {}, "said": {}}


def test_a_draft_that_is_dropped_or_downloaded_is_none_any_more(editor, rig):
    editor.on_typed(SOURCE + "LD", 5, 1)
    editor.on_drop()
    assert editor.layout()["draft"] is None
    editor.on_run(SOURCE + "LD X1\nOUT Y1", 2)
    rig.read_program()
    assert Editor(rig).layout()["draft"] is None
