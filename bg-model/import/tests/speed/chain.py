"""Writes a chain of N links of 1 m and 1 kg on hinges about y and z by turns, as a URDF."""

import sys

ORIGIN = '<origin xyz="{} 0 0"/>'
TENSOR = '<inertia ixx="2e-4" ixy="0" ixz="0" iyy="0.0834" iyz="0" izz="0.0834"/>'


def main(count):
    print(f'<robot name="chain{count}">\n<link name="link0"/>')
    for k in range(1, count + 1):
        axis = "0 1 0" if k % 2 else "0 0 1"
        print(f'<link name="link{k}"><inertial>{ORIGIN.format(0.5)}<mass value="1"/>{TENSOR}</inertial></link>')
        print(f'<joint name="hinge{k}" type="continuous">{ORIGIN.format(int(k > 1))}<axis xyz="{axis}"/>')
        print(f'<parent link="link{k - 1}"/><child link="link{k}"/></joint>')
    print("</robot>")


main(int(sys.argv[1]))
