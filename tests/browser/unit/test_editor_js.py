"""The editor panel with a real PLC behind it: colours, problems, completion, download in RUN, undo, and nothing that gets lost."""

import pytest
from ecsim_widgets.editor import Editor
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

PROGRAM = "LD X0\nOUT Y0\nLD SM0\nINC D0\n"


@pytest.fixture
def still(make_lab):
    Editor._desks.clear()
    lab = make_lab(PROGRAM)
    lab.session.scan(5)
    return lab


@pytest.fixture
def editor(bench, still):
    """The editor of a PLC in RUN that has counted to 5, the cursor at the text's end."""
    bench.connect(still.panel("editor"))
    bench["text"].click()
    bench.page.keyboard.press("Control+End")
    return bench


def type_(editor, text):
    """Type, and let the kernel answer."""
    for line, part in enumerate(text.split("\n")):
        if line:
            editor.page.keyboard.press("Enter")
        editor.page.keyboard.type(part)
    answered(editor)


def answered(editor):
    editor.page.wait_for_function("() => model.sent.some((message) => message.part === 'editor')")
    editor.settle()


def key(editor, name):
    editor.page.keyboard.press(name)
    editor.settle()


def text(editor):
    return editor["text"].input_value()


def shown(editor):
    """What the coloured text says, without the sentences behind it."""
    return editor.js(
        "() => [...document.querySelectorAll('.ln')].map((line) => [...line.querySelectorAll('span:not(.why)')].map((span) => span.textContent).join(''))"
    )


def test_the_text_is_coloured_line_for_line(editor):
    type_(editor, "LD X1 // a\n/* b\nc */\nOUT Y1")
    assert "\n".join(shown(editor)).replace("\u00a0", " ") == text(editor)
    colours = editor.js(
        "() => [...document.querySelectorAll('.ln')].map((line) => [...line.querySelectorAll('span')].map((span) => span.className).filter(Boolean).join(' '))"
    )
    assert colours == ["op device", "op device", "op device", "op device", "op device comment", "comment", "comment", "op device"]


def test_a_comment_that_is_opened_colours_the_lines_below_and_closed_it_does_not(editor):
    editor.page.keyboard.press("Control+Home")
    type_(editor, "/*\n")
    kinds = "() => [...document.querySelectorAll('.ln')].map((line) => line.querySelector('span')?.className ?? '')"
    assert editor.js(kinds)[1:5] == ["comment"] * 4
    key(editor, "Backspace")
    type_(editor, "*/")
    assert [kind.split()[0] for kind in editor.js(kinds)[1:4]] == ["op"] * 3


def test_a_problem_is_marked_while_it_is_typed_and_can_be_gone_to(editor):
    type_(editor, "OUT X9")
    expect(editor["editor"].locator(".wavy")).to_have_text("X9")
    expect(editor["problems"].locator("li")).to_have_count(1)
    expect(editor["problems"]).to_contain_text("line 5")
    expect(editor["editor"].locator(".no[data-bad]")).to_have_text("5")
    editor.page.keyboard.press("Control+Home")
    editor["problems"].locator("button").click()
    assert editor.js("() => document.activeElement.selectionStart") == len(PROGRAM) + 4
    editor.page.keyboard.press("Control+End")
    editor.page.keyboard.press("Backspace")
    editor.page.keyboard.press("Backspace")
    type_(editor, "Y1")
    expect(editor["editor"].locator(".wavy")).to_have_count(0)


def test_a_change_in_run_keeps_the_values_and_says_so(editor, still):
    type_(editor, "LD X1\nOUT Y1")
    key(editor, "Control+Enter")
    expect(editor["verdict"]).to_have_text("Changed in RUN: 2 new instructions, 0 gone. No device has changed its value.")
    assert (still.plc.running, still.plc["D0"]) == (True, 5)
    assert still.plc.program.source == PROGRAM + "LD X1\nOUT Y1"
    assert editor.js("() => document.activeElement.tagName") == "TEXTAREA"
    type_(editor, "7")  # the cursor is where it was
    assert text(editor).endswith("OUT Y17")


def test_a_refusal_loses_nothing(editor, still):
    type_(editor, "OUT X1")
    key(editor, "Shift+Enter")
    expect(editor["verdict"]).to_contain_text("Not downloaded: 1 problem.")
    assert text(editor) == PROGRAM + "OUT X1"
    assert still.plc.program.source == PROGRAM


def test_undo_works_over_a_download(editor):
    type_(editor, "LD X1\nOUT Y1")
    key(editor, "Control+Enter")
    for _ in range(40):
        editor.page.keyboard.press("Control+z")
    assert text(editor) == PROGRAM


