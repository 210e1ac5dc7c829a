"""Puts the lessons, which lie beside the package, into what is built of it; all else is in pyproject.toml."""

from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

LESSONS = Path("notebooks")
HOME = Path("cranio_nb", "teaching", "notebooks")


class WithLessons(build_py):
    """Builds the package with its lessons; a checkout that is installed as it lies has them already."""

    def run(self) -> None:
        """Copy the modules, then the notebooks."""
        super().run()
        for path in () if self.editable_mode else (*LESSONS.glob("*.ipynb"), *LESSONS.glob("exercises/*.ipynb")):
            goal = Path(self.build_lib) / HOME / path.relative_to(LESSONS)
            self.mkpath(str(goal.parent))
            self.copy_file(str(path), str(goal))


setup(cmdclass={"build_py": WithLessons})
