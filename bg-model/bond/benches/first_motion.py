"""From a text to the first trajectory: `bond` beside programs that take models at run time as well.

    python first_motion.py target/release/bond            # what is installed of mujoco, exudyn, pydiffsol, rumoca takes part

Each program is given a pendulum and a slider-crank, 5 s of motion, 501 samples, its default method at a relative
tolerance of 1e-8 (MuJoCo: RK4 with 1 ms), in a process of its own, least of several in turns. What is told: CPU time of the
whole process, of it the part after the imports, and the error of the first angle at 5 s beside DOP853 of scipy on the equation of
one coordinate at 1e-13. Exudyn and MuJoCo get bodies and joints, pydiffsol and rumoca that equation, which a user has to derive.
"""

import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time

# Crank and rod of steel as uniform slender rods, a sliding mass: m, kg, rad, rad/s.
CRANK, ROD, SLIDER, CRANK_MASS, ROD_MASS, START, SPEED = 0.1, 0.3, 0.5, 0.4, 0.6, 0.5, 20.0
LENGTH, PENDULUM_START = 0.6, 0.5
G, END, SAMPLES = 9.81, 5.0, 501

BOND = {
    "pendulum": f"""
graph Pendulum {{
    gravity [0, -{G}, 0];
    ground {{ point pivot = [0, 0, 0]; }}
    body rod {{ mass 1; inertia [1e-6, {LENGTH**2 / 12}, {LENGTH**2 / 12}]; point end = [-{LENGTH / 2}, 0, 0];
               start end at [0, 0, 0]; start turned rotation_z({PENDULUM_START}); }}
    joint pin: revolute z (ground.pivot -> rod.end) {{ rigid; }}
    observe {{ angle: rad = pin.angle; }}
    scene planar {{ observe {{ angle: rad = pin.angle; }} }}
}}
""",
    "slider-crank": f"""
graph SliderCrank {{
    param start_angle: rad = {START};
    let phi = -asin({CRANK} * sin(start_angle) / {ROD});
    gravity [0, -{G}, 0];
    ground {{ point shaft = [0, 0, 0]; }}
    body crank {{ mass {CRANK_MASS}; inertia [1e-6, {CRANK_MASS * CRANK**2 / 12}, {CRANK_MASS * CRANK**2 / 12}];
                 point inner = [-{CRANK / 2}, 0, 0]; point outer = [{CRANK / 2}, 0, 0];
                 start inner at [0, 0, 0]; start turned rotation_z(start_angle);
                 start velocity [guess(0), guess(0), 0]; start spin [0, 0, {SPEED}]; }}
    body rod {{ mass {ROD_MASS}; inertia [1e-6, {ROD_MASS * ROD**2 / 12}, {ROD_MASS * ROD**2 / 12}];
               point inner = [-{ROD / 2}, 0, 0]; point outer = [{ROD / 2}, 0, 0];
               start inner at [{CRANK} * cos(start_angle), {CRANK} * sin(start_angle), 0]; start turned rotation_z(phi);
               start velocity [guess(0), guess(0), 0]; start spin [0, 0, guess(0)]; }}
    body block {{ mass {SLIDER}; inertia [1e-3, 1e-3, 1e-3];
                 start at [{CRANK} * cos(start_angle) + {ROD} * cos(phi), 0, 0]; start velocity [guess(0), guess(0), 0]; }}
    joint bearing: revolute z (ground.shaft -> crank.inner) {{ rigid; }}
    joint knee: revolute z (crank.outer -> rod.inner) {{ rigid; }}
    joint wrist: revolute z (rod.outer -> block) {{ rigid; }}
    joint guide: prismatic x (ground.shaft -> block) {{ rigid; }}
    observe {{ angle: rad = bearing.angle; }}
    scene planar {{ observe {{ angle: rad = bearing.angle; }} }}
}}
""",
}

# The slider-crank by one coordinate: q'' = -(M'(q) q'^2 / 2 + V'(q)) / M(q).
TERMS = [
    ("s", "sin(q)"),
    ("c", "cos(q)"),
    ("w", f"sqrt({ROD**2} - {CRANK**2} * s * s)"),
    # The rod's rate over the crank's, and its derivative.
    ("u", f"{CRANK} * c / w"),
    ("du", f"-{CRANK} * s / w + {CRANK**3} * s * c * c / (w * w * w)"),
    # The block's speed, and that of the rod's centre along x, over the crank's rate, and derivatives.
    ("x", f"-{CRANK} * s * (1 + u)"),
    ("dx", f"-{CRANK} * c * (1 + u) - {CRANK} * s * du"),
    ("y", f"-{CRANK} * s * (1 + u / 2)"),
    ("dy", f"-{CRANK} * c * (1 + u / 2) - {CRANK} * s * du / 2"),
    (
        "m",
        f"{CRANK_MASS * CRANK**2 / 3} + {ROD_MASS} * (y * y + {CRANK**2 / 4} * c * c) + {ROD_MASS * ROD**2 / 12} * u * u"
        f" + {SLIDER} * x * x",
    ),
    (
        "dm",
        f"2 * ({ROD_MASS} * (y * dy - {CRANK**2 / 4} * c * s) + {ROD_MASS * ROD**2 / 12} * u * du + {SLIDER} * x * dx)",
    ),
    ("dv", f"{G * CRANK * (CRANK_MASS + ROD_MASS) / 2} * c"),
]
ACCELERATION = {"pendulum": [("a", f"-{1.5 * G / LENGTH} * cos(q)")], "slider-crank": [*TERMS, ("a", "-(dm * v * v / 2 + dv) / m")]}
AT = {"pendulum": (PENDULUM_START, 0.0), "slider-crank": (START, SPEED)}


