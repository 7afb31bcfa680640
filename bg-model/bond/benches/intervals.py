"""How often the intervals of `identify` have the true values: known runs with noise drawn anew, fitted from elsewhere.

    cargo build --release -p hacksaw
    python3 bg-model/bond/benches/intervals.py target/release/hacksaw -- --scene rigid

The noise of a column is normal and independent, 1 % of how far the column spreads. Of 100 intervals that hold with 95 %
some 95 have the value: 91 to 99 in 95 of 100 such benches. Any other program serves as well:
`intervals.py bond --file swing.bond --fit stiffness`.
"""

import argparse
import csv
import json
import math
import pathlib
import random
import subprocess
import tempfile


def told(program, command, *options):
    made = subprocess.run([program, *command, *options], capture_output=True, text=True, check=False)
    if made.returncode == 2:
        raise SystemExit(made.stderr)
    return made


def noisy(rows, part, draw):
    """The rows with noise of this part of each column's deviation."""
    columns = list(zip(*rows))
    means = [sum(column) / len(column) for column in columns]
    pairs = zip(columns, means)
    spreads = [math.sqrt(sum((value - mean) ** 2 for value in column) / len(column)) for column, mean in pairs]

    def with_noise(k, value):
        # The first column is the time.
        return value if k == 0 else value + draw.gauss(0, 1) * part * spreads[k]

    return [[with_noise(k, value) for k, value in enumerate(row)] for row in rows]


def main():
    ask = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    ask.add_argument("program")
    ask.add_argument("--file", help="the model's file, of a program such as bond")
    ask.add_argument("--fit", default="torque,r_cut")
    ask.add_argument("--start", type=float, default=1.1, help="where fits start, in parts of the true values")
    ask.add_argument("--t-end", default="1")
    ask.add_argument("--draws", type=int, default=100)
    ask.add_argument("--noise", type=float, default=0.01, help="in parts of a column's deviation")
    ask.add_argument("options", nargs="*", help="options of the model, after --")
    asked = ask.parse_args()
    file = [asked.file] if asked.file else []
    truth = json.loads(told(asked.program, ["parameters", *file], "--json").stdout)
    names = asked.fit.split(",")
    start = [word for name in names for word in ("--set", f"{name}={asked.start * truth[name]['default']!r}")]
    found, none = {name: 0 for name in names}, 0
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        exact, measured = str(folder / "exact.csv"), folder / "measured.csv"
        told(asked.program, ["run", *file], *asked.options, "--t-end", asked.t_end, "--csv", exact, "--no-figures")
        with open(exact, newline="") as source:
            head, *rows = csv.reader(source)
        rows = [[float(cell) for cell in row] for row in rows]
        for seed in range(asked.draws):
            with measured.open("w", newline="") as target:
                csv.writer(target).writerows([head, *noisy(rows, asked.noise, random.Random(seed))])
            fit = ["--fit", asked.fit, "--json", "--out", str(folder / "out")]
            made = told(asked.program, ["identify", *file, str(measured)], *asked.options, *start, *fit)
            estimates = json.loads(made.stdout)["parameters"]
            none += any(estimate["interval"] is None for estimate in estimates)
            for estimate in estimates:
                lower, upper = estimate["interval"] or (math.inf, -math.inf)
                found[estimate["name"]] += lower <= truth[estimate["name"]]["default"] <= upper
    for name, count in found.items():
        print(f"{name}: {count} of {asked.draws} intervals have the true value")
    print(f"without an interval, since what is left is no noise: {none}")


if __name__ == "__main__":
    main()
