"""Compares what bg-import writes with MuJoCo and Pinocchio, over the robots of Python packages.

    pip install mujoco==4.0.0 pin==4.1.0 gymnasium example-robot-data dm_control
    cargo build --release -p bg-import
    python compare.py ../../../target/release/bg-import [-v] [PART OF A PATH]

Of each file: the text that is written is read here, without the compiler, and its mass matrix, bias (Coriolis,
centrifugal and weights) and passive forces (springs, dampers, fluids, gravity compensation) are calculated at a random
pose with random speeds. MJCF is compared with MuJoCo, URDF with Pinocchio. A file without a note has to agree to 1e-9
of the largest entry; one that differs needs a note. That there are no contacts, and that efforts and speeds are not
limited, changes none of the three: such notes do not count. Of MJCF without a note on an actuator the efforts of all
actuators are compared as well, with random controls.
"""

import os
import re
import subprocess
import sys
import tempfile
from importlib.metadata import files
from pathlib import Path

import numpy as np

ALLOWED = 1e-9
# Notes of what changes neither mass matrix nor bias nor passive forces.
ASIDE = (
    "Shapes touch nothing",
    "`effort` of <limit>",
    "`velocity` of <limit>",
    ": the actuator",
    "are among those of",
)


class M:
    """A scalar, vector or matrix whose product is the language's."""

    def __init__(self, value):
        self.v = np.asarray(value, dtype=float)

    def __mul__(self, other):
        other = other if isinstance(other, M) else M(other)
        both = self.v.ndim and other.v.ndim
        return M(self.v @ other.v if both else self.v * other.v)

    __rmul__ = lambda self, other: M(other) * self
    __add__ = lambda self, other: M(self.v + (other.v if isinstance(other, M) else other))
    __radd__ = __add__
    __sub__ = lambda self, other: M(self.v - (other.v if isinstance(other, M) else other))
    __rsub__ = lambda self, other: M(other) - self
    __neg__ = lambda self: M(-self.v)
    __gt__ = lambda self, other: bool(self.v > (other.v if isinstance(other, M) else other))
    __lt__ = lambda self, other: bool(self.v < (other.v if isinstance(other, M) else other))
    __truediv__ = lambda self, other: M(self.v / (other.v if isinstance(other, M) else other))
    x, y, z = (property(lambda self, k=k: M(self.v[k])) for k in range(3))


def rotation(axis):
    def turned(angle):
        angle = angle.v if isinstance(angle, M) else angle
        c, s = np.cos(angle), np.sin(angle)
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = c
        matrix[i, j], matrix[j, i] = -s, s
        return M(matrix)

    return turned


FUNCTIONS = {f"rotation_{letter}": rotation(k) for k, letter in enumerate("xyz")}
FUNCTIONS["pow"] = lambda a, b: (a if isinstance(a, M) else M(a)).v ** b
FUNCTIONS["transpose"] = lambda a: M(a.v.T)
FUNCTIONS["abs"] = lambda a: abs(a.v if isinstance(a, M) else a)


CHOICE = re.compile(r"if ([^{}]*) \{ ([^{}]*) \} else if ([^{}]*) \{ ([^{}]*) \} else \{ ([^{}]*) \}")


def value(text, names):
    """The value of an expression of the text."""
    text = CHOICE.sub(r"((\2) if \1 else ((\4) if \3 else (\5)))", text)
    python = re.sub(r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]", lambda found: f"_m([{found.group(1)}])", text)
    scope = {**FUNCTIONS, **names, "_m": lambda rows: M([row.v if isinstance(row, M) else row for row in rows])}
    result = eval(python, {"__builtins__": {}}, scope)
    return result.v if isinstance(result, M) else np.asarray(float(result))