def reference(case):
    """The angle at the end, by scipy."""
    import math

    from scipy.integrate import solve_ivp

    code = compile("\n".join(f"{name} = {text}" for name, text in ACCELERATION[case]), case, "exec")

    def rate(_, state):
        names = {"q": state[0], "v": state[1], "sin": math.sin, "cos": math.cos, "sqrt": math.sqrt}
        exec(code, names)
        return [state[1], names["a"]]

    return solve_ivp(rate, (0, END), AT[case], method="DOP853", rtol=1e-13, atol=1e-13).y[0, -1]


def by_mujoco(case):
    import mujoco

    start = time.process_time()
    hinge, flat = 'type="hinge" axis="0 0 1"', 'contype="0" conaffinity="0" type="box" size=".001 .001 .001"'
    rod = lambda mass, length: (
        f'<inertial pos="{length / 2} 0 0" mass="{mass}" diaginertia="1e-9 {mass * length**2 / 12} {mass * length**2 / 12}"/>'
    )
    option = f'<option gravity="0 -{G} 0" timestep="0.001" integrator="RK4"/>'
    if case == "pendulum":
        text = f'<mujoco>{option}<worldbody><body><joint {hinge}/>{rod(1, LENGTH)}</body></worldbody></mujoco>'
    else:
        text = f"""<mujoco>{option}<worldbody><body><joint {hinge}/>{rod(CRANK_MASS, CRANK)}
            <body name="rod" pos="{CRANK} 0 0"><joint {hinge}/>{rod(ROD_MASS, ROD)}</body></body>
            <body name="block" pos="{CRANK + ROD} 0 0"><joint type="slide" axis="1 0 0"/><geom {flat} mass="{SLIDER}"/></body></worldbody>
            <equality><connect body1="rod" body2="block" anchor="{ROD} 0 0" solref="0.002 1"/></equality></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    if case == "pendulum":
        data.qpos[0] = PENDULUM_START
    else:
        import math

        phi = -math.asin(CRANK * math.sin(START) / ROD)
        along = CRANK * math.cos(START) + ROD * math.cos(phi)
        data.qpos[:] = [START, phi - START, along - CRANK - ROD]
        tilt = -CRANK * math.cos(START) / (ROD * math.cos(phi))
        data.qvel[:] = [SPEED, SPEED * tilt - SPEED, -SPEED * CRANK * math.sin(START) - SPEED * tilt * ROD * math.sin(phi)]
    rows = []
    for _ in range(SAMPLES - 1):
        for _ in range(10):
            mujoco.mj_step(model, data)
        rows.append(data.qpos[0])
    return rows[-1], time.process_time() - start


def by_pydiffsol(case):
    import numpy
    import pydiffsol

    start = time.process_time()
    q, v = AT[case]
    # `u` names the states there.
    lines = re.sub(r"\bu\b", "r", "\n".join(f"{name} {{ {text} }}" for name, text in ACCELERATION[case]))
    text = f"u_i {{ q = {q}, v = {v} }}\n{lines}\nF_i {{ v, a }}\nout_i {{ q }}"
    ode = pydiffsol.Ode(text, matrix_type=pydiffsol.nalgebra_dense)
    ode.rtol, ode.atol = 1e-8, 1e-9
    ode.ode_solver = pydiffsol.tsit45
    solution = ode.solve_dense(numpy.array([]), numpy.linspace(0, END, SAMPLES))
    return float(solution.ys[0, -1]), time.process_time() - start


def by_rumoca(case):
    import rumoca

    start = time.process_time()
    q, v = AT[case]
    own = "".join(f"  Real {name};\n" for name, _ in ACCELERATION[case])
    equations = "".join(f"  {name} = {text};\n" for name, text in ACCELERATION[case])
    text = f"""model M
  Real q(start = {q}, fixed = true);
  Real v(start = {v}, fixed = true);
{own}equation
  der(q) = v;
  der(v) = a;
{equations}end M;
"""
    model = rumoca.Session().loads(text, model="M")
    config = rumoca.SimConfig(rtol=1e-8, atol=1e-9)
    result = model.simulate(t=(0, END), dt=END / (SAMPLES - 1), config=config)
    return float(result["q"].values[-1] if hasattr(result["q"], "values") else result["q"][-1]), time.process_time() - start


def by_exudyn(case):
    import exudyn
    import exudyn.utilities as of
    import numpy

    start = time.process_time()
    systems = exudyn.SystemContainer()
    system = systems.AddSystem()
    ground = system.AddObject(of.ObjectGround())

    def rod(mass, length, at, angle, spin=0.0, velocity=(0.0, 0.0)):
        node = system.AddNode(of.NodeRigidBody2D(referenceCoordinates=[*at, angle], initialVelocities=[*velocity, spin]))
        body = of.ObjectRigidBody2D(physicsMass=mass, physicsInertia=mass * length**2 / 12, nodeNumber=node)
        body = system.AddObject(body)
        centre = system.AddMarker(of.MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, 0]))
        system.AddLoad(of.LoadForceVector(markerNumber=centre, loadVector=[0, -G * mass, 0]))
        return body, node

    def marker(body, x=0.0):
        return system.AddMarker(of.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))

    pin = lambda a, b: system.AddObject(of.RevoluteJoint2D(markerNumbers=[a, b]))
    sin, cos, asin = numpy.sin, numpy.cos, numpy.arcsin
    if case == "pendulum":
        centre = [LENGTH / 2 * cos(PENDULUM_START), LENGTH / 2 * sin(PENDULUM_START)]
        body, node = rod(1.0, LENGTH, centre, PENDULUM_START)
        pin(marker(ground), marker(body, -LENGTH / 2))
        angle = PENDULUM_START
    else:
        phi = -asin(CRANK * sin(START) / ROD)
        tilt = -SPEED * CRANK * cos(START) / (ROD * cos(phi))
        knee = numpy.array([CRANK * cos(START), CRANK * sin(START)])
        knee_speed = SPEED * numpy.array([-knee[1], knee[0]])
        half = ROD / 2 * numpy.array([cos(phi), sin(phi)])
        half_speed = tilt * numpy.array([-half[1], half[0]])
        crank, node = rod(CRANK_MASS, CRANK, knee / 2, START, SPEED, knee_speed / 2)
        link, _ = rod(ROD_MASS, ROD, knee + half, phi, tilt, knee_speed + half_speed)
        at = system.AddNode(of.NodePoint2D(referenceCoordinates=list(knee + 2 * half), initialVelocities=list(knee_speed + 2 * half_speed)))
        block = system.AddObject(of.MassPoint2D(physicsMass=SLIDER, nodeNumber=at))
        pin(marker(ground), marker(crank, -CRANK / 2))
        pin(marker(crank, CRANK / 2), marker(link, -ROD / 2))
        pin(marker(link, ROD / 2), marker(block))
        height = system.AddMarker(of.MarkerNodeCoordinate(nodeNumber=at, coordinate=1))
        fixed = system.AddNode(of.NodePointGround())
        zero = system.AddMarker(of.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))
        system.AddObject(of.CoordinateConstraint(markerNumbers=[zero, height]))
        angle = START
    sensor = system.AddSensor(of.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=exudyn.OutputVariableType.Coordinates))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 5000
    settings.timeIntegration.endTime = END
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = END / (SAMPLES - 1)
    settings.timeIntegration.newton.useModifiedNewton = True
    system.SolveDynamic(settings)
    return float(system.GetSensorStoredData(sensor)[-1, 3]) + angle, time.process_time() - start


def by_bond(case, bond, folder):
    path = os.path.join(folder, f"{case}.bond")
    with open(path, "w") as file:
        file.write(BOND[case])
    out = os.path.join(folder, "run.csv")
    command = [bond, "run", path, "--scene", "planar", "--no-figures", "--quiet", "--csv", out]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(out) as file:
        last = float(file.read().splitlines()[-1].split(",")[1])
    spent = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
    return last, spent, spent


PEERS = {"mujoco": by_mujoco, "exudyn": by_exudyn, "pydiffsol": by_pydiffsol, "rumoca": by_rumoca}


def by_peer(case, name):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    told = subprocess.run([sys.executable, __file__, "--peer", name, case], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if told.returncode != 0:
        raise RuntimeError(told.stderr.strip().splitlines()[-1])
    last, own = json.loads(told.stdout.splitlines()[-1])
    return last, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime, own


def main(bond, rounds=5):
    with tempfile.TemporaryDirectory() as folder:
        for case in BOND:
            exact, best, off = reference(case), {}, {}
            for _ in range(rounds):
                for name in ["bond", *PEERS]:
                    if name in off and isinstance(off[name], str):
                        continue
                    try:
                        last, spent, own = by_bond(case, bond, folder) if name == "bond" else by_peer(case, name)
                    except Exception as fault:
                        off[name] = str(fault)
                        continue
                    off[name] = abs(last - exact)
                    least = best.get(name, (float("inf"), float("inf")))
                    best[name] = (min(least[0], spent), min(least[1], own))
            print(f"{case}: angle {exact:.10f} rad after {END} s")
            for name, error in off.items():
                if isinstance(error, str):
                    print(f"  {name:10} {error}")
                else:
                    print(f"  {name:10} process {1e3 * best[name][0]:7.0f} ms, after imports {1e3 * best[name][1]:7.1f} ms, error {error:.1e} rad")


if __name__ == "__main__":
    if sys.argv[1] == "--peer":
        print(json.dumps(PEERS[sys.argv[2]](sys.argv[3])))
    else:
        main(*sys.argv[1:2])
