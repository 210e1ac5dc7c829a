"""Inputs bred by the branches they reach, through the reader: what raises something foreign, and on what.

python benchmarks/fuzz.py dicom|nifti|nrrd [--seconds 180] [--corpus FOLDER]

Needs Atheris: pip install atheris. An input is one file of the kind; a DICOM folder holds nothing else, so that
what is read is refused for its few slices at the latest. `InputRefused` is the answer that is wanted; any other
exception, a death or 30 s for one file stop the run, and the file is left as `crash-...` in the working folder.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import atheris
import numpy as np

with atheris.instrument_imports(include=["cranio_nb", "nibabel", "nrrd", "pydicom"]):
    # the readers load these only when they meet such a file: too late to be watched
    import nibabel  # noqa: F401
    import nrrd  # noqa: F401

    import cranio_nb.readers.dicom.read
    import cranio_nb.readers.image_file
    import cranio_nb.readers.nifti
    import cranio_nb.readers.nrrd  # noqa: F401
    from cranio_nb.errors import InputRefused
    from cranio_nb.output.nifti_files import write_nifti
    from cranio_nb.readers import read_ct

from cranio_nb.volume import Volume
from data_synth import write_dicom

NAMES = {"dicom": "slice/a.dcm", "nifti": "a.nii", "nrrd": "a.nrrd"}
LARGEST = 1 << 16  # bytes of an input


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=NAMES)
    parser.add_argument("--seconds", type=int, default=180, help="length of the run")
    parser.add_argument("--corpus", type=Path, help="keeps the inputs that reach new branches for the next run")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as home:
        corpus = asked.corpus or Path(home) / "corpus"
        corpus.mkdir(exist_ok=True, parents=True)
        (corpus / "seed").write_bytes(seed(asked.kind, Path(home) / "seed"))
        path = Path(home) / NAMES[asked.kind]
        path.parent.mkdir(exist_ok=True)
        limits = [f"-max_total_time={asked.seconds}", f"-max_len={LARGEST}", "-timeout=30", "-rss_limit_mb=2048"]
        atheris.Setup([sys.argv[0], *limits, str(corpus)], lambda data: read(path, data))
        atheris.Fuzz()


def seed(kind: str, folder: Path) -> bytes:
    """A small valid file of a kind."""
    folder.mkdir()
    hu, affine = np.full((8, 12, 10), -1000, np.int16), np.eye(4)[[2, 1, 0, 3]] * [2, 1, 1, 1]
    hu[2:6, 3:9, 3:7] = 900
    if kind == "dicom":
        return write_dicom(folder, hu, affine)[0].read_bytes()
    if kind == "nifti":
        write_nifti(Volume(hu, affine), folder / "a.nii")
        return (folder / "a.nii").read_bytes()
    directions = " ".join(f"({','.join(map(str, row))})" for row in affine[:3, :3].T)
    header = f"NRRD0004\ntype: int16\ndimension: 3\nspace: LPS\nsizes: 8 12 10\nspace directions: {directions}\n"
    ending = "kinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n\n"
    return (header + ending).encode() + hu.tobytes(order="F")


def read(path: Path, data: bytes) -> None:
    path.write_bytes(data)
    try:
        read_ct(path.parent if path.suffix == ".dcm" else path)
    except InputRefused:
        pass


if __name__ == "__main__":
    main()
