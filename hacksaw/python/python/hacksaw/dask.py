"""A sweep on a cluster of dask.distributed: ``hacksaw.dask.sweep(client, plan, out)``.

The unit of work is a shard of some hundred runs, its result a file in ``out``, which all workers see. So nothing is lost with a worker:
what it had finished is on disk, what it had not another one makes, and the bytes are the same.
"""

from . import _hacksaw


def _shard(plan, out, number, count):
    return _hacksaw.sweep(plan, out, shard=(number, count), threads=1)


def sweep(client, plan, out):
    """Make the runs of ``plan``, a path or a dict, into the folder ``out`` on the workers of ``client``.

    Waits for the end and gives the counts that ``hacksaw.sweep`` gives. Each thread of a worker has one shard at a time. Started again it
    goes on with the shards that are missing.
    """
    from distributed import as_completed

    count = _hacksaw.sweep_shards(plan)
    total = {"runs": 0, "made": 0, "failed": 0, "files": 0, "found": 0}
    # Results are files and not a worker's memory, so a task is not pure: it is made again where it is asked for again.
    tasks = client.map(
        _shard, [plan] * count, [out] * count, range(1, count + 1), [count] * count, pure=False, retries=5
    )
    for task in as_completed(tasks):
        counts = task.result()
        for name in ("made", "failed", "files", "found"):
            total[name] += counts[name]
        total["runs"] = counts["runs"]
        task.release()
    return total
