"""What a run says of its inputs, with a model that has some: ``examples/_driven.rs``."""

import zlib

import _driven
import pytest

SHORT = {"t_end": 1.0, "step": 0.5}


def test_inputs_are_named_with_value_or_file_and_hash(tmp_path):
    file = tmp_path / "push.csv"
    file.write_text("t,push\n0,4\n2,4\n")
    r = _driven.run(inputs={"push": str(file)}, **SHORT)
    assert r["speed"][-1] == pytest.approx(2.0, abs=1e-9)
    push, brake = r.info["inputs"]["push"], r.info["inputs"]["brake"]
    assert list(r.info["inputs"]) == ["push", "brake"]
    assert push["is_given"] and push["unit"] == "N" and "value" not in push
    table = push["table"]
    assert table["file"] == str(file) and table["crc32"] == f"{zlib.crc32(file.read_bytes()):08x}"
    assert table["rows"] == 2 and table["first"] == [0.0, 4.0] and table["last"] == [2.0, 4.0] and not table["cubic"]
    assert brake == {"unit": "N", "is_given": False, "value": 0.0}


def test_a_constant_is_named_with_its_value_in_sensitivities_too():
    one = {"unit": "N", "is_given": True, "value": 3.0}
    assert _driven.run(inputs={"brake": 3}, **SHORT).info["inputs"]["brake"] == one
    exact = _driven.sensitivity(inputs={"brake": 3}, by=["mass"], **SHORT)
    assert exact.info["inputs"]["brake"] == one
    assert exact["d(speed)/d(mass)"][-1] == pytest.approx(3 / 4, abs=1e-9)


def test_a_model_without_inputs_names_none():
    import hacksaw

    assert hacksaw.run("motion", t_end=0.05, step=0.01).info["inputs"] == {}
