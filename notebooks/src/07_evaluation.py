# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 07 Evaluation: how good is it, really?
#
# A prosthesis that looks right may be wrong by millimetres. This lesson measures, in mm, both ways, and shows how each
# measure can be fooled. It also puts the paper's own yardstick, the mirrored head, on trial.
#
# **After this lesson you can**
# - compute Dice, surface distances and HD95 and say what each does not see;
# - remake a row of the paper's Table 3, and its colour map (Figure 9);
# - explain why a mirrored skull is not the truth.
#
# **Time:** 45 minutes (text 20, questions 10, exercises 15). **You need:** lessons 00 and 06.
#
# **From the paper:** section 3, Table 3, Figure 9.

# %%
import numpy as np
from scipy import ndimage, spatial

import cranio_nb as cn
from cranio_nb.evaluation import against_truth, paper_tables
from cranio_nb.teaching import check, classroom, widgets

# %% [markdown]
# ## Parameters
#
# None to tune: an evaluation that can be tuned is none.
#
# *The switch:* `classroom.load("full", needs_truth=True)` takes a head of the paper's size; or a scan of your own whose
# missing bone is known, for this lesson needs a truth: `classroom.load(scan="path/to/your/scan",
# truth="path/to/its/truth.nii.gz")`.

# %% tags=["nbval-check-output"]
case = classroom.load("class", needs_truth=True)
bone, truth = cn.segment(case.ct), case.truth
print(f"voxels of {np.round(truth.spacing, 2)} mm (between planes, rows, columns)")
openings = cn.find_openings(bone)
made = cn.design(bone, openings)
seen = against_truth.check_truth(made, truth, bone, openings[0].head_centre)

# %% [markdown]
# ## 1. Table 3: distances of nodes
#
# The paper takes each node of the prosthesis' top (outer) and inner surface and measures its distance from the true
# surface, in voxels (each coordinate is divided by its own spacing first): smallest, largest, mean, standard deviation.
# Its truth is a mirrored skull and its head another one, so look at the kind of number, not at who wins.

# %% tags=["nbval-check-output"]
print("in voxels       min   max   mean  std")
for whose, table in (("ours", seen.table3), ("the paper's", paper_tables.PAPER_DISTANCES)):
    for side in ("outer", "inner"):
        row = table[side]
        print(f"{side} {whose:11} {row.min:5.2f} {row.max:5.2f} {row.mean:5.2f} {row.std:5.2f}")

# %% [markdown]
# Voxels are no good unit: one is 2.5 mm high and 0.9 mm wide. From here on we use mm.
#
# **Predict, then move, then explain.** Where on the prosthesis will the largest distances lie: in its middle or at its
# rim? Switch to the inner side (its numbers are printed too; without controls: `panel.set(side="inner")`). Is it better
# or worse?

# %% tags=["nbval-check-output"]
panel = widgets.distances(made, seen.prosthesis)
for side in ("inner", "outer"):
    print(panel.set(side=side).view.line)
panel

# %% tags=["nbval-check-output"]
# a cKDTree finds nearest points: query gives the distances to them, and their numbers
to_bone = spatial.cKDTree(bone.to_world(np.argwhere(bone.voxels)))
for side, code in against_truth.SIDES.items():
    off, far = seen.distances[side], to_bone.query(made.surface(code).vertices)[0]
    worst = far[off > 2 / 3 * off.max()]
    middle, within = off[far > 0.7 * far.max()].mean(), off[far > 5].max()
    print(f"{side}: the {len(worst)} largest of {len(off)}", end=" ")
    print(f"lie {worst.min():.1f} to {worst.max():.1f} mm from bone")
    print(f"{side}: more than 5 mm from bone at most {within:.2f} mm off")
    print(f"{side}: the middle is {middle:.2f} mm off on average")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# At the rim, if the very largest are asked for: the few nodes with more than two thirds of the maximum lie within 3.3
# mm of bone. (The picture's bright spot lies further in, more than 5 mm from bone. It is 0.77 mm off, not half as far
# as the worst node, the circle at the rim, which the colours do not tell: they end at 0.7 mm.) One would expect the
# middle to be worst, for it is farthest from any bone, and one wrong tangent (lesson 05) does most harm there. But here
# six directions are averaged, and the middle is one of the *best* places: 0.07 mm off, where the mean is 0.14 mm. The
# inner side is a little worse on average here (0.18 against 0.14 mm); the single worst node lies on the outer side
# (1.91 against 1.05 mm).
#
# </details>
#
# **Question.** Half of the prosthesis is cut off. What happens to the mean distance of Table 3?
#
# Guess first; the cell cuts it in four ways.

