"""heyoka: Taylor series of the order that the tolerance asks for, compiled with LLVM for the machine at hand.

The zeros of the slip velocity are terminal events: the integrator stops at each, the callback changes the resistance by
the slip's direction there, and it goes on. Samples come from its dense output (`propagate_grid`). `compact_mode` is off:
the series is one straight-line function. Making an integrator is not part of the times.
"""

import time

import heyoka as hy

import model

# Relative tolerances; heyoka has no absolute one apart.
TOLERANCES = [factor * 10.0**-k for k in range(3, 17) for factor in (1.0, 0.3)]
# After an event heyoka ignores the same event for a while that it guesses from the tolerance. The first two are 23 us apart,
# the blade being at rest in its dead centre; with the guess the second is lost and the first stroke has the wrong law.
COOLDOWN = 1e-6


def solvers(problem):
    """The one line of heyoka."""
    made = {}

    def run(tolerance):
        if tolerance not in made:
            made[tolerance] = Integrator(problem, tolerance)
        return made[tolerance].run()

    line = {"name": "heyoka", "source": "heyoka", "locates_events": True, "settings": TOLERANCES, "run": run}
    return [line]


class Integrator:
    """A compiled integrator of one tolerance."""

    def __init__(self, problem, tolerance):
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

        names = [f"{kind}{link}" for link in range(4) for kind in ("x", "y", "a")]
        names += [f"{kind}{link}" for link in range(4) for kind in ("u", "v", "w")]
        s = list(hy.make_vars(*names))
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
