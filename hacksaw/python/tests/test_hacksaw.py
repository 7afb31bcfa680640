"""The module ``hacksaw`` as a user meets it."""

import pickle
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import hacksaw

SHORT = {"t_end": 0.05, "step": 0.01}


def test_a_run_gives_columns_as_arrays():
    r = hacksaw.run("motion", torque=12, **SHORT)
    assert isinstance(r["t"], np.ndarray) and r["t"].dtype == np.float64
    assert np.allclose(r["t"], np.arange(6) * 0.01, atol=1e-15)
    assert list(r) == ["t", *hacksaw.outputs("motion")] == r.keys()
    assert "t" in r and "none" not in r and len(r) == len(r.keys())
    assert r.units["t"] == "s" and r.info["steps"] > 0 and r.info["rtol"] == 1e-8
    with pytest.raises(KeyError, match="there is no column `none`; there are t, "):
        r["none"]


def test_a_run_begins_with_what_made_another_one():
    first = hacksaw.run("motion", rtol=1e-4, **SHORT)
    run = hacksaw.run("motion", rtol=1e-4, hint="nystrom", **SHORT)
    assert run.info["hint"] == "nystrom" != first.info["hint"] and not np.array_equal(run["C4_x"], first["C4_x"])
    again = hacksaw.run("motion", rtol=1e-4, hint=run.info["hint"], **SHORT)
    assert np.array_equal(again["C4_x"], run["C4_x"])


def test_columns_are_not_copied():
    r = hacksaw.run("motion", **SHORT)
    # The array is over memory that the run filled, and the same one each time.
    assert r["t"] is r["t"] and not r["t"].flags.owndata and r["t"].base is not None


def test_parameters_change_the_run_and_have_units_and_ranges():
    torque = hacksaw.parameters()["torque"]
    assert torque["unit"] == "N*m" and torque["lower"] <= torque["default"] <= torque["upper"]
    a, b, c = (hacksaw.run("motion", **way, **SHORT)["C4_x"] for way in ({"torque": 8}, {"set": {"torque": 14}}, {"torque": 14}))
    assert not np.array_equal(a, b) and np.array_equal(b, c)
    assert set(hacksaw.parameters("motion")) < set(hacksaw.parameters())
    assert "paper" in hacksaw.scenes()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"torke": 12}, "there is no parameter `torke`; did you mean `torque`?"),
        ({"scene": "nothing"}, "there is no scene `nothing`; there are "),
        ({"t_end": -1}, "t_end -1: must be a finite number above 0"),
        ({"method": "euler"}, "method: there is no integrator `euler`"),
        ({"hint": "best"}, 'hint "best": give one of dop853, cfmr7, nystrom, taylor, ark5, radau9, or the summary.json'),
        ({"start": "there"}, 'start "there": give "model", "equilibrium" or a state'),
        ({"inputs": {"force": 3}}, "there is no input `force`"),
    ],
)
def test_what_cannot_be_is_a_value_error_with_a_sentence(arguments, sentence):
    with pytest.raises(ValueError) as fault:
        hacksaw.run(**arguments)
    assert sentence in str(fault.value)


def test_frames():
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    r = hacksaw.run("motion", **SHORT)
    frame = r.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and frame.index.name == "t" and len(frame) == 6
    assert isinstance(r.to_polars(), polars.DataFrame) and r.to_polars()["t"].to_list() == list(r["t"])


def test_a_linear_model_has_matrices_and_modes():
    linear = hacksaw.linearize("motion", at=0)
    states, outputs = len(linear["states"]), len(linear["outputs"])
    assert linear["a"].shape == (states, states) and linear["c"].shape == (outputs, states)
    swings = sorted(abs(mode["imaginary"]) for mode in linear["modes"])
    assert np.allclose(max(swings), max(abs(np.linalg.eigvals(linear["a"]).imag)), rtol=1e-6)
    with pytest.raises(ValueError, match="at -1"):
        hacksaw.linearize("motion", at=-1)


def test_derivatives_are_differences():
    exact = hacksaw.sensitivity("motion", by=["torque"], outputs=["C4"], rtol=1e-11, **SHORT)
    assert list(exact) == ["t", "d(C4_x)/d(torque)", "d(C4_y)/d(torque)", "d(C4_z)/d(torque)"]
    assert exact.units["d(C4_x)/d(torque)"] == "m/(N*m)" and exact.info["steps"] > 0
    low, high = (hacksaw.run("motion", torque=torque, rtol=1e-11, **SHORT)["C4_x"] for torque in (9.99, 10.01))
    middle = hacksaw.sensitivity("motion", by=["torque"], outputs=["C4_x"], torque=10, rtol=1e-11, **SHORT)["d(C4_x)/d(torque)"]
    assert np.abs(middle).max() > 0 and np.allclose(middle, (high - low) / 0.02, rtol=1e-5, atol=1e-6 * np.abs(middle).max())
    with pytest.raises(ValueError, match="has no parameter `torke` to be asked for; did you mean `torque`?"):
        hacksaw.sensitivity("motion", by=["torke"])


def test_other_threads_run_meanwhile():
    counted, done = 0, threading.Event()

    def count():
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    other = threading.Thread(target=count)
    other.start()
    during, t_end = 0, 0.5
    while during <= 10 and t_end < 200:  # however fast the build is
        before = counted
        hacksaw.run("motion", t_end=t_end)
        during, t_end = counted - before, 4 * t_end
    done.set()
    other.join()
    assert during > 10


