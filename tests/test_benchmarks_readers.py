"""The benchmark of the readers calls exact what is exact, and hears what a reader says."""

import os
import signal

import numpy as np
from benchmark_scripts import script

from data_synth.faults import fault_cases

readers = script("readers")


def test_the_truth_is_exact_in_any_order_of_its_axes(readers, tmp_path):
    case, _ = next(fault_cases(tmp_path))
    assert readers.is_exact(case.hu, case.affine, case)
    flipped = case.affine.copy()
    flipped[:3, 2] *= -1
    flipped[:3, 3] += case.affine[:3, 2] * (case.hu.shape[2] - 1)
    assert readers.is_exact(case.hu[..., ::-1], flipped, case)
    assert not readers.is_exact(case.hu[..., ::-1], case.affine, case)
    assert not readers.is_exact(case.hu + 1, case.affine, case)


def test_each_verdict_is_found(readers, tmp_path):
    case, path = next(fault_cases(tmp_path, valid=False))

    def fails(_):
        raise ValueError("no")

    def warns(_):
        os.write(2, b"a remark")
        return case.hu, case.affine

    verdicts = {
        "refused": fails,
        "warned": warns,
        "accepted, no message": lambda _: (case.hu, case.affine),
        "silently wrong": lambda _: (np.zeros((2, 2, 2)), case.affine),
        "crash": lambda _: signal.raise_signal(signal.SIGKILL),
    }
    for verdict, read in verdicts.items():
        assert readers.verdict(read, path, case, set()) == verdict
    assert readers.verdict(warns, path, case, {"a remark"}) == "accepted, no message"
