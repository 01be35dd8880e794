"""What holds for every panel: names, keys, focus, contrast in a host that is not Jupyter, states without colour, and the last state without a kernel."""

import io
import re

import pytest
from ecsim_exercises import conveyor
from ecsim_widgets.lab import PARTS
from PIL import Image

pytestmark = pytest.mark.browser

CONTROL_ROLES = {
    "button", "checkbox", "combobox", "link", "listbox", "menuitem", "option", "radio", "searchbox", "slider", "spinbutton",
    "switch", "tab", "textbox", "treeitem",
}  # fmt: skip


@pytest.fixture
def conveyor_lab(make_lab):
    """The conveyor some seconds after its start: a step is active, something is forced, a timer has run."""
    made = make_lab(
        conveyor.SOLUTION,
        plant=conveyor.Conveyor(),
        picture=conveyor.PICTURE,
        title=conveyor.TITLE,
        controls={"X5": "push", "X6": "stop", "X7": "latch"},
    )
    made.session.set("X5", 1)
    made.session.scan(5)
    made.session.set("X5", 0)
    made.session.scan(400)
    made.plc.force("Y3", 1)
    made.session.scan(2)
    return made


@pytest.fixture(params=PARTS)
def shown(request, bench, conveyor_lab):
    """Each panel alone."""
    bench.key = request.param
    bench.connect(conveyor_lab.panel(request.param))
    return bench


# -- names and roles: what the browser tells a screen reader


def accessible(page):
    """The nodes of the browser's accessibility tree as (role, name, focusable)."""
    client = page.context.new_cdp_session(page)
    try:
        nodes = client.send("Accessibility.getFullAXTree")["nodes"]
    finally:
        client.detach()
    for node in nodes:
        if not node.get("ignored"):
            focusable = any(each["name"] == "focusable" and each["value"]["value"] for each in node.get("properties", ()))
            yield node["role"]["value"], node.get("name", {}).get("value", ""), focusable


def test_every_control_has_a_name_and_a_role(shown):
    nodes = [node for node in accessible(shown.page) if node[0] != "RootWebArea"]
    controls = [(role, name) for role, name, focusable in nodes if focusable or role in CONTROL_ROLES]
    assert [control for control in controls if not control[1].strip() or control[0] in ("generic", "none")] == []
    assert len(controls) > 1 or shown.key == "machine"


# -- the keyboard: Tab goes from stop to stop, arrows inside a group, and what has the focus shows it

MARKED = """() => {
  window.marks = new Map();
  window.mark = (node) => node && node !== document.body ? marks.get(node) ?? (marks.set(node, marks.size), marks.get(node)) : null;
  window.named = (node) => node.dataset.testid ?? node.getAttribute('aria-label') ?? node.outerHTML.slice(0, 90);
}"""
FOCUSED = """() => {
  const node = document.activeElement;
  if (node === document.body) return null;
  const outlined = [node, ...(node.closest('.ec-root') ? [node.parentElement, node.parentElement?.parentElement] : [])].some((each) => {
    const style = each && getComputedStyle(each);
    return style && style.outlineStyle !== 'none' && parseFloat(style.outlineWidth) >= 2;
  });
  return { mark: mark(node), name: named(node), outlined, group: node.hasAttribute('data-row') };
}"""
CONTROLS = """() => [...document.querySelectorAll('.ec-root :is(button, input, select, textarea, [role=button], [role=switch], [role=slider], [role=treeitem], [role=radio])')]
  .filter((node) => node.getClientRects().length && !node.disabled && getComputedStyle(node).visibility === 'visible')
  .map((node) => [mark(node), named(node)])"""
BY_ARROWS = """(start) => {
  const focused = FOCUSED;
  const found = [start];
  for (const here of found)
    for (const key of ['ArrowRight', 'ArrowDown', 'ArrowLeft', 'ArrowUp']) {
      const node = [...marks].find(([, number]) => number === here.mark)[0];
      node.focus();
      node.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
      const there = focused();
      if (there && !found.some((each) => each.mark === there.mark)) found.push(there);
    }
  return found;
}""".replace("FOCUSED", FOCUSED)


def stops_of_tab(page):
    """What has the focus after each press of Tab, until it leaves the page."""
    page.evaluate(MARKED)
    stops = []
    for _ in range(200):
        page.keyboard.press("Tab")
        focused = page.evaluate(FOCUSED)
        if focused is None:
            return stops
        stops.append(focused)
    raise AssertionError("the focus never leaves the panel")


