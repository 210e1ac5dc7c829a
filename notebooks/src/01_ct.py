# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 01 CT: numbers with a place in the patient
#
# A CT is not a picture. It is a box of measurements, and each has a place in the patient. Most bugs in medical image
# processing are here: files in the wrong order, a forgotten slope, a distance between slices taken from the wrong
# header field. This lesson reads a DICOM folder and then breaks it on purpose.
#
# **After this lesson you can**
# - turn stored values into Hounsfield units, and Hounsfield units into grey levels (windowing);
# - turn a voxel index into millimetres, and say why the distance between slices comes from positions;
# - predict what a careful reader does with shuffled, tilted and missing slices.
#
# **Time:** 50 minutes (text 20, questions 10, exercises 20). **You need:** lesson 00; matrices.
#
# **From the paper:** section 2, first paragraph, and Figure 1 (a).

# %%
import tempfile
from pathlib import Path

import numpy as np
import pydicom

from cranio_nb import check, classroom, widgets
from cranio_nb.readers import read_ct
from data_synth import phantom_case, write_dicom

# %% [markdown]
# ## 1. A folder of files
#
# A CT series is a folder with one file for each slice. We write one for a synthetic head, with file names in
# a random order, as scanners like to do. (*The switch:* set `folder` to a DICOM folder of your own.)

# %% tags=["nbval-check-output"]
head = phantom_case("class")
folder = Path(tempfile.mkdtemp()) / "ct"
write_dicom(folder, head.hu, head.affine, shuffle_names=True)
files = sorted(folder.iterdir())
one = pydicom.dcmread(files[0])
print(f"{len(files)} files; the first holds slice at {one.ImagePositionPatient} mm")
print(f"pixels {one.PixelSpacing} mm, {one.Rows} x {one.Columns}")

# %% [markdown]
# ## 2. Stored values and Hounsfield units
#
# The file stores integers. **HU = slope x stored + intercept.** Forget the intercept and all is 1024 too high: air
# turns into bone. HU are anchored at water (0) and air (-1000); the paper gives bone as 400 to 1000, but dense bone
# goes well past 1000, so this package sets no upper bound.

# %% tags=["nbval-check-output"]
stored = one.pixel_array
print(
    f"stored {stored.min()} to {stored.max()}, "
    f"slope {one.RescaleSlope}, intercept {one.RescaleIntercept}"
)
ct, report = read_ct(folder)
print(
    f"HU {ct.voxels.min()} to {ct.voxels.max()}, "
    f"{ct.shape} voxels of {np.round(ct.spacing, 2)} mm"
)

# %% [markdown]
# ## 3. Windowing
#
# HU span some 4000 values; an eye tells perhaps 100 greys apart. So we choose a **window**: below centre - width / 2
# all is black, above centre + width / 2 all is white.
#
# **Predict, then move, then explain.** Where do you put centre and width to see (a) only bone, (b) the brain against
# the skin? Try it.

# %% tags=["nbval-check-output"]
case = classroom.load("class")
widgets.ct_viewer(case.ct)

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# (a) A centre near 800 and a width near 800: everything soft goes black. (b) A centre near 40 and a width near 80:
# brain (35 HU) and soft tissue (50 HU) part, all bone is plain white. The data are the same; only the map to grey
# has changed.
#
# </details>
#
# ## 4. Geometry: the affine
#
# Where is voxel (plane, row, column)? A matrix with four rows and columns says it: three columns of steps and one
# origin.
#
# $$(x, y, z)^T = A_{3\times3}\,(p, r, c)^T + \text{origin}$$
#
# DICOM's axes are **LPS**: x to the patient's left, y to the back (posterior), z up (superior).

# %% tags=["nbval-check-output"]
print(np.round(ct.affine, 2))
print("voxel (10, 64, 64) lies at", np.round(ct.to_world([10, 64, 64]), 2), "mm")

# %% [markdown]
# Voxels are rarely cubes. Forget it, and the head is squashed:

