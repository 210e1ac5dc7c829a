"""The golden comparison notices one bit, and takes nothing identical for different."""

import os
import subprocess
import sys

import numpy as np
import pytest
from benchmark_scripts import FOLDER, script

from cranio_nb.errors import InputRefused

golden = script("golden")


def found(**changed):
    arrays = {"patch": np.zeros((2, 3, 4), bool), "vertices": np.ones((5, 3)), "faces": np.zeros((4, 3), np.int64)}
    return arrays | {"sides": np.zeros(4, np.uint8), "parameters": {"skip": 1.5}} | changed


class TestDifferences:
    def test_equal_bytes_are_identical(self, golden):
        assert golden.differences(found(), found(), {}) == []
        nan = np.full((5, 3), np.nan)
        assert golden.differences(found(vertices=nan), found(vertices=nan.copy()), {}) == []

    def test_the_last_bit_of_a_number_is_seen(self, golden):
        moved = np.ones((5, 3))
        moved[2, 1] = np.nextafter(1.0, 2.0)
        assert golden.differences(found(), found(vertices=moved), {}) == [
            "vertices: 1 of 15 differ, by at most 2.22e-16"
        ]

    def test_differing_voxels_are_counted(self, golden):
        patch = np.zeros((2, 3, 4), bool)
        patch[0, :2, 0] = True
        assert golden.differences(found(), found(patch=patch), {}) == ["patch: 2 of 24 differ, by at most 1"]

    def test_zero_with_another_sign_is_another_byte(self, golden):
        before, after = np.zeros((5, 3)), -np.zeros((5, 3))
        assert golden.differences(found(vertices=before), found(vertices=after), {})

    @pytest.mark.parametrize("faces", [np.zeros((4, 3), np.int32), np.zeros((5, 3), np.int64)], ids=["type", "shape"])
    def test_type_and_shape_are_part_of_it(self, faces, golden):
        (phrase,) = golden.differences(found(), found(faces=faces), {})
        assert phrase.startswith("faces: int64 (4, 3) became")

    def test_parameters_may_be_named_otherwise_but_not_changed(self, golden):
        renamed = {"skip": "skip_mm"}
        assert golden.differences(found(), found(parameters={"skip_mm": 1.5}), renamed) == []
        assert golden.differences(found(), found(parameters={"skip_mm": 3.0}), renamed)
        assert len(golden.differences(found(), found(parameters={"skip_mm": 1.5}), {})) == 2

    def test_refusals_are_compared_by_code(self, golden):
        a, b = {"refused": "TooSmall"}, {"refused": "NoVault"}
        assert golden.differences(a, dict(a), {}) == []
        assert golden.differences(a, b, {}) == ["TooSmall became NoVault"]
        assert golden.differences(a, found(), {}) == ["TooSmall became a design"]


class TestOutcome:
    def test_a_refusal_gives_its_code_and_a_fault_is_raised(self, golden):
        def refuse():
            raise InputRefused("TooSmall", "It is too small.")

        def break_down():
            raise ValueError("shapes do not match")

        assert golden.outcome(refuse) == {"refused": "TooSmall"}
        with pytest.raises(ValueError, match="shapes"):
            golden.outcome(break_down)

    def test_this_checkout_is_understood(self, golden, skull):
        bone = skull("burr_hole")
        openings = golden.named(golden.FIND, "find_openings")(bone)
        design = golden.designer()
        first, again = (
            golden.outcome(lambda: design(bone, openings, "slicewise", "default", {"directions": 1})) for _ in range(2)
        )
        assert first["patch"].any() and first["parameters"]["directions"] == 1
        assert golden.differences(first, again, {}) == []


def test_another_copy_than_the_one_asked_for_is_noticed(tmp_path):
    command = [sys.executable, FOLDER / "golden.py", tmp_path, "--run-to", tmp_path / "out.pickle"]
    place = os.environ | {"PYTHONPATH": str(FOLDER.parent)}
    ran = subprocess.run(command, capture_output=True, text=True, check=False, env=place)
    assert ran.returncode == 1 and "not from" in ran.stderr