class Text:
    """The graph of a text."""

    def __init__(self, text):
        self.parameters, self.lets, self.bodies, self.joints, self.elements = {}, [], {"ground": {}}, [], []
        self.gravity = np.zeros(3)
        graph = re.sub(r"^\s*//.*$", "", text[text.index("\nbond_graph!") :], flags=re.M)
        for name, rest in re.findall(r"param (\w+): [^=]* = ([^;,]*)", graph):
            self.parameters[name] = float(rest)
        found = re.search(r"^\s*gravity (.*);$", graph, re.M)
        if found:
            self.gravity = value(found.group(1), {})
        lets = [found for found in re.findall(r"let (\w+): [^=]* = ([^;]*);", graph) if found[0] != "potential"]
        self.controls = re.findall(r"^\s*input (\w+): 1;", graph, re.M)
        # Those of a fluid depend on speeds, those of an actuator on joints and controls.
        moves = r"\.(orientation|velocity|angular_velocity|angle|travel|flow)\b"
        made = [f"{name}_{word}" for name in self.controls for word in ("control", "effort")]
        moving = [name for name, rest in lets if name in made or re.search(moves, rest)]
        self.lets = [found for found in lets if found[0] not in moving]
        self.moving = [found for found in lets if found[0] in moving]
        for name, inside in re.findall(r"^\s*(?:body )?(\w+) \{\n(.*?)\n        \}", graph, re.M | re.S):
            if name == "observe":
                continue
            body = self.bodies.setdefault(name, {})
            body["points"] = {}
            for point, place, turned in re.findall(r"point (\w+) = (\[[^\]]*\])(?: turned ([^;]*))?;", inside):
                body["points"][point] = (value(place, {}), value(turned, {}) if turned else np.eye(3))
            for clause in ("mass", "center", "inertia"):
                found = re.search(rf"^\s*{clause} (.*);$", inside, re.M)
                body[clause] = value(found.group(1), {}) if found else np.zeros(3)
            body["place"], body["turned"] = f"{name}_place", f"{name}_turned"
        ends = r"\((\w+)(?:\.(\w+))? -> (\w+)(?:\.(\w+))?\)"
        for name, kind, axis, a, p, b, q, inside in re.findall(
            rf"joint (\w+): (\w+)([ xyz]*) {ends} \{{(.*?)\}}", graph
        ):
            self.joints.append((name, kind, axis.strip(), (a, p), (b, q), inside.strip()))
        self.graph = graph

    def frame(self, end):
        body, point = end
        return self.bodies[body].get("points", {}).get(point, (np.zeros(3), np.eye(3)))


class State:
    """A text at a pose with speeds."""

    def __init__(self, text, angles):
        self.text = text
        names = {**text.parameters, **angles}
        left = list(text.lets)
        # Order is free in the language.
        while left:
            rest = []
            for name, expression in left:
                try:
                    names[name] = M(value(expression, names))
                except NameError:
                    rest.append((name, expression))
            if len(rest) == len(left):
                raise ValueError(f"lets without a value: {rest[:2]}")
            left = rest
        self.names = names
        get = lambda name, other: names[name].v if name in names else other
        self.pose = {
            body: (get(f"{body}_place", np.zeros(3)), get(f"{body}_turned", np.eye(3))) for body in text.bodies
        }

    def world(self, end):
        place, turned = self.text.frame(end)
        at, axes = self.pose[end[0]]
        return at + axes @ place, axes @ turned

    def tree(self):
        """Joints from parents to children: name, parent, child, kind, axis in space, anchor."""
        carried = {"ground"}
        left = [joint for joint in self.text.joints if joint[5] == "rigid;"]
        found = []
        held = {joint[3][0] for joint in left} | {joint[4][0] for joint in left}
        free = [body for body in self.text.bodies if body != "ground"]
        children = {}
        for name, kind, axis, first, second, _ in left:
            children.setdefault(first[0], []).append((name, kind, axis, first, second, 1.0))
            children.setdefault(second[0], []).append((name, kind, axis, second, first, -1.0))
        del held
        order = ["ground"]
        done = set()
        for root in ["ground", *free]:
            if root in done:
                continue
            if root != "ground":
                found.append((root, "ground", root, "free", None, self.pose[root][0]))
            stack = [root]
            done.add(root)
            while stack:
                body = stack.pop()
                for name, kind, axis, own, other, sign in children.get(body, []):
                    if other[0] in done:
                        continue
                    done.add(other[0])
                    order.append(other[0])
                    place, axes = self.world(own)
                    there, other_axes = self.world(other)
                    direction = sign * axes[:, "xyz".index(axis)] if axis in ("x", "y", "z") else None
                    self.check(name, kind, direction, place, axes, there, other_axes)
                    found.append((name, body, other[0], kind, direction, there if kind == "prismatic" else place))
                    stack.append(other[0])
        del carried
        return found

    @staticmethod
    def check(name, kind, direction, place, axes, there, other_axes):
        gap = there - place
        if kind == "prismatic":
            gap = gap - direction * (direction @ gap)
        if np.abs(gap).max() > 1e-9:
            raise ValueError(f"joint {name} is torn by {np.abs(gap).max()}")
        turned = axes.T @ other_axes
        if kind in ("prismatic", "fixed") and np.abs(turned - np.eye(3)).max() > 1e-9:
            raise ValueError(f"joint {name} is turned")


