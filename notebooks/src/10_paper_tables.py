# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 10 The paper's tables, remade
#
# The paper prints three tables and ten figures. Here is what the same method gives on a head whose truth is known, set
# beside the printed numbers; and what the improved defaults give. The heads differ, so the numbers *should* differ. The
# question is whether they tell the same story.
#
# **After this lesson you can**
# - remake Tables 1 to 3 from a run's record;
# - tell what of a published number depends on the data and what on the method;
# - read the geometry of the authors' lesion off their table of angles.
#
# **Time:** 35 minutes (text 15, questions 10, exercises 10). **You need:** lessons 04 and 07.
#
# **From the paper:** Tables 1, 2 and 3. Table 3 has a third row, for the method of You and others (2009), which the
# authors compare theirs with. It and the reflection have their turn in lesson 08.

# %%
import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from cranio_nb import check, classroom, lesion, plot, segment, tables, widgets
from cranio_nb.methods import slicewise
from cranio_nb.run import check_truth
from data_synth import phantom_case

# %% [markdown]
# ## Parameters
#
# | name | the paper's preset | default |
# |---|---|---|
# | slices | planes of the scan | fans in 6 directions |
# | pressure | 0.062 | follows from the tangents |
# | snaxels | 21 | 41 |
# | surface | marching cubes | smoothed within half a voxel |
#
# *The switch:* `"full"` has the paper's 512 x 512 x 68 voxels and takes a minute or so.

# %%
case = classroom.load("class")
bone = segment.segment(case.ct)
openings = lesion.find(bone)
paper = slicewise.design(bone, openings, **slicewise.paper_options(bone))
ours = slicewise.design(bone, openings)

# %% [markdown]
# ## Tables 1 and 2: angles and steps
#
# **Predict.** The paper's outer theta0 goes from 4 to 22 degrees. In which slices of a round hole are the angles small?
# Then look at ours, slice by slice.

# %% tags=["nbval-check-output"]
counts = tables.count_statuses(paper.record["slices"])
print(
    f"{counts['balloon']} slices by balloons (paper: 20), "
    f"{counts['hull']} by the hull (paper: 3)"
)

# %% tags=["nbval-check-output"]
found = tables.balloon_ranges(paper.record["slices"])
print("                 paper           here")
for side, rows in tables.PAPER_BALLOONS.items():
    for key, (low, high) in rows.items():
        here = found[side][key]
        print(f"{side} {key:7} {low:6g} to {high:<6g} {here[0]:6.0f} to {here[1]:<6.0f}")

# %% tags=["nbval-check-output"]
balloons = [s for s in paper.record["slices"] if s["status"] == "balloon"]
for key in ("theta0", "theta1"):
    print(f"outer {key}, slice by slice:", *(f"{s[key][0]:.0f}" for s in balloons))
for i, (side, rows) in enumerate(tables.PAPER_BALLOONS.items()):
    above = sum(s["n_iter"][i] > rows["n_iter"][1] for s in balloons)
    print(f"{side}: {above} of {len(balloons)} slices take more steps than the paper's largest")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# In its first and last slices, where the gap is short. On a circle the angle follows from the gap (exercise 10.2):
# with a radius of 80 mm an angle of 22 degrees means a gap of 60 mm, and 4 degrees one of 11 mm.
#
# </details>
#
# Angles of 180 - theta1 mirror those of theta0: the hole is about symmetric. The exception is the last bridged slice,
# whose outer theta1 is 199 degrees: more than 180 means that the curve has to arrive from *inside* the head.
# There the cutter slanted the bone, and the line was fitted to the slant (lesson 05, slice 44).
#
# The number of steps depends on `dt`, which the paper does not give. With dt = 1 most of our slices take more steps
# than the paper's largest; whether their time step was larger or their stop earlier, we cannot tell.
#
# ## Table 3: distances
#
# The paper's distances are in voxels against a *mirrored* skull; ours are against the bone that was really removed. Two
# designs stand between the paper's preset and the default: the preset with `k` from the tangents, and the default on
# axial slices.

