"""A served PLC, its clients, and a cable between two serial ports."""

import contextlib
import os
import select
import threading

import pytest

import ecsim
from ecsim.modbus import serve


@pytest.fixture
def plc():
    plc = ecsim.Plc("EC20", input_filter_ms=0)
    plc.load("LD X0\nOUT Y0\nLD SM0\nINC D0")
    plc.run()
    return plc


@pytest.fixture
def server(plc):
    with serve(plc, tcp=0) as server:
        yield server


class Cable:
    """A null modem: two pseudo-terminals whose far ends are joined. `ends` are the paths, `say` speaks into one of them."""

    def __init__(self):
        import tty

        self.pairs = [os.openpty() for _ in range(2)]
        for far, near in self.pairs:
            tty.setraw(near)
            os.set_blocking(far, False)
        self.ends = [os.ttyname(near) for _, near in self.pairs]
        self.wake, self.bell = os.pipe()
        self.thread = threading.Thread(target=self.pump, daemon=True)
        self.thread.start()

    def pump(self):
        (one, _), (other, _) = self.pairs
        while True:
            ready, _, _ = select.select([one, other, self.wake], [], [])
            if self.wake in ready:
                return
            for end in ready:
                with contextlib.suppress(BlockingIOError):
                    os.write(other if end == one else one, os.read(end, 4096))

    def close(self):
        os.write(self.bell, b".")
        self.thread.join()
        for fd in (*self.pairs[0], *self.pairs[1], self.wake, self.bell):
            os.close(fd)


@pytest.fixture
def cable():
    if not hasattr(os, "openpty"):
        pytest.skip("no pseudo-terminals here")
    cable = Cable()
    yield cable
    cable.close()