def cross(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


class Moving:
    """What an expression may ask of a body."""

    def __init__(self, velocity, orientation, spin):
        self.at, self.orientation, self.angular_velocity = velocity, M(orientation), M(spin)

    def __getattr__(self, point):
        return type("Point", (), {"velocity": M(self.at(point))})


class Freedom:
    """What an expression may ask of a joint."""

    def __init__(self, place, speed):
        self.angle = self.travel = M(place)
        self.spin = self.slide = type("Flow", (), {"flow": M(speed)})


def forces(text, angles, speeds, controls):
    """Names of the freedoms, mass matrix, bias, passive forces, forces of actuators."""
    state = State(text, angles)
    tree = state.tree()
    width = {"free": 6, "spherical": 3, "revolute": 1, "prismatic": 1, "fixed": 0}
    columns, count = {}, 0
    for name, _, _, kind, _, _ in tree:
        columns[name] = (count, width[kind])
        count += width[kind]
    u = np.zeros(count)
    for name, (start, size) in columns.items():
        u[start : start + size] = speeds[name][:size] if size else []
    zero = lambda: np.zeros((3, count))
    # Of each body: the Jacobians of its origin's velocity and its angular velocity, and the accelerations without u'.
    motion = {"ground": (zero(), zero(), np.zeros(3), np.zeros(3))}
    for name, parent, child, kind, direction, anchor in tree:
        start, size = columns[name]
        at, axes = state.pose[child]
        v, w, a, alpha = motion[parent]
        origin = state.pose[parent][0]
        omega = w @ u
        arm = anchor - origin
        jv = v - cross(arm) @ w
        jw = w.copy()
        acceleration = a + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))
        turning = alpha.copy()
        if kind == "revolute":
            jw[:, start] += direction
            turning = turning + np.cross(omega, direction * u[start])
        elif kind == "prismatic":
            jv[:, start] += direction
            acceleration = acceleration + 2 * np.cross(omega, direction * u[start])
        elif kind == "spherical":
            jw[:, start : start + 3] += axes
            turning = turning + np.cross(jw @ u, axes @ u[start : start + 3])
        elif kind == "free":
            jv[:, start : start + 3] += np.eye(3)
            jw[:, start + 3 : start + 6] += axes
        arm = at - anchor
        omega = jw @ u
        motion[child] = (
            jv - cross(arm) @ jw,
            jw,
            acceleration + np.cross(turning, arm) + np.cross(omega, np.cross(omega, arm)),
            turning,
        )
    mass, bias, passive = np.zeros((count, count)), np.zeros(count), np.zeros(count)
    for body, parts in text.bodies.items():
        if body == "ground":
            continue
        v, w, a, alpha = motion[body]
        axes = state.pose[body][1]
        arm = axes @ parts["center"]
        omega = w @ u
        jv = v - cross(arm) @ w
        acceleration = a + np.cross(alpha, arm) + np.cross(omega, np.cross(omega, arm))
        tensor = parts["inertia"] if parts["inertia"].ndim == 2 else np.diag(parts["inertia"])
        tensor = axes @ tensor @ axes.T
        mass += float(parts["mass"]) * jv.T @ jv + w.T @ tensor @ w
        bias += jv.T @ (float(parts["mass"]) * (acceleration - text.gravity)) + w.T @ (
            tensor @ alpha + np.cross(omega, tensor @ omega)
        )
    kinds = {name: kind for name, _, _, kind, _, _ in tree}

    def velocity(body, point):
        v, w, _, _ = motion[body]
        return v - cross(state.pose[body][1] @ text.frame((body, point))[0]) @ w

    names = {
        body: Moving(lambda point, body=body: velocity(body, point) @ u, state.pose[body][1], motion[body][1] @ u)
        for body in motion
    }
    ways = {}
    for name, (start, size) in columns.items():
        if size == 1:
            ways[name] = np.eye(count)[start]
            place = state.names.get(f"{name}_start")
            if place is not None:
                names[name] = Freedom(getattr(place, "v", place), u[start])
    names.update(controls)
    for name, expression in text.moving:
        names[name] = M(value(expression, names))
    # Along a tendon: the sum of the joints' speeds, each times a factor.
    for factor, joint, name in re.findall(r"TF \w+ = ([^;]*); (\w+)\.(?:spin|slide) -> \w+ -> (\w+)_sum;", text.graph):
        ways[f"{name}_pull"] = ways.get(f"{name}_pull", 0.0) + float(factor) * ways[joint]
    for body, point, force in re.findall(
        r"drive \w+ on (\w+)(?:\.(\w+))? force = ((?:\[|\w+_fluid)[^;]*);", text.graph
    ):
        passive += velocity(body, point).T @ value(force, names)
    for body, torque in re.findall(r"drive \w+ on (\w+) torque = (\w+_fluid[^;]*);", text.graph):
        passive += motion[body][1].T @ value(torque, names)
    for variable, law, target in re.findall(
        r"R \w+(?:\((\w)\))? = ([^;]*); (\w+)(?:\.(?:spin|slide))? -> ", text.graph
    ):
        if target in ways:
            speed = ways[target] @ u
            passive -= ways[target] * (value(law, {"w": M(speed)}) if variable else float(law) * speed)
    for target, damping in re.findall(r"friction \w+ on (\w+) \{ coulomb [^;]*; viscous ([^;]*); \}", text.graph):
        passive -= ways[target] * float(damping) * (ways[target] @ u)
    for damping, body in re.findall(r"R \w+ = ([^;]*); (\w+)\.rotation -> ", text.graph):
        jw = motion[body][1]
        passive -= float(damping) * jw.T @ (jw @ u)
    for damping, parent, child in re.findall(
        r"R \w+ = ([^;]*); 1 \w+\[3\]: rotation;.*\n.* (\w+)\.rotation -> \w+ -> (\w+)\.rotation", text.graph
    ):
        jw = motion[child][1] - motion[parent][1]
        passive -= float(damping) * jw.T @ (jw @ u)
    for body, damping in re.findall(r"spherical \(ground -> (\w+)\) \{ stiffness 0; damping ([^;]*);", text.graph):
        jv = motion[body][0]
        passive -= float(damping) * jv.T @ (jv @ u)
    for law, start, target in re.findall(
        r"C \w+\(q\) = ([^;]*?) start ([^;]*?)(?: energy [^;]*)?; (\w+)(?:\.(?:spin|slide))? -> ", text.graph
    ):
        passive -= ways[target] * value(law, {"q": M(value(start, state.names))})
    for inertia, joint in re.findall(r"I \w+ = ([^;]*); (\w+)\.(?:spin|slide) -> ", text.graph):
        mass[columns[joint][0], columns[joint][0]] += float(inertia)
    driven = np.zeros(count)
    for joint, effort in re.findall(r"drive \w+_drive\d* on (\w+) (?:force|torque) = ([^;]*);", text.graph):
        driven += ways[joint] * value(effort, names)
    return columns, kinds, mass, bias, passive, driven


