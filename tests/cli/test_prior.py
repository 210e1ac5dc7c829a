"""The command `prior learn` refuses what holds no skulls; what it learns is tested with the prior itself."""

from cli_runs import assert_refused, cranio


def test_a_folder_without_skulls_is_refused_and_nothing_is_written(tmp_path):
    (tmp_path / "notes.txt").write_text("about")
    assert_refused(cranio("prior", "learn", tmp_path, "--out", tmp_path / "prior.npz"), 3)
    assert [p.name for p in tmp_path.iterdir()] == ["notes.txt"]


def test_a_file_that_cannot_be_written_is_refused_before_any_work(tmp_path):
    (tmp_path / "prior.npz").mkdir()
    assert_refused(cranio("prior", "learn", tmp_path, "--out", tmp_path / "prior.npz"), 5)
