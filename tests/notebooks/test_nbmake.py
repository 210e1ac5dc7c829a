"""The students' copies run from the first cell to the last before anything is filled in, on the smallest head too."""

from notebook_runs import EXERCISES, LESSONS, run


def test_every_copy_runs_with_its_stubs(tmp_path):
    said, code = run(["--nbmake"], EXERCISES, tmp_path, CRANIO_NB_SIZE="tiny")
    assert code == 0, said[-4000:]
    assert len(EXERCISES) == len(LESSONS) >= 9
