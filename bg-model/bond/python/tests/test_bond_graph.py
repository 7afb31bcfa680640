"""What Python sees of models that are loaded."""

import json
import math
import pathlib
import pickle

import numpy as np
import pytest

import bond_graph as bg
from mechanisms import SWING


def test_a_run_is_what_theory_says():
    run = bg.compile(SWING).run(t_end=1, step=0.25, rtol=1e-10)
    assert np.allclose(run["x"], 0.1 * np.cos(5 * run["t"]), atol=1e-9)
    assert run.units["v"] == "m/s"


def test_parameters_are_keyword_arguments():
    swing = bg.compile(SWING)
    assert swing.parameters()["mass"]["default"] == 2
    run = swing.run(t_end=0.5, step=0.5, mass=0.5, rtol=1e-10)
    assert math.isclose(run["x"][-1], 0.1 * math.cos(5), abs_tol=1e-9)
    with pytest.raises(ValueError, match="`mass` = -1 kg is out of range"):
        swing.run(mass=-1)


def test_a_run_begins_with_what_made_another_one(tmp_path: pathlib.Path):
    swing = bg.compile(SWING)
    assert swing.run(t_end=1).info["hint"] == "dop853"
    run = swing.run(t_end=1, hint="radau9")
    assert run.info["methods"][0][1] == "Radau IIA 9" and run.info["hint"] == "radau9"
    (tmp_path / "summary.json").write_text('{"hint": "radau9"}')
    for hint in (run.info["hint"], tmp_path / "summary.json"):
        again = swing.run(t_end=1, hint=hint)
        assert np.array_equal(again["x"], run["x"]) and not np.array_equal(again["x"], swing.run(t_end=1)["x"])
    # After a method by name there is none, and none is what `hint` is without one.
    assert swing.run(t_end=1, method="bs5").info["hint"] is None
    assert np.array_equal(swing.run(t_end=1, hint=None)["x"], swing.run(t_end=1)["x"])
    with pytest.raises(ValueError, match='hint "bs5": auto does not choose it; give one of dop853, '):
        swing.run(hint="bs5")


def test_a_linear_model_has_its_mode():
    modes = bg.compile(SWING).linearize()["modes"]
    assert math.isclose(modes[0]["imaginary"], 5, rel_tol=1e-9)


def test_pictures_are_svg(tmp_path: pathlib.Path):
    swing = bg.compile(SWING)
    (tmp_path / "measured.csv").write_text("t,x,v\n0,0.1,0\n1,0.05,0.1\n")
    picture = swing.plot("v over x", t_end=2, others=[tmp_path / "measured.csv"])
    assert picture.svg.startswith("<svg") and "x in m" in picture.svg and "measured" in picture._repr_svg_()
    picture.save(tmp_path / "phase.svg")
    assert (tmp_path / "phase.svg").read_text() == picture.svg
    assert "frequency in Hz" in swing.plot("spectrum of x", t_end=2).svg
    with pytest.raises(ValueError, match="there is no output, parameter or measure `y`"):
        swing.plot("y over x")


ROTOR = """
graph Rotor {
    param speed: rpm = 3000; ground { point bearing = [0, 0, 0]; }
    body disc { mass 5; inertia [0.02, 0.02, 0.04]; start spin [0, 0, speed]; }
    joint bearing: revolute z (ground.bearing -> disc) { stiffness 1e6; tilt stiffness 2000; }
    observe { x: rad = disc.z_axis.x }
}
"""


def test_critical_speeds_are_those_of_the_closed_form():
    found = bg.compile(ROTOR).campbell("speed=0..12000", points=25, orders=[1])
    speeds = found["critical_speeds"]
    # Against the rotation 0.02 w^2 + 0.04 w^2 = 2000; the three places of the bearing swing at the root of 1e6 / 5.
    expected = [math.sqrt(2000 / 0.06) * 30 / math.pi] + 3 * [math.sqrt(2e5) * 30 / math.pi]
    assert np.allclose(speeds["speed"], expected, rtol=1e-9) and speeds.units["speed"] == "rpm"
    assert set(found["modes"]["mode"]) == {1, 2, 3, 4, 5} and "order 1" in found["picture"].svg
    with pytest.raises(ValueError, match="has no parameter `sped`"):
        bg.compile(ROTOR).campbell("sped=0..1")


def test_faults_are_shown_at_their_places():
    with pytest.raises(bg.FaultError) as raised:
        bg.compile(SWING.replace("slide -> spring", "slide -> sprin"))
    fault = raised.value.faults[0]
    assert (fault["line"], fault["code"]) == (8, "BG0303")
    assert "did you mean `spring`?" in str(raised.value) and "^^^^^" in str(raised.value)


