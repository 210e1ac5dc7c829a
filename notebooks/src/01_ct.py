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
# A CT is not a picture. It is a box of measurements, and each has a place in the patient. Many bugs in medical image
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
import numpy as np
import pydicom

import cranio_nb as cn
from cranio_nb.teaching import check, classroom, pictures, widgets
from data_synth import write_dicom

# %% [markdown]
# ## 1. A folder of files
#
# A CT series is a folder with one file for each slice. We write one for a synthetic head, with file names in
# a random order, as scanners like to do. (*The switch:* for a DICOM folder of your own, put
# `import pathlib; folder = pathlib.Path("path/to/your/dicom")` in place of the first three lines. Your files are only
# read.)

# %% tags=["nbval-check-output"]
head = classroom.synthetic("class").phantom
folder = classroom.scratch_folder()
write_dicom(folder, head.hu, head.affine, shuffle_names=True)
files = sorted(folder.iterdir())
one = pydicom.dcmread(files[0])
print(f"{len(files)} files; the first holds slice at {one.ImagePositionPatient} mm")
print(
    f"pixels {one.PixelSpacing} mm, {one.Rows} x {one.Columns}, {one.SliceThickness} mm thick"
)

# %% [markdown]
# ## 2. Stored values and Hounsfield units
#
# The file stores integers. **HU = slope x stored + intercept.** Forget the intercept and all is 1024 too high: air
# looks like water, water and brain look like bone. HU are anchored at water (0) and air (-1000); the paper gives bone
# as 400 to 1000, but dense bone goes well past 1000, so this package sets no upper bound.
#
# The first file happens to hold a slice of the neck. It has no bone, so its HU end far below those of the whole scan.

# %% tags=["nbval-check-output"]
stored = one.pixel_array
slope, intercept = one.RescaleSlope, one.RescaleIntercept
hu = slope * stored + intercept
print(
    f"this slice: stored {stored.min()} to {stored.max()}, slope {slope}, intercept {intercept}"
)
print(f"this slice: {hu.min():.0f} to {hu.max():.0f} HU")
ct, report = cn.read_ct(folder)
print(f"all slices: {ct.voxels.min()} to {ct.voxels.max()} HU")
print(f"{ct.shape} voxels of {np.round(ct.spacing, 2)} mm")

# %% [markdown]
# ## 3. Windowing
#
# A scan holds thousands of different HU, a picture 256 greys (this scan's number is printed below). So we choose a
# **window**: below centre - width / 2 all is black, above centre + width / 2 all is white.
#
# **Predict, then move, then explain.** Where do you put centre and width to see (a) only bone, (b) the brain against
# the skin (soft tissue)? Try it, with the sliders or in a new cell with `viewer.set(centre=300, width=1500)` and your
# numbers.

# %% tags=["nbval-check-output"]
case = classroom.load("class")
print(f"{np.unique(case.ct.voxels).size} different HU; {2**8} greys in a picture of 8 bits")
viewer = widgets.ct_viewer(case.ct)
viewer

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# (a) `viewer.set(centre=800, width=800)`: everything soft goes black. (b) `viewer.set(centre=40, width=80)`: brain
# (35 HU) and soft tissue (50 HU) part, all bone is plain white. The picture is noisy, because the noise of the scan
# (12 HU here) is now a good part of all greys. The data are the same; only the map to grey has changed.
#
# </details>
#
# *The numbers of this answer,* measured in two places where there is one tissue only:

# %% tags=["nbval-check-output"]
if case.phantom is not None:
    middle_brain = case.ct.voxels[28:38, 110:146, 110:146]
    neck = case.ct.voxels[1, 110:146, 110:146]  # the slice of the neck of section 2
    for name, hu_there in (("brain", middle_brain), ("soft tissue", neck)):
        print(f"{name}: mean {hu_there.mean():.0f} HU, noise {hu_there.std():.0f} HU")

# %% [markdown]
# ## 4. Geometry: the affine
#
# Where is voxel (plane, row, column)? A matrix with four rows and columns says it: three columns of steps and one
# origin.
#
# $$(x, y, z)^T = A_{3\times3}\,(p, r, c)^T + \text{origin}$$
#
# The fourth row, 0 0 0 1, says nothing; with it one product with (p, r, c, 1) does both, step and origin. DICOM's axes
# are **LPS**: x to the patient's left, y to the back (posterior), z up (superior).

# %% tags=["nbval-check-output"]
print(np.round(ct.affine, 2))
print("voxel (10, 64, 64) lies at", np.round(ct.to_world([10, 64, 64]), 2), "mm")

# %% [markdown]
# Voxels are rarely cubes. Forget it, and the head is squashed. Both pictures have the same scale along the rows; A is
# the front, P the back, S above (superior), I below (inferior). The gap in the floor of the skull is natural: the
# spinal cord leaves there. The hole of lesson 00 lies at the left side, outside of this picture.

