"""CVODE of SUNDIALS as in a C program: `cvode.c`, compiled here, on the libraries that scikit-sundae brings along.

scikit-sundae itself takes right-hand sides in Python only, so it is not what is measured: its build of CVODE is. Adams with
fixed-point iteration, and BDF with Newton iteration on a dense difference Jacobian. The slip's zeros are CVODE's roots.
"""

import ctypes
import glob
import importlib.util
import os
import subprocess
import tempfile
import time

from tolerances import three_a_decade

# The fields of `Model` in cvode.c.
CONSTANTS = (
    "torque gravity masses inertias pin_o pin_a pin_b pin_c slot twist work r_cut r_return b4 bar blade block pivot "
    "crank rod o5 work_point"
).split()
# In the order of their dependence.
LIBRARIES = ("core", "nvecserial", "sunmatrixdense", "sunlinsoldense", "cvode")
METHODS = (("CVODE Adams", 1, range(3, 14)), ("CVODE BDF", 2, range(3, 12)))


def solvers(problem):
    """CVODE's two families of methods."""
    integrate = compiled(problem["c_flags"])
    model = [value for name in CONSTANTS for value in flat(problem["constants"][name])]
    times = problem["samples"]
    model, start, instants = doubles(model), doubles(problem["start"]), doubles(times)

    def runner(method):
        def run(tolerance):
            poses, counts = (ctypes.c_double * (12 * len(times)))(), (ctypes.c_long * 4)()
            absolute = problem["absolute"] * tolerance
            clock = time.perf_counter()
            flag = integrate(
                model,
                start,
                int(problem["cutting"]),
                instants,
                len(times),
                method,
                ctypes.c_double(tolerance),
                ctypes.c_double(absolute),
                poses,
                counts,
            )
            seconds = time.perf_counter() - clock
            if flag:
                return {"fault": f"CVode gives {flag}"}
            work = dict(zip(("steps", "rejected", "rates", "events"), counts))
            return {"seconds": seconds, "poses": [poses[12 * k : 12 * k + 12] for k in range(len(times))], "work": work}

        return run

    return [
        {"name": name, "source": "cvode", "locates_events": True, "settings": three_a_decade(ks), "run": runner(m)}
        for name, m, ks in METHODS
    ]


def compiled(c_flags):
    """The function `run` of cvode.c, compiled and linked with the package's libraries."""
    package = os.path.dirname(importlib.util.find_spec("sksundae").origin)
    folder = os.path.join(os.path.dirname(package), "scikit_sundae.libs")
    libraries = [glob.glob(os.path.join(folder, f"libsundials_{name}-*"))[0] for name in LIBRARIES]
    for library in libraries:
        ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)
    source = os.path.join(os.path.dirname(__file__), "cvode.c")
    with tempfile.TemporaryDirectory() as target:
        output = os.path.join(target, "cvode.so")
        flags = ["-std=gnu11", *c_flags, "-Wall", "-fPIC", "-shared"]
        subprocess.run(["cc", *flags, source, "-o", output, *libraries, "-lm"], check=True)
        return ctypes.CDLL(output).run


def flat(value):
    """A number or a list of numbers as a list."""
    return value if isinstance(value, list) else [value]


def doubles(values):
    """An array for C."""
    return (ctypes.c_double * len(values))(*values)
