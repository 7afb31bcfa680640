"""Loads units as a host does, by FMPy: validates them, simulates them both ways, asks for derivatives and saved states.

    python fmpy_check.py UNIT.fmu {validate | simulate TYPE STOP INTERVAL TOLERANCE OUTPUT | derivatives | states}

Prints what it finds, for the test that calls it.
"""

import sys

import fmpy
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Model, FMU2Slave
from fmpy.fmi3 import FMU3Model, FMU3Slave
from fmpy.validation import validate_fmu


def instance(unit, exchange):
    """A unit's instance, initialized at t = 0."""
    description = read_model_description(unit)
    is_two = description.fmiVersion == "2.0"
    kind = ((FMU2Slave, FMU2Model) if is_two else (FMU3Slave, FMU3Model))[exchange]
    identifier = (description.modelExchange if exchange else description.coSimulation).modelIdentifier
    fmu = kind(guid=description.guid, unzipDirectory=extract(unit), modelIdentifier=identifier, instanceName="one")
    fmu.instantiate()
    if is_two:
        fmu.setupExperiment(startTime=0.0)
        fmu.getFloat64 = fmu.getReal
        names = ["getFMUState", "setFMUState", "freeFMUState", "serializeFMUState", "deserializeFMUState"]
        twos = ["getFMUstate", "setFMUstate", "freeFMUstate", "serializeFMUstate", "deSerializeFMUstate"]
        for name, two in zip(names, twos):
            if not hasattr(fmu, name):
                setattr(fmu, name, getattr(fmu, two))
    fmu.enterInitializationMode()
    fmu.exitInitializationMode()
    if exchange:
        fmu.enterContinuousTimeMode()
    return description, fmu


def validate(unit):
    problems = validate_fmu(unit)
    print("\n".join(["problems"] + problems if problems else ["no problems"]))


def simulate(unit, kind, stop, interval, tolerance, output):
    result = simulate_fmu(unit, fmi_type=kind, stop_time=float(stop), output_interval=float(interval),
                          relative_tolerance=float(tolerance), output=[output])
    print(repr(float(result["time"][-1])), repr(float(result[output][-1])), len(result))


def derivatives(unit):
    """The largest difference of rows and columns of the Jacobian, and the largest entry. In FMI 2.0, which has no rows: of the derivative
    along the sum of all directions and the sum of the columns."""
    description, fmu = instance(unit, True)
    rows = [unknown.variable.valueReference for unknown in description.derivatives]
    columns = [unknown.variable.derivative.valueReference for unknown in description.derivatives]
    n = len(rows)
    one = lambda k: [1.0 if i == k else 0.0 for i in range(n)]
    forward = [fmu.getDirectionalDerivative(rows, columns, one(k)) for k in range(n)]
    largest = max(abs(a) for column in forward for a in column)
    if description.fmiVersion == "2.0":
        along = fmu.getDirectionalDerivative(rows, columns, [1.0] * n)
        print(repr(max(abs(a - sum(column[i] for column in forward)) for i, a in enumerate(along))), repr(largest))
        return
    back = [fmu.getAdjointDerivative(rows, columns, one(k)) for k in range(n)]
    entries = [(forward[k][i], back[i][k]) for i in range(n) for k in range(n)]
    print(repr(max(abs(a - b) for a, b in entries)), repr(largest))


def states(unit):
    """The same steps again, from a saved state and from its bytes."""
    description, fmu = instance(unit, False)
    outputs = [variable.valueReference for variable in description.modelVariables if variable.causality == "output"]
    on = lambda first, last: [fmu.doStep(k / 64, 1 / 64) for k in range(first, last)]
    on(0, 40)
    saved = fmu.getFMUState()
    on(40, 80)
    first = fmu.getFloat64(outputs)
    fmu.setFMUState(saved)
    on(40, 80)
    again = fmu.getFloat64(outputs)
    data = fmu.serializeFMUState(saved)
    fmu.freeFMUState(saved)
    read = fmu.deserializeFMUState(data)
    fmu.setFMUState(read)
    on(40, 80)
    from_bytes = fmu.getFloat64(outputs)
    fmu.freeFMUState(read)
    fmu.terminate()
    fmu.freeInstance()
    print(list(first) == list(again), repr(max(abs(a - b) for a, b in zip(first, from_bytes))))


if __name__ == "__main__":
    unit, what, *rest = sys.argv[1:]
    {"validate": validate, "simulate": simulate, "derivatives": derivatives, "states": states}[what](unit, *rest)
