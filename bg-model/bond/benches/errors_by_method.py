"""How far each method is off at the same tolerance: `error / rtol` over the examples and the hacksaw, and beside `dop853`.

    python errors_by_method.py target/release/bond        # from the root of the project; some ten minutes, needs numpy

Each model runs for 2 s (the hacksaw 1 s) by each method at four relative tolerances, absolute ones by the sizes of the states. The error is
the largest difference of an output at 51 instants to a run at 1e-13 by the Taylor series (DOP853 or Radau where it stops), over the largest
value of that output; forces, moments and powers, which jump where joints ring, are left out. What is told: the quantiles 10, 50 and 90 % over
the models of error / rtol, and of the error over that of `dop853`; models whose motion is known in closed form to all methods do not count.
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

METHODS = ["auto", "dop853", "taylor", "cfmr7", "nystrom", "bs5", "radau9", "radau5", "rodas5p", "ark5"]
TOLERANCES = [1e-4, 1e-6, 1e-8, 1e-10]
REFERENCE = 1e-13
SCENES = ["paper", "motion", "full", "angles", "rigid", "free-run"]
TEXTS = ["governor", "spatial_slider_crank", "double_wishbone"]
# Errors below this part of the tolerance are rounding, or the motion is exact.
EXACT = 1e-6


def models():
    """File, options and the end of the run, s."""
    for path in sorted(Path("bg-model/workbench/examples").glob("*.rs")):
        yield path, [], 2.0
    for scene in SCENES:
        yield Path("hacksaw/src/mechanism.rs"), ["--scene", scene], 1.0
    for name in TEXTS:
        yield Path(f"bg-model/bond/examples/{name}.bond"), [], 2.0


def run(bond, model, method, rtol, table):
    """The outputs at 51 instants by their names, or nothing where the run stops."""
    path, options, end = model
    command = [bond, "run", str(path), *options, "--method", method, "--rtol", repr(rtol), "--t-end", str(end)]
    command += ["--step", str(end / 50), "--csv", str(table), "--no-figures"]
    try:
        if subprocess.run(command, capture_output=True, timeout=120).returncode:
            return None
    except subprocess.TimeoutExpired:
        return None
    rows = [row for row in csv.reader(table.open()) if row]
    numbers = [row for row in rows[1:] if row[0][:1] in "-0123456789."]
    return dict(zip(rows[0], numpy.array(numbers, dtype=float).T))


def error(found, reference):
    """The largest difference over the largest value; of angles without whole turns."""
    largest = 0.0
    for name, expected in list(reference.items())[1:]:
        size = numpy.abs(expected).max()
        if name[0] in "FM" or any(word in name for word in ("force", "moment", "power")) or size < 1e-9:
            continue
        difference = numpy.abs(found[name] - expected)
        if "angle" in name or "phi" in name:
            difference = numpy.abs((difference + numpy.pi) % (2 * numpy.pi) - numpy.pi)
        largest = max(largest, difference.max() / size)
    return largest


def quantiles(values):
    values = numpy.array([value for value in values if numpy.isfinite(value)])
    low, middle, high = numpy.quantile(values, [0.1, 0.5, 0.9])
    return f"{middle:.2g} ({low:.2g} to {high:.2g})"


def main():
    bond = str(Path(sys.argv[1]).resolve())
    errors = {method: [] for method in METHODS}
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "run.csv"
        for model in models():
            references = (run(bond, model, method, REFERENCE, table) for method in ("taylor", "dop853", "radau9"))
            reference = next(found for found in references if found)
            rows = {}
            for method in METHODS:
                runs = [(rtol, run(bond, model, method, rtol, table)) for rtol in TOLERANCES]
                rows[method] = [error(found, reference) / rtol if found else numpy.nan for rtol, found in runs]
            print(model[0].stem, *model[1], {method: [f"{value:.2g}" for value in row] for method, row in rows.items()}, flush=True)
            if numpy.nanmax(rows["dop853"]) > EXACT:
                for method in METHODS:
                    errors[method].append(rows[method])
    first = numpy.array(errors["dop853"])
    for title, of in (("error / rtol", lambda rows: rows), ("error / that of dop853", lambda rows: rows / first)):
        print(f"\n| {title} |" + "".join(f" {rtol:g} |" for rtol in TOLERANCES) + "\n|---|" + "---|" * len(TOLERANCES))
        for method in METHODS:
            columns = of(numpy.array(errors[method])).T
            print(f"| `{method}` |" + "".join(f" {quantiles(column)} |" for column in columns))


main()