def test_files(tmp_path: pathlib.Path):
    file = tmp_path / "swing.bond"
    file.write_text(SWING + SWING.replace("Swing", "Other"))
    with pytest.raises(ValueError, match='Say graph="NAME"'):
        bg.load(file)
    assert len(bg.load(file, graph="Other").run(t_end=0.1, step=0.1)["t"]) == 2
    with pytest.raises(FileNotFoundError):
        bg.load(tmp_path / "missing.bond")


SHAFT = """
part Shaft { param inertia: kg*m^2 = 2; port end: rotation; I wheel = inertia; end -> wheel; observe { speed: rad/s = wheel.flow } }
"""
DRIVEN = """
use "parts/shaft.bond";
graph Driven { part shaft: Shaft; Se drive = 3; 1 axle: rotation; drive -> axle -> shaft.end; observe { shaft.speed } }
"""


def test_files_use_parts_of_files(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "parts").mkdir()
    shaft = tmp_path / "parts" / "shaft.bond"
    shaft.write_text(SHAFT)
    (tmp_path / "driven.bond").write_text(DRIVEN)
    for model in (bg.load(tmp_path / "driven.bond"), bg.compile(DRIVEN, folder=tmp_path)):
        # J dw/dt = 3 N*m.
        assert math.isclose(model.run(t_end=1, step=1)["shaft.speed"][-1], 1.5, rel_tol=1e-9)
    with pytest.raises(bg.FaultError, match="cannot read parts/shaft.bond"):
        bg.compile(DRIVEN)
    monkeypatch.chdir(tmp_path)
    bg.compile(DRIVEN)
    shaft.write_text(SHAFT.replace("-> wheel", "-> weel"))
    with pytest.raises(bg.FaultError) as raised:
        bg.load("driven.bond")
    fault = raised.value.faults[0]
    assert (fault["file"], fault["line"], fault["code"]) == ("parts/shaft.bond", 2, "BG0303")


def test_an_optimum_is_where_theory_has_it():
    found = bg.compile(SWING).optimize(minimize="(max v - 0.3 m/s)^2", by="stiffness=10..100", t_end=2)
    best = found["best"]
    assert best["feasible"] and math.isclose(best["parameters"]["stiffness"], 18, rel_tol=1e-3)
    assert math.isclose(found["trials"]["stiffness"][0], 50) and found["trials"].units["stiffness"] == "N/m"
    with pytest.raises(ValueError, match="there is no output, parameter or measure `w`"):
        bg.compile(SWING).optimize(minimize="max w", by=["stiffness"])


FAN = """
graph Fan {
    table curve: rpm -> N*m = [[0, 2], [1000, 2]], held;
    1 shaft: rotation; I wheel = 0.1; MSe motor = curve(shaft.flow); motor -> shaft -> wheel;
    observe { speed: rad/s = shaft.flow }
}
"""


def test_tables_get_other_points(tmp_path: pathlib.Path):
    speed = lambda **given: bg.compile(FAN, **given).run(t_end=1, step=1, rtol=1e-10)["speed"][-1]
    assert math.isclose(speed(), 20, rel_tol=1e-9)
    assert math.isclose(speed(tables={"curve": np.array([[0, 3], [500, 3], [1000, 3]])}), 30, rel_tol=1e-9)
    file = tmp_path / "new.csv"
    file.write_text("speed [rad/s],torque [kN*m]\n0,0.004\n100,0.004\n")
    assert math.isclose(speed(tables={"curve": file}), 40, rel_tol=1e-9)
    with pytest.raises(ValueError, match="there is no table `curv`; there are `curve`"):
        speed(tables={"curv": [[0, 1], [1, 1]]})
    with pytest.raises(ValueError, match="give the path of a CSV file, or rows"):
        speed(tables={"curve": 3})


def test_steps_one_after_the_other_are_a_run():
    swing = bg.compile(SWING)
    state, steps = None, []
    for _ in range(4):
        state, outputs = swing.step(state, 0.25, rtol=1e-11)
        steps.append(outputs["x"])
    assert np.allclose(steps, 0.1 * np.cos(5 * np.arange(1, 5) * 0.25), atol=1e-9)
    # A state of a run is one, too, and a run begins in one.
    run = swing.run(t_end=1, rtol=1e-11)
    assert json.loads(state)["t"] == json.loads(run.info["state"])["t"] == 1
    later = swing.run(t_end=1.5, step=0.5, start=state, rtol=1e-11)
    assert later["t"][0] == 1 and math.isclose(later["x"][-1], 0.1 * math.cos(7.5), abs_tol=1e-9)
    with pytest.raises(ValueError, match="dt -1: must be a finite number above 0"):
        swing.step(state, -1)
    with pytest.raises(ValueError, match='give "model", "equilibrium" or a state'):
        swing.run(start="rest")
    with pytest.raises(ValueError, match="start: "):
        swing.step('{"t": 1}')


