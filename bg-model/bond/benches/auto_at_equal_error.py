"""What `auto` takes beside the best method by name at equal error, in rates.

    python bg-model/bond/benches/auto_at_equal_error.py target/release/bond [WORD]      # from the root; some minutes, needs numpy

Each model runs by `auto` and by each explicit method at a relative tolerance in each decade; errors as in errors_by_method.py. What a run takes
is its rates, an order of a Taylor series counted as 1.6 of them and a Jacobian with its factorisation as 30: what they cost on the hacksaw in
the plane. A rate of Nystrom's, with second derivatives, takes somewhat more than another and counts as one. It is counted, so
races, trials, events and rejected steps are in it, and the machine is not. What a method takes for the error that `auto` has is
interpolated between its neighbouring tolerances, in logarithms; of several places with this error the cheapest counts, and
where its loosest tolerance errs less, that run.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy
from errors_by_method import REFERENCE, error, run

METHODS = ["auto", "dop853", "cfmr7", "nystrom", "taylor"]
TOLERANCES = [10.0**-decade for decade in range(3, 13)]
ORDER, JACOBIAN = 1.6, 30.0
HACKSAW = Path("hacksaw/hacksaw.bond")
MODELS = {
    "paper": (HACKSAW, ["--scene", "paper"], 5.0),
    "motion": (HACKSAW, ["--scene", "motion"], 5.0),
    "full": (HACKSAW, ["--scene", "full"], 1.0),
    "rigid": (HACKSAW, ["--scene", "rigid"], 5.0),
    "slider-crank": (Path("bg-model/workbench/examples/slider_crank.rs"), [], 10.0),
    "double pendulum": (Path("bg-model/workbench/examples/double_pendulum.rs"), [], 2.0),
}


def taken(bond, model, method, rtol):
    """What the run takes, in rates, and by what it was made."""
    path, options, end = model
    command = [bond, "run", str(path), *options, "--method", method, "--rtol", repr(rtol), "--t-end", str(end), "--step", str(end / 50)]
    with tempfile.TemporaryDirectory() as folder:
        command += ["--csv", f"{folder}/run.csv", "--no-figures", "--json"]
        told = json.loads(subprocess.run(command, capture_output=True, text=True, check=True, timeout=120).stdout)
    rates = told["rate_evaluations"] + ORDER * told["series_orders"] + JACOBIAN * told["factorisations"]
    return rates, told["integrators"][-1]


def at(curve, wanted):
    """What a method takes for this error, from pairs of error and rates at falling tolerances; none where it does not get there."""
    places = [curve[0][1]] if curve[0][0] <= wanted else []
    for (before, cost), (after, more) in zip(curve, curve[1:]):
        if before > wanted >= after > 0:
            places.append(cost * (more / cost) ** (math.log(before / wanted) / math.log(before / after)))
    return min(places, default=None)


def main():
    bond = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "run.csv"
        print("| | " + " | ".join(f"{rtol:.0e}" for rtol in TOLERANCES) + " |\n|---|" + "---|" * len(TOLERANCES))
        for name, model in MODELS.items():
            if len(sys.argv) > 2 and sys.argv[2] not in name:
                continue
            reference = run(bond, model, "taylor", REFERENCE, table) or run(bond, model, "dop853", REFERENCE, table)
            curves = {method: [] for method in METHODS}
            for method in METHODS:
                for rtol in TOLERANCES:
                    found = run(bond, model, method, rtol, table)
                    rates, _ = taken(bond, model, method, rtol) if found else (math.inf, "")
                    curves[method].append((error(found, reference) if found else math.inf, rates))
            row = []
            for wanted, rates in curves["auto"]:
                costs = {method: at(curves[method], wanted) for method in METHODS[1:]}
                costs = {method: cost for method, cost in costs.items() if cost and numpy.isfinite(cost)}
                best = min(costs, key=costs.get, default=None)
                row.append(f"{rates / costs[best]:.2f} {best}" if best else "-")
            print(f"| {name} | " + " | ".join(row) + " |", flush=True)


main()
