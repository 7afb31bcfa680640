from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, TypeAlias, TypedDict

import numpy as np
import numpy.typing as npt

__version__: str

Input: TypeAlias = float | str | PathLike[str] | tuple[npt.ArrayLike, npt.ArrayLike] | npt.ArrayLike | Callable[[float], float]
"""What an input is set to: a number, a text such as ``"12 kN"``, the path of a CSV file, a pair of arrays ``(t, values)``, rows
``[[t, value], ..]``, or a function of t in s, which is called several times a step and gives the same for the same t."""

class RunFailed(ValueError):
    """A run that stopped before its end."""

    run: Table
    """What was reached."""

class Table:
    """Columns of the same length by name."""

    units: dict[str, str]
    info: dict[str, Any]
    """How it was made and what it took; `info["inputs"]` has of each input its unit, `is_given`, and `value` or `table`;
    `info["hint"]` is the method by which `auto` made most of it, for `run(.., hint=..)`, None after another method."""

    def __getitem__(self, name: str) -> Any:
        """A NumPy array; of names a list of texts."""
    def __contains__(self, name: str) -> bool: ...
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[str]: ...
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def _repr_html_(self) -> str: ...
    def keys(self) -> list[str]: ...
    def values(self) -> list[Any]: ...
    def items(self) -> list[tuple[str, Any]]: ...
    def to_pandas(self) -> Any: ...
    def to_polars(self) -> Any: ...

class Picture:
    """A picture, which a notebook shows."""

    svg: str
    def save(self, path: str | PathLike[str]) -> None: ...
    def _repr_svg_(self) -> str: ...

class Page:
    """A page, which a notebook shows."""

    html: str
    def save(self, path: str | PathLike[str]) -> None: ...
    def _repr_html_(self) -> str: ...

class Parameter(TypedDict):
    default: float
    unit: str
    lower: float
    upper: float
    range: str
    doc: str

class Counts(TypedDict):
    runs: int
    made: int
    failed: int
    files: int
    found: int

def run(
    scene: str | None = None,
    *,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    fixed_step: float | None = None,
    start: str = "model",
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> Table:
    """Run the model; parameters are keyword arguments, SI units. ``hint`` is what ``auto`` begins with: a name, the
    ``info["hint"]`` of a run before, or its summary.json."""

def step(
    state: str | None = None,
    dt: float = 0.01,
    scene: str | None = None,
    *,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    fixed_step: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> tuple[str, dict[str, float]]:
    """Go on by ``dt`` s from a state: the next state, and the outputs there by name. A state is the ``info["state"]`` of a
    run; without one it begins at the model's own start."""

def plot(
    picture: str,
    scene: str | None = None,
    *,
    others: Sequence[str | PathLike[str]] | None = None,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    start: str = "model",
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> Picture:
    """Run the model and draw "v over x", "spectrum of x", "orders of torque over crank.angle", or a signal over time."""

def graph(scene: str | None = None) -> Picture:
    """The bond graph of a scene, with its causal strokes."""

def report(
    scene: str | None = None,
    *,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    start: str = "model",
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> Page:
    """Run the model and show all of it: the machine in motion, charts, energy balance, the bond graph."""

def linearize(
    scene: str | None = None,
    *,
    at: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> dict[str, Any]:
    """Linearise where the run is at ``at`` s, or at the equilibrium near the start."""

def campbell(
    by: str,
    scene: str | None = None,
    *,
    points: int = 61,
    orders: Sequence[float] | None = None,
    at: float | None = None,
    start: str = "model",
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> dict[str, Any]:
    """Natural frequencies over a parameter, "speed=0..12000": ``modes``, ``critical_speeds``, ``picture``."""

def sensitivity(
    scene: str | None = None,
    *,
    by: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> Table:
    """A column ``d(output)/d(parameter)`` over the run for each of the outputs and each parameter in ``by``."""

def gradient(
    of: str,
    scene: str | None = None,
    *,
    at: float | None = None,
    integral: bool = False,
    by: Sequence[str] | None = None,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> tuple[float, dict[str, float]]:
    """The output ``of`` at the end, at ``at`` s, or its integral; with its derivatives by the parameters in ``by``."""

def identify(
    data: str | PathLike[str] | Mapping[str, Sequence[float] | npt.NDArray[np.float64]] | Table,
    fit: str | Sequence[str],
    scene: str | None = None,
    *,
    bounds: str | Sequence[str] | None = None,
    columns: str | Sequence[str] | None = None,
    method: str | None = None,
    rtol: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> dict[str, Any]:
    """Fit parameters to what was measured: ``parameters`` with value and interval, what the ``columns`` leave."""

def optimize(
    scene: str | None = None,
    *,
    minimize: str | Sequence[str] | None = None,
    maximize: str | Sequence[str] | None = None,
    subject: str | Sequence[str] | None = None,
    by: str | Sequence[str] | None = None,
    starts: int = 1,
    points: int = 9,
    steps: int = 50,
    threads: int = 0,
    t_end: float | None = None,
    step: float | None = None,
    method: str | None = None,
    hint: str | PathLike[str] | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    inputs: Mapping[str, Input] | None = None,
    set: Mapping[str, float] | None = None,
    **parameters: float,
) -> dict[str, Any]:
    """The parameters in ``by`` with which a number such as ``"max |pin.force|"`` is least or largest.

    ``best``, ``searches`` and the ``front`` of two goals, each a dict; ``trials`` a table of all runs."""

def parameters(scene: str | None = None) -> dict[str, Parameter]:
    """The parameters by name; those of a scene, or all."""

def scenes() -> dict[str, str]:
    """The scenes by name, with what they are."""

def outputs(scene: str | None = None) -> dict[str, str]:
    """The outputs of a scene by name, with their units."""

def sweep(
    plan: str | PathLike[str] | Mapping[str, Any],
    out: str | PathLike[str],
    *,
    shard: tuple[int, int] = (1, 1),
    threads: int = 0,
) -> Counts:
    """Make the runs of a plan into the folder ``out``; what is there is not made again."""

def sweep_shards(plan: str | PathLike[str] | Mapping[str, Any]) -> int:
    """How many shards, each some hundred runs, the sweep of a plan has."""

def read_sweep(folder: str | PathLike[str], *, trajectories: bool = False) -> Table:
    """The rows of a sweep's folder: one for each run, or with ``trajectories`` for each sample."""