PUSHED = """
graph Pushed {
    param mass: kg = 2, above 0;
    input push: N;
    1 slide: translation; Se drive = push; I body = mass;
    drive -> slide; slide -> body;
    observe { v: m/s = slide.flow }
}
"""


def test_inputs_hold_for_one_step():
    pushed, state = bg.compile(PUSHED), None
    for push, speed in ((2, 0.5), (0, 0.5), (-4, -0.5)):
        state, outputs = pushed.step(state, 0.5, inputs={"push": push})
        assert math.isclose(outputs["v"], speed, abs_tol=1e-9)


def test_inputs_are_arrays_and_functions():
    pushed = bg.compile(PUSHED)
    last = lambda push: pushed.run(t_end=1, step=1, rtol=1e-10, inputs={"push": push})["v"][-1]
    assert math.isclose(last(math.cos), math.sin(1) / 2, abs_tol=1e-9)
    t = np.array([0.0, 0.5, 1.0])
    for ramp in ((t, 2 * t), np.column_stack((t, 2 * t)), [[0, 0], [1, 2]], ([0, 1], [0, 2])):
        assert math.isclose(last(ramp), 0.5, abs_tol=1e-9)
    assert math.isclose(last("4 N"), 2, abs_tol=1e-9) and math.isclose(last(np.float64(4)), 2, abs_tol=1e-9)
    told = pushed.run(t_end=1, inputs={"push": (t, t)}).info["inputs"]["push"]["table"]
    assert (told["rows"], told["last"]) == (3, [1.0, 1.0])
    # Everything else takes them, too: x' = cos(t) / mass.
    value, slopes = pushed.gradient("v", by=["mass"], inputs={"push": math.cos}, t_end=1, rtol=1e-10)
    assert math.isclose(slopes["mass"], -math.sin(1) / 4, abs_tol=1e-8)
    assert "push" in pushed.report(t_end=1, inputs={"push": math.cos}).html


def test_what_is_wrong_with_an_input_is_said():
    pushed = bg.compile(PUSHED)
    run = lambda push: pushed.run(t_end=1, inputs={"push": push})
    for wrong in (None, [1, 2], ([0, 1], [1, 2, 3]), {"a": 1}):
        with pytest.raises(ValueError, match="inputs: `push`: give a number, a text such as"):
            run(wrong)
    with pytest.raises(ValueError, match=r'inputs=\{"push": \[..\]\}: .*do not ascend'):
        run([[1, 1], [0, 1]])
    with pytest.raises(ValueError, match='inputs={"pull": 3.0}: there is no input `pull`; there are push'):
        pushed.run(inputs={"pull": 3})
    # What a function raises is raised; one that gives no number is one that raises.
    with pytest.raises(ZeroDivisionError):
        run(lambda t: 1 / (t - t))
    with pytest.raises(TypeError):
        run(lambda t: "much")


def test_sentences_name_arguments():
    swing = bg.compile(SWING)
    measured = {"t": [0, 1, 2], "x": [1, 2, 3]}
    for call, sentence in (
        (lambda: swing.gradient("y"), 'of: scene `literal` has no output `y` to be asked for; `outputs("literal")` lists the outputs'),
        (lambda: swing.identify(measured, "stiffness", bounds="k=1..2"), "bounds: scene `literal` has no parameter `k`"),
        (lambda: swing.identify(measured, "stiffness", bounds="stiffness=1..2"), "start inside with set="),
        (lambda: swing.identify(measured, "stiffness", columns="q=x"), "data: it has no column `q`"),
        (lambda: swing.optimize(by="mass"), "0 goals: give one with minimize= or maximize="),
        (lambda: swing.optimize(minimize="max y", by="mass"), 'minimize="max y": there is no output'),
        (lambda: swing.run(masss=1), "masss=1: there is no parameter `masss`; did you mean `mass`?"),
        (lambda: swing.campbell("mass=1..2", orders=[1]), "leave orders= out"),
        (lambda: swing.campbell("mass=1..2", at=-1), "at -1: must be a finite number, at least 0"),
    ):
        with pytest.raises(ValueError) as raised:
            call()
        assert sentence in str(raised.value) and "--" not in str(raised.value)
    with pytest.raises(TypeError, match="mass='2 kg': give a number, in the parameter's unit"):
        swing.run(mass="2 kg")
    with pytest.raises(bg.FaultError, match="a larger `limit_statements=` allows it"):
        bg.compile(SWING, limit_statements=2)