def differences(mine, reference):
    """Of mass matrix, bias, passive forces and efforts of actuators, in parts of the largest entry."""
    off = []
    for a, b in zip(mine, reference):
        scale = max(np.abs(b).max(initial=0.0), 1e-300 if np.abs(a).max(initial=0.0) == 0 else np.abs(a).max())
        off.append(float(np.abs(a - b).max(initial=0.0) / scale))
    return off


def identifier(name):
    kept = re.sub(r"[^A-Za-z0-9]", "_", name).strip("_")
    return "unnamed" if not kept else f"n{kept}" if kept[0].isdigit() else kept


def followers(text):
    return set(re.findall(r"rSe (\w+)_follows", text.graph))


def numbers(text, random):
    """Values of all `NAME_start`, and those that follow from them."""
    angles = {name: random.uniform(-0.7, 0.7) for name in text.parameters if name.endswith("_start")}
    return angles, State(text, angles).names


def with_mujoco(path, text, random):
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    angles, names = numbers(text, random)
    data = mujoco.MjData(model)
    mine = [name for name, *_ in State(text, angles).tree() if True]
    kinds = dict((name, kind) for name, _, _, kind, _, _ in State(text, angles).tree())
    mine = [name for name in mine if kinds[name] != "fixed"]
    # The text has joints in the order of the file, free bodies by their own names.
    order = [
        name
        for name in re.findall(r"^\s*(?:joint|body) (\w+)[: ]", text.graph, re.M)
        if name in mine and kinds[name] != "free" or name in mine and kinds[name] == "free"
    ]
    if len(order) != model.njnt:
        raise ValueError(f"{len(order)} joints, {model.njnt} in MuJoCo")
    speeds, wanted = {}, np.zeros(model.nv)
    picked = []
    for k, name in enumerate(order):
        kind, q, v = model.jnt_type[k], model.jnt_qposadr[k], model.jnt_dofadr[k]
        width = {0: 6, 1: 3}.get(int(kind), 1)
        speeds[name] = random.uniform(-1, 1, width)
        wanted[v : v + width] = speeds[name]
        if width == 1:
            data.qpos[q] = model.qpos0[q] + float(
                np.asarray(getattr(names[f"{name}_start"], "v", names[f"{name}_start"]))
            )
        picked.append((name, v, width))
    data.qvel[:] = wanted
    controls = {}
    if len(text.controls) == model.nu:
        data.ctrl[:] = [random.uniform(-1, 1) for _ in text.controls]
        controls = dict(zip(text.controls, map(M, data.ctrl)))
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full) if fullm_takes_data() else mujoco.mj_fullM(model, full, data.qM)
    for name, kind in kinds.items():
        speeds.setdefault(name, np.zeros(6))
    if len(text.controls) != model.nu:
        # Some are left out: those that are there are not looked at.
        controls = {name: M(0.0) for name in text.controls}
        data.qfrc_actuator[:] = np.nan
    columns, _, mass, bias, passive, driven = forces(text, angles, speeds, controls)
    mine = [columns[name][0] + k for name, _, width in picked for k in range(width)]
    theirs = [v + k for _, v, width in picked for k in range(width)]
    off = differences(
        (mass[np.ix_(mine, mine)], bias[mine], passive[mine], driven[mine]),
        (full[np.ix_(theirs, theirs)], data.qfrc_bias[theirs], data.qfrc_passive[theirs], data.qfrc_actuator[theirs]),
    )
    # Of actuators that are not compared there is no number.
    return off[: 4 if model.nu and np.isfinite(off[3]) else 3], model.nv