def test_what_was_undone_can_be_done_again(editor):
    type_(editor, "LD X1")
    for _ in range(4):
        editor.page.keyboard.press("Control+z")
    assert text(editor) == PROGRAM
    for _ in range(4):
        editor.page.keyboard.press("Control+Shift+z")
    assert text(editor) == PROGRAM + "LD X1"


def test_completion_offers_and_takes_by_keys(editor):
    type_(editor, "TON")
    expect(editor["offers"].locator("li").first).to_contain_text("TONR")
    key(editor, "Tab")
    assert text(editor) == PROGRAM + "TONR"
    type_(editor, " T")
    expect(editor["operands"]).to_contain_text("TONR")
    expect(editor["operands"].locator(".here")).to_have_text("D")
    key(editor, "ArrowDown")
    expect(editor["offers"].locator('[aria-selected="true"]')).to_contain_text("T0")
    key(editor, "Enter")
    assert text(editor) == PROGRAM + "TONR T0"
    editor.page.keyboard.press("Control+z")
    assert text(editor) != PROGRAM + "TONR T0"


def test_enter_makes_a_line_although_something_is_offered(editor):
    type_(editor, "TON")
    expect(editor["offers"]).to_be_visible()
    editor.page.keyboard.press("Enter")
    assert text(editor) == PROGRAM + "TON\n"
    expect(editor["offers"]).to_be_hidden()


def test_another_program_is_shown_but_never_over_what_was_typed(editor, still):
    still.rig.session.post(lambda plc: plc.load("LD X7\nOUT Y7"))
    editor.settle()
    assert text(editor) == "LD X7\nOUT Y7"
    type_(editor, "7")
    still.rig.session.post(lambda plc: plc.load(PROGRAM))
    editor.settle()
    assert "Y77" in text(editor)
    expect(editor["verdict"]).to_contain_text("what you typed is kept")
    editor["drop"].click()
    editor.settle()
    assert text(editor) == PROGRAM
    editor.page.keyboard.press("Control+z")
    assert "Y77" in text(editor)


def test_a_cell_that_runs_again_finds_what_was_typed(editor, make_lab):
    type_(editor, "LD X1")
    editor.connect(make_lab(PROGRAM).panel("editor"))
    assert text(editor) == PROGRAM + "LD X1"
    expect(editor["verdict"]).to_contain_text("not downloaded")


def test_without_its_kernel_the_text_stays_and_cannot_be_downloaded(editor):
    type_(editor, "LD X1")
    editor.js("() => { model.gone = true; model.handlers['comm_live_update'](); }")
    editor.frame()
    expect(editor["download"]).to_be_disabled()
    editor.page.keyboard.type(" ")
    assert text(editor) == PROGRAM + "LD X1 "


TYPE = """async (at) => {
  const area = document.querySelector('textarea');
  area.focus();
  area.setSelectionRange(at, at);
  for (const sign of 'LD X0') {
    document.execCommand('insertText', false, sign);
    await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  }
}"""


def test_a_program_of_12000_steps_is_typed_in_without_delay(bench, make_lab):
    """The page's own time for a key stroke, from the key to the picture, whatever else the machine does."""
    Editor._desks.clear()
    networks = "\n".join(
        f"LD X{number % 8}\nOR M{number % 900}\nOUT M{number % 1000}\nMOV {number} D{number % 7000}" for number in range(1499)
    )
    made = make_lab(networks)
    assert 11_900 < made.plc.program.steps <= 12_000
    bench.connect(made.panel("editor"))
    lines, drawn = made.plc.program.source.count("\n") + 1, bench.page.locator(".editor .ln")
    assert drawn.count() < 200
    client = bench.page.context.new_cdp_session(bench.page)
    client.send("Performance.enable", {"timeDomain": "threadTicks"})

    def spent_ms():
        return 1000 * next(each["value"] for each in client.send("Performance.getMetrics")["metrics"] if each["name"] == "TaskDuration")

    bench.js("() => { Model.prototype.send = () => {} }")
    for at in (0, len(networks) // 2, len(networks)):
        bench.js(TYPE, at)
        before = spent_ms()
        bench.js(TYPE, at)
        assert (spent_ms() - before) / 5 < 50
    client.detach()
    bench["text"].press("Control+Home")
    bench["text"].press("Control+End")
    expect(bench.page.locator(".editor .no").last).to_have_text(str(lines))  # the end is in sight, with its number
    assert drawn.last.inner_text().startswith("MOV 1498 D1498")
    assert drawn.count() < 200
