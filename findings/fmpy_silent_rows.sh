#!/usr/bin/env bash
# FMPy 0.3.32, pythonfmu 0.7.0 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: a row of `simulate_fmu` has inputs and outputs of one instant, and a name that no variable has is an error.
# Seen: in Co-Simulation the column of an input is one row late: at 0.5 s it has what it was at 0.4 s. An unknown name is left out without a word.
# Output seen:
#   columns: ('time', 'u', 'y')
#   the input is t; at t = 0.5 the row says 0.4
# Fails where the row has the input of its instant, or the unknown name is refused.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install FMPy==0.3.32 pythonfmu==0.7.0
cat > ramp.py <<'END'
from pythonfmu import Fmi2Causality, Fmi2Slave, Real
class Ramp(Fmi2Slave):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.u = self.y = 0.0
        self.register_variable(Real("u", causality=Fmi2Causality.input))
        self.register_variable(Real("y", causality=Fmi2Causality.output))
    def do_step(self, time, step):
        self.y = self.u
        return True
END
python/bin/python -m pythonfmu build -f ramp.py > /dev/null
python/bin/python - <<'END'
import fmpy, numpy as np
ramp = np.array([(0.0, 0.0), (1.0, 1.0)], dtype=[("time", float), ("u", float)])
rows = fmpy.simulate_fmu("Ramp.fmu", stop_time=0.5, output_interval=0.1, input=ramp, output=["u", "y", "no_such_name"])
print(f"columns: {rows.dtype.names}")
print(f"the input is t; at t = {rows['time'][-1]} the row says {rows['u'][-1]:.1f}")
assert rows.dtype.names == ("time", "u", "y") and abs(rows["u"][-1] - 0.4) < 1e-9
END
