# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 00 Tour: from a head CT to a prosthesis
#
# A patient has a hole in the skull. We have a CT scan of the head. We want the piece of bone that is missing, as a
# solid body that a machine can make. This lesson walks through all of it, once and quickly. Lessons 01 to 06 open the
# boxes one by one, lessons 07 to 11 ask how good the result is and what else there is.
#
# > **Not for clinical use.** This is a tool for teaching and research, not a medical device. The head below is
# > synthetic; nobody's data is used.
#
# **After this lesson you can**
# - name the five stages of the method and say what goes into each and what comes out;
# - run the whole pipeline on a scan and read its result;
# - turn voxels into cubic centimetres, and say how well two masks agree.
#
# **Time:** 30 minutes (tour 15, questions 5, exercises 10). **You need:** Python with numpy arrays; nothing else.
#
# **The paper:** *Surface reconstruction for generating digital models of prosthesis* (VISAPP 2011, doi
# 10.5220/0003356601370142). Its five stages, and the lessons that open them:
#
# | stage | in | out | lesson |
# |---|---|---|---|
# | 1 segmentation | CT in HU | bone mask | lessons 01, 02 |
# | 2 feature extraction | bone of one slice | ends of the gap and their tangents | lesson 03 |
# | 3 deformable model | ends and tangents | outer and inner curve across the gap | lesson 04 |
# | 4 prosthesis volume | curves | patch of voxels | lesson 05 |
# | 5 surface reconstruction | patch | closed triangle mesh | lesson 06 |
# | and afterwards | mesh and truth | how good is it? what else closes it? which settings? | lessons 07 to 11 |

# %%
import numpy as np

import cranio_nb as cn
from cranio_nb.teaching import check, classroom, diagrams, widgets

# %% [markdown]
# ## 1. The scan
#
# `classroom.load` makes a synthetic head with a hole, so you need no data and no network. It is a simple head: skin,
# skull and brain, without a face. A CT is a box of numbers in **Hounsfield units** (HU): air is -1000, water 0, bone
# several hundreds and more. Each value is measured with some noise, so single voxels of air lie below -1000; the file
# holds no value below -1024, so there they end. A **slice** is the picture of one **plane** of voxels.
#
# *The switch:* `"class"` takes seconds; `"full"` is the size of the paper's scan (512 x 512 x 68);
# `classroom.load(scan="path/to/your/scan")` takes your own (DICOM folder, NIfTI or NRRD).

# %% tags=["nbval-check-output"]
case = classroom.load("class")
ct = case.ct
print(f"{ct.shape} voxels (planes, rows, columns), {np.round(ct.spacing, 2)} mm apart")
print(f"from {ct.voxels.min()} to {ct.voxels.max()} HU", end=" ")
print(f"(air, in a corner: {ct.voxels[:, :9, :9].mean():.0f} on average)")

# %% tags=["nbval-check-output"]
viewer = widgets.ct_viewer(ct)
viewer

# %% [markdown]
# *Move this picture with its sliders; where it has none, from a new cell of a notebook:*
# `viewer.set(plane=30)`. *Its controls are* `plane`, `centre` *and* `width`; lesson 01 explains the last two. At the
# right: how many voxels have which HU, with the centre (full line) and the ends of the width (dashes).
#
# The bright ring is the skull. Move through the slices: somewhere the ring is open. The letters are the patient's
# sides: A front (anterior), P back (posterior), L left, R right. **L is at the right of the picture**, because
# radiologists look at a slice from the feet.
#
# ## 2. Bone (stage 1)
#
# Everything from 400 HU up is bone: this is the paper's lower bound, and lesson 02 asks what difference it makes. Then
# the couch under the head and loose specks are dropped and small holes are closed. What comes out is a **mask**: True
# where a voxel is bone, False elsewhere.

# %% tags=["nbval-check-output"]
bone = cn.segment(ct, threshold=400)
print(f"{bone.voxels.mean():.1%} of the voxels are bone")

# %% [markdown]
# ## 3. Where is the hole?
#
# We stand inside the head and look out. Where a ray meets no bone, there is an opening. (The rays run through several
# planes at a slant, and the rim is bevelled: in the first and last of the planes that are named the ring of bone itself
# may still be closed.)

