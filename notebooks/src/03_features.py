# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 03 Features: where the gap ends, and which way the bone was going
#
# The balloon of the next lesson needs four numbers for each gap: where it ends (two points) and in which direction
# the bone was going there (two tangents). This lesson gets them from a slice of bone.
#
# **After this lesson you can**
# - compute boundary, skeleton and convex hull of a slice and explain what each is for;
# - part the boundary into an outer and an inner curve with the paper's trick;
# - fit a tangent, and explain what `skip` and `reach` trade against each other.
#
# **Time:** 45 minutes (text 20, questions 10, exercises 15). **You need:** lesson 02 (a bone mask).
#
# **From the paper:** section 2, Figures 2 and 3.

# %%
import numpy as np
from scipy import ndimage
from scipy.spatial import ConvexHull

from cranio_nb import check, classroom, features, lesion, segment, widgets
from cranio_nb.curves import ChordFrame

# %% [markdown]
# ## Parameters
#
# | name | meaning | unit | paper |
# |---|---|---|---|
# | `skip` | boundary left out next to the gap | px along the bone | 10 points |
# | `reach` | boundary that carries the tangent, after that | px along the bone | not given |
#
# *The switch:* `"full"` for the paper's size, or `classroom.load(scan="path/to/your/scan")`.

# %%
case = classroom.load("class")
bone = segment.segment(case.ct)
opening = lesion.find(bone)[0]
plane = classroom.bridged_plane(bone, opening, skip=10, reach=10)
mask, px = bone.voxels[plane], case.px

# %% [markdown]
# ## 1. Boundary, skeleton, hull
#
# - **Boundary B**: pixels of bone that touch what is not bone.
# - **Skeleton**: the middle line of the bone, one pixel thin.
# - **Hull S**: the smallest convex region that holds the skeleton.
#
# **Predict.** The skeleton runs in the *middle* of the bone. Which part of the boundary lies inside its hull, the
# outer or the inner one?

# %% tags=["nbval-check-output"]
seen = features.slice_features(mask)
fig, (left, right) = classroom.axes(2, height=4.4)
classroom.show_mask(left, mask, px=px, title="bone, spine, hull")
spine = seen.skeleton[0]
corners = spine[ConvexHull(spine).vertices]
classroom.show_curve(left, spine, px=px, line=0, label="spine")
classroom.show_curve(left, [*corners, corners[0]], px=px, line=1, label="hull S")
left.legend(loc="center")
classroom.show_points(right, seen.outer, px=px, colour="#0072B2", label="outer: B without S")
classroom.show_points(right, seen.inner, px=px, colour="#D55E00", label="inner: B and S")
right.set(xlim=left.get_xlim(), ylim=left.get_ylim(), aspect="equal", xlabel="mm")
right.legend(loc="center")
alt = "Left: an open ring of bone, its middle line and hull. Right: its two boundaries."
classroom.picture(fig, alt, f"boundary: {len(seen.outer)} px outer, {len(seen.inner)} px inner")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# The hull reaches out to the middle line. What lies further out than the middle line is outside: the outer boundary,
# **B - S**. What lies further in is in the hull: the inner boundary, **B and S**. One convex hull parts the curves,
# and nobody had to say where inside is. It works because a skull is nearly convex: a deep dent of the bone would end up
# in the hull.
#
# </details>
#
# *A slip worth knowing:* read literally, the paper's "B and S" with S a *curve* would be almost empty. S must be the
# filled hull, as here.
#
# ## 2. The ends
#
# The gap ends where the skeleton ends. But a squarely cut bone has two corners there, and the skeleton forks into
# both. Real bone adds spurs. So we take the **longest path** through the skeleton, measured along it, and cut off
# what runs into a corner.
#
# ## 3. The tangents
#
# At the very end of the bone the boundary turns round the corner into the cut face. Its direction there says nothing
# about the skull. So the first pixels are left out (`skip`), and a line is fitted to the next ones (`reach`).
#
# **Predict, then move, then explain.** Move `skip` to 0: what do the tangents do? Then move `reach` to 2 mm, and
# to 40 mm.

# %% tags=["nbval-check-output"]
widgets.features(bone, plane, opening=opening.opening)

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# - `skip` = 0: pixels of the cut face join the fit and turn the line.
# - `reach` small: a few pixels of a staircase; the line jumps from slice to slice (noise).
# - `reach` large: the bone is curved, and the line shows the direction in the *middle* of the neighbourhood, not at
#   the end (bias). Both errors bend the balloon.
#
# </details>
#
# ## 4. How large are these errors?
#
# For a synthetic head the true angles are known in closed form. We measure angles above the chord, as the paper
# does: theta0 at one end, theta1 (obtuse) at the other.