# %% tags=["nbval-check-output"]
nodes, off = made.surface(cn.mesh.OUTER).vertices, seen.distances["outer"]
print(f"the whole outer side: {off.mean():.2f} mm")
backwards, upwards = (nodes - nodes.mean(axis=0))[:, 1:].T
for name, way in {"front": -backwards, "back": backwards}.items():
    print(f"its {name} half only: {off[way > 0].mean():.2f} mm")
for name, way in {"lower": -upwards, "upper": upwards}.items():
    print(f"its {name} half only: {off[way > 0].mean():.2f} mm")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# Nearly nothing: the nodes that are left still lie as near to the truth. A one-way distance does not see what is
# *missing*. So we also look from the truth to the prosthesis.
#
# </details>
#
# ## 2. How measures can be fooled
#
# **Predict** for each of these what Dice and HD95 do: (a) the truth, moved by one voxel towards the patient's left,
# which for this hole in the side of the head is *across* the plate; (b) half of the truth; (c) the truth, one voxel
# thicker wherever no bone is in the way. (The last column, one way, is the mean distance from each voxel's centre to
# the nearest one of the truth: the voxels inside count too, so it is not that of Table 3.)

# %%
middle = np.nonzero(truth.voxels)[0].mean()  # plane
half = truth.voxels & (np.arange(truth.shape[0]) < middle)[:, None, None]
thick = ndimage.binary_dilation(truth.voxels, iterations=1) & ~bone.voxels
tries = {
    "our design": made.patch.voxels,
    "moved by one voxel": np.roll(truth.voxels, 1, axis=2),
    "half of it": half,
    "one voxel thicker": thick,
}

# %% tags=["nbval-check-output"]
to_truth = spatial.cKDTree(truth.to_world(np.argwhere(truth.voxels)))
print("                     Dice   HD95   one way, mm")
for name, voxels in tries.items():
    s = cn.score(truth.with_voxels(voxels), truth, bone)
    one_way = to_truth.query(truth.to_world(np.argwhere(voxels)))[0].mean()
    print(f"{name:20} {s.dice:.3f} {s.hd95:6.2f} {one_way:8.2f}")
