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
# A prosthesis that looks right may be wrong by 3 mm. This lesson measures, in mm, both ways, and shows how each measure
# can be fooled. It also puts the paper's own yardstick, the mirrored head, on trial.
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
from scipy import ndimage
from scipy.spatial import cKDTree

from cranio_nb import check, classroom, evaluate, lesion, segment, widgets
from cranio_nb.methods import slicewise
from cranio_nb.run import check_truth

# %% [markdown]
# ## Parameters
#
# None to tune: an evaluation that can be tuned is none.
#
# *The switch:* `"full"` for the paper's size; or a scan of your own whose missing bone is known, for this lesson needs
# a truth: `classroom.load(scan="path/to/your/scan", truth="path/to/its/truth.nii.gz")`.

# %%
case = classroom.load("class", needs_truth=True)
bone, truth = segment.segment(case.ct), case.truth
openings = lesion.find(bone)
made = slicewise.design(bone, openings)
seen = check_truth(made, truth, bone, openings[0])

# %% [markdown]
# ## 1. Table 3: distances of nodes
#
# The paper takes each node of the prosthesis' top (outer) and inner surface and measures its distance from the true
# surface, in voxels: smallest, largest, mean, standard deviation.

# %% tags=["nbval-check-output"]
print("in mm    min   max   mean  std")
for side, distances in seen.distances.items():
    row = evaluate.distance_stats(distances)
    print(f"{side}  {row.min:5.2f} {row.max:5.2f} {row.mean:5.2f} {row.std:5.2f}")

# %% tags=["nbval-check-output"]
widgets.evaluation(made, seen.prosthesis)

# %% [markdown]
# **Predict, then move, then explain.** Where on the prosthesis will the largest distances lie: in its middle or at its
# rim? Switch to the inner side. Is it better or worse?
#
# <details>
# <summary>Answer</summary>
#
# The middle of the gap is farthest from any bone and can be wrong by a whole tangent; but single large values sit at the
# rim, where one voxel more or less of bevelled bone decides. The inner side is a little worse: its bone is less smooth and
# the gap's inner ends are harder to see.
#
# </details>
#
# **Question.** Half of the prosthesis is cut off. What happens to the mean distance of Table 3?
#
# <details>
# <summary>Answer</summary>
#
# Nearly nothing! The nodes that are left still lie near the truth. A one-way distance does not see what is *missing*.
# So we also look from the truth to the prosthesis.
#
# </details>
#
# ## 2. How measures can be fooled
#
# **Predict** for each of these what Dice and HD95 do: (a) the truth, moved by one voxel; (b) half of the truth; (c) the
# truth, one voxel thicker all round.

# %% tags=["nbval-check-output"]
half = truth.voxels & (np.arange(truth.shape[0]) < 34)[:, None, None]
thick = ndimage.binary_dilation(truth.voxels, iterations=1) & ~bone.voxels
tries = {
    "our design": made.patch.voxels,
    "moved by one voxel": np.roll(truth.voxels, 1, axis=2),
    "half of it": half,
    "one voxel thicker": thick,
}
for name, voxels in tries.items():
    s = evaluate.score(truth.with_voxels(voxels), truth, bone)
    one_way = cKDTree(np.argwhere(truth.voxels)).query(np.argwhere(voxels))[0].mean()
    print(f"{name:20} Dice {s.dice:.3f}  HD95 {s.hd95:5.2f} mm  one way {one_way:.2f} voxels")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# For a thin shell Dice is harsh: a shift by one voxel (0.9 mm) costs far more of it than of a ball. Half of the truth
# has a one-way distance of exactly 0. HD95 sees both. No single number will do; the package prints several.
#
# </details>
#
# ## 3. The mirror on trial
#
# The paper has no truth. It takes the mirrored sound side instead. Let us do so: flip the bone left to right, find the
# shift at which it covers the skull best, and cut out what fills the hole.

# %% tags=["nbval-check-output"]
flipped = bone.voxels[:, :, ::-1]
shifts = np.arange(-15, 16)
cover = [(np.roll(flipped, s, 2) & bone.voxels).sum() for s in shifts]
best = shifts[np.argmax(cover)]
near = ndimage.binary_dilation(openings[0].opening.voxels, iterations=6)
mirror = truth.with_voxels(np.roll(flipped, best, 2) & ~bone.voxels & near)
s = evaluate.score(mirror, truth, bone)
print(f"mirror, shifted by {best} columns: Dice {s.dice:.3f}, HD95 {s.hd95:.2f} mm")
print(f"our design:                  Dice {seen.score.dice:.3f}, HD95 {seen.score.hd95:.2f} mm")

# %% [markdown]
# Heads are not quite symmetric, and a head in a scanner is never quite straight. A yardstick that is itself off by
# this much cannot tell a method that is off by 1 mm from one that is off by half. Where the defect crosses the middle
# there is no mirror at all. The paper is right to call it a *similarity* measure.
#
# ## A mistake to make once
#
# Compare masks that stand on different grids. As arrays they may even have the same shape; the volumes know better:

# %% tags=["raises-exception"]
small = classroom.load("tiny")
evaluate.score(small.ct.with_voxels(small.ct.voxels > 400), truth, bone)

# %% [markdown]
# ## Exercises
#
# **Exercise 7.1.** HD95 of two sets of points (n, 3) in mm: distances to the nearest point, both ways, joined; the 95th
# percentile of them. (`cKDTree` is imported.)


# %% tags=["solution"]
def hd95(a, b):
    """95th percentile of the distances to the nearest point, both ways, mm."""
    there, back = cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]
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
# - A mirror is a guess, not a truth.
#
# | paper | code | unit |
# |---|---|---|
# | distance field | `evaluate.surface_distance` | mm |
# | Min., Max., Mean, StD. | `evaluate.distance_stats` | mm or voxels |
# | in voxel units | `evaluate.in_voxels` | voxels |
# | similarity by reflection | section 3 above | |
#
# **Further reading.** Maier-Hein and others, *Metrics reloaded*, Nature Methods 21 (2024). Li and others, *AutoImplant
# 2020*, IEEE Transactions on Medical Imaging 40 (2021).