def test_every_control_is_reached_by_the_keyboard_and_shows_its_focus(shown):
    page = shown.page
    stops = stops_of_tab(page)
    reached = {stop["mark"]: stop for stop in stops}
    for stop in stops:
        if stop["group"]:
            reached |= {member["mark"]: member for member in page.evaluate(BY_ARROWS, stop)}
    missed = [name for mark, name in page.evaluate(CONTROLS) if mark not in reached]
    if shown.key == "devices":  # F goes to the format of the row
        assert {name.removeprefix("Format of ") for name in missed} <= set(shown.panel.rig.plc.names)
        shown["grid"].focus()
        page.keyboard.press("End")
        page.keyboard.press("f")
        assert page.evaluate("() => document.activeElement.getAttribute('aria-label')") == "Format of D0"
        page.keyboard.press("Escape")
        assert page.evaluate("() => document.activeElement.dataset.testid") == "grid"
    else:
        assert missed == []
    assert [stop["name"] for stop in reached.values() if not stop["outlined"]] == []


def test_tab_goes_through_the_lab_as_it_is_read(bench, conveyor_lab):
    """From top to bottom, and in a row of panels from left to right, however many columns there are."""
    panels = """() => [...document.querySelectorAll('.ec-root :is(section.panel, .transport, .unit)')].filter((node) => node.querySelector('[tabindex="0"], button, input'))
      .map((node) => [node.dataset.testid, Math.round(node.getBoundingClientRect().top), Math.round(node.getBoundingClientRect().left)])"""
    for width in (760, 1280):
        bench.page.set_viewport_size({"width": width, "height": 900})
        bench.connect(conveyor_lab)
        places = {name: (top, left) for name, top, left in bench.js(panels)}
        bench.js(MARKED)
        order = []
        for _ in range(200):
            bench.page.keyboard.press("Tab")
            name = bench.js("() => document.activeElement.closest('section.panel, .transport, .unit')?.dataset.testid")
            if name is None:
                break
            if name not in order[-1:]:
                order.append(name)
        assert order == sorted(places, key=places.get)


def test_what_has_the_focus_keeps_it_when_the_columns_change(bench, conveyor_lab):
    bench.connect(conveyor_lab)
    bench["chart"].locator(".step").nth(1).focus()
    bench["ladder"].locator(".ladder-scroll").evaluate("(body) => { body.scrollTop = 500 }")
    for width, columns in ((1600, "wide"), (700, "one"), (1000, "pair")):
        bench.page.set_viewport_size({"width": width, "height": 900})
        bench.page.wait_for_function("(columns) => document.querySelector('.lab').dataset.columns === columns", arg=columns)
        assert bench.js("() => document.activeElement.dataset.testid") == "step-S20"
        assert bench["ladder"].locator(".ladder-scroll").evaluate("(body) => body.scrollTop") == 500


# -- a host that is not Jupyter: VS Code sets --vscode-* and a class on the body, and puts widgets on white whatever its theme

