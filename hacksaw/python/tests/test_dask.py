"""A sweep on a cluster of two workers, one of which is killed in the middle."""

import os
import signal
import threading
import time

import pytest

distributed = pytest.importorskip("distributed")

import hacksaw
import hacksaw.dask

PLAN = {
    "scene": "motion",
    "t_end": 0.1,
    "shard": 2,
    "grid": {"torque": {"from": 8, "to": 14, "count": 30}},
    "columns": ["final"],
}


def test_a_killed_worker_costs_nothing(tmp_path):
    out = tmp_path / "out"
    hacksaw.sweep(PLAN, tmp_path / "one")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, protocol="tcp"
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        workers = list(client.run(os.getpid).values())
        assert len(workers) == 2

        def kill():
            while len(list(out.glob("runs-*.parquet"))) < 4:
                time.sleep(0.005)
            os.kill(workers[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        counts = hacksaw.dask.sweep(client, PLAN, str(out))
        killer.join()
        assert counts["runs"] == 30 and counts["files"] + counts["found"] == 15
        # Once more: all is there.
        assert hacksaw.dask.sweep(client, PLAN, str(out))["found"] == 15
    names = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert len(names) == 16
    for name in names:
        assert (out / name).read_bytes() == (tmp_path / "one" / name).read_bytes(), name
