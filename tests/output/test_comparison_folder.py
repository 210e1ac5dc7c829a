"""The folder of a comparison is whole or not there."""

import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.output import comparison_folder
from cranio_nb.output.staging import staged


def test_all_or_nothing(found, tmp_path, monkeypatch):
    def full_disk(*_):
        raise OSError(28, "No space left on device")

    with staged(tmp_path / "good") as part:
        comparison_folder.write_comparison(found, part)
    assert {p.name for p in (tmp_path / "good").iterdir()} == set(comparison_folder.FILES)
    monkeypatch.setattr(comparison_folder, "comparison_page", full_disk)
    with pytest.raises(CannotWrite), staged(tmp_path / "new" / "out") as part:
        comparison_folder.write_comparison(found, part)
    assert [p.name for p in tmp_path.iterdir()] == ["good"]