VSCODE = {
    "vscode-light": {"editor-background": "#ffffff", "editor-foreground": "#3b3b3b", "font-family": "sans-serif"},
    "vscode-dark": {"editor-background": "#1f1f1f", "editor-foreground": "#cccccc", "font-family": "sans-serif"},
    "vscode-high-contrast": {"editor-background": "#000000", "editor-foreground": "#ffffff", "font-family": "sans-serif"},
    "vscode-high-contrast vscode-high-contrast-light": {
        "editor-background": "#ffffff",
        "editor-foreground": "#292929",
        "font-family": "sans-serif",
    },
}
# The widget manager brings these along in every theme.
BROUGHT = {"--jp-layout-color0": "white", "--jp-ui-font-color1": "rgba(0, 0, 0, 0.87)", "--jp-brand-color1": "#1976d2"}
HOST = """([classes, variables, brought]) => {
  document.body.removeAttribute('data-jp-theme-light');
  document.body.className = classes;
  document.body.style.background = '#ffffff';
  for (const [name, value] of Object.entries(variables)) document.documentElement.style.setProperty(`--vscode-${name}`, value);
  for (const [name, value] of Object.entries(brought)) document.documentElement.style.setProperty(name, value);
}"""
WORDS = """() => {
  const clipped = (box, node) => {
    for (let over = node.parentElement; over; over = over.parentElement) {
      if (getComputedStyle(over).overflow === 'visible') continue;
      const edge = over.getBoundingClientRect();
      box = { left: Math.max(box.left, edge.left), right: Math.min(box.right, edge.right), top: Math.max(box.top, edge.top), bottom: Math.min(box.bottom, edge.bottom) };
    }
    return box;
  };
  const found = [];
  const walker = document.createTreeWalker(document.querySelector('.ec-root'), NodeFilter.SHOW_TEXT);
  for (let text = walker.nextNode(); text; text = walker.nextNode()) {
    const node = text.parentElement;
    if (!text.data.trim() || !node.getBoundingClientRect().width || !node.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || node.closest('[disabled], [aria-disabled=true], .visually-hidden, option, title, style')) continue;
    const style = getComputedStyle(node);
    const range = document.createRange();
    range.selectNodeContents(text);
    const { left, right, top, bottom } = clipped(range.getBoundingClientRect(), node);
    if (right - left < 4 || bottom - top < 4) continue;
    found.push({ text: text.data.trim(), colour: node instanceof SVGElement ? style.fill : style.color, box: [left + scrollX, top + scrollY, right + scrollX, bottom + scrollY].map(Math.round) });
  }
  for (const field of document.querySelectorAll('.ec-root input:placeholder-shown')) {
    if (!field.checkVisibility()) continue;
    const { left, right, top, bottom } = field.getBoundingClientRect();
    found.push({ text: field.placeholder, colour: getComputedStyle(field, '::placeholder').color, box: [left + 3, top + 3, right - 3, bottom - 3].map(Math.round) });
  }
  return found;
}"""
BARE = """(on) => {
  document.head.querySelector('#bare')?.remove();
  if (on) document.head.insertAdjacentHTML('beforeend', `<style id="bare">.ec-root, .ec-root * { color: transparent !important; transition: none !important; }
    .ec-root svg text { fill: transparent !important; } .ec-root ::placeholder { color: transparent !important; }</style>`);
}"""


def luminance(colour):
    """The relative luminance of red, green and blue of 0 to 255, as WCAG 2 defines it."""
    linear = [each / 12.92 if each <= 0.04045 else ((each + 0.055) / 1.055) ** 2.4 for each in (value / 255 for value in colour)]
    return sum(weight * value for weight, value in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def contrast(one, other):
    """The contrast of two colours, 1 to 21."""
    darker, lighter = sorted((luminance(one), luminance(other)))
    return (lighter + 0.05) / (darker + 0.05)


def test_the_measure_of_contrast():
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21)
    assert contrast((118, 118, 118), (255, 255, 255)) == pytest.approx(4.54, abs=0.005)  # the darkest grey that WCAG names for white


def picture(page):
    """The page as it looks."""
    return Image.open(io.BytesIO(page.screenshot(full_page=True, animations="disabled"))).convert("RGB")


def faint(page):
    """The words whose contrast with what lies behind them is less than 4.5 to 1."""
    words = page.evaluate(WORDS)
    page.evaluate(BARE, True)
    behind = picture(page)
    page.evaluate(BARE, False)
    found = []
    for word in words:
        area = behind.crop(word["box"])
        _, ground = max(area.getcolors(area.width * area.height))
        red, green, blue, *alpha = (float(each) for each in re.findall(r"[\d.]+", word["colour"]))
        share = alpha[0] if alpha else 1.0
        colour = [share * own + (1 - share) * under for own, under in zip((red, green, blue), ground, strict=True)]
        if contrast(colour, ground) < 4.5:
            found.append((word["text"], word["colour"], ground, round(contrast(colour, ground), 2)))
    assert words
    return found


def test_everything_can_be_read_in_vs_code(shown):
    for classes, variables in VSCODE.items():
        shown.js(HOST, [classes, variables, BROUGHT])
        shown.frame()
        paper = shown.js("() => getComputedStyle(document.querySelector('.ec-root')).backgroundColor")
        assert (luminance(map(int, re.findall(r"\d+", paper))) < 0.1) == (classes in ("vscode-dark", "vscode-high-contrast"))
        assert (classes, faint(shown.page)) == (classes, [])


# -- the last state: what a page shows that was saved and opened again, with no kernel behind it

