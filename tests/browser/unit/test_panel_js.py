"""panel.js: words and numbers, drawings, roving focus, the room for a drawing, the link to the kernel."""

import pytest

pytestmark = pytest.mark.browser

DRAWING = '<svg class="ec" width="200" height="40"><g id="EC0-a" class="contact"><text id="EC0-t">1</text></g><rect id="EC0-r" data-testid="EC0-box" width="5"/></svg>'


@pytest.mark.parametrize(
    ("call", "text"),
    [
        ("number(1234567)", "1,234,567"),
        ("number(-5)", "−5"),
        ("number(2.5, 2)", "2.50"),
        ("seconds(12480000)", "12.480"),
        ("seconds(830000, 2)", "0.83"),
        ("escaped('<b>&\"')", "&#60;b&#62;&#38;&#34;"),
        ("escaped(null)", ""),
        ("named('', 'X0')", '<span class="mono">X0</span>'),
        ("named('Start', 'X0')", 'Start <span class="mono">X0</span>'),
    ],
)
def test_words_and_numbers(bench, call, text):
    assert bench.js(f"() => {call}") == text


def test_set_takes_an_attribute_away_and_leaves_what_is_the_same(bench):
    changes = """() => {
      const node = document.createElement('p');
      let touched = 0;
      node.setAttribute = (name, value) => { touched += 1; Element.prototype.setAttribute.call(node, name, value); };
      set(node, 'a', 1); set(node, 'a', '1'); set(node, 'b', ''); set(node, 'c', 0);
      for (const gone of [null, undefined, false]) { set(node, 'b', ''); set(node, 'b', gone); }
      return [touched, node.outerHTML];
    }"""
    assert bench.js(changes) == [5, '<p a="1" c="0"></p>']


def test_a_drawing_gets_ids_of_its_own_and_frames_touch_only_them(bench):
    result = bench.js(
        """(markup) => {
          const [one, two] = [0, 1].map(() => document.querySelector('#place').appendChild(document.createElement('div')));
          const [first, second] = [new Drawing(one, markup), new Drawing(two, markup)];
          first.apply({ 'a:class': 'contact flow', 't:text': '7', 'r:width': null, 'nobody:class': 'x', active: ['S0'] });
          second.apply({ 't:text': null });
          return [first.prefix === second.prefix, one.querySelector('g').getAttribute('class'), one.textContent, one.querySelector('rect').hasAttribute('width'),
            one.querySelector('rect').dataset.testid, two.querySelector('g').getAttribute('class'), two.textContent, two.querySelector('rect').getAttribute('width')];
        }""",
        DRAWING,
    )
    assert result == [False, "contact flow", "7", False, "box", "contact", "", "5"]


def grid(bench, rows=2, columns=3):
    bench.js(
        """([rows, columns]) => {
          const root = document.querySelector('#place');
          root.innerHTML = '<button id="before">before</button>';
          for (let row = 0; row < rows; row += 1) for (let col = 0; col < columns; col += 1)
            root.insertAdjacentHTML('beforeend', `<button id="n${row}${col}" data-row="${row}" data-col="${col}">${row}${col}</button>`);
          roving(root, () => [...root.querySelectorAll('[data-row]')]);
        }""",
        [rows, columns],
    )


def test_one_stop_of_tab_and_arrows_inside(bench):
    grid(bench)
    stops = bench.js("() => [...document.querySelectorAll('[data-row]')].map((node) => node.tabIndex)")
    assert stops == [0, -1, -1, -1, -1, -1]
    bench.page.locator("#before").focus()
    bench.page.keyboard.press("Tab")
    seen = []
    for key in ("ArrowRight", "ArrowDown", "End", "ArrowUp", "Home", "ArrowLeft"):
        bench.page.keyboard.press(key)
        seen.append(bench.js("() => document.activeElement.id"))
    assert seen == ["n01", "n11", "n12", "n02", "n00", "n00"]  # at the left edge it stays


