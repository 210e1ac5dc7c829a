"""Several methods on one case: a row for each whatever it does, one scale, a page complete by itself, whole or not."""

import base64
import csv
import io
import json
import re
import types
from contextlib import contextmanager
from html.parser import HTMLParser

import numpy as np
import pytest
from click.testing import CliRunner

from cranio_nb.cli.main import main
from cranio_nb.drawing import figures
from cranio_nb.errors import CannotWrite, InputRefused, NoOpening
from cranio_nb.geometry.face_sides import label_faces
from cranio_nb.methods import catalogue
from cranio_nb.output import comparison_page
from cranio_nb.output.files import write_nifti
from cranio_nb.output.staging import staged
from cranio_nb.pipeline import compare, trial
from cranio_nb.pipeline.run import prepare
from cranio_nb.pipeline.trial import Contender, attempt, attempt_apart, contenders
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.volume import Volume
from data_synth import phantom_case


def from_truth(grow):
    """A method that knows the answer, and moves it `grow` planes up the head."""

    def design(bone, openings=None, *, progress=None):
        case = phantom_case("tiny", "round", 0)
        patch = np.roll(case.implant, grow, axis=0) & ~bone.voxels
        mesh = extract_surface(bone.with_voxels(patch))
        sides = label_faces(mesh, bone, openings[0].head_centre)
        return Prosthesis(mesh, sides, bone.with_voxels(patch), "stand-in", {}, {"version": "0", "seconds": 1.0})

    return design


def refusing(bone, openings=None, *, progress=None):
    raise InputRefused("CrossesMiddle", "The other side <is> open, too.", "Try another.")


def finding_nothing(bone, openings=None, *, progress=None):
    raise NoOpening("NothingBridged", "Nothing was bridged.")


def faulty(bone, openings=None, *, progress=None):
    raise IndexError("a secret")


STAND_INS = {
    "perfect": from_truth(0),
    "moved": from_truth(1),
    "refusing": refusing,
    "finding_nothing": finding_nothing,
    "faulty": faulty,
}


@contextmanager
def only_stand_ins():
    """Stand-ins in the catalogue, as if they were all the methods there are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(catalogue, "import_module", lambda name: types.SimpleNamespace(design=STAND_INS[name]))
        patch.setattr(catalogue, "METHODS", names := {name: name for name in STAND_INS})
        patch.setattr(trial, "METHODS", names)
        yield


@pytest.fixture
def stand_ins():
    with only_stand_ins():
        yield


@pytest.fixture(scope="module")
def home(tmp_path_factory):
    folder = tmp_path_factory.mktemp("case")
    case = phantom_case("tiny", "round", 0)
    write_nifti(Volume(case.bone, case.affine), folder / "skull.nii.gz")
    write_nifti(Volume(case.implant, case.affine), folder / "truth.nii.gz")
    return folder


@pytest.fixture(scope="module")
def case(home):
    return prepare(home / "skull.nii.gz", truth=home / "truth.nii.gz")


@pytest.fixture(scope="module")
def found(case):
    with only_stand_ins():
        return compare.compare(case, contenders(), attempt=attempt)


@pytest.fixture(scope="module")
def blind(home):
    """Without a truth."""
    with only_stand_ins():
        asked = contenders(["moved", "refusing", "perfect"])
        return compare.compare(prepare(home / "skull.nii.gz"), asked, attempt=attempt)


@pytest.fixture(scope="module")
def html(found):
    return comparison_page.comparison_page(found)


class Page(HTMLParser):
    """Tags with their attributes, and the text."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.words = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.words.append(data)

    def all(self, tag):
        return [attrs for name, attrs in self.tags if name == tag]


def cranio(*arguments):
    return CliRunner().invoke(main, [str(a) for a in arguments])


