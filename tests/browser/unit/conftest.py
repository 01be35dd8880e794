"""The panels' scripts in a bare Chromium page: no Jupyter, no kernel, a link that the test holds in its hand.

`bench.show(layouts, state)` shows panels that were described by hand; `bench.connect(panel)` shows a real `Panel`, and `bench.settle()`
carries messages to and fro until nobody has more to say. `bench.js(...)` runs a piece of JavaScript that knows every function
of panel.js.
"""

from itertools import count

import pytest
from ecsim_widgets import Lab
from ecsim_widgets.panel import Panel
from ecsim_widgets.stream import Stream

from ecsim.plc import Plc

EXPORTED = "panels, work, escaped, number, seconds, named, set, write, frame, icon, Drawing, fitting, roving, columns, Page, View"
PAGE = """<!doctype html><html><head><meta charset="utf-8"><style>{style}</style></head>
<body data-jp-theme-light="true" style="margin:0;background:var(--ec-paper)"><div id="place" style="width:100%"></div></body></html>"""
LINK = """async (source) => {
  const link = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  const { default: widget, ...all } = await import(link);
  Object.assign(window, all);
  window.Model = class {
    constructor(values) {
      this.values = { page: 'page', ...values };
      this.handlers = {};
      this.sent = [];
    }
    get(name) { return this.values[name]; }
    set(name, value) { this.values[name] = value; }
    on(event, handler) { this.handlers[event] = handler; }
    send(message) {
      if (this.gone) throw new Error('the comm is closed');
      this.sent.push(message);
    }
    tell(message) { this.handlers['msg:custom'](message); }
  };
  window.show = (values) => {
    window.ends?.forEach((end) => end());
    window.model = new Model(values);
    window.ends = [widget.initialize({ model }), widget.render({ model, el: document.querySelector('#place') })].reverse();
  };
}"""
FRAME = """() => new Promise((done) => {
  let frames = 0;
  const step = () => (++frames < 2 || work.frame || work.draws.size || work.looks.size ? requestAnimationFrame(step) : done());
  requestAnimationFrame(step);
})"""  # until everything has been drawn


class Bench:
    """A page with the panels on it, and the kernel's end of the link."""

    def __init__(self, page):
        self.page = page
        self.panel = None
        page.set_content(PAGE.format(style=Panel._css))
        page.evaluate(LINK, f"{Panel._esm}\nexport {{ {EXPORTED} }};")

    def js(self, code, value=None):
        """What a function of JavaScript gives for a value."""
        return self.page.evaluate(code, value)

    def show(self, layouts, state=None):
        """Show panels (key -> layout) with a state (key -> entries); the page has said hello and waits."""
        self.panel = None
        self.js("(values) => show(values)", {"face": {"parts": list(layouts), "panels": layouts}, "last": state or {}})
        self.frame()

    def connect(self, panel):
        """Show a real panel; its frames are always due."""
        self.panel, self.said = panel, []
        panel.stream = Stream(count().__next__)
        panel.send = self.said.append
        self.js("(values) => show(values)", {"face": panel.face, "last": panel.last})
        self.settle()

    def settle(self):
        """Carry messages between the page and its panel until there are none; the page has drawn what came."""
        while True:
            self.frame()
            asked = self.sent()
            for message in asked:
                self.panel._receive(self.panel, message, [])
            told = self.said[:]
            self.said.clear()
            for message in told:
                self.js("(message) => model.tell(message)", message)
            if not asked and not told:
                return

    def tell(self, **message):
        """The kernel says something, and the page draws it."""
        self.js("(message) => model.tell(message)", message)
        self.frame()

    def sent(self):
        """What the page has said since the last look."""
        return self.js("() => model.sent.splice(0)")

    def asked(self, part):
        """What the page has asked of one part since the last look, as (verb, values)."""
        said = [message for message in self.sent() if message.get("part") == part]
        return [(message.pop("do"), {key: value for key, value in message.items() if key != "part"}) for message in said]

    def frame(self):
        """Wait until the page has been drawn."""
        self.page.evaluate(FRAME)

    def __getitem__(self, name):
        return self.page.get_by_test_id(name)


@pytest.fixture(scope="session")
def bare_page(browser):
    """One page for all tests; what it says of errors is kept in `page.errors`."""
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    page.set_default_timeout(10_000)
    page.errors = []
    page.on("pageerror", lambda error: page.errors.append(str(error)))
    yield page
    page.close()


@pytest.fixture
def bench(bare_page):
    """A clean page with every panel's script; an error in a script fails the test."""
    bare_page.errors.clear()
    bare_page.set_viewport_size({"width": 1280, "height": 900})
    bare_page.goto("about:blank")
    yield Bench(bare_page)
    assert bare_page.errors == []


@pytest.fixture
def make_lab():
    """Make a lab in RUN that stands still: scans of 10 ms come when the test asks for them, inputs are not filtered."""
    labs = []

    def make(program, model="EC20", **more):
        labs.append(Lab(Plc(model, scan_ms=10, input_filter_ms=0), program, name="unit test", autostart=False, **more))
        labs[-1].plc.run()
        return labs[-1]

    yield make
    for each in labs:
        each.close()