def test_the_arrows_with_a_modifier_are_not_taken(bench):
    grid(bench)
    bench.page.locator("#n00").focus()
    bench.page.keyboard.press("Control+ArrowRight")
    assert bench.js("() => document.activeElement.id") == "n00"


def test_a_page_says_hello_and_asks_for_its_room(bench):
    bench.show({"ladder": {"about": "3 steps", "steps": {}, "least": 0}})
    said = bench.sent()
    assert {"hello": True} in said
    assert {"part": "ladder", "do": "fit", "width": 1276} in said


def test_frames_are_merged_acknowledged_and_kept(bench):
    bench.show({"timers": {"rows": []}}, {"run": {"scan": 0, "time_us": 0}})
    bench.sent()
    bench.js("() => { model.tell({ n: 1, state: { timers: { a: 1 } } }); model.tell({ n: 2, ack: true, state: { timers: { b: 2 } } }); }")
    bench.frame()
    assert bench.sent() == [{"ack": 2}]
    assert bench.js("() => model.get('last').timers") == {"a": 1, "b": 2}


def test_a_whole_frame_takes_the_place_of_all_that_was(bench):
    bench.show({"timers": {"rows": []}}, {"run": {"scan": 0, "time_us": 0}, "timers": {"old": 1}})
    bench.tell(n=1, full=True, state={"run": {"scan": 5, "time_us": 50_000}, "timers": {"new": 2}})
    assert bench.js("() => model.get('last').timers") == {"new": 2}
    assert bench["timers"].locator(".stamp").inner_text() == "scan 5 · 0.050 s"


def test_a_link_that_is_gone_shows_the_last_state_and_a_frame_brings_it_back(bench):
    bench.show({"timers": {"rows": []}}, {"run": {"scan": 1248, "time_us": 12_480_000}})
    bench.js("() => { model.gone = true; window.dispatchEvent(new Event('x')); model.handlers['comm_live_update'](); }")
    assert bench["timers"].locator(".stamp").inner_text() == "last state · scan 1,248"
    assert bench["ec"].get_attribute("data-dead") == ""
    bench.js("() => { model.gone = false; }")
    bench.tell(n=2, full=True, state={"run": {"scan": 1249, "time_us": 12_490_000}})
    assert bench["ec"].get_attribute("data-dead") is None


def test_another_program_builds_the_panels_anew(bench):
    bench.show({"timers": {"rows": []}}, {"run": {"scan": 0, "time_us": 0}})
    row = {"device": "T7", "name": "", "kind": "TON", "unit": "timer", "base": "100 ms", "steps": ""}
    layout = {"parts": ["timers"], "panels": {"timers": {"rows": [row], "timers": 256}}}
    bench.tell(n=1, full=True, layout=layout, state={"run": {"scan": 0, "time_us": 0}, "timers": {"T7": 3, "T7.preset": 20}})
    assert bench["T7"].inner_text() == "3"


@pytest.mark.parametrize(("width", "columns"), [(700, "one"), (900, "pair"), (1400, "wide")])
def test_the_lab_has_columns_by_its_own_width(bench, width, columns):
    bench.page.set_viewport_size({"width": width, "height": 900})
    bench.show(
        {"transport": {}, "chart": {"steps": {}}, "ladder": {"about": ""}, "timers": {}},
        {"run": {"scan": 0, "time_us": 0, "state": "paused"}},
    )
    assert bench.page.locator(".lab").get_attribute("data-columns") == columns


# -- the queue of work: what is drawn when

PROBES = """({ slow, high }) => {
  window.drawn = []; // [part, what it was told]
  for (const name of ['one', 'two', 'three']) panels[name] = (place) => {
    place.style.height = `${high}px`;
    return {
      apply(changes) {
        drawn.push([name, { ...changes }]);
        for (const began = performance.now(); performance.now() - began < slow; );
      },
    };
  };
}"""
TELL = "(states) => { for (const state of states) model.tell({ n: 1, state: { one: state, two: state, three: state } }); }"
FRAMES = """(count) => new Promise((done) => {
  const step = () => (count-- > 0 ? requestAnimationFrame(step) : done(drawn.splice(0)));
  step();
})"""