class TestComparison:
    def test_every_contender_is_a_row_whatever_it_does(self, found):
        assert {t.contender.name: t.status for t in found.trials} == {
            "perfect": "done",
            "moved": "done",
            "refusing": "refused",
            "finding_nothing": "no patch",
            "faulty": "broken",
        }
        assert [t.message for t in found.trials[2:]] == [
            "The other side <is> open, too. Try another.",
            "Nothing was bridged.",
            "Something unforeseen went wrong in the method (IndexError).",
        ]
        assert len(found.rows) == len(found.trials)
        assert all(set(row) == set(compare.MEASURES) for row in found.rows)
        assert all(np.isnan(list(row.values())).all() for row in found.rows[2:])

    def test_the_truth_scores_as_the_truth(self, found):
        row = found.rows[0]
        assert row["dice"] == row["border_dice"] == row["volume_ratio"] == 1
        assert row["hd95"] == row["assd"] == row["overlap"] == 0
        assert [row[k] for k in ("thickness_rmse", "top_mean", "inner_mean")] == pytest.approx([0, 0, 0], abs=1e-6)
        moved = found.rows[1]
        assert moved["dice"] < 1 and moved["top_mean"] > 0.1 and np.isfinite(list(moved.values())).all()

    def test_distances_are_to_the_truth_and_share_one_scale(self, found):
        assert found.reference == "truth" and set(found.distances) == {"perfect", "moved"}
        every = np.concatenate([d for sides in found.distances.values() for d in sides.values()])
        assert np.percentile(every, 99) <= found.top and found.top % 0.5 == 0
        assert np.percentile(every, 99) > found.top - 0.5 or found.top == 0.5

    def test_without_a_truth_the_first_that_made_something_is_the_reference(self, blind):
        assert blind.reference == "moved" and set(blind.distances) == {"perfect"}
        assert all(np.isnan(row["dice"]) for row in blind.rows) and blind.rows[0]["volume"] > 0

    def test_agreement_of_each_two(self, found):
        assert set(found.pairs) == {("perfect", "moved")}
        assert found.pairs["perfect", "moved"] == pytest.approx((found.rows[1]["dice"], found.rows[1]["assd"]))

    def test_progress_names_each(self, case, stand_ins):
        told = []
        compare.compare(
            case, contenders(["refusing", "faulty"]), attempt=attempt, progress=lambda *told_now: told.append(told_now)
        )
        assert told == [("refusing", 0.0), ("faulty", 0.5)]


class TestContenders:
    def test_by_name_once_each(self):
        assert contenders(["slicewise:paper", "slicewise", "slicewise"]) == (
            Contender("slicewise", "paper"),
            Contender("slicewise"),
        )
        assert [c.name for c in contenders(["slicewise:paper"])] == ["slicewise:paper"]

    def test_all_by_default_with_the_papers_preset_where_there_is_one(self):
        names = [c.name for c in contenders()]
        assert set(catalogue.METHODS) <= set(names) and "slicewise:paper" in names

    @pytest.mark.parametrize("name", ["magic", "slicewise:best", ":paper"])
    def test_unknown_names_are_refused(self, name):
        with pytest.raises(InputRefused, match="There is no"):
            contenders([name])


def test_a_patch_that_runs_out_of_the_image_is_a_failure_and_no_refusal(case, monkeypatch):
    def leaking(bone, openings=None, *, progress=None):
        patch = np.zeros(bone.shape, bool)
        patch[-1] = True
        return Prosthesis(
            extract_surface(bone.with_voxels(patch)), np.zeros(0, np.uint8), bone.with_voxels(patch), "leaking"
        )

    monkeypatch.setitem(STAND_INS, "perfect", leaking)
    with only_stand_ins():
        assert attempt(case.bone, case.openings, Contender("perfect")).status == "no patch"


