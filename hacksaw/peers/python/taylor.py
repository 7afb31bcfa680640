"""heyoka: Taylor series of the order that the tolerance asks for, compiled with LLVM for the machine at hand.

The zeros of the slip velocity are terminal events: the integrator stops at each, the callback changes the resistance by
the slip's direction there, and it goes on. Samples come from its dense output (`propagate_grid`). `compact_mode` is off:
the series is one straight-line function. Making an integrator is not part of the times. With `fast_math` LLVM may change
the order of operations and fuse them: heyoka's fastest setting.

`batch` makes runs with parameters of their own side by side, as many as the machine's vectors hold.
"""

import time

import heyoka as hy
import numpy as np

import model

# Relative tolerances; heyoka has no absolute one apart.
TOLERANCES = [factor * 10.0**-k for k in range(3, 17) for factor in (1.0, 0.3)]
# After an event heyoka ignores the same event for a while that it guesses from the tolerance. The first two are 23 us apart,
# the blade being at rest in its dead centre; with the guess the second is lost and the first stroke has the wrong law.
COOLDOWN = 1e-6


def solvers(problem):
    """heyoka as it comes, and with `fast_math`."""
    return [line(problem, "heyoka", False), line(problem, "heyoka, fast_math", True)]


def line(problem, name, fast_math):
    """One line."""
    made = {}

    def run(tolerance):
        if tolerance not in made:
            made[tolerance] = Integrator(problem, tolerance, fast_math)
        return made[tolerance].run()

    return {"name": name, "source": "heyoka", "locates_events": True, "settings": TOLERANCES, "run": run}


class Integrator:
    """A compiled integrator of one tolerance."""

    def __init__(self, problem, tolerance, fast_math):
        p = problem["constants"]
        self.start, self.samples = problem["start"], problem["samples"]
        cutting, returning = p["r_cut"], p["r_return"]
        self.first = cutting if problem["cutting"] else returning
        self.events = events = [0]

        # A plain function: heyoka copies the callback with all that belongs to it.
        def switch(integrator, direction):
            """The branch after an event is that of the slip's sign a moment later."""
            integrator.pars[0] = cutting if direction < 0 else returning
            events[0] += 1
            return True

        s = variables()
        rates = model.rates(p, s, hy.par[0], hy.sin, hy.cos)
        event = hy.t_event(model.slip(p, s, hy.sin, hy.cos), callback=switch, cooldown=COOLDOWN)
        clock = time.perf_counter()
        self.integrator = hy.taylor_adaptive(
            list(zip(s, rates)),
            self.start,
            pars=[0.0],
            tol=tolerance,
            t_events=[event],
            compact_mode=False,
            fast_math=fast_math,
        )
        self.compiled = time.perf_counter() - clock

    def run(self):
        """One run from the start."""
        self.events[0] = 0
        integrator = self.integrator
        integrator.time = 0.0
        integrator.state[:] = self.start
        integrator.pars[0] = self.first
        integrator.reset_cooldowns()
        clock = time.perf_counter()
        outcome = integrator.propagate_grid(self.samples)
        seconds = time.perf_counter() - clock
        return {
            "seconds": seconds,
            "poses": outcome[-1][:, :12].tolist(),
            "compile_seconds": self.compiled,
            "work": {"steps": int(outcome[3]), "events": self.events[0]},
        }


def variables():
    """The states: places and angles of the links, then their velocities."""
    names = [f"{kind}{link}" for link in range(4) for kind in ("x", "y", "a")]
    names += [f"{kind}{link}" for link in range(4) for kind in ("u", "v", "w")]
    return list(hy.make_vars(*names))


class Batch:
    """Runs side by side in the machine's vectors, with `fast_math`. Each has its own torque, resistance and two stiffnesses."""

    def __init__(self, problem, tolerance):
        p = dict(problem["constants"])
        self.start, self.end = problem["start"], problem["samples"][-1]
        self.lanes = hy.recommended_simd_size()
        self.cutting, self.returning = problem["cutting"], p["r_return"]
        returning = self.returning

        def switch(integrator, direction, lane):
            """The branch after an event is that of the slip's sign a moment later."""
            integrator.pars[0, lane] = integrator.pars[2, lane] if direction < 0 else returning
            return True

        p["torque"] = hy.par[1]
        p["pin_b"] = [hy.par[3], p["pin_b"][1]]
        p["pin_a"] = [hy.par[4], p["pin_a"][1]]
        s = variables()
        rates = model.rates(p, s, hy.par[0], hy.sin, hy.cos)
        event = hy.t_event_batch(model.slip(p, s, hy.sin, hy.cos), callback=switch, cooldown=COOLDOWN)
        self.integrator = hy.taylor_adaptive_batch(
            list(zip(s, rates)),
            np.repeat(np.array(self.start)[:, None], self.lanes, axis=1),
            pars=np.zeros((5, self.lanes)),
            tol=tolerance,
            t_events=[event],
            compact_mode=False,
            fast_math=True,
        )

    def run(self, values):
        """The runs with `values`, rows of torque, r_cut, k_34, k_23: time, s, and the poses at their ends."""
        integrator = self.integrator
        poses, seconds = [], 0.0
        for first in range(0, len(values), self.lanes):
            some = np.array(values[first : first + self.lanes])
            clock = time.perf_counter()
            integrator.set_time(0.0)
            integrator.state[:] = np.array(self.start)[:, None]
            integrator.pars[1:] = some.T
            integrator.pars[0] = integrator.pars[2] if self.cutting else self.returning
            integrator.reset_cooldowns()
            integrator.propagate_until(self.end)
            seconds += time.perf_counter() - clock
            poses += integrator.state[:12].T.tolist()
        return {"seconds": seconds, "poses": poses, "work": {}}


def batch(problem, made, tolerance, values):
    """The runs of `values` at a tolerance; `made` keeps compiled integrators from call to call."""
    if tolerance not in made:
        made[tolerance] = Batch(problem, tolerance)
    return made[tolerance].run(values)
