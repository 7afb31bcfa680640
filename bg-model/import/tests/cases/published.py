"""Published robots, where Python packages bring them, and how they swing in MuJoCo, for tests/published.rs.

    python published.py where NAME       # the file; nothing where its package is not installed
    python published.py swing NAME STOP  # `JOINT VALUE` a line, after a free swing of STOP seconds

Packages: mujoco, gymnasium, example-robot-data. Runge-Kutta of order 4 with steps of 1e-4 s, without limits and contacts.
"""

import re
import sys
from importlib.metadata import PackageNotFoundError, files

# The package, the end of the file's path in it, where the joints start (rad, m).
ROBOTS = {
    "inverted_double_pendulum": ("gymnasium", "mujoco/assets/inverted_double_pendulum.xml", {"slider": 0.1, "hinge": 0.4, "hinge2": -0.7}),
    "ur5": ("example-robot-data", "ur_description/urdf/ur5_robot.urdf",
            {"shoulder_pan_joint": 0.3, "shoulder_lift_joint": -0.5, "elbow_joint": 0.8, "wrist_1_joint": 0.2, "wrist_2_joint": -0.4,
             "wrist_3_joint": 0.6}),
    "so101": ("example-robot-data", "so_arm_description/urdf/so101.urdf",
              {"shoulder_pan": 0.3, "shoulder_lift": -0.5, "elbow_flex": 0.2, "wrist_flex": 0.2, "wrist_roll": -0.5, "gripper": 0.4}),
}
STEP = 1e-4


def where(name):
    package, end, _ = ROBOTS[name]
    try:
        found = [file.locate() for file in files(package) or [] if str(file).endswith(end)]
    except PackageNotFoundError:
        found = []
    return found[0] if found else None


def model(path):
    import mujoco

    text = path.read_text()
    # Shapes need meshes, and touch; masses are given.
    if path.suffix == ".urdf":
        text = re.sub(r"<(visual|collision)>.*?</\1>", "", text, flags=re.S)
    model = mujoco.MjModel.from_xml_string(text)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    model.opt.timestep = STEP
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT | mujoco.mjtDisableBit.mjDSBL_CONTACT
    return model


def swing(name, stop):
    import mujoco

    robot = model(where(name))
    data = mujoco.MjData(robot)
    starts = ROBOTS[name][2]
    for joint, value in starts.items():
        data.qpos[robot.joint(joint).qposadr[0]] = value
    for _ in range(round(stop / STEP)):
        mujoco.mj_step(robot, data)
    for joint, start in starts.items():
        print(joint, start, repr(float(data.qpos[robot.joint(joint).qposadr[0]])))


if __name__ == "__main__":
    what, name, *rest = sys.argv[1:]
    print(where(name) or "") if what == "where" else swing(name, float(rest[0]))
