"""How far each method is off at the same tolerance: `error / rtol` over the examples and the hacksaw, and beside `dop853`.

    python errors_by_method.py target/release/bond        # from the root of the project; half an hour on two cores, needs numpy

Each model runs for 2 s (the hacksaw 1 s) by each method at a relative tolerance in each decade, absolute ones by the sizes of the states. The
error is the largest difference of an output at 51 instants to a run at 1e-13 by the Taylor series (DOP853 or Radau where it stops), over the
largest value of that output; forces, moments and powers, which jump where joints ring, are left out. What is told: the quantiles 10, 50 and
90 % over the models of error / rtol, and of the error over that of `dop853`; models whose motion is known in closed form to all methods do not
count. Then the same over models and decades from 1e-3 to 1e-11 where a method's tolerance is some times as large as that of `dop853`: its
error there is interpolated between decades, in logarithms. See decision 76.
"""

import csv
import subprocess
import sys
import tempfile
from multiprocessing import Pool
from pathlib import Path

import numpy

METHODS = ["auto", "dop853", "taylor", "cfmr7", "nystrom", "bs5", "radau9", "radau5", "rodas5p", "ark5"]
TOLERANCES = [10.0**-decade for decade in range(2, 13)]
# Those of the tables, by their places, and the decades that factors are judged by.
TOLD = [2, 4, 6, 8]
JUDGED = range(1, 10)
FACTORS = [0.1, 0.2, 1 / 3, 1, 3, 5, 10]
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
        yield Path("hacksaw/hacksaw.bond"), ["--scene", scene], 1.0
    for name in TEXTS:
        yield Path(f"bg-model/bond/examples/{name}.bond"), [], 2.0


def run(bond, model, method, rtol, table):
    """The outputs at 51 instants by their names, or nothing where the run stops."""
    path, options, end = model
    command = [bond, "run", str(path), *options, "--method", method, "--rtol", repr(rtol), "--t-end", str(end)]
    command += ["--step", str(end / 50), "--csv", str(table), "--no-figures"]
    try:
        if subprocess.run(command, capture_output=True, timeout=60).returncode:
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


def errors_of(bond, model):
    """The errors over the tolerances by each method; not a number where a run stops. A method that stops once is not asked for less."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "run.csv"
        references = (run(bond, model, method, REFERENCE, table) for method in ("taylor", "dop853", "radau9"))
        reference = next(found for found in references if found)
        rows = {}
        for method in METHODS:
            row = [numpy.nan] * len(TOLERANCES)
            for place, rtol in enumerate(TOLERANCES):
                found = run(bond, model, method, rtol, table)
                if found:
                    row[place] = error(found, reference) / rtol
                elif rtol < 1e-4:
                    break
            rows[method] = row
        print(model[0].stem, *model[1], {method: [f"{value:.2g}" for value in row] for method, row in rows.items()}, flush=True)
        return rows


def with_factor(row, first, factor):
    """The errors over those of the first method where the tolerances are `factor` times as large, in the decades that count."""
    with numpy.errstate(divide="ignore", invalid="ignore"):
        logarithms = numpy.log10(row * TOLERANCES)
    known = numpy.isfinite(logarithms)
    if known.sum() < 2:
        return [numpy.nan]
    decades = -numpy.log10(TOLERANCES)
    wanted = decades[JUDGED] - numpy.log10(factor)
    found = numpy.interp(wanted, decades[known], logarithms[known], left=numpy.nan, right=numpy.nan)
    return 10**found / (first * TOLERANCES)[JUDGED]


def main():
    bond = str(Path(sys.argv[1]).resolve())
    with Pool(2) as pool:
        everything = pool.starmap(errors_of, [(bond, model) for model in models()], chunksize=1)
    kept = [{method: numpy.array(row) for method, row in rows.items()} for rows in everything if numpy.nanmax(rows["dop853"]) > EXACT]
    heads = [f"{TOLERANCES[place]:g}" for place in TOLD]
    for title, first in (("error / rtol", None), ("error / that of dop853", "dop853")):
        print(f"\n| {title} | " + " | ".join(heads) + " |\n|---|" + "---|" * len(heads))
        for method in METHODS:
            columns = numpy.array([rows[method] / (rows[first] if first else 1.0) for rows in kept]).T
            print(f"| `{method}` | " + " | ".join(quantiles(columns[place]) for place in TOLD) + " |")
    print("\n| times as large | " + " | ".join(f"{factor:.2g}" for factor in FACTORS) + " |\n|---|" + "---|" * len(FACTORS))
    for method in METHODS[1:]:
        of = [numpy.concatenate([with_factor(rows[method], rows["dop853"], factor) for rows in kept]) for factor in FACTORS]
        print(f"| `{method}` | " + " | ".join(quantiles(column) for column in of) + " |")


if __name__ == "__main__":
    main()