# %% tags=["nbval-check-output"]
openings = cn.find_openings(bone)
first, end = openings[0].planes
print(f"{len(openings)} opening, in planes {first} to {end - 1}")

# %% tags=["nbval-check-output"]
diagrams.ray_fan(bone, openings[0])

# %% [markdown]
# Grey rays end at the bone, black ones leave: side by side they make one opening. The light blue sheet, laid across it,
# is how the package keeps its place. The other rays measure the skull, one outer and one inner radius for each
# direction (at the right). Lesson 09 works on these radii alone.
#
# ## 4. One slice: ends, tangents, balloon (stages 2 and 3)
#
# In one slice the hole is a gap in a ring. At each end of the gap we take the direction in which the bone was going,
# and let a curve bulge from one end to the other, like a rubber band with wind behind it: a **balloon**. One balloon
# runs along the outside of the bone, one along the inside. Here is the outer one.
#
# The slice is turned so that the **chord**, the straight line between the ends, lies level (thin grey dashes). The
# orange dashes are the curve that the balloon starts from. It is made from the ends and their tangents and is a good
# guess already, so little is left to change. The broad pale line is the outer edge of the bone that is missing, known
# because this head is synthetic. The two plots below (`||dc||` and the energy) tell how the balloon comes to rest;
# lesson 04 explains them, and the letters of the caption and of the controls too. You see the balloon at rest; where
# there is a button to play it, watch it again from step 0.

# %% tags=["nbval-check-output"]
# px along the bone: leave out the ragged first 3, fit the tangent to the next 10
follow = {"skip_px": 3, "reach_px": 10}
plane = classroom.bridged_plane(bone, openings[0], **follow)  # a slice with both ends
outer, inner = classroom.gap_ends(bone, openings[0], plane, **follow)
# any point in the head: the balloon must know which way is out
inside = bone.to_voxel(openings[0].head_centre)[1:]
truth = next(iter(case.true_curves(plane)), None)  # None for a scan of your own
player = widgets.balloon(outer, inside, background=bone.voxels[plane], truth=truth, px=case.px)
player.set(preset="tangent pressure: k from the ends", step=300)

# %% [markdown]
# **Predict, then move, then explain.** What happens to the curve if you choose the preset *paper* (the fixed pressure
# k = 0.062), and then make the pressure `k` negative? Say it first, then try: with the controls, or in a new cell with
#
# - `player.set(preset="paper: k as set below")`
# - `player.set(pressure=-0.1)`
#
# <details>
# <summary>Answer</summary>
#
# The paper's pressure is the same for every gap, and for this one it is too weak: the curve comes out too flat, 3.8 px
# high; the pressure from the ends made it 7.2, a little above the true bone. With k = -0.1 the wind blows the other
# way, and the curve sinks below the chord. Each end holds its tangent over about one snaxel (a dot of the curve) only;
# further on the wind wins. So the curve sags like a rope: next to the steeper end it is still 0.6 px above the chord,
# and further on 2.8 px below. The energy falls at first (from 165.5 to 158.9 px2, step 38) and then *rises* (to 160.3):
# energy is what the bent and stretched curve holds, and the wind does work on it. Lesson 04 has this account, and tells
# which `k` fits and why.
#
# </details>
#
# *The numbers of this answer:*

# %% tags=["nbval-check-output"]
again = widgets.balloon(outer, inside)
print(again.set(preset="tangent pressure: k from the ends", step=300).view.line)
again.set(preset="paper: k as set below")
for k, step in ((0.062, 300), (-0.1, 0), (-0.1, 38), (-0.1, 300)):
    print(again.set(pressure=k, step=step).view.line)

# %% [markdown]
# ## 5. All slices (stage 4), and the surface (stage 5)
#
# `design` closes the whole hole so: it lets curves bulge in many slices, fills between them, and wraps the filled
# voxels in triangles. Its slices are not those of the scan, as in section 4 and in the paper, but planes through the
# hole in six directions. Lesson 05 shows why this comes nearer (`axial=True` would take the scan's own). The key of the
# picture calls this method *slicewise*.
#
# *Can be built* means: the surface is closed, all its triangles face outward, and no two pass through each other
# (lesson 06).

