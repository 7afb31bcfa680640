#!/usr/bin/env bash
# libcosimpy 0.0.6, pythonfmu 0.7.0 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: `simulate_until` with steps of 10 ms and an end at 25 ms stops at 20 ms, takes a shorter step, or says that it cannot.
# Seen: it goes on to 30 ms and says True.
# Output seen:
#   asked for 25 ms: True, at 30 ms
# Fails where it stops at 25 ms or before.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install libcosimpy==0.0.6 pythonfmu==0.7.0
cat > clock.py <<'END'
from pythonfmu import Fmi2Causality, Fmi2Slave, Real
class Clock(Fmi2Slave):
    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.now = 0.0
        self.register_variable(Real("now", causality=Fmi2Causality.output))
    def do_step(self, time, step):
        self.now = time + step
        return True
END
python/bin/python -m pythonfmu build -f clock.py > /dev/null
python/bin/python - 2> /dev/null <<'END' | grep '^asked'
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimSlave import CosimLocalSlave
MILLISECOND = 1_000_000
execution = CosimExecution.from_step_size(step_size=10 * MILLISECOND)
execution.add_local_slave(CosimLocalSlave(fmu_path="Clock.fmu", instance_name="clock"))
says = execution.simulate_until(target_time=25 * MILLISECOND)
at = execution.status().current_time / MILLISECOND
print(f"\nasked for 25 ms: {says}, at {at:.0f} ms", flush=True)
assert says and at == 30
END
