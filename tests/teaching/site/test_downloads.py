"""What the site offers to download: the project without what lies beside it, and the students' copies."""

import zipfile

from cranio_nb.teaching.site.downloads import write_exercises, write_project


def _project(folder):
    for name in (
        "pyproject.toml",
        "constraints.txt",
        "cranio_nb/mesh.py",
        "cranio_nb/__pycache__/mesh.pyc",
        "notebooks/04_x.ipynb",
        "notebooks/.ipynb_checkpoints/04_x.ipynb",
        "notebooks/exercises/04_x.ipynb",
        ".venv/bin/python",
        ".git/config",
        "patients/scan.dcm",
        "cranio_nb_out/report.html",
    ):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(name)
    return folder


def test_the_project_without_what_lies_beside_it(tmp_path):
    project = _project(tmp_path / "project")
    write_project(project, tmp_path / "all.zip")
    with zipfile.ZipFile(tmp_path / "all.zip") as archive:
        wanted = {"cranio_nb/mesh.py", "notebooks/04_x.ipynb", "notebooks/exercises/04_x.ipynb"}
        assert set(archive.namelist()) == {
            f"cranio-nb/{name}" for name in wanted | {"pyproject.toml", "constraints.txt"}
        }
        assert archive.read("cranio-nb/cranio_nb/mesh.py") == b"cranio_nb/mesh.py"


def test_the_same_project_makes_the_same_archive(tmp_path):
    for name in ("one", "other"):
        write_project(_project(tmp_path / name), tmp_path / f"{name}.zip")
    assert (tmp_path / "one.zip").read_bytes() == (tmp_path / "other.zip").read_bytes()


def test_the_students_copies_alone(tmp_path):
    write_exercises(_project(tmp_path / "project"), tmp_path / "exercises.zip")
    with zipfile.ZipFile(tmp_path / "exercises.zip") as archive:
        assert archive.namelist() == ["exercises/04_x.ipynb", "exercises/constraints.txt"]
        assert archive.read("exercises/04_x.ipynb") == b"notebooks/exercises/04_x.ipynb"