# %%
own_k = slicewise.paper_options(bone) | {"pressure": None}
designs = {
    "paper's preset": paper,
    "its k from ends": slicewise.design(bone, openings, **own_k),
    "default, axial": slicewise.design(bone, openings, axial=True),
    "default": ours,
}

# %% tags=["nbval-check-output"]
if case.truth is not None:
    print("voxels                    min   max   mean  std")
    for name, design in designs.items():
        for side, s in check_truth(design, case.truth, bone, openings[0]).table3.items():
            print(f"{name:17} {side} {s.min:5.2f} {s.max:5.2f} {s.mean:5.2f} {s.std:5.2f}")
for side, s in tables.PAPER_DISTANCES.items():
    print(f"printed {side:15} {s.min:5.2f} {s.max:5.2f} {s.mean:5.2f} {s.std:5.2f}")

# %% [markdown]
# **Question.** With the paper's own settings we come out *worse* than the paper. Did the authors cheat?
#
# <details>
# <summary>Answer</summary>
#
# No. Their k = -0.062 was chosen for their lesion, and a `k` fits one width of gap (lesson 04). Our head has other
# gaps, other pixels and another `skip` in mm (10 pixels of 0.9 mm are 9 mm). Let `k` follow from the tangents, and
# the same slices come much nearer: 2.25 falls to 0.83 outside, 2.01 to 1.24 inside. A shorter `skip` brings 0.43 and
# 0.74, the fans the rest. So the constant explains most. The idea was good; the constant was local.
#
# </details>
#
# ## Figure 5: one slice, both ways
#
# First a plane of the scan with the paper's constant. Then the middle page of the default's first fan: another plane,
# so the two gaps are not of the same length. In both, blue belongs to the outer boundary and orange-red to the inner
# one: dots are the boundary, a dashed line is the start curve, a full line the balloon at rest. Rings are the ends of
# the gap, green arrows the tangents there; light blue is the patch.

