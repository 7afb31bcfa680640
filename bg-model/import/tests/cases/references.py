"""The reference numbers of tests/swing.rs, by MuJoCo: pip install mujoco==4.0.0; python references.py

Runge-Kutta of order 4 with steps of 1e-4 s; half of that changes nothing above 1e-12. Limits are left out, since none is reached.
"""

import re
import sys
from pathlib import Path

import mujoco

HERE = Path(__file__).parent


def swing(name, text, starts, step=1e-4, free=None):
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = step
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    data = mujoco.MjData(model)
    for joint, value in starts.items():
        data.qpos[model.joint(joint).qposadr[0]] = value
    print(name, "masses", [(model.body(k).name, float(model.body_mass[k])) for k in range(model.nbody)])
    for count in range(1, 5):
        while data.time < 0.125 * count - step / 2:
            mujoco.mj_step(model, data)
        values = [data.qpos[model.joint(joint).qposadr[0]] for joint in starts] + list(data.body(free).xpos if free else [])
        print(f"{data.time:.3f}", *(repr(float(value)) for value in values))


urdf = (HERE / "double_pendulum.urdf").read_text()
# MuJoCo wants a mass of each link that moves.
urdf = re.sub(r'<joint name="tool_to_camera".*?</joint>', "", urdf, flags=re.S).replace('<link name="camera"/>', "")
# The equality of MuJoCo gives way: tests/swing.rs knows that motion in closed form.
features = re.sub(r"<equality>.*?</equality>", "", (HERE / "features.xml").read_text(), flags=re.S)
crane = (HERE / "crane.xml").read_text()
for step in [float(word) for word in sys.argv[1:]] or [1e-4]:
    swing("double_pendulum", urdf, {"shoulder": 0.5, "elbow": -0.8}, step)
    swing("crane", crane, {"rail": 0.05, "swing": 0.6}, step)
    swing("features", features, {"pin": 0.6, "tuned": 0.4}, step, free="float")
