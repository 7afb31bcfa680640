"""How far something is that takes long."""

import os
import signal
import sys
import threading
import types

import numpy as np
import pytest

import bond_graph as bg
from mechanisms import SWING

#: A run that takes minutes.
LONG = {"t_end": 1e6, "step": 1e3}
TIMES = np.linspace(0, 2000, 50)
#: Each call with what its bar counts to.
CALLS = {
    "run": (lambda swing: swing.run(**LONG), 1000),
    "sensitivity": (lambda swing: swing.sensitivity(**LONG), 1000),
    "gradient": (lambda swing: swing.gradient("x", **LONG), 1000),
    # How many runs a fit needs nobody knows.
    "identify": (lambda swing: swing.identify({"t": TIMES, "x": 0.1 * np.cos(5.01 * TIMES)}, ["stiffness", "mass"]), None),
}


class Bar:
    """A bar that remembers what it was told."""

    def __init__(self, total, **_):
        self.total, self.n, self.is_closed = total, 0, False
        self.told = []

    def update(self, more):
        self.n += more
        self.told.append(self.n)

    def close(self):
        self.is_closed = True


@pytest.fixture
def bars(monkeypatch):
    made = []

    def tqdm(**options):
        made.append(Bar(**options))
        return made[-1]

    monkeypatch.setitem(sys.modules, "tqdm", types.ModuleType("tqdm"))
    monkeypatch.setitem(sys.modules, "tqdm.auto", types.SimpleNamespace(tqdm=tqdm))
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield made
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("name", CALLS)
def test_what_takes_long_has_a_bar(name: str, bars):
    call, total = CALLS[name]
    swing = bg.compile(SWING)
    swing.run(t_end=1)
    assert bars == [], "what is short has none"
    timer = threading.Timer(2.0, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call(swing)
            timer.cancel()
    finally:
        timer.cancel()
    (bar,) = bars
    assert bar.total == total and bar.is_closed
    assert bar.told == sorted(bar.told) and bar.told[-1] > 0
