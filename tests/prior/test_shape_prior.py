"""The shape prior: what it learns from synthetic heads, and that what it foretells obeys the known bone."""

import json

import numpy as np
import pytest
from click.testing import CliRunner
from scipy import ndimage

import cranio_nb as cn
from cranio_nb.cli.main import main
from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.methods import thin_plate
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.prior import alignment, shape_prior, vault_radii
from cranio_nb.prior import study as prior_study
from cranio_nb.prior.file import VERSION, load, save
from cranio_nb.prior.shape_prior import Expected
from cranio_nb.vault import radius_measurement, ray_casting
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume

N_HEADS = 4


@pytest.fixture(scope="module")
def intact(phantom):
    """`intact(seed)`: a whole tiny head."""
    return lambda seed: Volume(
        phantom("round", seed).bone | phantom("round", seed).implant, phantom("round", seed).affine
    )


@pytest.fixture(scope="module")
def learned(intact):
    return shape_prior.learn(intact(seed) for seed in range(1, 1 + N_HEADS))


@pytest.fixture(scope="module")
def hole():
    """Rays through a round hole on the left."""
    towards = np.array([0.7, 0.3, 0.65])
    return vault_radii.vault_rays() @ towards > np.cos(0.4) * np.linalg.norm(towards)


def mirror_image(bone):
    affine = np.diag([-1.0, 1.0, 1.0, 1.0]) @ bone.affine
    return Volume(bone.voxels, affine).canonical()


def masked(radii, unknown):
    return np.where(unknown, np.nan, radii.astype(float))


def test_the_sphere_is_symmetric_and_even():
    rays = alignment.sphere(3)
    twins = alignment.twins(rays)
    assert len(rays) == 642
    np.testing.assert_allclose(rays[twins], rays * [-1, 1, 1], atol=1e-12)
    np.testing.assert_array_equal(twins[twins], np.arange(len(rays)))
    np.testing.assert_allclose(rays.T @ rays / len(rays), np.eye(3) / 3, atol=0.01)


def test_a_moved_and_stretched_skull_is_laid_back(intact):
    cloud = alignment.see(intact(1))
    turn = alignment._rotation(np.array([0.15, 0.03, -0.04]))
    matrix, shift = 1.08 * turn @ np.diag([0.97, 1.0, 1.03]), np.array([3.0, -4.0, 5.0])
    frame = alignment.stand(cloud.posed(matrix, shift), cloud)
    back = cloud.axes.T @ frame.matrix
    np.testing.assert_allclose(back, matrix, atol=5e-3)
    np.testing.assert_allclose(cloud.axes.T @ (frame.origin - cloud.eye), shift, atol=0.3)


def test_a_hole_hardly_moves_a_skull(intact, skull, learned):
    whole, open_ = (alignment.stand(alignment.see(bone), learned.mean) for bone in (intact(0), skull("large", 0)))
    other = alignment.stand(alignment.see(intact(0)), learned.mean)
    np.testing.assert_array_equal(other.matrix, whole.matrix)
    assert np.linalg.norm(open_.origin - whole.origin) < 2.0
    np.testing.assert_allclose(open_.matrix, whole.matrix, atol=0.04)


def test_learned_heads_stand_symmetric_and_of_mean_size(learned):
    assert learned.radii.shape == (N_HEADS, 2, len(vault_radii.vault_rays()))
    assert np.isfinite(learned.radii).all() and (learned.radii[:, 0] > learned.radii[:, 1]).all()
    middle = learned.samples.mean(axis=0)
    np.testing.assert_allclose(vault_radii.mirrored(middle), middle, atol=1e-4)
    assert 60 < middle[0].mean() < 110


def test_known_bone_is_reproduced(learned, hole, intact):
    truth = learned.radii[0]
    given = shape_prior.condition(learned.subset([1, 2, 3]), masked(truth, hole), np.ones(len(hole), bool))
    beside = ~hole & (vault_radii.distance(hole) < 10)
    assert np.abs(given - truth)[:, beside].mean() < 0.25  # the noise of the tiny heads' voxels


def test_a_skull_that_was_seen_is_foretold_better(learned, hole):
    truth = learned.radii[0]
    off = [
        np.abs(shape_prior.condition(learned.subset(chosen), masked(truth, hole), hole) - truth[:, hole]).mean()
        for chosen in ([1, 2, 3], [0, 1, 2, 3])
    ]
    assert off[1] < 0.6 * off[0]


def test_a_larger_head_is_foretold_larger(learned, hole):
    truth, others = 1.03 * learned.radii[0], learned.subset([1, 2, 3])
    foretold = shape_prior.condition(others, masked(truth, hole), hole)
    plain = others.samples.mean(axis=0)[:, hole]
    assert np.abs(foretold - truth[:, hole]).mean() < 0.2 * np.abs(plain - truth[:, hole]).mean()