def probes(bench, slow=0, high=50):
    """Three panels that write down what they draw, take their time for it in ms, and are so many px high."""
    bench.js(PROBES, {"slow": slow, "high": high})
    bench.show({"one": {}, "two": {}, "three": {}})
    bench.js(FRAMES, 2)


def test_two_updates_before_a_frame_are_drawn_once_together(bench):
    probes(bench)
    bench.js(TELL, [{"a": 1, "b": 1}, {"a": 2}])
    assert bench.js(FRAMES, 4) == [[part, {"a": 2, "b": 1}] for part in ("one", "two", "three")]


def test_a_frame_draws_no_more_panels_when_its_time_is_spent_and_the_next_one_goes_on(bench):
    probes(bench, slow=4)
    bench.js(TELL, [{"a": 1}])
    assert [bench.js(FRAMES, 1) for _ in range(3)] == [[["one", {"a": 1}]], [["two", {"a": 1}]], [["three", {"a": 1}]]]


def test_what_still_waits_is_drawn_with_what_has_come_since(bench):
    probes(bench, slow=4)
    seen = []
    for value in (1, 2):
        bench.js(TELL, [{"a": value}])
        seen += bench.js(FRAMES, 1)
    seen += bench.js(FRAMES, 6)
    assert seen == [["one", {"a": 1}], ["two", {"a": 2}], ["three", {"a": 2}], ["one", {"a": 2}]]


def test_a_panel_out_of_sight_is_drawn_a_few_times_a_second_and_to_the_end(bench):
    probes(bench, high=1500)  # two of them begin below the window of 900 px
    for value in range(20):
        bench.js(TELL, [{"a": value}])
        if value == 0:
            bench.frame()
            bench.js("() => drawn.splice(0)")
            began = bench.js("() => performance.now()")
        else:
            bench.page.evaluate("() => new Promise((done) => requestAnimationFrame(done))")
    lasted_ms = bench.js("() => performance.now()") - began
    bench.frame()
    drawn = bench.js("() => drawn")
    counts = {name: sum(part == name for part, _ in drawn) for name in ("one", "two", "three")}
    assert counts["one"] >= 15
    assert counts["three"] <= lasted_ms / 250 + 1
    assert {part: changes["a"] for part, changes in drawn} == {"one": 19, "two": 19, "three": 19}


def test_what_looks_at_sizes_comes_before_what_draws(bench):
    order = """() => new Promise((done) => {
      const order = [];
      work.draw(() => order.push('draw'), document.body);
      work.look(() => order.push('look'));
      work.look(() => work.look(() => done(order)));
    })"""
    assert bench.js(order) == ["look", "draw"]


PROGRAM = "LD SM0\nTON T0 500\nLD SM1\nSET S0\nSTL S0\nOUT Y0\nLD X0\nSET S20\nSTL S20\nINC D0\nRET"


def test_thirty_frames_after_an_update_every_panel_shows_it(bench, make_lab):
    lab = make_lab(PROGRAM, devices=["D0"])
    lab.session.scan(1)
    bench.connect(lab)
    lab.plc["X0"] = 1
    for _ in range(3):
        lab.session.scan(7)
    for message in bench.said:
        bench.js("(message) => model.tell(message)", message)
    bench.js("() => { window.drawn = []; }")
    bench.js(FRAMES, 30)
    assert bench["scans"].inner_text() == "22"
    assert bench["step-S20"].get_attribute("class") == "step active"
    assert bench["step-S20"].get_attribute("aria-label") == "S20, active"
    assert bench["lamp-Y0"].get_attribute("aria-label") == "Y0 off"
    assert bench["T0"].inner_text() == str(lab.plc["T0"])
    assert bench["device-D0"].locator(".value").inner_text() == str(lab.plc["D0"])
    assert bench["ladder"].locator(".coil[data-device=Y0]").get_attribute("class") == "coil open"
