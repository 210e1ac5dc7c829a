"""No text of a header leaves: each text element of every slice holds a text of its own, and no output holds one."""

import re
import shutil
import subprocess
import sys

import nibabel
import nrrd
import numpy as np
import pydicom
import pytest
from pydicom.datadict import DicomDictionary

from data_synth import phantom_case
from data_synth.files import write_case

RUN = "from cranio_nb.cli.main import main; main()"
MARK = "QJXZWVK"  # of every text that is planted
FIGURES = "40977"  # begins every number but a time
CLOCK = "114059"  # begins every time
NUMBER = {"IS": f"{FIGURES}%05d", "DS": f"{FIGURES}.%05d", "TM": f"{CLOCK}.%06d"}
NUMBER |= dict.fromkeys(("DA", "DT"), f"{FIGURES}%03d")
LONG = {"LT", "ST", "UT", "UC", "UR"}
TEXT = {"PN", "LO", "SH", "CS", "AE", "AS", *LONG}
KEPT = {"SOPClassUID", "SOPInstanceUID", "Modality", "ImageType", "PhotometricInterpretation", "RescaleType"}
KEPT |= {"ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "SliceThickness", "RescaleSlope"}
KEPT |= {"RescaleIntercept", "InstanceNumber", "NumberOfFrames", "SpecificCharacterSet", "LossyImageCompression"}
KEPT |= {"GantryDetectorTilt", "SpacingBetweenSlices", "TransferSyntaxUID", "LossyImageCompressionMethod"}
KEPT |= {"TimezoneOffsetFromUTC"}


def planted(vr, number):
    """A value of a kind that would be known again."""
    if vr in NUMBER:
        return NUMBER[vr] % (number % 1000 if vr in {"DA", "DT"} else number)
    if vr == "UI":
        return f"1.2.{FIGURES}.{number}"
    return f"{MARK} {number:05d} name" if vr in LONG | {"LO", "PN"} else f"{MARK} {number:05d}"


def canaries():
    """An element for each text that the dictionary knows, and how many there are."""
    extra = pydicom.Dataset()
    for number, (tag, (vr, *_, keyword)) in enumerate(sorted(DicomDictionary.items())):
        plain = tag >> 16 not in (0, 2, 4) and keyword not in KEPT and tag >> 16 < 0x7FE0
        if plain and vr in {*TEXT, *NUMBER, "UI"}:
            extra.add_new(tag, vr, planted(vr, number))
    private = extra.private_block(0x0009, f"{MARK} PRIVATE", create=True)
    private.add_new(1, "LO", f"{MARK} private")
    return extra


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """A case whose every slice holds them all."""
    folder = tmp_path_factory.mktemp("canaries")
    write_case(folder, phantom_case("tiny", "unilateral", 0))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pydicom.config.settings, "writing_validation_mode", pydicom.config.IGNORE)
        patch.setattr(pydicom.config.settings, "reading_validation_mode", pydicom.config.IGNORE)
        extra = canaries()
        for path in (folder / "ct").iterdir():
            slice_ = pydicom.dcmread(path)
            slice_.update(extra)
            slice_.save_as(path, enforce_file_format=True)
    assert len(extra) > 2000
    return folder