SAVED = "() => JSON.parse(JSON.stringify({ face: model.values.face, last: model.values.last }))"
REOPENED = """(values) => {
  const send = Model.prototype.send;
  Model.prototype.send = () => { throw new Error('there is no comm'); };
  try { show(values); } finally { Model.prototype.send = send; }
  model.gone = true;
}"""
SHOWN = """() => {
  const root = document.querySelector('.ec-root');
  const words = [...root.querySelectorAll('*')].filter((node) => node.childNodes.length && [...node.childNodes].some((each) => each.nodeType === 3 && each.data.trim()));
  const own = (node) => [...node.childNodes].filter((each) => each.nodeType === 3).map((each) => each.data.trim()).join(' ');
  return {
    words: words.filter((node) => node.getBoundingClientRect().width && !node.closest('.stamp, .chip, .history .end, option')).map(own),
    states: [...root.querySelectorAll('[data-on], [data-forced], [aria-checked=true], [data-state], .flow, .active, .on')]
      .map((node) => [node.dataset.testid ?? node.getAttribute('class'), node.getAttribute('aria-label')]),
  };
}"""
AWAKE = """() => [...document.querySelectorAll('.ec-root :is(button, input, select, textarea, [role=slider], [role=switch])')]
  .filter((node) => node.getBoundingClientRect().width && !node.disabled && node.getAttribute('aria-disabled') !== 'true' && !node.readOnly)
  .map((node) => node.dataset.testid ?? node.className)"""
LOOKING = {
    "chart-follow",
    "zoom-out",
    "zoom-in",
    "seconds",
    "follow",
    "network",
    "breaks",
    "text",
}  # what only looks still works, and a text can be copied


def test_opened_again_without_a_kernel_it_shows_the_last_state_and_says_so(shown):
    before, saved = shown.js(SHOWN), shown.js(SAVED)
    assert before["words"]
    shown.js(REOPENED, saved)
    shown.frame()
    assert shown.js("() => document.querySelector('.ec-root').hasAttribute('data-dead')")
    scan = f"{shown.panel.rig.plc.scans:,}"
    told = shown["chip"] if shown.key == "transport" else shown["ec"].locator(".stamp")
    assert told.first.inner_text() == (
        "Not connected: the last state" if shown.key == "transport" else f"last state \N{MIDDLE DOT} scan {scan}"
    )
    after = shown.js(SHOWN)
    assert after["words"] == before["words"]
    assert after["states"] == before["states"]
    assert set(shown.js(AWAKE)) <= LOOKING


# -- states without colour: in shades of grey, as an eye without cones or a copying machine sees it

STATES = """PROGRAM MAIN
LD X0
OUT Y0
TON T0 0
LD SM1
SET S0
STL S0
LD X0
SET S20
STL S20
OUT Y2
RET
END_PROGRAM"""
TOLD = {
    "switch": "[data-testid=X0]",
    "lamp of an input": "[data-testid=lamp-X0]",
    "lamp of an output": "[data-testid=lamp-Y0]",
    "forced lamp": "[data-testid=lamp-Y3]",
    "contact": ".ladder-scroll [data-device=X0]",
    "coil": ".ladder-scroll .coil[data-device=Y0]",
    "step": "[data-testid=step-S20]",
    "contact of a timer": "[data-testid=row-T0] .mini",
    "bit in the table": "[data-testid=device-Y0] .value b",
    "forced row": "[data-testid=device-Y3]",
    "bit in the microscope": "[data-testid=micro-points] tr[data-device=Y0] td:nth-child(4) .bit",
    "value in the trace": "svg.trace [id$=ga1]",
    "breakpoint": "[data-testid=break]",
}


BOXES = """(told) => Object.fromEntries(Object.entries(told).map(([name, selector]) => {
  const { left, top, right, bottom } = document.querySelector(selector).getBoundingClientRect();
  return [name, [left, top, right, bottom].map(Math.round)];
}))"""


def test_every_state_is_told_without_colour(bench, make_lab):
    made = make_lab(STATES, devices=["X0", "Y0", "Y3"], trace=["X0", "Y0"])
    made.session.scan(2)
    bench.page.set_viewport_size({"width": 1280, "height": 4000})
    bench.connect(made)
    bench["follow"].click()
    bench["ladder"].locator(".ladder-scroll").evaluate("(body) => { body.scrollTop = 0 }")

    def greys():
        bench.settle()
        page = picture(bench.page).convert("L")
        return {name: page.crop(box) for name, box in bench.js(BOXES, TOLD).items()}

    off = greys()
    made.session.set("X0", 1)
    made.plc.force("Y3", 1)
    made.session.breakpoints.add("S0")
    bench["step-S0"].click()
    made.session.scan(2)
    bench.settle()
    bench["micro-place"].press("End")
    on = greys()
    for name, before in off.items():
        after = on[name].resize(before.size)
        differing = sum(abs(one - other) > 48 for one, other in zip(before.get_flattened_data(), after.get_flattened_data(), strict=True))
        assert (name, differing > 40) == (name, True)  # pixels: a dot or a letter at least
