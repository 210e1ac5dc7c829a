"""The command `demo`: a whole run on a synthetic head."""

from cli_runs import OUTPUTS, assert_refused, cranio, digest, run_is


def test_demo_can_be_run_twice_but_never_replaces_a_strangers_series(paper, tmp_path, monkeypatch):
    out = tmp_path / "demo"
    for _ in range(2):
        result = cranio("demo", "--size", "tiny", "--out", out)
        assert result.exit_code == 0, result.output
        run_is(paper, monkeypatch)
    assert {p.name for p in out.iterdir()} == OUTPUTS | {"ct", "truth.nii.gz", "truth.json"}
    assert len(list((out / "ct").iterdir())) == 54
    (out / "ct" / "mine.dcm").write_text("one more slice")
    before = digest(out)
    assert_refused(cranio("demo", "--size", "tiny", "--out", out), 5)
    assert digest(out) == before
