"""The comparison that stand-ins have made, and a run with its truth."""

import dataclasses

import pytest
from stand_ins import blind, compared_case, compared_home, found  # noqa: F401  (fixtures)

from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import RunResult, run_design
from data_synth import phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="session")
def result(tmp_path_factory) -> RunResult:
    """A hole on the left of a known head, closed as the paper does."""
    folder = tmp_path_factory.mktemp("case")
    write_case(folder, phantom_case("tiny", "unilateral", 0))
    return run_design(prepare(folder / "ct", truth=folder / "truth.nii.gz"), preset="paper")


@pytest.fixture(scope="session")
def crossed(result) -> RunResult:
    """The same run, as if in two slices the curves had crossed: from half-way on, inner is outer."""
    made = result.prosthesis
    (sliced,) = made.working
    own = [i for i, s in enumerate(sliced.slices) if s.status == "balloon"][1:3]
    slices = list(sliced.slices)
    for i in own:
        curves = slices[i].curves.copy()
        half = curves.shape[1] // 2
        curves[:, half:] = curves[::-1, half:]
        slices[i] = dataclasses.replace(slices[i], curves=curves)
    record = made.record | {"slices": [a | b.record() for a, b in zip(made.record["slices"], slices, strict=True)]}
    sliced = dataclasses.replace(sliced, slices=tuple(slices))
    return dataclasses.replace(result, prosthesis=dataclasses.replace(made, record=record, working=(sliced,)))