def fullm_takes_data():
    import mujoco

    return "MjData" in (mujoco.mj_fullM.__doc__ or "").split("->")[0]


def with_pinocchio(path, text, random):
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    angles, names = numbers(text, random)
    kinds = dict((name, kind) for name, _, _, kind, _, _ in State(text, angles).tree())
    q, v = pin.neutral(model), np.zeros(model.nv)
    step = np.zeros(model.nv)
    speeds, picked, lost = {name: np.zeros(6) for name in kinds}, [], []
    for k in range(1, model.njoints):
        name, joint = identifier(model.names[k]), model.joints[k]
        name = next((known for known in (name, f"{name}_joint", f"{name}_2") if known in kinds), None)
        if name is None or joint.nv != 1:
            lost.append(model.names[k])
            continue
        start = names[f"{name}_start"]
        step[joint.idx_v] = float(np.asarray(getattr(start, "v", start)))
        v[joint.idx_v] = speeds[name][0] = random.uniform(-1, 1)
        picked.append((name, joint.idx_v))
    if lost or len(picked) != sum(kind != "fixed" for kind in kinds.values()):
        raise ValueError(f"joints {lost[:3]} are not in the text")
    q = pin.integrate(model, q, step)
    full = pin.crba(model, data, q)
    full = np.triu(full) + np.triu(full, 1).T
    bias = pin.nonLinearEffects(model, data, q, v)
    columns, _, mass, own, passive, _ = forces(text, angles, speeds, {})
    mine, theirs = [columns[name][0] for name, _ in picked], [k for _, k in picked]
    reference = -np.asarray(model.damping)[theirs] * v[theirs]
    return (
        differences(
            (mass[np.ix_(mine, mine)], own[mine], passive[mine]),
            (full[np.ix_(theirs, theirs)], bias[theirs], reference),
        ),
        model.nv,
    )