def test_without_known_bone_the_mean_head_is_foretold(learned, hole):
    nothing = np.full(learned.radii.shape[1:], np.nan)
    np.testing.assert_allclose(shape_prior.condition(learned, nothing, hole), learned.samples.mean(axis=0)[:, hole])


def test_where_all_skulls_agree_the_smooth_kernel_speaks(learned, hole):
    alike = shape_prior.Prior(
        learned.mean, np.repeat(learned.samples.mean(axis=0, keepdims=True), 3, axis=0).astype("f4")
    )
    swollen = alike.radii[0] + 1.0
    foretold = shape_prior.condition(alike, masked(swollen, hole), hole) - alike.radii[0][:, hole]
    rim = vault_radii.distance(~hole)[hole] < 6
    assert (foretold > 0.8).all() and foretold[:, rim].mean() > 0.95


def test_the_mirror_image_is_foretold_as_the_mirror_image(learned, hole):
    truth, others = learned.radii[0], learned.subset([1, 2, 3])
    twin = alignment.twins(vault_radii.vault_rays())
    plain = np.zeros(truth.shape)
    plain[:, hole] = shape_prior.condition(others, masked(truth, hole), hole)
    turned = np.zeros(truth.shape)
    turned[:, hole[twin]] = shape_prior.condition(others, masked(truth, hole)[:, twin], hole[twin])
    np.testing.assert_allclose(vault_radii.mirrored(turned), plain, atol=0.01)  # mm: ties between neighbours


def test_a_hole_in_a_head_is_foretold_on_its_chart(learned, phantom, skull):
    case, bone = phantom("round", 0), skull("round", 0)
    chart = radius_measurement.measure_around(bone, find_openings(bone)[0])
    found = shape_prior.expect(learned, bone, chart)
    whole = Volume(case.bone | case.implant, case.affine)
    inner, outer = ray_casting.cast(
        whole, chart.grid.centre, chart.grid.directions, np.nan_to_num(found.outer, nan=80.0)
    )
    assert np.isfinite(found.outer[chart.hole]).all()
    assert np.abs(found.outer - outer)[chart.hole].mean() < 0.8
    assert np.abs(found.inner - inner)[chart.hole].mean() < 0.8
    sound = ~chart.hole & np.isfinite(found.outer) & np.isfinite(chart.outer)
    assert np.median(np.abs(found.outer - chart.outer)[sound]) < 0.5


def test_the_mirrored_head_is_foretold_mirrored(learned, skull):
    bone = skull("round", 0)
    twin = mirror_image(bone)
    charts = [radius_measurement.measure_around(one, find_openings(one)[0]) for one in (bone, twin)]
    found = [shape_prior.expect(learned, one, chart) for one, chart in zip((bone, twin), charts, strict=True)]
    middles = [np.nanmean(one.outer[chart.hole]) for one, chart in zip(found, charts, strict=True)]
    assert middles[0] == pytest.approx(middles[1], abs=0.3)
    assert np.linalg.norm(found[0].frame.origin * [-1, 1, 1] - found[1].frame.origin) < 1.0


def test_a_prior_survives_its_file(learned, tmp_path):
    save(learned, tmp_path / "prior.npz")
    back = load(tmp_path / "prior.npz")
    np.testing.assert_array_equal(back.radii, learned.radii)
    np.testing.assert_allclose(back.mean.inside, learned.mean.inside, atol=1e-4)
    assert [p.name for p in tmp_path.iterdir()] == ["prior.npz"]


@pytest.mark.parametrize("fault", ["missing", "text", "cut", "version", "pickle", "shape", "nan", "other"])
def test_what_is_no_prior_is_refused(fault, learned, tmp_path):
    path = tmp_path / "prior.npz"
    save(learned, path)
    parts = dict(np.load(path))
    if fault == "missing":
        path.unlink()
    elif fault == "text":
        path.write_text("not a prior")
    elif fault == "cut":
        path.write_bytes(path.read_bytes()[:-300])
    else:
        change = {
            "version": {"version": np.int64(VERSION + 1)},
            "pickle": {"radii": np.array([{}], dtype=object)},
            "shape": {"radii": parts["radii"][:, :, :-1]},
            "nan": {"radii": parts["radii"] * np.float32("nan")},
            "other": {},
        }[fault]
        np.savez(path, **({"x": np.zeros(3)} if fault == "other" else parts | change))
    with pytest.raises(InputRefused) as refused:
        load(path)
    assert refused.value.code == "NoPrior" and str(tmp_path) not in str(refused.value)


