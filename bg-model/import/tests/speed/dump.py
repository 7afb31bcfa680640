"""Writes a robot as Pinocchio has it, a line for each joint: parent, kind, placement, axis, mass, centre, tensor."""

import sys

import numpy as np
import pinocchio as pin

KINDS = {
    "JointModelRX": "rx", "JointModelRY": "ry", "JointModelRZ": "rz", "JointModelPX": "px", "JointModelPY": "py",
    "JointModelPZ": "pz", "JointModelRUBX": "rx", "JointModelRUBY": "ry", "JointModelRUBZ": "rz",
    "JointModelFreeFlyer": "ff", "JointModelRevoluteUnaligned": "ru", "JointModelPrismaticUnaligned": "pu",
}


def axis(model, index):
    """The direction in which a joint moves, in its own axes."""
    data, speeds = model.createData(), np.zeros(model.nv)
    speeds[model.joints[index].idx_v] = 1
    pin.forwardKinematics(model, data, pin.neutral(model), speeds)
    seen = data.v[index] if model.parents[index] == 0 else data.v[index] - data.liMi[index].actInv(
        data.v[model.parents[index]]
    )
    return seen.angular if np.linalg.norm(seen.angular) > 0.5 else seen.linear


def main(urdf, base):
    free = [pin.JointModelFreeFlyer()] if base == "free" else []
    model = pin.buildModelFromUrdf(urdf, *free)
    for index in range(1, model.njoints):
        kind = KINDS[model.joints[index].shortname()]
        place, body = model.jointPlacements[index], model.inertias[index]
        along = axis(model, index) if kind in ("ru", "pu") else [0, 0, 0]
        numbers = [*place.rotation.flatten(), *place.translation, *along, body.mass, *body.lever, *body.inertia.flatten()]
        print(model.parents[index], kind, *[f"{number:.17g}" for number in numbers])


main(*sys.argv[1:])