# %% tags=["nbval-check-output"]
middle = ct.voxels[:, :, ct.shape[2] // 2]
ratio = ct.spacing[0] / ct.spacing[1]
fig, (wrong, right) = pictures.axes(2, height=3.8)
look = {"cmap": "gray", "vmin": -700, "vmax": 1300, "origin": "lower"}  # plane 0 at the bottom
wrong.imshow(middle, aspect=1, **look)
right.imshow(middle, aspect=ratio, **look)
wrong.set(title="voxels drawn as squares", xlabel="row", ylabel="plane")
right.set(title="in true proportion", xlabel="row", ylabel="plane")
along_planes, along_rows, _ = ct.edges
for ax in (wrong, right):
    pictures.name_sides(ax, np.array([along_rows, -along_planes]))  # to the right, and down
alt = "The same side view of a head twice: squashed to a third of its height, and true."
pictures.picture(fig, alt, f"one plane is as high as {ratio:.2f} rows")

# %% [markdown]
# How far apart are two slices? The **unit normal** is the direction at right angles to rows and columns, of length 1.
# The **height** of a slice is how far it lies along it: height = position . normal. The difference of two heights is
# the distance. The header's ImageOrientationPatient holds both directions, three numbers each: the way along a row and
# the way down a column. Their cross product is the normal.

# %% tags=["nbval-check-output"]
across, down = np.array(one.ImageOrientationPatient, float).reshape(2, 3)
normal = np.cross(across, down)
position = np.array(one.ImagePositionPatient, float)
print(f"normal {normal}, height of the first file's slice {position @ normal:.2f} mm")

# %% [markdown]
# Do not take `SliceThickness` for this distance. In our files both are 2.5 mm (section 1), but a scanner may
# measure slices that are twice as thick as they lie apart, so that they overlap, or half as thick, with gaps between
# them.
#
# ## 5. Breaking it
#
# What should a reader do with a folder that is not right? Three answers are possible: read it rightly, correct it and
# say so, or refuse it. The fourth, *silently wrong*, is the one to fear. We try three faults.
#
# **Predict** for each which answer you would want: (a) file names in random order, (b) a scanner that leans by 15
# degrees (gantry tilt), (c) one file missing in the middle. (In the output stands the number that the header gives the
# series, and the **kernel**, which says how sharply the scanner turned its measurements into a picture: a soft one has
# less noise, a sharp one clearer edges.)

# %% tags=["nbval-check-output"]
tilted = classroom.synthetic("class", tilt_deg=15.0).phantom
leaning = classroom.scratch_folder()
write_dicom(leaning, tilted.hu, tilted.affine)
for name, path in (("shuffled", folder), ("tilted", leaning)):
    volume, report = cn.read_ct(path)
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
# *The numbers of (b).* The couch moves 2.5 mm from slice to slice, but the slices lean, so along their normal they are
# 2.5 x cos 15 = 2.41 mm apart. The last slice is moved by 40.8 mm, which is 45.3 rows, so the box needs 46 more: 302
# rows instead of 256. *Corners off* compares, for each slice, where its header puts the corners and where the finished
# box has them: 0 means that no slice has lost its place.
#
# </details>
#
# *The numbers of (b):*

# %% tags=["nbval-check-output"]
lean = np.radians(15)
n_slices, n_rows, _ = tilted.hu.shape
couch, row, _ = np.linalg.norm(tilted.affine[:3, :3], axis=0)  # mm: lengths of the steps
apart = couch * np.cos(lean)  # mm along the normal
slid = (n_slices - 1) * couch * np.sin(lean)  # mm, the last slice against the first
more = np.ceil(slid / row)
print(f"couch {couch:.1f} mm, slices {apart:.2f} mm apart;", end=" ")
print(f"moved by {slid:.1f} mm = {slid / row:.1f} rows,", end=" ")
print(f"so {more:.0f} rows more: {n_rows + more:.0f} instead of {n_rows}")

# %% [markdown]
# ## A mistake to make once
#
# Files get lost when a folder is copied. A reader that takes `SliceThickness` for the distance and stacks what is there
# would make the head 2.5 mm shorter, and a prosthesis across the gap too. We lose a file of a copy, so that `folder`
# stays whole.

# %% tags=["raises-exception"]
lossy = classroom.scratch_folder(copy_of=folder)
by_height = {pydicom.dcmread(f).ImagePositionPatient[2]: f for f in lossy.iterdir()}
by_height[sorted(by_height)[20]].unlink()
cn.read_ct(lossy)

# %% [markdown]
# If you know what you do, you may allow it by name, and the report keeps it on record:

# %% tags=["nbval-check-output"]
volume, report = cn.read_ct(lossy, allow=["gap_fill"])
for finding in report.findings:
    print(f"{finding.severity}: {finding.message}")

# %% [markdown]
# ## Exercises
#
# **Exercise 1.1.** Windowing. Return grey levels from 0 to 255 (floats or integers): exactly 0 at centre - width / 2
# and below, exactly 255 at centre + width / 2 and above, and rising evenly between.


# %% tags=["solution"]
def window(hu, centre, width):
    """Grey levels 0 to 255 of HU for a window of given centre and width."""
    low = centre - width / 2
    return np.clip((hu - low) / width, 0, 1) * 255


# %% tags=["check", "nbval-check-output"]
check.exercise("1.1", window)

# %% tags=["expected"]
fig, panels = pictures.slices(3, case.ct, height=3.6)
windows = [("wide", 300, 2000), ("bone", 800, 800), ("brain", 40, 80)]
for ax, (name, centre, width) in zip(panels, windows, strict=True):
    grey = window(case.ct.voxels[38].astype(float), centre, width)
    title = f"{name}: {centre} / {width} HU"
    pictures.show_hu(ax, grey, px=case.px, centre=127.5, width=255, title=title)
alt = (
    "One slice in three windows: skull and skin; bone alone; brain grey and noisy, bone white."
)
pictures.picture(fig, alt, "windows: wide, bone, brain")

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
# files (any order), and the unit normal of the slices (section 4). Return the median distance between neighbours. Why
# the median? One slice may be missing and another too close to its neighbour, and the rest should not pay for them.


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
