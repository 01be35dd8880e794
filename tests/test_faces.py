"""What objects of the public face show of themselves: short, stable text, and a picture in a notebook."""

import ecsim

PROGRAM = "VAR_GLOBAL\n  Start AT X0 // the green button\nEND_VAR\nPROGRAM MAIN\nLD Start\nADD D0 -5 D1\nEND_PROGRAM\n"


def test_a_program_shows_its_listing_in_a_notebook():
    program = ecsim.compile(PROGRAM)
    assert repr(program) == "<Program EC20, 1 unit, 8 steps>"
    html = program._repr_html_()
    assert html.startswith("<style>")
    for word in ("Start", "ADD", "-5", "the green button", "VAR_GLOBAL"):
        assert word in html


def test_what_a_program_says_is_not_taken_for_html():
    html = ecsim.compile("LD< D0 5 // <b>&\nOUT Y0")._repr_html_()
    assert "<b>" not in html
    assert "&lt;b&gt;&amp;" in html
    assert "LD&lt;" in html


def test_without_a_view_a_notebook_falls_back_on_the_text(monkeypatch):
    monkeypatch.setattr(ecsim.Program, "face", None)
    assert ecsim.compile("LD X0\nOUT Y0")._repr_html_() is None
