"""A large lab in a browser: how soon it shows, how smoothly it scrolls, what its page takes.

    python bench/large.py [--write] [--seconds 6] [--browser PATH]

A program of 12,000 steps as a ladder of 3,000 networks, and a chart of 400 steps, each in a JupyterLab of its own while it runs.
The wheel is turned all the time while frames are counted. `--write` puts the figures into docs/performance.md.
"""

import argparse
import json
import os
import shutil

import pages
from labserver import CONNECTED, COUNT_FRAMES, EVALUATE, page_of
from programs import LARGEST

STEPS = 400
SHOWN_SINCE = """([name, began]) => new Promise((done) => {
  const look = () => {
    const node = document.querySelector(`[data-testid=${name}] ${name === 'ladder' ? '.net' : '.step'}`);
    if (node && node.getBoundingClientRect().width) requestAnimationFrame(() => done(Date.now() - began));
    else requestAnimationFrame(look);
  };
  look();
})"""
DRAWN = "() => [document.querySelectorAll('.ec-root *').length, performance.memory?.usedJSHeapSize ?? 0]"
BLANK = """(name) => {
  if (name !== 'ladder') return false;
  const outer = document.querySelector('.ladder-scroll').getBoundingClientRect();
  return ![...document.querySelectorAll('.net')].some((net) => {
    const box = net.getBoundingClientRect();
    return box.top < outer.top + outer.height / 2 && box.bottom > outer.top + outer.height / 2;
  });
}"""


def chain() -> str:
    """A chart of 400 steps that goes round, one step each 100 ms."""
    numbers = [0, *range(20, 19 + STEPS)]
    text = ["LD SM1", "SET S0"]
    for place, (step, following) in enumerate(zip(numbers, [*numbers[1:], 0], strict=True)):
        timer = place % 200
        text += [
            f"STL S{step}",
            f"OUT M{step}",
            "LD SM0",
            f"TON T{timer} 1",
            f"LD T{timer}",
            f"{'SET' if following else 'OUT'} S{following}",
        ]
    return "\n".join([*text, "RET"])


def measure(browser: str, seconds: float, panel: str, text: str) -> dict[str, float]:
    """All figures of one panel of a lab with one program."""
    code = f"from ecsim_widgets import Lab\nimport time\nbegan = time.time()\nbusy = time.process_time()\nlab = Lab('EC20', {text!r})\nbusy = time.process_time() - busy\nmade = time.time()\nlab"
    with page_of(code, browser) as (page, address):
        page.goto(address)
        page.wait_for_function(CONNECTED, timeout=60_000)
        page.evaluate(EVALUATE, "import ecsim_widgets")
        page.evaluate("() => { window.jupyterapp.commands.execute('notebook:run-all-cells'); }")
        page.evaluate(SHOWN_SINCE, [panel, 0])
        now = page.evaluate("() => Date.now()")
        began, made, busy = json.loads(page.evaluate(EVALUATE, "print([1000 * began, 1000 * made, busy])"))
        page.evaluate(COUNT_FRAMES, 3000)  # until the page has settled
        body = page.locator(".ladder-scroll" if panel == "ladder" else ".chart-scroll")
        body.scroll_into_view_if_needed()
        box = body.bounding_box()
        page.mouse.move(box["x"] + box["width"] / 2, box["y"] + min(box["height"], 600) / 2)
        usage = "print(time.process_time(), time.perf_counter(), lab.stream.number)"
        timing = page.context.new_cdp_session(page)
        timing.send("Performance.enable", {"timeDomain": "threadTicks"})

        def thread() -> float:
            """Seconds of processor that the page's own thread has had."""
            return {each["name"]: each["value"] for each in timing.send("Performance.getMetrics")["metrics"]}["TaskDuration"]

        resting = page.evaluate(COUNT_FRAMES, 1000 * seconds)
        before = [float(word) for word in page.evaluate(EVALUATE, usage).split()]
        page.evaluate(f"() => {{ window.frames_ = ({COUNT_FRAMES})({1000 * seconds}); }}")
        first, started = thread(), page.evaluate("() => performance.now()")
        turns, blank = round(seconds * 20), 0
        for turn in range(turns):
            page.mouse.wheel(0, 120 if turn < turns / 2 else -120)
            blank += page.evaluate(BLANK, panel)
            page.evaluate(COUNT_FRAMES, 20)
        scrolling = page.evaluate("() => window.frames_")
        share = (thread() - first) / (page.evaluate("() => performance.now()") - started) * 1000
        after = [float(word) for word in page.evaluate(EVALUATE, usage).split()]
        cpu, wall, updates = (last - first for first, last in zip(before, after, strict=True))
        nodes, heap = page.evaluate(DRAWN)
    return {
        "Lab(...), s": (made - began) / 1000,
        "Lab(...), s of processor": busy,
        "from Lab(...) to the first picture, s": (now - began) / 1000,
        "animation frames a second at rest": resting,
        "animation frames a second while the wheel turns": scrolling,
        "looks into a part not drawn yet, %": 100 * blank / turns,
        "updates a second while the wheel turns": updates / wall,
        "kernel while the wheel turns, % of a core": 100 * cpu / wall,
        "the page's thread while the wheel turns, % of a core": 100 * share,
        "the page's thread for a frame while the wheel turns, ms": 1000 * share / scrolling,
        "elements in the page": nodes,
        "memory of the page, MB": heap / 1e6,
    }


def main() -> None:
    """Measure, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--seconds", type=float, default=6)
    parser.add_argument("--browser", default=shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome"))
    asked = parser.parse_args()
    ladder = measure(asked.browser, asked.seconds, "ladder", LARGEST)
    chart = measure(asked.browser, asked.seconds, "chart", chain())
    wanted = {"from Lab(...) to the first picture, s": "below 1.5", "animation frames a second while the wheel turns": "at least 50"}
    rows = [f"| {name} | {value:,.1f} | {chart[name]:,.1f} | {wanted.get(name, '')} |" for name, value in ladder.items()]
    about = f"`python bench/large.py --write`: all panels at 1920 px while the program runs, {os.cpu_count()} processors, load average {os.getloadavg()[0]:.1f} (others work on the machine too)."
    table = "\n".join([about, "", f"| | 12,000 steps, 3,000 networks | a chart of {STEPS} steps | wanted |", "|---|---|---|---|", *rows])
    print(table)
    if asked.write:
        pages.put(pages.PERFORMANCE, "large", table.splitlines())


if __name__ == "__main__":
    main()
