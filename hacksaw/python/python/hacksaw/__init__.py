"""The paper's five-link power hacksaw.

>>> import hacksaw
>>> r = hacksaw.run("paper", torque=12, t_end=2)
>>> r["crank_speed"]            # a NumPy array, for the times r["t"] in s
>>> r.to_pandas()               # with the time as index; to_polars() likewise

Parameters have SI units: ``hacksaw.parameters()`` has their names, units and ranges, ``hacksaw.outputs("paper")`` those of what a
scene gives. What cannot be raises ``ValueError`` with a sentence, a run that stops before its end ``RunFailed``, whose ``run`` has what
was reached. While a model runs, other threads do.
"""

from ._hacksaw import (
    Page,
    Picture,
    RunFailed,
    Table,
    __version__,
    campbell,
    gradient,
    graph,
    identify,
    linearize,
    optimize,
    outputs,
    parameters,
    plot,
    read_sweep,
    report,
    run,
    scenes,
    sensitivity,
    step,
    sweep,
    sweep_shards,
)

# What messages, `help` and pickle call them.
for _class in (Page, Picture, RunFailed, Table):
    _class.__module__ = __name__

__all__ = [
    "Page",
    "Picture",
    "RunFailed",
    "Table",
    "__version__",
    "campbell",
    "gradient",
    "graph",
    "identify",
    "linearize",
    "optimize",
    "outputs",
    "parameters",
    "plot",
    "read_sweep",
    "report",
    "run",
    "scenes",
    "sensitivity",
    "step",
    "sweep",
    "sweep_shards",
]
