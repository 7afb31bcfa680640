"""Writes a URDF without what is seen and touched, whose meshes are in other files; on a floating base if that is asked."""

import sys
import xml.etree.ElementTree as tree


def main(urdf, base):
    robot = tree.parse(urdf).getroot()
    for link in robot.iter("link"):
        for name in ("visual", "collision"):
            for seen in link.findall(name):
                link.remove(seen)
    own = tree.SubElement(robot, "mujoco")
    tree.SubElement(own, "compiler", {"balanceinertia": "true", "fusestatic": "true", "strippath": "true"})
    if base == "free":
        children = {joint.find("child").get("link") for joint in robot.iter("joint")}
        root = next(link.get("name") for link in robot.iter("link") if link.get("name") not in children)
        tree.SubElement(robot, "link", {"name": "world"})
        free = tree.SubElement(robot, "joint", {"name": "free", "type": "floating"})
        tree.SubElement(free, "parent", {"link": "world"})
        tree.SubElement(free, "child", {"link": root})
    print(tree.tostring(robot, encoding="unicode"))


main(*sys.argv[1:])