def test_a_gradient_is_that_of_the_closed_form():
    swing = bg.compile(SWING)
    value, slopes = swing.gradient("x", t_end=1, rtol=1e-11)
    assert math.isclose(value, 0.1 * math.cos(5), abs_tol=1e-9)
    by_rate = -0.1 * math.sin(5)
    assert math.isclose(slopes["stiffness"], by_rate * 5 / (2 * 50), abs_tol=1e-9)
    assert math.isclose(slopes["mass"], -by_rate * 5 / (2 * 2), abs_tol=1e-9)
    integral, slopes = swing.gradient("x", integral=True, by=["mass"], t_end=1, rtol=1e-11)
    assert math.isclose(integral, 0.02 * math.sin(5), abs_tol=1e-9) and list(slopes) == ["mass"]
    with pytest.raises(ValueError, match="at and integral"):
        swing.gradient("x", at=0.5, integral=True)


def test_parameters_are_identified(tmp_path: pathlib.Path):
    swing = bg.compile(SWING)
    measured = swing.run(t_end=2, step=0.05, stiffness=60, rtol=1e-10)
    columns = {name: measured[name] for name in ("t", "x")}
    (tmp_path / "measured.csv").write_text("\n".join(["t,x", *(f"{t},{x}" for t, x in zip(*columns.values()))]))
    for data in (measured, columns, tmp_path / "measured.csv"):
        found = swing.identify(data, "stiffness", bounds="stiffness=20..200")
        assert math.isclose(found["parameters"][0]["value"], 60, rel_tol=1e-6)
    with pytest.raises(ValueError, match="has no parameter `k`"):
        swing.identify(columns, "k")
    with pytest.raises(ValueError, match="data: the column `x` has 1 values, and `t` has 2"):
        swing.identify({"t": [0, 1], "x": [1]}, "stiffness")


def test_graph_and_report_are_shown(tmp_path: pathlib.Path):
    swing = bg.compile(SWING)
    assert swing.graph().svg.startswith("<svg") and "spring" in swing.graph().svg
    page = swing.report(t_end=1)
    assert page.html.startswith("<!DOCTYPE html>") and page._repr_html_().startswith('<iframe srcdoc="')
    page.save(tmp_path / "swing.html")
    assert (tmp_path / "swing.html").read_text() == page.html


def test_a_table_goes_where_others_want_it():
    run = bg.compile(SWING).run(t_end=1, step=0.05)
    assert [name for name, _ in run.items()] == run.keys() == ["t", "x", "v"]
    assert all(np.array_equal(values, run[name]) for name, values in run.items())
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again["x"], run["x"]) and again.units == run.units and again.info["state"] == run.info["state"]
    with pytest.raises(bg.RunFailed) as raised:
        bg.compile(PUSHED).run(t_end=1, inputs={"push": lambda t: 1 / (0.5 - t) if t < 0.5 else math.nan})
    failed = pickle.loads(pickle.dumps(raised.value))
    assert str(failed) == str(raised.value) and failed.run["t"][-1] == raised.value.run["t"][-1]
    html = run._repr_html_()
    assert "<th>x<br><small>m</small></th>" in html and "3 columns, 21 rows" in html and html.count("<tr>") == 1 + 10 + 1


def test_a_table_is_a_stream_of_arrow():
    pyarrow = pytest.importorskip("pyarrow")
    run = bg.compile(SWING).run(t_end=1, step=0.05)
    assert np.array_equal(pyarrow.table(run)["x"].to_numpy(), run["x"])


def test_classes_are_those_of_the_package():
    assert {getattr(bg, name).__module__ for name in bg.__all__ if name[0].isupper()} == {"bond_graph"}


def test_the_stubs_have_what_the_module_has():
    stubs = pathlib.Path(bg.__file__).with_suffix(".pyi").read_text()
    for name in bg.__all__:
        assert f"def {name}(" in stubs or f"class {name}" in stubs or f"{name}:" in stubs, name
    for of in (bg.Model, bg.Table, bg.Picture, bg.Page):
        described = stubs.split(f"class {of.__name__}:")[1].split("\nclass ")[0]
        for name in (name for name in vars(of) if not name.startswith("__")):
            assert f"def {name}(" in described or f"{name}:" in described, f"{of.__name__}.{name}"
            assert name.startswith("_repr_") or getattr(of, name).__doc__, f"{of.__name__}.{name}"


def test_the_notebook_runs():
    """Its cells without a notebook; what they gave is saved in it."""
    notebook = json.loads((pathlib.Path(__file__).parents[1] / "examples/press.ipynb").read_text())
    names = {}
    for cell in (cell for cell in notebook["cells"] if cell["cell_type"] == "code"):
        assert cell["outputs"], cell["source"]
        exec("".join(cell["source"]), names)
    saved = next(cell["outputs"][0] for cell in notebook["cells"] if "angles.append" in "".join(cell["source"]))
    assert np.allclose(eval("".join(saved["data"]["text/plain"])), names["angles"], atol=1e-6)
