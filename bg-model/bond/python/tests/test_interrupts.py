"""Ctrl-C while something takes long."""

import math
import os
import pathlib
import signal
import threading
import time

import numpy as np
import pytest

import bond_graph as bg
from mechanisms import SWING

#: A run that takes minutes.
LONG = {"t_end": 1e6, "step": 1e3}
TIMES = np.linspace(0, 1e6, 50)
CALLS = {
    "run": lambda swing, _: swing.run(**LONG),
    "step": lambda swing, _: swing.step(None, 1e6),
    "plot": lambda swing, _: swing.plot("x", **LONG),
    "report": lambda swing, _: swing.report(**LONG),
    "linearize": lambda swing, _: swing.linearize(at=1e6),
    "campbell": lambda swing, _: swing.campbell("stiffness=40..60", at=1e6),
    "sensitivity": lambda swing, _: swing.sensitivity(**LONG),
    "gradient": lambda swing, _: swing.gradient("x", **LONG),
    "identify": lambda swing, _: swing.identify({"t": TIMES, "x": 0.1 * np.cos(TIMES)}, "stiffness"),
    "optimize": lambda swing, _: swing.optimize(minimize="final(x)", by="stiffness=40..60", **LONG),
    "sweep": lambda swing, path: swing.sweep({**LONG, "grid": {"stiffness": [40, 60]}}, path / "sweep"),
    "inputs": lambda swing, _: bg.compile(SWING.replace("graph Swing {", PUSH)).run(inputs={"push": math.sin}, **LONG),
}
PUSH = "graph Swing { input push: N; Se pushing = push; pushing -> slide;"


def tasks() -> int:
    """How many threads there are, where the machine says so."""
    return len(list(pathlib.Path("/proc/self/task").glob("*")))


def interrupted(call) -> float:
    """How long after Ctrl-C, s, a call has ended."""
    sent = []

    def send():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.15, send)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
            timer.cancel()
        return time.perf_counter() - sent[0]
    finally:
        timer.cancel()


@pytest.fixture(autouse=True)
def signals():
    """What is started in the background may have been told to ignore Ctrl-C."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c_ends_each_call_and_the_model_can_be_used_after_that(name: str, tmp_path):
    swing, threads = bg.compile(SWING), tasks()
    assert interrupted(lambda: CALLS[name](swing, tmp_path)) < 1
    # It has ended and is not left to itself, but for threads of a pool that are on their way.
    end = time.perf_counter() + 5
    while tasks() > threads and time.perf_counter() < end:
        time.sleep(0.01)
    assert tasks() == threads
    assert math.isclose(swing.run(t_end=1, step=1, rtol=1e-10)["x"][-1], 0.1 * math.cos(5), abs_tol=1e-9)


def test_ctrl_c_ends_a_compilation_that_asks_nobody():
    masses = range(1, 250)
    chain = "".join(
        f"1 m{i}: translation; I b{i} = 1; m{i} -> b{i}; 0 j{i}: translation; C c{i} = k; m{i - 1} -> j{i} -> m{i}; j{i} -> c{i};"
        for i in masses
    )
    text = f"graph Chain {{ param k: N/m = 1; 1 m0: translation; I b0 = 1; m0 -> b0; {chain} observe {{ v: m/s = m0.flow }} }}"
    assert interrupted(lambda: bg.compile(text)) < 1
    assert bg.compile(SWING).parameters()["mass"]["default"] == 2
