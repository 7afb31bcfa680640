"""Loads a unit as libcosim does, the core of the Open Simulation Platform, by libcosimpy: Co-Simulation of FMI 2.0.

    python cosim_check.py UNIT.fmu STOP INTERVAL OUTPUT

Prints the time that was reached and the output there.
"""

import sys

from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

SECOND = 1e9  # nanoseconds

if __name__ == "__main__":
    unit, stop, interval, output = sys.argv[1:]
    # Its parser wants a start value of the time, which FMI 2.0.4 forbids (section 2.2.7, `independent`), says so and goes on.
    log_output_level(CosimLogLevel.FATAL)
    execution = CosimExecution.from_step_size(step_size=float(interval) * SECOND)
    index = execution.add_local_slave(CosimLocalSlave(fmu_path=unit, instance_name="one"))
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    (reference,) = [v.reference for v in execution.slave_variables(index) if v.name.decode() == output]
    assert execution.simulate_until(int(float(stop) * SECOND))
    print(repr(execution.status().current_time / SECOND), repr(observer.last_real_values(index, [reference])[0]))