class TestApart:
    def test_is_the_same_design_and_does_not_count_what_this_process_holds(self, case):
        here = attempt(case.bone, case.openings, Contender("slicewise", "paper"))
        ballast = np.ones(50_000_000)  # 400 MB
        apart = attempt_apart(case.bone, case.openings, Contender("slicewise", "paper"))
        np.testing.assert_array_equal(apart.prosthesis.patch.voxels, here.prosthesis.patch.voxels)
        np.testing.assert_array_equal(apart.prosthesis.mesh.vertices, here.prosthesis.mesh.vertices)
        assert apart.prosthesis.parameters == here.prosthesis.parameters
        assert 20 < apart.memory < trial.peak_memory() - 100 and ballast.nbytes == 4e8

    def test_a_refusal_comes_back_as_a_sentence(self, case):
        whole = case.bone.with_voxels(np.zeros(case.bone.shape, bool))
        apart = attempt_apart(whole, case.openings, Contender("slicewise"))
        assert apart.status != "done" and apart.prosthesis is None and apart.message.endswith(".")


class TestPage:
    def test_is_self_contained(self, html):
        text, page = re.sub(r"base64,[A-Za-z0-9+/=]+", "", html), Page(html)
        assert not re.search(r"https?:|//|url\(|@import|<script|<link|<iframe|<object|\shref=|\son\w+=", text)
        assert all(attrs["src"].startswith("data:image/png;base64,") for attrs in page.all("img"))
        assert not page.all("a")

    def test_every_picture_is_a_png_with_words_of_its_own(self, html):
        pictures = Page(html).all("img")
        assert len(pictures) == 2 * 3 + 2 + 1 + 2 * 2  # views with the truth, cuts, scale, maps
        assert all(base64.b64decode(p["src"].split(",")[1]).startswith(b"\x89PNG") for p in pictures)
        assert all(len(p["alt"]) > 60 and "mm" in p["alt"] for p in pictures)
        assert len({p["alt"] for p in pictures}) == len(pictures)

    def test_is_structured_for_reading_aloud(self, html):
        page = Page(html)
        assert page.all("html")[0]["lang"] == "en" and len(page.all("h1")) == 1
        ids = {attrs["id"] for _, attrs in page.tags if "id" in attrs}
        assert {attrs["aria-labelledby"] for attrs in page.all("section")} <= ids
        assert all("scope" in attrs for attrs in page.all("th"))

    def test_has_a_row_for_each_and_shows_markup_as_words(self, html):
        text = " ".join(" ".join(Page(html).words).split())
        assert all(text.count(name) >= 2 for name in STAND_INS) and "not for clinical use" in text
        assert "The other side <is> open, too." in text and "<is>" not in html and "secret" not in html

    def test_all_maps_and_the_bar_have_the_scale_of_the_comparison(self, found, monkeypatch):
        tops = []
        scale = figures.colour_scale
        monkeypatch.setattr(figures, "colour_scale", lambda top: tops.append(top) or scale(top))
        comparison_page.comparison_page(found)
        assert len(tops) == 5 and set(tops) == {found.top}

    def test_all_pictures_of_a_view_are_seen_from_one_side(self, found, monkeypatch):
        seen = []
        draw = figures.view_figure
        monkeypatch.setattr(figures, "view_figure", lambda *a, **k: seen.append((*a[2], k["px"])) or draw(*a, **k))
        comparison_page.comparison_page(found)
        assert len(seen) == 6 and len(set(seen[:3])) == 1 and len(set(seen[3:])) == 1

    def test_heads_for_little_room_tell_columns_apart(self):
        heads = [what.short for what in compare.MEASURES.values()]
        assert len(set(heads)) == len(heads) and max(map(len, heads)) <= 5

    def test_best_is_what_is_printed_best(self, found):
        accuracy, implant = comparison_page.tables(found)
        assert accuracy["best"]["dice"] == 1 and accuracy["best"]["hd95"] == 0
        assert accuracy["best"]["volume_ratio"] is None and implant["best"]["overlap"] is None

    def test_without_a_truth(self, blind):
        page = Page(comparison_page.comparison_page(blind))
        assert len(page.all("img")) == 2 * 2 + 2 + 1 + 2
        assert len(page.all("table")) == 2 and "the surface of moved" in " ".join(page.words)


