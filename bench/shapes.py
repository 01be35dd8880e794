"""What CPython likes: the same meaning in several shapes of generated code, side by side.

Each shape is written out a thousand times with other device numbers, in functions of fifty, as the compiled engine
writes it; the figures are nanoseconds for one, least and median of the turns. The loop around costs about 1.5 ns.

    python bench/shapes.py
"""

from __future__ import annotations

import random
import re
import statistics
import time
from collections.abc import Callable

COPIES, COPIES_OF_A_FUNCTION, TURNS, SCANS = 1000, 50, 30, 6

ON, OFF = "X[{a}] and not X[{b}]", "N[{a}]"
SHAPES: dict[str, dict[str, str]] = {
    "a latch": {
        "bool lists, `or`/`and`/`not`": "Y[{y}] = (X[{a}] or Y[{y}]) and not X[{b}]",
        "bool lists, `False if b else`": "Y[{y}] = False if X[{b}] else X[{a}] or Y[{y}]",
        "bool lists, `if`: True `else`: False": "if (X[{a}] or Y[{y}]) and not X[{b}]: Y[{y}] = True\nelse: Y[{y}] = False",
        "bool lists, through a local": "flow = (X[{a}] or Y[{y}]) and not X[{b}]\nY[{y}] = flow",
        "0/1 lists, `or`/`and`/`not`": "J[{y}] = (I[{a}] or J[{y}]) and not I[{b}]",
        "0/1 lists, `|`/`&`/`^`": "J[{y}] = (I[{a}] | J[{y}]) & (I[{b}] ^ 1)",
    },
    "two coils on one flow": {
        "chained assignment": "Y[{y}] = M[{m}] = X[{a}] and X[{b}]",
        "through a local": "flow = X[{a}] and X[{b}]\nY[{y}] = flow\nM[{m}] = flow",
    },
    "SET on a flow": {
        "condition in the `if`": "if " + ON + ": Y[{y}] = True",
        "through a local": "flow = " + ON + "\nif flow: Y[{y}] = True",
    },
    "a coil read by the next rung": {
        "read again": "M[{m}] = X[{a}] and X[{b}]\nif M[{m}]: D[{i}] = 1",
        "kept in a local": "M[{m}] = flow = X[{a}] and X[{b}]\nif flow: D[{i}] = 1",
    },
    "compare into a bit": {
        "store the comparison": "Y[{y}] = D[{i}] >= {v}",
        "`if`: True `else`: False": "if D[{i}] >= {v}: Y[{y}] = True\nelse: Y[{y}] = False",
    },
    "is a period over": {
        "time as float": "if now >= due[{k}]: Y[{y}] = True",
        "time as int below 2**30": "if ticks >= soon[{k}]: Y[{y}] = True",
        "time as int beyond 2**30": "if late >= later[{k}]: Y[{y}] = True",
    },
    "ADD": {
        "no wrap, no flags": "D[{i}] = D[{k}] + 1",
        "wrap by range": "r = D[{k}] + 1\nif -32768 <= r <= 32767: D[{i}] = r\nelse: D[{i}] = wrapped(r)",
        "wrap by upper bound (constant >= 0)": "r = D[{k}] + 1\nif r <= 32767: D[{i}] = r\nelse: D[{i}] = wrapped(r)",
        "wrap by mask": "r = D[{k}] + 1\nD[{i}] = (r + 32768 & 65535) - 32768",
        "wrap by range, flags": "r = D[{k}] + 1\nif -32768 <= r <= 32767:\n    D[{i}] = r\n    SM[180] = not r\n    SM[181] = SM[182] = False\nelse: D[{i}] = wrapped(r)",
        "positive first, flags": "r = D[{k}] + 1\nif 0 < r <= 32767:\n    D[{i}] = r\n    SM[180] = SM[181] = SM[182] = False\nelse: D[{i}] = wrapped(r)",
    },
    "rising edge": {
        "store the flow each time": "flow = X[{a}]\nM[{m}] = flow and not E[{i}]\nE[{i}] = flow",
        "compare by identity": "flow = X[{a}]\nif flow is E[{i}]: M[{m}] = False\nelse: E[{i}] = M[{m}] = flow",
    },
    "an inactive step": {
        "two tests": "if " + OFF + ": Y[{y}] = True\nelif N[{b}]: Y[{y}] = False",
        "one test of `active or just left`": "if " + OFF + ":\n    if X[{b}]: Y[{y}] = True\n    else: Y[{y}] = False",
    },
    "four bits as a number": {
        "shifts of the bits": "D[{i}] = M[{k}] | M[{k1}] << 1 | M[{k2}] << 2 | M[{k3}] << 3",
        "a constant for each bit": "D[{i}] = (1 if M[{k}] else 0) + (2 if M[{k1}] else 0) + (4 if M[{k2}] else 0) + (8 if M[{k3}] else 0)",
    },
}


def memory() -> dict[str, list]:
    """Lists in a state that takes both branches about equally often."""
    chance = random.Random(3)
    bits = lambda count: [chance.random() < 0.5 for _ in range(count)]
    words = lambda count: [chance.randrange(9) for _ in range(count)]
    return {
        "X": bits(256), "Y": bits(256), "M": bits(2000), "E": bits(1000), "N": [False] * 256, "SM": bits(256), "D": words(8000),
        "I": [int(bit) for bit in bits(256)], "J": [int(bit) for bit in bits(256)],
        "due": [float(word) for word in words(200)], "soon": words(200), "later": [2**31 + word for word in words(200)],
    }  # fmt: skip


def written_out(shape: str, header: str = "now, ticks, late, {lists}") -> Callable[[], None]:
    """A function that runs all copies of the shape once."""
    lists = memory()
    used = [name for name in lists if re.search(rf"\b{name}\[", shape)]
    signature = header.format(lists=", ".join(f"{name}={name}" for name in used)).rstrip(", ")
    chance = random.Random(7)
    environment: dict = dict(lists, wrapped=lambda value: (value + 32768 & 65535) - 32768)
    functions = []
    for first in range(0, COPIES, COPIES_OF_A_FUNCTION):
        lines = [f"def chunk({signature}):"]
        for i in range(first, first + COPIES_OF_A_FUNCTION):
            k = i % 197
            numbers = {name: chance.randrange(256) for name in "aby"} | {"m": chance.randrange(2000), "v": chance.randrange(1, 8)}
            lines += ["    " + line for line in shape.format(i=i, k=k, k1=k + 1, k2=k + 2, k3=k + 3, **numbers).splitlines()]
        exec("\n".join(lines), environment)
        functions.append(environment["chunk"])

    def scan() -> None:
        for function in functions:
            function(5.0, 5, 2**31 + 5)

    return scan


def main() -> None:
    ready = {(group, title): written_out(shape) for group, shapes in SHAPES.items() for title, shape in shapes.items()}
    latch = SHAPES["a latch"]["bool lists, `or`/`and`/`not`"]
    ready["where the lists come from", "defaults of the function"] = written_out(latch)
    ready["where the lists come from", "globals"] = written_out(latch, header="now, ticks, late")
    times: dict[tuple[str, str], list[float]] = {key: [] for key in ready}
    for _ in range(TURNS):
        for key, scan in ready.items():
            began = time.perf_counter_ns()
            for _ in range(SCANS):
                scan()
            times[key].append((time.perf_counter_ns() - began) / SCANS / COPIES)
    heading = ""
    for (group, title), taken in times.items():
        if group != heading:
            print(group)
            heading = group
        print(f"    {title:40} {min(taken):6.1f} {statistics.median(taken):6.1f}")


if __name__ == "__main__":
    main()