# %% tags=["nbval-check-output"]
prosthesis = cn.design(bone, openings)
report = cn.check_mesh(prosthesis.mesh)
print(
    f"{report.n_faces} triangles, {report.volume / 1000:.1f} cm3, can be built: {report.sound}"
)

# %% [markdown]
# ## 6. How good is it?
#
# For a synthetic head we know the bone that is missing. **Dice** (DSC in tables) says how well two masks overlap (1 is
# perfect). The **95th percentile of the surface distance** (HD95) says how far apart the surfaces are, in mm, leaving
# out the worst one in twenty.

# %% tags=["nbval-check-output"]
if case.truth is not None:
    score = cn.score(prosthesis.patch, case.truth, bone)
    print(f"Dice {score.dice:.3f}, 95 % of the surface within {score.hd95:.2f} mm")

# %% tags=["nbval-check-output"]
cn.show(bone, prosthesis)

# %% [markdown]
# *In a live notebook and on the site this head turns with the mouse.* The letters S and I are up (superior) and down
# (inferior). Its top is flat because the slices are 2.5 mm
# apart (section 1): the highest slice with bone is a disc, and there is nothing between it and the next. The flat spot
# under the hole is the outermost column of voxels in the same way.
#
# That is the whole way: a scan went in, a solid came out. Here it is in one picture, drawn from what this notebook
# made. Each stage has the name of its module in `cranio_nb.stages`; the frame in the second picture is what the next
# three show from near by: one slice of the scan, as in section 4.

# %% tags=["nbval-check-output"]
diagrams.pipeline(ct, bone, openings[0], prosthesis)

# %% [markdown]
# The rest of the course asks at each step: *why does this work, when does it fail, and how do we know?*
#
# ## A mistake to make once
#
# What if bone began at 4000 HU, more than any voxel has? The package says what it found and what to do,
# rather than going on with nothing.

# %% tags=["raises-exception"]
cn.segment(ct, threshold=4000)

# %% [markdown]
# ## Exercises
#
# Each check prints one line: your points, and what is wrong, as exactly as it can. It never stops your notebook. Stuck?
# Ask for a hint: `check.exercise("0.1", volume_cm3, hint=1)`, then 2, then 3.
#
# **Exercise 0.1.** How much material does a prosthesis need? Write a function that takes a mask and the spacing of its
# voxels in mm (three numbers, which may all differ), and returns the volume in cm3.


# %% tags=["solution"]
def volume_cm3(mask, spacing):
    """Volume of a mask in cm3; spacing is mm between voxels along (plane, row, col)."""
    return mask.sum() * np.prod(spacing) / 1000


# %% tags=["check", "nbval-check-output"]
check.exercise("0.1", volume_cm3)

# %% [markdown]
# **Exercise 0.2.** Write Dice's coefficient: twice the number of voxels that two masks share, over the sum of their
# sizes. Why twice? Because two equal masks should give 1. At least one of the two masks is not empty, so you never
# divide by 0.


# %% tags=["solution"]
def dice(a, b):
    """Dice's coefficient of two bool masks, 0 to 1."""
    return 2 * (a & b).sum() / (a.sum() + b.sum())


# %% tags=["check", "nbval-check-output"]
check.exercise("0.2", dice)

# %% [markdown]
# ## Summary
#
# - A scan is a box of HU; a bone mask says which voxels are bone.
# - In each slice two curves continue the bone across the gap; between them lies the prosthesis.
# - A result without a measure is a picture. We measure overlap and distance in mm.
#
# | paper | code | unit |
# |---|---|---|
# | CT number | `ct.voxels` | HU |
# | bone | `cn.segment` | mask |
# | end points, tangents | `feature_extraction.find_gap_ends` -> `GapEnds` | px |
# | balloon | `deformable_model.inflate` | px |
# | prosthesis volume | `Prosthesis.patch` | mask |
# | digital model | `Prosthesis.mesh` | mm |
#
# **Further reading.** Sanan and Haines, *Repairing holes in the head: a history of cranioplasty*, Neurosurgery 40
# (1997). The AutoImplant challenges (MICCAI 2020 and 2021) compare many automatic methods.