# %% tags=["nbval-check-output"]
inside = bone.to_voxel(opening.head_centre)[1:]


def angles(skip, reach):
    outer, _ = features.gap_ends(seen, opening.opening.voxels[plane], skip=skip, reach=reach)
    return np.degrees(ChordFrame.of(outer, inside).end_angles(outer))


print("degrees                   theta0  theta1")
for skip, reach in ((0, 10), (3, 10), (10, 10), (3, 6), (3, 25)):
    theta0, theta1 = angles(skip, reach)
    print(f"skip {skip:2} px, reach {reach:2} px: {theta0:7.1f} {theta1:7.1f}")
for theta0, theta1 in case.true_angles(plane)[:1]:
    print(f"closed form:            {theta0:8.1f} {theta1:7.1f}")

# %% [markdown]
# Compare with the closed form, and mind one thing: with a large `skip` the gap is also *wider*, for it begins at the
# first pixel that is used, and a wider gap in a round skull has steeper ends. So part of the difference is no error.
# With radius R and chord L a circle has sin theta = L / (2 R) (you will derive this in exercise 10.2).
#
# **Question.** The paper leaves out "10 points". On a scan with pixels half as large, is this the same?
#
# <details>
# <summary>Answer</summary>
#
# No: 10 px of 0.45 mm are 4.5 mm, 10 px of 0.9 mm are 9 mm. A length of the patient should be given in mm. The
# sliders above do so, and so do the options of `slicewise.design`.
#
# </details>
#
# ## A mistake to make once
#
# Not every slice that the hole touches is an open ring: near its upper and lower end only part of the thickness is
# missing, or nothing. A closed ring has no ends, and the package says so. (Lesson 05 has the paper's answer for these.)

# %% tags=["raises-exception"]
closed = features.slice_features(bone.voxels[opening.planes[0] - 4])
features.gap_ends(closed)

# %% [markdown]
# ## Exercises
#
# **Exercise 3.1.** The boundary. Return the pixels of bone that have at least one pixel that is not bone among their
# four neighbours. What lies outside the image is not bone.


# %% tags=["solution"]
def boundary(bone):
    """Boundary pixels of a bool mask, as a bool mask."""
    return bone & ~ndimage.binary_erosion(bone)


# %% tags=["check", "nbval-check-output"]
check.exercise("3.1", boundary)

# %% tags=["expected"]
fig, (ax,) = classroom.axes(height=4.0)
classroom.show_mask(ax, boundary(mask), px=px, colour="#0072B2", title="boundary of the slice")
alt = "A thin closed outline: the boundary of a ring of bone that is open at one side."
classroom.picture(fig, alt, f"{boundary(mask).sum()} boundary pixels")

# %% [markdown]
# **Exercise 3.2.** The tangent. Fit a line to points of shape (n, 2) and return its direction as (row, col). The fit
# must work for lines in *any* direction, so `np.polyfit` will not do: it measures distances along one axis only.


# %% tags=["solution"]
def tangent(points):
    """Direction (row, col) of the line that lies nearest to points (n, 2)."""
    return np.linalg.svd(points - points.mean(axis=0))[2][0]


# %% tags=["check", "nbval-check-output"]
check.exercise("3.2", tangent)

# %% [markdown]
# **Exercise 3.3.** The way along the bone. `skip` and `reach` are lengths *along* the skeleton. Given its ordered
# points (n, 2), return for each point the length from the first point to it.


# %% tags=["solution"]
def arc_length(points):
    """Length along a polyline up to each of its points, shape (n,), starting with 0."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


# %% tags=["check", "nbval-check-output"]
check.exercise("3.3", arc_length)

# %% [markdown]
# ## Summary
#
# - The hull of the skeleton parts the boundary into outer (B - S) and inner (B and S).
# - Ends come from the longest path of the skeleton; tangents from boundary pixels near them.
# - `skip` keeps the cut face out. `reach` trades noise against bias.
#
# | paper | code | unit |
# |---|---|---|
# | B | `SliceFeatures.boundary` | px |
# | skeleton | `SliceFeatures.skeleton` | px |
# | S | `SliceFeatures.hull` | half-planes |
# | B - S, B and S | `.outer`, `.inner` | px |
# | 10 points | `features.PAPER_SKIP` | px |
# | theta0, theta1 | `ChordFrame.end_angles` | rad |
#
# **Further reading.** Zhang and Suen, *A fast parallel algorithm for thinning digital patterns*, CACM 27 (1984).
# Golub and Van Loan, *Matrix Computations*, the chapter on total least squares.
