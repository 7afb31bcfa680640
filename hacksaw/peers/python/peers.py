"""Runs the solvers that come with Python packages, one run for each line on standard input.

The first line in is JSON: {"constants": .., "start": [24 numbers], "cutting": true, "samples": [times], "absolute": ratio,
"sources": [names], "c_flags": [flags]}. The first line out is the JSON list of solvers; after that each line {"solver": i, "setting": x} in is
answered with {"seconds": .., "poses": [[12 numbers] ..], "work": {..}} or {"fault": ".."}. A line {"batch": tolerance,
"values": [[4 numbers] ..]}, whose runs number a multiple of heyoka's batch, is answered with the poses at their ends. What has to be compiled is
compiled when the list is made or at the first run, outside of the time taken.
"""

import importlib
import json
import sys
import traceback

# The modules of this folder by the source's name on the command line.
SOURCES = {"heyoka": "taylor", "cvode": "cvode", "casadi": "cvodes"}


def main():
    """Answers until standard input ends."""
    # Packages that print must not get between the answers.
    answers, sys.stdout = sys.stdout, sys.stderr

    def answer(value):
        print(json.dumps(value), file=answers, flush=True)

    problem = json.loads(sys.stdin.readline())
    solvers, faults = [], []
    for source in problem["sources"]:
        try:
            solvers += importlib.import_module(SOURCES[source]).solvers(problem)
        except Exception as fault:
            traceback.print_exc()
            faults.append({"source": source, "fault": f"{type(fault).__name__}: {fault}"})
    listed = [{key: solver[key] for key in ("name", "source", "locates_events", "settings")} for solver in solvers]
    answer({"solvers": listed, "faults": faults, "versions": versions()})
    batches = {}
    for line in sys.stdin:
        request = json.loads(line)
        try:
            if "batch" in request:
                taylor = importlib.import_module(SOURCES["heyoka"])
                answer(taylor.batch(problem, batches, request["batch"], request["values"]))
                continue
            answer(solvers[request["solver"]]["run"](request["setting"]))
        except Exception as fault:
            answer({"fault": f"{type(fault).__name__}: {fault}".splitlines()[0]})


def versions():
    """Python's version and those of the packages asked for in requirements.txt."""
    from importlib import metadata
    from pathlib import Path

    lines = Path(__file__).with_name("requirements.txt").read_text().split()
    packages = [line.partition("==")[0] for line in lines]
    found = {"python": sys.version.split()[0]}
    for package in packages:
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            pass
    return found


if __name__ == "__main__":
    main()
