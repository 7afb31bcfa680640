#!/usr/bin/env bash
# drake 1.51.1 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: the reaction port of a plant gives the forces in the joints of the state at hand, whether time is continuous or goes in steps.
# Seen: a discrete plant gives zeros until its first step, for a rod that hangs askew too; then the forces of that step. A continuous one
# gives them at once. Initializing a simulator does not help.
# Output seen:
#   continuous: 21.39 N
#   discrete: 0.00 N, after one step 21.39 N
# Fails where a discrete plant has the force before a step.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install drake==1.51.1
python/bin/python - <<'END'
import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.systems.analysis import Simulator
ROD = """<robot name="rod"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>"""
def plant_of(step):
    plant = MultibodyPlant(step)
    Parser(plant).AddModelsFromString(ROD, "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName("base"))
    plant.mutable_gravity_field().set_gravity_vector([0, 0, -10])
    plant.Finalize()
    context = plant.CreateDefaultContext()
    plant.GetJointByName("hinge").set_angle(context, np.pi / 6)
    plant.GetJointByName("hinge").set_angular_rate(context, 2)
    return plant, context
def force(plant, context):
    return max(np.linalg.norm(of.translational()) for of in plant.get_reaction_forces_output_port().Eval(context))
continuous = force(*plant_of(0.0))
print(f"continuous: {continuous:.2f} N")
plant, context = plant_of(1e-3)
simulator = Simulator(plant, context)
simulator.Initialize()
before = force(plant, simulator.get_context())
simulator.AdvanceTo(1e-3)
after = force(plant, simulator.get_context())
print(f"discrete: {before:.2f} N, after one step {after:.2f} N")
assert before == 0 and abs(after - continuous) < 1e-6
END
