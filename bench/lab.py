"""The lab in a browser: what it costs the kernel and the line, how smoothly it moves, how soon a click is seen.

    python bench/lab.py [--write] [--seconds 10] [--browser PATH]

A JupyterLab with a notebook of one cell shows a lab with 200 devices in its table, a ladder of 100 rungs and a chart of 30 steps,
while the program changes them all. Needs the browser test's Chromium. `--write` puts the figures into docs/performance.md.
"""

import argparse
import json
import os
import shutil
import statistics

import pages
from labserver import CONNECTED, COUNT_FRAMES, EVALUATE, page_of

STEPS, RUNGS, DEVICES, CLICKS = 30, 100, 200, 25
CLICK = """() => { const now = Date.now(); document.querySelector('[data-testid=X5]').click(); return now; }"""
PREPARE = """
import time
seen = []
level = [lab.plc["X5"]]
def look():
    now = lab.plc.memory.lists["X"][5]
    if now != level[0]:
        level[0] = now
        seen.append(time.time() * 1000)
leave = lab.session.each_scan(look)
"""


def program() -> str:
    """A chart of 30 steps that goes round, one step each 100 ms, and about 100 rungs; 200 registers change."""
    text = ["LD SM1", "SET S0"]
    numbers = [0, *range(20, 19 + STEPS)]  # one initial step, then general ones
    for step, following in zip(numbers, [*numbers[1:], 0], strict=True):
        text += [f"STL S{step}", f"OUT M{step}", "LD SM0", f"TON T{step} 1", f"LD T{step}", f"{'SET' if following else 'OUT'} S{following}"]
    text.append("RET")
    for rung in range(RUNGS - 3 * STEPS):
        text += [f"LD M{rung}", "OR X5", f"ANI M{rung + 1}", f"OUT Y{rung % 8}"]
    text += ["LD SM0", "INC Z0", "LD> Z0 99", "MOV 0 Z0", "LD SM0", "INC D0Z0", "INC D100Z0"]
    return "\n".join(text)


def lab() -> str:
    """The cell that shows the lab."""
    return f"from ecsim_widgets import Lab\nlab = Lab('EC20', {program()!r}, devices=['D0-D{DEVICES - 1}'])\nlab"


def measure(browser: str, seconds: float) -> dict[str, float]:
    """All figures of one run."""
    with page_of(lab(), browser) as (page, address):
        octets = [0]
        sockets = page.context.new_cdp_session(page)
        sockets.send("Network.enable")

        def heard(event: dict) -> None:
            response = event["response"]  # a binary message comes as base64
            octets[0] += len(response["payloadData"]) * (3 if response["opcode"] == 2 else 4) // 4

        sockets.on("Network.webSocketFrameReceived", heard)
        page.goto(address)
        page.wait_for_function(CONNECTED, timeout=60_000)
        page.evaluate("() => window.jupyterapp.commands.execute('notebook:run-all-cells')")
        page.get_by_test_id("ec").first.wait_for(timeout=60_000)
        page.evaluate(COUNT_FRAMES, 3000)  # until the page has settled
        now = "import time; print(time.process_time(), time.perf_counter(), lab.stream.number, lab.plc.scans)"
        before, octets[0] = [float(word) for word in page.evaluate(EVALUATE, now).split()], 0
        frames = page.evaluate(COUNT_FRAMES, 1000 * seconds)
        line = octets[0]
        after = [float(word) for word in page.evaluate(EVALUATE, now).split()]
        cpu, wall, updates, scans = (last - first for first, last in zip(before, after, strict=True))
        page.evaluate(EVALUATE, PREPARE)
        clicks = []
        for _ in range(CLICKS):
            clicks.append(page.evaluate(CLICK))
            page.evaluate(COUNT_FRAMES, 237)
        seen = json.loads(page.evaluate(EVALUATE, "print(seen); leave()"))
        delays = [later - click for click, later in zip(clicks, seen, strict=True)]
    return {
        "updates a second": updates / wall, "scans a second": scans / wall, "kernel, % of a core": 100 * cpu / wall,
        "animation frames a second": frames, "kB a second to the page": line / 1000 / seconds,
        "click to PLC, ms, median": statistics.median(delays), "click to PLC, ms, slowest": max(delays),
    }  # fmt: skip


WANTED = {
    "updates a second": "at least 20", "kernel, % of a core": "below 25", "animation frames a second": "at least 50",
    "kB a second to the page": "below 100", "click to PLC, ms, median": "below 60",
}  # fmt: skip


def main() -> None:
    """Measure, print, and write where asked."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--browser", default=shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome"))
    asked = parser.parse_args()
    figures = measure(asked.browser, asked.seconds)
    rows = [f"| {name} | {value:,.1f} | {WANTED.get(name, '')} |" for name, value in figures.items()]
    about = f"`python bench/lab.py --write`: {DEVICES} devices, a ladder of {RUNGS} rungs, a chart of {STEPS} steps, all panels, 1920 px, {os.cpu_count()} processors, load average {os.getloadavg()[0]:.1f} (others work on the machine too)."
    table = "\n".join([about, "", "| | measured | wanted |", "|---|---|---|", *rows])
    print(table)
    if asked.write:
        pages.put(pages.PERFORMANCE, "lab", table.splitlines())


if __name__ == "__main__":
    main()