# %% tags=["nbval-check-output"]
middle = ct.voxels[::-1, :, ct.shape[2] // 2]
ratio = ct.spacing[0] / ct.spacing[1]
fig, (wrong, right) = classroom.axes(2, height=3.0)
look = {"cmap": "gray", "vmin": -700, "vmax": 1300}
wrong.imshow(middle, aspect=1, **look)
right.imshow(middle, aspect=ratio, **look)
wrong.set(title="voxels drawn as squares", xlabel="row", ylabel="plane")
right.set(title="in true proportion", xlabel="row", ylabel="plane")
alt = "The same side view of a head twice: squashed to half its height, and in true proportion."
classroom.picture(fig, alt, f"one plane is as high as {ratio:.2f} rows")

# %% [markdown]
# ## 5. Breaking it
#
# What should a reader do with a folder that is not right? Three answers are possible: read it rightly, correct it and
# say so, or refuse it. The fourth, *silently wrong*, is the one to fear. We try three faults.
#
# **Predict** for each which answer you would want: (a) file names in random order, (b) a scanner that leans by 15
# degrees (gantry tilt), (c) one file missing in the middle.

# %% tags=["nbval-check-output"]
tilted = phantom_case("class", tilt_deg=15.0)
leaning = Path(tempfile.mkdtemp()) / "ct"
write_dicom(leaning, tilted.hu, tilted.affine)
for name, path in (("shuffled", folder), ("tilted", leaning)):
    volume, report = read_ct(path)
    print(f"{name}: {volume.shape}, corners off by {report.corner_error:.3f} mm")
    for finding in report.findings:
        print(f"   {finding.severity}: {finding.message}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# (a) Slices are sorted by their *position*, never by name or number: nothing to correct. (b) The slices slide over
# each other; the reader moves them back and says so. (c) See below: it is refused, because nobody can know what was
# in the missing slice.
#
# </details>
#
# ## A mistake to make once
#
# Files get lost when a folder is copied. A reader that takes `SliceThickness` for the distance and stacks what is there
# would make the head 2.5 mm shorter, and the prosthesis too.

# %% tags=["raises-exception"]
by_height = {pydicom.dcmread(f).ImagePositionPatient[2]: f for f in folder.iterdir()}
by_height[sorted(by_height)[20]].unlink()
read_ct(folder)

# %% [markdown]
# If you know what you do, you may allow it by name, and the report keeps it on record:

# %% tags=["nbval-check-output"]
volume, report = read_ct(folder, allow=["gap_fill"])
for finding in report.findings:
    print(f"{finding.severity}: {finding.message}")

# %% [markdown]
# ## Exercises
#
# **Exercise 1.1.** Windowing. Return grey levels from 0 to 255 (floats or integers).


# %% tags=["solution"]
def window(hu, centre, width):
    """Grey levels 0 to 255 of HU for a window of given centre and width."""
    low = centre - width / 2
    return np.clip((hu - low) / width, 0, 1) * 255


# %% tags=["check", "nbval-check-output"]
check.exercise("1.1", window)

# %% tags=["expected"]
fig, axes = classroom.axes(3, height=3.2)
for ax, (name, centre, width) in zip(
    axes, [("wide", 300, 2000), ("bone", 800, 800), ("brain", 40, 80)], strict=True
):
    grey = window(case.ct.voxels[38].astype(float), centre, width)
    ax.imshow(grey, cmap="gray", vmin=0, vmax=255)
    ax.set(title=f"{name}: {centre} / {width} HU", xticks=[], yticks=[])
alt = "One slice in three windows: skull and skin; bone alone; brain grey, bone white."
classroom.picture(fig, alt, "windows: wide, bone, brain")

# %% [markdown]
# **Exercise 1.2.** From index to millimetres. Use the affine (4, 4) and an index (plane, row, column).


# %% tags=["solution"]
def to_world(affine, index):
    """World (x, y, z) in mm of a voxel index (plane, row, column)."""
    return affine[:3, :3] @ index + affine[:3, 3]


# %% tags=["check", "nbval-check-output"]
check.exercise("1.2", to_world)

# %% [markdown]
# **Exercise 1.3.** The distance between slices. You get the positions (n, 3) of the slices in mm, in the order of the
# files, and the unit normal of the slices. Return the (median) distance between neighbours.


# %% tags=["solution"]
def slice_step(positions, normal):
    """Median distance in mm between neighbouring slices."""
    heights = np.sort(positions @ normal)
    return np.median(np.diff(heights))


# %% tags=["check", "nbval-check-output"]
check.exercise("1.3", slice_step)

# %% [markdown]
# ## Summary
#
# - HU = slope x stored + intercept; a window maps HU to grey and changes nothing else.
# - The affine gives every voxel its place. Distances between slices come from positions along the normal.
# - A good reader is right, or says what it corrected, or refuses.
#
# | paper, DICOM | code | unit |
# |---|---|---|
# | CT number | `Volume.voxels` | HU |
# | PixelSpacing | `Volume.spacing[1:]` | mm |
# | ImagePositionPatient, ImageOrientationPatient | `Volume.affine` | mm |
# | "512 x 512 x 68" | `Volume.shape` is (68, 512, 512) | voxels |
#
# **Further reading.** The DICOM standard, part 3, section C.7.6.2 (image plane module). The nibabel documentation,
# chapter "Coordinate systems and affines".