def all_of(folder, *arguments):
    """Run a command as a user does; all that it printed and wrote."""
    done = subprocess.run([sys.executable, "-c", RUN, *map(str, arguments)], capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr.decode()[-2000:]
    written = [path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()] if folder.exists() else []
    return b"\n".join([done.stdout, done.stderr, *written, *(str(p).encode() for p in folder.rglob("*"))])


def found(text):
    """What was planted and is there; digits in the middle of a number, as of a time measured, are none of it."""
    number = f"(?<![0-9.])(?:1\\.2\\.)?(?:{FIGURES}|{CLOCK})[0-9.]{{3,}}"
    return re.findall(f"(?i){MARK}.{{0,20}}|{number}".encode(), text)


NOTEBOOK = """
import nbformat, sys
from nbclient import NotebookClient
cells = ["import cranio_nb as cn; ct, report = cn.read_ct(%r)" % sys.argv[1], "report", "ct"]
cells += ["print(report, report.findings)", "vars(report)"]
notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
NotebookClient(notebook, kernel_name="python3", timeout=120).execute()
print(nbformat.writes(notebook))
"""


def in_a_notebook(scan):
    done = subprocess.run([sys.executable, "-c", NOTEBOOK, scan], capture_output=True, timeout=300)
    assert done.returncode == 0, done.stderr.decode()[-2000:]
    assert b"LoadReport(" in done.stdout
    return done.stdout + done.stderr


def test_the_search_finds_what_is_planted(series):
    text = next((series / "ct").iterdir()).read_bytes()
    assert len(found(text)) > 1500 and found(b'"series": 4097700012') and found(b"kernel qjxzwvk 00012")
    assert all(found(f'"{vr}": {planted(vr, 4321)}'.encode()) for vr in {*TEXT, *NUMBER, "UI"})
    assert not found(b'"design": 1.4097750450018793')  # seconds


@pytest.mark.parametrize(
    "command",
    [
        ("inspect",),
        ("inspect", "--json"),
        ("design", "--method", "hull", "--truth", "truth.nii.gz", "--out", "out"),
        ("compare", "--method", "hull", "--out", "out"),
    ],
    ids=" ".join,
)
def test_no_text_of_a_series_leaves(command, series, tmp_path):
    words = [series / word if word.endswith(".gz") else tmp_path / word if word == "out" else word for word in command]
    text = all_of(tmp_path / "out", words[0], series / "ct", *words[1:])
    assert not found(text)


def test_no_text_of_a_series_is_shown_in_a_notebook(series):
    pytest.importorskip("nbclient")
    assert not found(in_a_notebook(str(series / "ct")))


def test_no_text_of_a_series_is_in_a_refusal(series, tmp_path):
    """Two series of one folder are told apart by numbers and fixed words."""
    for name in ("a", "b"):
        shutil.copytree(series / "ct", tmp_path / "scan" / name)
    for path in (tmp_path / "scan" / "b").iterdir():
        slice_ = pydicom.dcmread(path)
        slice_.SeriesInstanceUID = f"1.2.{FIGURES}.2"
        slice_.PixelData = bytes(len(slice_.PixelData))
        slice_.save_as(path, enforce_file_format=True)
    done = subprocess.run([sys.executable, "-c", RUN, "inspect", tmp_path / "scan"], capture_output=True, timeout=300)
    assert done.returncode == 3 and b"several head CT series" in done.stderr
    assert not found(done.stdout + done.stderr)


def test_texts_where_numbers_are_wanted_do_not_leave(series, tmp_path):
    shutil.copytree(series / "ct", tmp_path / "scan")
    words = {
        keyword: f"{MARK}^Doe^John" for keyword in ("SeriesInstanceUID", "StudyInstanceUID", "FrameOfReferenceUID")
    }
    words |= {keyword: MARK for keyword in ("SeriesNumber", "AcquisitionNumber", "KVP", "ContentTime", "PatientAge")}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pydicom.config.settings, "writing_validation_mode", pydicom.config.IGNORE)
        patch.setattr(pydicom.config.settings, "reading_validation_mode", pydicom.config.IGNORE)
        for path in (tmp_path / "scan").iterdir():
            slice_ = pydicom.dcmread(path)
            for keyword, word in words.items():
                del slice_[keyword]
                slice_.add_new(keyword, "UI" if keyword.endswith("UID") else "LO", word)
            slice_.save_as(path)
    assert not found(all_of(tmp_path / "none", "inspect", tmp_path / "scan"))


def image_file(kind, folder):
    """A mask whose header holds texts wherever the format has room for them."""
    case = phantom_case("tiny", "unilateral", 0)
    voxels = case.bone.transpose(2, 1, 0).astype(np.uint8)
    if kind == "nifti":
        image = nibabel.Nifti1Image(voxels, np.diag([-1.0, -1.0, 1.0, 1.0]) @ case.affine[:, [2, 1, 0, 3]])
        header = image.header
        for name, size in (("descrip", 80), ("aux_file", 24), ("intent_name", 16), ("db_name", 18), ("data_type", 10)):
            header[name] = f"{MARK} {name}"[:size].encode()
        for code in (4, 6, 40):
            header.extensions.append(nibabel.nifti1.Nifti1Extension(code, f"{MARK} extension {code}".encode()))
        nibabel.save(image, folder / "scan.nii.gz")
        return folder / "scan.nii.gz"
    header = {"space": "left-posterior-superior", "space directions": case.affine[:3, [2, 1, 0]].T}
    header |= {"space origin": case.affine[:3, 3], "content": f"{MARK} content", f"{MARK} key": f"{MARK} value"}
    header |= {"labels": [f"{MARK} a", f"{MARK} b", f"{MARK} c"], "DICOM_0010_0010": f"{MARK}^NAME"}
    nrrd.write(str(folder / "scan.nrrd"), voxels, header)
    raw = (folder / "scan.nrrd").read_bytes()
    first, rest = raw.split(b"\n", 1)
    (folder / "scan.nrrd").write_bytes(first + f"\n# {MARK} comment\n".encode() + rest)
    return folder / "scan.nrrd"


@pytest.mark.parametrize("kind", ["nifti", "nrrd"])
def test_no_text_of_an_image_file_leaves(kind, tmp_path):
    scan = image_file(kind, tmp_path)
    raw = scan.read_bytes()
    assert kind == "nifti" or len(found(raw)) >= 5
    assert not found(all_of(tmp_path / "none", "inspect", scan))
    assert not found(all_of(tmp_path / "out", "design", scan, "--method", "hull", "--out", tmp_path / "out"))
    if kind == "nrrd":  # words of the format itself
        for field in (b"type: ", b"encoding: "):
            (tmp_path / "odd.nrrd").write_bytes(re.sub(field + rb"[^\n]*", field + MARK.encode(), raw, count=1))
            done = subprocess.run([sys.executable, "-c", RUN, "inspect", tmp_path / "odd.nrrd"], capture_output=True)
            assert done.returncode == 3 and not found(done.stderr), done.stderr