# a ball of the same volume, moved the same way
radius = np.cbrt(truth.voxels.sum() * np.prod(truth.spacing) * 3 / (4 * np.pi))
plane, row, col = np.indices((21, 51, 51)) - np.array([10, 25, 25])[:, None, None, None]
away = np.stack([plane, row, col], axis=-1) * truth.spacing
ball = np.linalg.norm(away, axis=-1) < radius
dice = (ball & np.roll(ball, 1, axis=2)).sum() / ball.sum()
print(f"a ball of {radius:.0f} mm radius, moved by one voxel: Dice {dice:.3f}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# (a) For a thin shell Dice is harsh: a shift by one voxel (0.9 mm) across it leaves 0.830, while a ball of as much bone
# would keep 0.958. Our design has 0.969. HD95 does not see the difference: both have 0.90 mm, one pixel. (b) HD95 sees
# what is missing, and so does Dice; the one-way distance is exactly 0. (c) One voxel thicker is nearly as bad as the
# shift for Dice (0.851), and HD95 is 1.27 mm, the diagonal of a pixel. No single number will do; the package prints
# several.
#
# </details>
#
# ## 3. The mirror on trial
#
# From here on *mean* is the average surface distance (ASSD) between the two masks, both ways, over their outermost
# voxels. It is not that of section 1, which goes one way, from the nodes of a mesh.
#
# The paper has no truth. It takes the mirrored sound side instead. Let us do so the plain way: flip the columns left to
# right, find the shift at which they cover the skull best, and cut out what fills the hole.
#
# **Predict.** The head in this scan is nearly symmetric. How near to the truth will its mirror image be?

# %% tags=["nbval-check-output"]
flipped = bone.voxels[:, :, ::-1]
shifts = np.arange(-15, 16)
cover = [(np.roll(flipped, s, 2) & bone.voxels).sum() for s in shifts]
best = shifts[np.argmax(cover)]
near = ndimage.binary_dilation(openings[0].sheet.voxels, iterations=6)
mirror = truth.with_voxels(np.roll(flipped, best, 2) & ~bone.voxels & near)
s = cn.score(mirror, truth, bone)
for name, one in {"our design": seen.score, f"columns, shifted by {best}": s}.items():
    ends = f"HD95 {one.hd95:.2f}, mean {one.assd:.2f} mm"
    print(f"{name:23} Dice {one.dice:.3f}, {ends}")

# %% [markdown]
# Worse than one might think. But is it the *head* that is not symmetric, or does it only stand a little askew? Whole
# columns can be shifted, not turned. Lesson 08 finds the plane of symmetry itself; here it is, on this head and on the
# same head with its sound half made wider (about 15 seconds):

# %% tags=["nbval-check-output"]
found = cn.design(bone, openings, method="reflection", fit_rim=False)  # not bent to the rim
plane = found.record["symmetry"]
print(f"the plane is turned by {plane['angle_deg']:.1f} degrees against the columns")
cols, middle = np.arange(bone.shape[2]), bone.to_voxel(plane["point"])[2]
for percent in (0, 2, 4, 6):
    # each column of the sound half shows what lay a little nearer to the middle
    source = np.where(cols < middle, middle + (cols - middle) / (1 + percent / 100), cols)
    skull = bone.with_voxels(bone.voxels[:, :, np.rint(source).astype(int)])
    if percent:  # with 0 it is the head as it was
        found = cn.design(skull, openings, method="reflection", fit_rim=False)
    s = cn.score(found.patch, truth, skull)
    ends = f"HD95 {s.hd95:.2f}, mean {s.assd:.2f} mm"
    moved = found.record["symmetry"]["offset_mm"] - plane["offset_mm"]
    print(f"sound half {percent} % wider: Dice {s.dice:.3f}, {ends}, plane by {moved:.2f} mm")

# %% [markdown]
# Two errors were in the plain mirror, and they are of different kinds.
#
# - **Pose.** This head is turned by 2.1 degrees. With the plane found, its mirror image rises from Dice 0.817 to 0.951
#   and HD95 falls from 1.80 to 0.90 mm. It is still farther from the truth than our design, 0.21 mm on average against
#   0.13 mm: even here the yardstick is less exact than what it is to measure.
# - **Asymmetry.** The plane found moves towards the wider half, by 1.48 mm in the last row, and hides a part of it.
#   With the sound half 4 % wider the yardstick is 0.58 mm off on average all the same, with 6 % 0.66 mm; each further
#   step costs. A mirror at a plane keeps all lengths, so it cannot make a wide half narrow.
#
# Real heads are not symmetric. A yardstick that is itself off by 0.58 mm on average may well take the worse of two good
# methods for the better one. Where the defect crosses the middle there is no mirror at all. The paper is right to call
# it a *similarity* measure.
#
# ## A mistake to make once
#
# Compare masks that stand on different grids, here one whose planes are said to be nearer (2 mm apart, not 2.5). As
# arrays they have the same shape, even the same voxels, and a Dice of 1; the volumes know better:

# %% tags=["raises-exception"]
nearer = cn.Volume(truth.voxels, truth.affine @ np.diag([0.8, 1, 1, 1]))
cn.score(nearer, truth, bone)

# %% [markdown]
# ## Exercises
#
# **Exercise 7.1.** HD95 of two sets of points (n, 3) in mm: distances to the nearest point, both ways, joined; the 95th
# percentile of them. (`spatial.cKDTree` is imported.)


# %% tags=["solution"]
def hd95(a, b):
    """95th percentile of the distances to the nearest point, both ways, mm."""
    there, back = spatial.cKDTree(b).query(a)[0], spatial.cKDTree(a).query(b)[0]
    return np.percentile(np.concatenate([there, back]), 95)


# %% tags=["check", "nbval-check-output"]
check.exercise("7.1", hd95)

# %% [markdown]
# **Exercise 7.2.** Mirror points (n, 3) at the plane through `origin` with the unit normal `normal`.


# %% tags=["solution"]
def mirrored(points, normal, origin):
    """Points on the other side of a plane, as far from it."""
    distance = (points - origin) @ normal
    return points - 2 * distance[:, None] * normal


# %% tags=["check", "nbval-check-output"]
check.exercise("7.2", mirrored)

# %% [markdown]
# ## Summary
#
# - One-way distances miss what is missing. Dice is harsh on thin shells. Show several measures.
# - Give distances in mm: a voxel here is 0.9 mm in one direction and 2.5 mm in another.
# - A mirror is a guess, not a truth: as good as its plane, and as the head is symmetric.
#
# | paper | code | unit |
# |---|---|---|
# | distance field | `mesh_distances.surface_distance` | mm |
# | Min., Max., Mean, StD. | `mesh_distances.distance_stats` | mm or voxels |
# | in voxel units | `mesh_distances.in_voxels` | voxels |
# | similarity by reflection | section 3 above | |
#
# **Further reading.** Maier-Hein and others, *Metrics reloaded*, Nature Methods 21 (2024). Li and others, *AutoImplant
# 2020*, IEEE Transactions on Medical Imaging 40 (2021).