class TestFiles:
    def test_csv_and_json_hold_the_same_rows(self, found):
        table = list(csv.DictReader(io.StringIO(comparison_page.comparison_csv(found))))
        record = json.loads(json.dumps(comparison_page.export.jsonable(comparison_page.comparison_record(found))))
        assert [row["name"] for row in table] == [m["name"] for m in record["methods"]] == list(STAND_INS)
        for row, told in zip(table, record["methods"], strict=True):
            assert row["status"] == told["status"] and row["message"] == told["message"]
            for key in compare.MEASURES:
                assert (row[key] == "") == (told[key] is None)
                assert row[key] == "" or float(row[key]) == told[key]
        assert record["reference"] == "truth" and record["colour_scale_mm"] == [0, found.top]

    def test_all_or_nothing(self, found, tmp_path, monkeypatch):
        def full_disk(*_):
            raise OSError(28, "No space left on device")

        with staged(tmp_path / "good") as part:
            comparison_page.write_comparison(found, part)
        assert {p.name for p in (tmp_path / "good").iterdir()} == set(comparison_page.FILES)
        monkeypatch.setattr(comparison_page, "comparison_page", full_disk)
        with pytest.raises(CannotWrite), staged(tmp_path / "new" / "out") as part:
            comparison_page.write_comparison(found, part)
        assert [p.name for p in tmp_path.iterdir()] == ["good"]


class TestCommand:
    def test_writes_its_files_and_prints_the_table(self, home, tmp_path):
        arguments = ("--truth", home / "truth.nii.gz", "--method", "slicewise:paper", "--out", tmp_path / "out")
        result = cranio("compare", home / "skull.nii.gz", *arguments)
        assert result.exit_code == 0, result.output
        assert {p.name for p in (tmp_path / "out").iterdir()} == set(comparison_page.FILES)
        assert "slicewise:paper" in result.stdout and "Border DSC" in result.stdout and result.stderr == ""
        text = (tmp_path / "out" / "comparison.html").read_text()
        assert str(home) not in text

    def test_without_a_folder_nothing_is_written(self, home, found, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(compare, "compare", lambda *a, **k: found)
        result = cranio("compare", home / "skull.nii.gz")
        assert result.exit_code == 0 and list(tmp_path.iterdir()) == []
        assert "faulty: broken" in result.stdout and "refusing: refused" in result.stdout

    @pytest.mark.parametrize("arguments", [("--method", "magic"), ("--method", "slicewise:best")], ids=str)
    def test_usage_errors(self, arguments, home, tmp_path):
        assert cranio("compare", home / "skull.nii.gz", *arguments, "--out", tmp_path / "out").exit_code == 2
        assert cranio("compare", home / "skull.nii.gz", "--out", home / "skull.nii.gz").exit_code == 2
        assert list(tmp_path.iterdir()) == []

    def test_where_none_makes_anything_the_page_says_why(self, home, case, stand_ins, tmp_path, monkeypatch):
        none = compare.compare(case, contenders(["finding_nothing", "refusing"]), attempt=attempt)
        assert none.distances == {} and none.pairs == {}
        monkeypatch.setattr(compare, "compare", lambda *a, **k: none)
        result = cranio("compare", home / "skull.nii.gz", "--out", tmp_path)
        assert result.exit_code == 4 and "Nothing was bridged." in result.stdout
        page = Page((tmp_path / "comparison.html").read_text())
        assert not page.all("img") and "Nothing was bridged." in " ".join(page.words)

    def test_refused_inputs_leave_nothing(self, tmp_path):
        assert cranio("compare", tmp_path / "missing", "--out", tmp_path / "out").exit_code == 3
        assert list(tmp_path.iterdir()) == []

    def test_every_method_is_named_in_the_help(self):
        for command in ("compare", "design"):
            text = "".join(cranio(command, "--help").stdout.split())  # names may be wrapped
            assert all(name in text for name in catalogue.METHODS)
