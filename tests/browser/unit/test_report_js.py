"""The report's script in a bare page: what a click sends, and how the hint's words come."""

import pytest
from ecsim_widgets.report import Sheet

pytestmark = pytest.mark.browser
HTML = """<button data-act="replay" data-rule="gate">Replay</button><b>no button</b>
<div data-place="hint"><button data-act="hint"></button><p></p></div>"""
SHOW = """async ([source, html, help]) => {
  const link = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  const widget = (await import(link)).default;
  const values = { html, help }, handlers = {};
  window.sent = [];
  window.model = {
    get: (name) => values[name],
    set: (name, value) => { values[name] = value; handlers[`change:${name}`]?.(); },
    on: (event, handler) => { handlers[event] = handler; },
    off: (event) => { delete handlers[event]; },
    send: (message) => window.sent.push(message),
  };
  const el = document.querySelector('#place');
  el.replaceChildren();
  window.leave = widget.render({ model: window.model, el });
}"""


@pytest.fixture
def page(bench):
    asked = {"words": "", "button": "Hint 1 of 3", "open": True}
    bench.js(SHOW, [str(Sheet._esm), HTML, asked])
    return bench.page


def test_a_click_on_a_button_is_one_message(page):
    page.click("text=Replay")
    page.click("text=no button")
    assert page.evaluate("sent") == [{"act": "replay", "rule": "gate"}]


def test_the_hint_says_its_words_and_closes_when_there_is_no_more(page):
    page.click("text=Hint 1 of 3")
    page.evaluate("model.set('help', { words: 'Look at <the> gate.', button: 'Hint 3 of 3', open: false })")
    assert page.inner_text("[data-place=hint] p") == "Look at <the> gate."
    assert page.is_disabled("text=Hint 3 of 3")
    assert page.evaluate("sent") == [{"act": "hint", "rule": ""}]


def test_a_report_that_is_taken_away_sends_nothing_more(page):
    page.evaluate("leave()")
    page.click("text=Replay")
    page.evaluate("model.set('help', { words: 'late' })")
    assert page.evaluate("sent") == []
    assert page.inner_text("[data-place=hint] p") == ""
