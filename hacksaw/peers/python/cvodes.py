"""CasADi with its CVODES: the right-hand side from symbols, compiled as C.

CasADi locates no events: the right-hand side chooses the resistance by the sign of the slip. The samples are the integrator's
output grid. Adams with fixed-point iteration, and BDF with Newton iteration on CasADi's exact sparse Jacobian.
"""

import time

import casadi as ca

import model
from tolerances import three_a_decade

METHODS = (
    ("CasADi CVODES Adams", {"linear_multistep_method": "adams", "nonlinear_solver_iteration": "functional"}),
    ("CasADi CVODES BDF", {"linear_multistep_method": "bdf", "nonlinear_solver_iteration": "newton"}),
)
SETTINGS = three_a_decade(range(3, 12))


def solvers(problem):
    """CVODES' two families of methods."""
    p = problem["constants"]
    s = ca.SX.sym("s", 24)
    states = [s[i] for i in range(24)]
    resistance = ca.if_else(model.slip(p, states, ca.sin, ca.cos) < 0, p["r_cut"], p["r_return"])
    rates = ca.vertcat(*model.rates(p, states, resistance, ca.sin, ca.cos))
    system = {"x": s, "ode": rates}
    return [
        {
            "name": name,
            "source": "casadi",
            "locates_events": False,
            "settings": SETTINGS,
            "run": runner(problem, system, options),
        }
        for name, options in METHODS
    ]


def runner(problem, system, options):
    """Runs one method; an integrator is compiled for each tolerance at its first run."""
    made = {}
    times = problem["samples"]

    def run(tolerance):
        if tolerance not in made:
            clock = time.perf_counter()
            everything = {
                **options,
                "reltol": tolerance,
                "abstol": problem["absolute"] * tolerance,
                "max_num_steps": 1_000_000_000,
                "jit": True,
                "compiler": "shell",
                "jit_options": {"flags": problem["c_flags"], "verbose": False},
            }
            integrator = ca.integrator("hacksaw", "cvodes", system, times[0], times[1:], everything)
            made[tolerance] = integrator, time.perf_counter() - clock
        integrator, compiled = made[tolerance]
        clock = time.perf_counter()
        states = integrator(x0=problem["start"])["xf"]
        seconds = time.perf_counter() - clock
        stats = integrator.stats()
        work = {"steps": int(stats["nsteps"]), "rejected": int(stats["netfails"]), "rates": int(stats["nfevals"])}
        poses = [problem["start"][:12]] + [[float(x) for x in row] for row in states[:12, :].T.full()]
        return {"seconds": seconds, "poses": poses, "compile_seconds": compiled, "work": work}

    return run