PLAN = {
    "scene": "motion",
    "t_end": 0.02,
    "shard": 4,
    "grid": {"torque": {"from": 8, "to": 14, "count": 10}},
    "columns": ["final", "max"],
}


def test_a_sweep_by_a_dict_is_that_of_the_file(tmp_path):
    counts = hacksaw.sweep(PLAN, tmp_path / "a")
    assert counts == {"runs": 10, "made": 10, "failed": 0, "files": 3, "found": 0}
    assert hacksaw.sweep_shards(PLAN) == 3
    plan = tmp_path / "plan.toml"
    plan.write_text(
        "scene = 'motion'\nt_end = 0.02\nshard = 4\ncolumns = ['final', 'max']\n"
        "[grid]\ntorque = { from = 8, to = 14, count = 10 }\n"
    )
    # The same recipe in other words, so nothing is left to do.
    assert hacksaw.sweep(plan, tmp_path / "a")["found"] == 3
    for part in (1, 2):
        hacksaw.sweep(PLAN, tmp_path / "b", shard=(part, 2), threads=1)
    names = sorted(path.name for path in (tmp_path / "a").iterdir())
    assert all((tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes() for name in names)
    rows = hacksaw.read_sweep(tmp_path / "a")
    assert list(rows["run"]) == list(range(10)) and np.allclose(rows["torque"], np.linspace(8, 14, 10))
    assert rows.units["torque"] == "N*m" and set(rows["status"]) == {"done"}
    with pytest.raises(ValueError, match="has another sweep: `t_end` is 0.02 there and 0.03 here"):
        hacksaw.sweep({**PLAN, "t_end": 0.03}, tmp_path / "a")


def read_by(reader, paths):
    """Columns by name as lists, None where there is no value."""
    module = pytest.importorskip(reader)
    if reader == "duckdb":
        found = module.sql(f"select * from read_parquet({[str(path) for path in paths]!r})")
        return dict(zip(found.columns, map(list, zip(*found.fetchall()))))
    if reader == "fastparquet":
        frame = pytest.importorskip("pandas").concat(module.ParquetFile(str(path)).to_pandas() for path in paths)
        return {name: [None if value != value else value for value in frame[name]] for name in frame.columns}
    if reader == "polars":
        return module.read_parquet(paths).to_dict(as_series=False)
    return pytest.importorskip("pyarrow.parquet").read_table([str(path) for path in paths]).to_pydict()


@pytest.mark.parametrize("reader", ["pyarrow", "fastparquet", "duckdb", "polars"])
def test_other_readers_read_a_sweep_to_the_same_bits(tmp_path, reader):
    # The crank with this many steps comes to the end from a low torque only, so values of some runs are missing.
    hacksaw.sweep({**PLAN, "trajectories": True, "event_times": 1, "step_limit": 60, "t_end": 0.05}, tmp_path)
    for kind in ("runs", "trajectories"):
        ours = hacksaw.read_sweep(tmp_path, trajectories=kind == "trajectories")
        theirs = read_by(reader, sorted(tmp_path.glob(f"{kind}-*.parquet")))
        assert list(theirs) == list(ours.keys())
        for name in ours:
            # Names are a list, numbers an array.
            expected = [None if value != value else value for value in list(ours[name])]
            assert theirs[name] == expected, name
    rows = hacksaw.read_sweep(tmp_path)
    assert all((reason != "") == (status != "done") for reason, status in zip(rows["reason"], rows["status"]))
    assert np.isnan(rows["event_1"]).any()


def interrupted(call):
    """What a program says that calls this, with Ctrl-C after half a second; what runs in the background may ignore it."""
    program = (
        "import hacksaw, _thread, signal, threading\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "threading.Timer(0.5, _thread.interrupt_main).start()\n"
        f"try:\n    {call}\nexcept KeyboardInterrupt:\n    print('ended')\n"
    )
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)


def test_ctrl_c_ends_a_sweep_between_runs(tmp_path):
    plan = {**PLAN, "t_end": 2, "grid": {"torque": {"from": 8, "to": 14, "count": 5000}}}
    ended = interrupted(f"hacksaw.sweep({plan!r}, {str(tmp_path / 'c')!r})")
    assert ended.stdout == "ended\n", ended.stderr
    assert not [path for path in (tmp_path / "c").iterdir() if path.suffix == ".unfinished"]


@pytest.mark.parametrize("call", ["run('rigid', t_end=1e5, step=10)", "plot('crank_speed', 'rigid', t_end=4.9e3)"])
def test_ctrl_c_ends_a_run(call):
    ended = interrupted(f"hacksaw.{call}")
    assert ended.stdout == "ended\n", ended.stderr


def test_the_stubs_have_what_the_module_has():
    stubs = Path(hacksaw.__file__).with_suffix(".pyi").read_text()
    for name in hacksaw.__all__:
        assert f"def {name}(" in stubs or f"class {name}" in stubs or f"{name}:" in stubs, name
        assert getattr(hacksaw, name).__doc__


def test_a_run_goes_through_pickle():
    run = hacksaw.run("motion", t_end=0.02)
    again = pickle.loads(pickle.dumps(run))
    assert all(np.array_equal(again[name], run[name]) for name in run)
    state, outputs = hacksaw.step(None, 0.01, "motion")
    assert outputs.keys() == set(run.keys()) - {"t"} and hacksaw.step(state, 0.01, "motion")[0] != state