def test_a_file_that_cannot_be_written_leaves_nothing(learned, tmp_path):
    (tmp_path / "prior.npz").mkdir()
    with pytest.raises(CannotWrite):
        save(learned, tmp_path / "prior.npz")
    with pytest.raises(CannotWrite):
        save(learned, tmp_path / "nowhere" / "prior.npz")
    assert [p.name for p in tmp_path.iterdir()] == ["prior.npz"]


def test_an_open_skull_is_not_learned_from(skull, intact):
    shape_prior.check_intact(intact(0))
    with pytest.raises(InputRefused, match="open or outside"):
        shape_prior.check_intact(skull("large", 0))


def test_one_skull_is_too_few(intact):
    with pytest.raises(InputRefused, match="needs 2 intact skulls"):
        shape_prior.learn([intact(0)])


def test_the_error_falls_with_the_number_of_skulls(learned):
    curve = prior_study.learning_curve(learned, sizes=(1,))
    assert [row.n_skulls for row in curve] == [1, N_HEADS - 1]
    assert curve[1].outer < curve[0].outer and curve[1].inner < curve[0].inner


def test_the_command_learns_from_a_folder(intact, skull, tmp_path):
    scans = tmp_path / "scans"
    scans.mkdir()
    for seed in (0, 1, 2):
        write_nifti(intact(seed), scans / f"head{seed}.nii.gz")
    write_nifti(skull("large", 3), scans / "open.nii.gz")
    (scans / "notes.txt").write_text("about")
    result = CliRunner().invoke(main, ["prior", "learn", str(scans), "--out", str(tmp_path / "prior.npz")])
    assert result.exit_code == 0, result.output
    assert "3 of 4 scans learned" in result.stdout and "Outer (mm)" in result.stdout
    assert result.stderr.startswith("skipped open.nii.gz: ") and result.stderr.count("\n") == 1
    assert len(load(tmp_path / "prior.npz").radii) == 3


def test_the_command_refuses_a_folder_without_skulls(tmp_path):
    for folder in (tmp_path, tmp_path / "nowhere"):
        result = CliRunner().invoke(main, ["prior", "learn", str(folder), "--out", str(tmp_path / "prior.npz")])
        assert result.exit_code == 3 and result.stderr.startswith("cranio-nb: ") and not list(tmp_path.iterdir())


def test_a_prior_draws_the_plate_towards_what_skulls_let_expect_but_not_off_the_rim(learned, skull, tmp_path):
    bone = skull("unilateral")
    save(learned, tmp_path / "prior.npz")
    (alone,) = cn.design(bone, method="thin-plate").working
    made = cn.design(bone, method="thin-plate", prior=str(tmp_path / "prior.npz"))
    (plate,) = made.working
    inside = ndimage.distance_transform_edt(plate.chart.hole) * plate.chart.step_mm
    rim, middle = (inside > 0) & (inside < 3), inside > 15
    for bent, held, expected in zip(
        (alone.outer, alone.inner), (plate.outer, plate.inner), plate.expected, strict=True
    ):
        assert np.abs(held - expected)[middle].mean() < np.abs(bent - expected)[middle].mean()
        assert np.abs(held - bent)[rim].mean() < np.abs(held - bent)[middle].mean()
    assert made.record["prior_skulls"] == len(learned.radii)
    assert made.patch.voxels.any() and not (made.patch.voxels & bone.voxels).any()


def test_a_prior_that_does_not_reach_the_hole_changes_nothing(learned, skull, tmp_path, monkeypatch):
    bone = skull("burr_hole")
    save(learned, tmp_path / "prior.npz")

    def nowhere(prior, bone, chart):
        return Expected(*np.full((2, *chart.hole.shape), np.nan), None)

    monkeypatch.setattr(thin_plate, "expect", nowhere)
    made = cn.design(bone, method="thin-plate", prior=str(tmp_path / "prior.npz"))
    np.testing.assert_array_equal(made.patch.voxels, cn.design(bone, method="thin-plate").patch.voxels)
    assert made.working[0].expected is None


def test_the_command_takes_a_prior_for_the_plate_only(learned, skull, tmp_path):
    save(learned, tmp_path / "prior.npz")
    write_nifti(skull("burr_hole"), tmp_path / "skull.nii.gz")
    wanted = ["design", str(tmp_path / "skull.nii.gz"), "--mask", "--prior", str(tmp_path / "prior.npz")]
    made = CliRunner().invoke(main, [*wanted, "--method", "thin-plate", "--out", str(tmp_path / "out")])
    assert made.exit_code == 0, made.output
    assert json.loads((tmp_path / "out" / "design.json").read_text())["parameters"]["prior"]
    refused = CliRunner().invoke(main, [*wanted, "--out", str(tmp_path / "other")])
    assert refused.exit_code != 0 and not (tmp_path / "other").exists()