# %% tags=["nbval-check-output"]
sliced = paper.working[0]
bridged = [s for s in sliced.slices if s.status == "balloon"]
middle = bridged[len(bridged) // 2]
figure = plot.slice_figure(sliced, middle, bone, paper.patch, skeleton=True)
alt = "The paper's preset: both balloons cross the gap flatter than the skull; patch in blue."
classroom.picture(figure, alt, "steps " + ", ".join(str(n) for n in middle.values["n_iter"]))

# %% tags=["nbval-check-output"]
fan = ours.working[0]
middle = fan.slices[len(fan.slices) // 2]
figure = plot.slice_figure(fan, middle, bone, ours.patch)
alt = "The default: both curves go on as the bone does; the patch is as thick as the bone."
classroom.picture(figure, alt, "steps " + ", ".join(str(n) for n in middle.values["n_iter"]))

# %% [markdown]
# Look at the dashed lines of the first picture: the *start* continues the skull better than the balloon that the
# paper's constant makes of it. Over all slices with a balloon:

# %% tags=["nbval-check-output"]
for i, side in enumerate(("outer", "inner")):
    off = []
    for s in bridged:
        true = case.true_curves(s.plane + max(openings[0].planes[0] - 2, 0))
        if true:
            dense = [ndimage.zoom(c[i], (20, 1), order=1) for c in (s.start, s.curves)]
            off.append([cKDTree(c).query(true[i])[0].mean() * case.px for c in dense])
    if off:
        print(side, "start {:.1f} mm off, balloon {:.1f} mm".format(*np.mean(off, axis=0)))

# %% [markdown]
# And why "steps 1, 1" for the default? Its start is a spiral that follows from both ends, with the pressure that
# holds just this spiral. So the balloon starts at rest, and stops after one look.
#
# ## Your turn: the whole method under sliders
#
# Every parameter at once, measured against the truth each time. **Predict** before you move: which *single* change
# from the default costs most? Is there one that does better? (DSC is the Dice coefficient; border DSC is Dice over
# the voxels within 10 mm of bone only. `panel.parameters` is what `cranio-nb design --params` takes as JSON.)

# %% tags=["nbval-check-output"]
panel = widgets.tuner(phantom_case("tiny"))
panel

# %% tags=["nbval-check-output"]
start = dict(panel.values)
axial = {"slices": "axial, as in the paper"}
changes = [{"own": True}, {"tension": 0.1}, axial, {"skip": 0}, {"reach": 4}]
for change in ({}, *changes, {"n_snaxels": 11}, {"skip": 5}):
    line = panel.set(**start | change).view.line
    print(f"{change or 'default'!s:38} {line[:9]}")
_ = panel.set(**start)

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# What breaks the balance of pressure and tension. With k = 0.062 by hand in place of the pressure that follows from
# the ends DSC falls from 0.955 to 0.417. A tension of 0.1 is worse still, 0.145: `k` is worked out for a tension of
# 1, and a tenth of it no longer holds the balloon back. (The ends of the `k` slider spoil everything.) Then come
# slicing along the scan's own planes (0.670), fitting tangents right at the cut (`skip` 0: 0.829), and a `reach` of 4
# mm, too short to carry a tangent (0.892). The number of snaxels hardly matters: 11 do as well as 41.
#
# A `skip` of 4 to 6 mm does *better* than the default (0.964 to 0.969), on this one coarse head. But a value chosen
# on one head fits that head, as the paper's `k` did.
#
# </details>

# %% [markdown]
# ## A mistake to make once
#
# The text of the paper takes 135 and 147 for the *mean* number of steps; its tables list them as the largest. Computing
# a mean settles such things:

# %% tags=["raises-exception"]
steps = np.array([s["n_iter"] for s in paper.record["slices"] if s["status"] == "balloon"])
assert steps.mean() == steps.max(), (
    f"mean {steps.mean():.0f}, largest {steps.max()}: not the same thing"
)

# %% [markdown]
# ## Exercises
#
# **Exercise 10.1.** A row of Table 1 or 2. `slices` is a list of records such as
# `{"status": "balloon", "theta0": [8.5, 12.0], "n_iter": [44, 61]}`, with values for outer (0) and inner (1). Return
# the smallest and largest value of `key` over the slices that have a balloon.


# %% tags=["solution"]
def table_row(slices, key, side):
    """Smallest and largest value of a key on one side, over the slices with balloons."""
    values = [s[key][side] for s in slices if s["status"] == "balloon"]
    return min(values), max(values)


# %% tags=["check", "nbval-check-output"]
check.exercise("10.1", table_row)

# %% [markdown]
# **Exercise 10.2.** A gap of chord L in a circle of radius R (both in mm): return theta0 in degrees.


# %% tags=["solution"]
def end_angle(chord, radius):
    """Angle between the chord and the tangent at its end, degrees."""
    return np.degrees(np.arcsin(chord / 2 / radius))


# %% tags=["check", "nbval-check-output"]
check.exercise("10.2", end_angle)

# %% tags=["expected"]
fig, (ax,) = classroom.axes(height=3.0)
chords = np.linspace(5, 100, 40)
curves = {f"R = {r} mm": [end_angle(c, r) for c in chords] for r in (70, 80, 90)}
classroom.plot_lines(ax, chords, curves, xlabel="gap (mm)", ylabel="theta0 (degrees)")
ax.axhspan(4, 22, color="#999999", alpha=0.2)
alt = "Three rising curves of angle against gap; a grey band from 4 to 22 degrees."
classroom.picture(fig, alt, f"80 mm: {end_angle(60, 80):.1f} degrees for a gap of 60 mm")

# %% [markdown]
# ## Summary
#
# - Same steps, same angles, same story; the constant `k` is what does not carry over.
# - Minimum and maximum hide the middle; "mean" and "max" are easily confused, even in print.
#
# | paper | code |
# |---|---|
# | Tables 1, 2 | `tables.balloon_ranges`, `tables.PAPER_BALLOONS` |
# | Table 3 | `evaluate.distance_stats`, `tables.PAPER_DISTANCES` |
# | 23 slices, 3 by hull | `tables.count_statuses` |
#
# **Further reading.** Ioannidis, *Why most published research findings are false*, PLoS Medicine 2 (2005); then
# Sandve and others, *Ten simple rules for reproducible computational research*, PLoS Computational Biology 9 (2013).
