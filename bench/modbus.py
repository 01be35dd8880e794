"""A PLC that runs in real time and is asked over Modbus: how fast it answers, and what that does to the moments of its scans.

`python bench/modbus.py` prints the table; `--write` puts it into docs/performance.md. The clients are processes of their own.
"""

import argparse
import json
import os
import socket
import statistics
import subprocess
import sys
import time

import pages

import ecsim

SCAN_S = 0.01
READ = bytes.fromhex("0001 0000 0006 01 03 0000 000A")  # ten registers
PROGRAM = "LD SM0\nINC D0\n" + "".join(f"LD M{n}\nOR M{n + 1}\nOUT M{n + 2}\n" for n in range(1000))
LOADS = [  # title, clients, reads a second of each (0: as fast as it goes), what is to be reached
    ("nobody asks", 0, 0, None),
    ("one client, 2,000 reads a second", 1, 2000, 2000),
    ("8 clients, 500 reads a second each", 8, 500, 4000),
    ("one client, as fast as it goes", 1, 0, 2000),
]


def client(port, rate, seconds):
    """Ask at a steady rate; prints how many answers came and how long they took."""
    peer = socket.create_connection(("127.0.0.1", port))
    peer.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    took, asked = [], 0
    began = time.perf_counter()
    while (now := time.perf_counter()) - began < seconds:
        if rate and (ahead := began + asked / rate - now) > 0:
            time.sleep(ahead)
        asked += 1
        sent = time.perf_counter()
        peer.sendall(READ)
        left = 29
        while left:
            left -= len(peer.recv(left))
        took.append(time.perf_counter() - sent)
    print(json.dumps({"count": len(took), "seconds": time.perf_counter() - began, "took": sorted(took)[:: max(1, len(took) // 1000)]}))


class Watched(ecsim.Session):
    """A session that notes when its scans begin."""

    moments: list

    def _scan(self, traced=False):
        self.moments.append(time.perf_counter())
        super()._scan(traced)


def measure(clients, rate, seconds):
    """(answers a second, ms that 99 % of the answers and the median took, ms that 99 % of the scans were late)."""
    plc = ecsim.Plc("EC20", scan_ms=1000 * SCAN_S)
    plc.load(PROGRAM)
    plc.run()
    session = Watched(plc, name="bench", speed=1.0)
    session.moments = []
    with ecsim.serve(session, tcp=0) as server:
        session.start()
        command = [sys.executable, __file__, "--client", str(server.port), str(rate), str(seconds)]
        processes = [subprocess.Popen(command, stdout=subprocess.PIPE) for _ in range(clients)]
        time.sleep(seconds if not clients else 0)
        told = [json.loads(process.communicate()[0]) for process in processes]
    session.stop()
    moments = session.moments[50:]
    offsets = [moment - place * SCAN_S for place, moment in enumerate(moments)]
    late = sorted(offset - min(offsets) for offset in offsets)
    took = sorted(each for one in told for each in one["took"])
    answers = sum(one["count"] / one["seconds"] for one in told)
    return answers, *(1000 * took[int(len(took) * share)] if took else 0 for share in (0.5, 0.99)), 1000 * late[int(0.99 * len(late))]


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--write", action="store_true", help="put the table into docs/performance.md")
    arguments.add_argument("--seconds", type=float, default=5, help="for each measurement")
    arguments.add_argument("--turns", type=int, default=3)
    arguments.add_argument("--client", nargs=3, metavar=("PORT", "RATE", "SECONDS"), help=argparse.SUPPRESS)
    options = arguments.parse_args()
    if options.client:
        client(int(options.client[0]), int(options.client[1]), float(options.client[2]))
        return
    lines = [
        f"`python bench/modbus.py --write`, {options.turns} turns of {options.seconds:g} s, scans of 10 ms in real time, {os.cpu_count()} processors"
        f" that other programs used as well (load average {os.getloadavg()[0]:.1f} at the begin). A scan is late by its distance behind the grid of 10 ms; best (median).",
        "",
        "| over TCP, ten registers a read | reads a second | at least | ms for an answer, median | 99 % within | scans late by ms, 99 % within | at most |",
        "|---|---|---|---|---|---|---|",
    ]
    for title, clients, rate, wanted in LOADS:
        turns = [measure(clients, rate, options.seconds) for _ in range(options.turns)]
        answers, half, most, late = zip(*turns, strict=True)
        cells = [f"{max(answers):,.0f} ({statistics.median(answers):,.0f})", f"{wanted:,}"] if wanted else ["", ""]
        cells += [f"{min(column):.2f} ({statistics.median(column):.2f})" if wanted else "" for column in (half, most)]
        lines.append(f"| {title} | {' | '.join(cells)} | {min(late):.2f} ({statistics.median(late):.2f}) | 2 |")
        print(lines[-1], flush=True)
    if options.write:
        pages.put(pages.PERFORMANCE, "modbus", lines)


if __name__ == "__main__":
    main()
