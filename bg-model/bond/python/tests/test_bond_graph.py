"""What Python sees of models that are loaded."""

import math
import pathlib

import numpy as np
import pytest

import bond_graph as bg

SWING = """
/// A mass on a spring.
graph Swing {
    param mass: kg = 2, above 0;
    param stiffness: N/m = 50;
    1 slide: translation;
    I body = mass; C spring = stiffness start 0.1;
    slide -> body; slide -> spring;
    observe { x: m = spring.q; v: m/s = slide.flow }
}
"""


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


def test_a_linear_model_has_its_mode():
    modes = bg.compile(SWING).linearize()["modes"]
    assert math.isclose(modes[0]["imaginary"], 5, rel_tol=1e-9)


def test_faults_are_shown_at_their_places():
    with pytest.raises(bg.FaultError) as raised:
        bg.compile(SWING.replace("slide -> spring", "slide -> sprin"))
    fault = raised.value.faults[0]
    assert (fault["line"], fault["code"]) == (8, "BG0303")
    assert "did you mean `spring`?" in str(raised.value) and "^^^^^" in str(raised.value)


def test_files(tmp_path: pathlib.Path):
    file = tmp_path / "swing.bond"
    file.write_text(SWING + SWING.replace("Swing", "Other"))
    with pytest.raises(ValueError, match="Say --graph NAME|which graph"):
        bg.load(file)
    assert len(bg.load(file, graph="Other").run(t_end=0.1, step=0.1)["t"]) == 2
    with pytest.raises(OSError):
        bg.load(tmp_path / "missing.bond")