def without_small_masses(text, notes, compare, path):
    """The differences where links without mass have none: MuJoCo and Pinocchio take them as they are."""
    for name in re.findall(r"Link `([^`]*)` has no mass: here it has", "\n".join(notes)):
        body = next(
            (text.bodies[known] for known in (identifier(name), f"{identifier(name)}_body") if known in text.bodies),
            None,
        )
        if body:
            body["mass"], body["inertia"] = 0.0, np.zeros((3, 3))
    return compare(path, text, np.random.default_rng(1))[0]


def robots():
    for package, ending in (("example-robot-data", ".urdf"), ("gymnasium", ".xml"), ("dm_control", ".xml")):
        for file in sorted(files(package) or [], key=str):
            path = Path(os.path.realpath(file.locate()))
            if (
                str(file).endswith(ending)
                and path.exists()
                and (ending == ".urdf" or "<mujoco" in path.read_text(errors="replace"))
            ):
                yield package, path


def main():
    program, *rest = sys.argv[1:]
    is_told = "-v" in rest
    part = next((word for word in rest if word != "-v"), "")
    counts, largest, driven = {}, 0.0, 0
    program = os.path.abspath(program)
    with tempfile.TemporaryDirectory() as folder:
        # MuJoCo writes its log where it stands.
        os.chdir(folder)
        for package, path in robots():
            if part not in str(path):
                continue
            output = Path(folder) / "robot.rs"
            output.unlink(missing_ok=True)
            kind = "urdf" if path.suffix == ".urdf" else "mjcf"
            # In a URDF they limit efforts alone.
            options = ["--actuators"] if kind == "mjcf" else []
            done = subprocess.run(
                [program, kind, str(path), "-o", str(output), *options], capture_output=True, text=True, timeout=120
            )
            notes = [line for line in done.stderr.splitlines() if line.startswith("note: ")]
            counted = [note for note in notes if not any(words in note for words in ASIDE)]
            detail = ""
            if done.returncode:
                result = "refused"
                detail = done.stderr.strip()[-160:]
            else:
                try:
                    text = Text(output.read_text())
                    compare = with_pinocchio if kind == "urdf" else with_mujoco
                    off, freedoms = compare(path, text, np.random.default_rng(1))
                    agrees = max(off) < ALLOWED
                    if agrees and not counted:
                        largest = max(largest, max(off))
                    driven += len(off) > 3
                    if not agrees and counted and max(without_small_masses(text, notes, compare, path)) < ALLOWED:
                        counted = [note for note in counted if "has no mass: here it has" not in note]
                        result = "differs by the masses of links without mass alone"
                    else:
                        result = ("agrees" if agrees else "differs") + (", with notes" if counted else "")
                    detail = f"{freedoms} freedoms, off by " + ", ".join(f"{value:.1e}" for value in off)
                except Exception as fault:
                    result = "not compared" + (", with notes" if counted else "")
                    detail = f"{type(fault).__name__}: {fault}"[:160].replace("\n", " ")
            counts.setdefault((package, result), []).append(path)
            if is_told or result in ("differs", "not compared"):
                print(f"{result}: {path.name}: {detail}")
                for note in counted[:3] if is_told else []:
                    print(f"    {note[:150]}")
    for (package, result), paths in sorted(counts.items()):
        print(f"{package}: {len(paths)} {result}")
    print(f"largest deviation of files that agree without a note: {largest:.1e}; efforts of actuators in {driven} files")
    sys.exit(any(result == "differs" for _, result in counts))


if __name__ == "__main__":
    main()
