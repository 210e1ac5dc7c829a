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
# - read the geometry of the authors' opening off their table of angles.
#
# **Time:** 45 minutes (text 20, questions 15, exercises 10). **You need:** lessons 04 and 07.
#
# **From the paper:** Tables 1, 2 and 3, and all ten figures. A map at the end says where each of them is.

# %%
import numpy as np

import cranio_nb as cn
from cranio_nb.drawing import figures
from cranio_nb.evaluation import against_truth, paper_tables
from cranio_nb.teaching import check, classroom, pictures, widgets

# %% [markdown]
# ## Parameters
#
# | name | the paper's preset | default |
# |---|---|---|
# | slices | planes of the scan | fans in 6 directions |
# | `skip` | 4.5 mm, the paper's ten points | 1.5 mm |
# | pressure | 0.062 px per index squared | follows from the tangents |
# | snaxels | 21 | 41 |
# | surface | marching cubes | smoothed within half a voxel |
#
# *The switch:* `"full"` has the paper's 512 x 512 x 68 voxels and takes some minutes; or a scan of your own whose
# missing bone is known, as in lesson 07. The numbers in the text are those of `"class"`.

# %%
case = classroom.load("class", needs_truth=True)
bone, px = cn.segment(case.ct), case.px
openings = cn.find_openings(bone)
first = max(openings[0].planes[0] - 2, 0)  # plane of the first slice: two below the hole
preset = {"preset": "paper"}
paper = cn.design(bone, openings, **preset)
ours = cn.design(bone, openings)

# %% [markdown]
# ## Tables 1 and 2: angles and steps
#
# **Predict.** The paper's outer theta0 goes from 4 to 22 degrees. In which slices of a round hole are the angles small?
# Then look at ours, slice by slice.

# %% tags=["nbval-check-output"]
counts = paper_tables.count_statuses(paper.record["slices"])
print(
    f"{counts['balloon']} slices by balloons (paper: 20), "
    f"{counts['hull']} by the hull (paper: 3)"
)

# %% tags=["nbval-check-output"]
found = paper_tables.balloon_ranges(paper.record["slices"])
print("                 paper           here")
for side, rows in paper_tables.PAPER_BALLOONS.items():
    for key, (low, high) in rows.items():
        here = found[side][key]
        print(f"{side} {key:7} {low:6g} to {high:<6g} {here[0]:6.0f} to {here[1]:<6.0f}")

# %% tags=["nbval-check-output"]
balloons = [s for s in paper.record["slices"] if s["status"] == "balloon"]
for key in ("theta0", "theta1"):
    print(f"outer {key}, slice by slice:", *(f"{s[key][0]:.0f}" for s in balloons))
theta0, theta1 = np.mean([[s["theta0"][0], s["theta1"][0]] for s in balloons], axis=0)
print(f"on average outer theta0 {theta0:.0f}, 180 - theta1 {180 - theta1:.0f} degrees")
for i, (side, rows) in enumerate(paper_tables.PAPER_BALLOONS.items()):
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
# The second end is steeper than the first: the skull is rounder towards the back. The exception is the last bridged
# slice, whose outer theta1 is more than 180 degrees: there the curve has to arrive from *inside* the head. The cutter
# had slanted the bone, and the line was fitted to the slant (lesson 05, section 3).
#
# The number of steps depends on `dt`, which the paper does not give. With dt = 1 most of our slices take more steps
# than the paper's largest; whether their time step was larger or their stop earlier, we cannot tell.
#
# ## Table 3: distances
#
# The paper's distances are in voxels against a *mirrored* skull; ours are against the bone that was really removed. So
# the reflection, the paper's truth, can be a row itself (as it is in the paper: not bent to the rim). The first four
# rows are the preset and its two causes of error (lesson 05): ten points counted on our pixels, which are 9 mm, or the
# paper's 4.5 mm; the constant `k`, or one from the tangents. Then comes the default, on axial slices and in fans.
# Lesson 08 has the reflection and You's fill in detail. `thin-plate` and `dnurbs` are not in the paper's table; the
# second is what its last paragraph wishes for.

# %%
ways = {
    "skip 9 mm": preset | {"skip_mm": 10 * px},
    "paper's preset": preset,
    "9 mm, k from ends": preset | {"skip_mm": 10 * px, "pressure_mm": None},
    "its k from ends": preset | {"pressure_mm": None},
    "default, axial": {"axial": True},
    "default": {},
    "reflection": {"method": "reflection", "fit_rim": False},
    "You et al.": {"method": "you"},
    "thin-plate": {"method": "thin-plate"},
    "dnurbs": {"method": "dnurbs"},
}
designs = {name: cn.design(bone, openings, **options) for name, options in ways.items()}

# %%
true = against_truth.true_prosthesis(case.truth, bone, openings[0].head_centre)
seen = {
    name: against_truth.measure_against(design, true, bone) for name, design in designs.items()
}


def print_row(name, top, inner=None):
    """One method's rows of Table 3 side by side."""
    cells = [f"{s.min:6.2f} {s.max:5.2f} {s.mean:5.2f} {s.std:5.2f}" for s in (top, inner) if s]
    print(f"{name:17}", " |".join(cells))


# %% tags=["nbval-check-output"]
print("voxels             top: min   max  mean   std | inner: min   max  mean   std")
for name, one in seen.items():
    print_row(name, one.table3["outer"], one.table3["inner"])
printed = paper_tables.PAPER_DISTANCES
print_row("printed: theirs", printed["outer"], printed["inner"])
print_row("printed: You", printed["You et al."])

# %% [markdown]
# **Question.** With the paper's own settings we come out *worse* than the paper. Did the authors cheat?
#
# <details>
# <summary>Answer</summary>
#
# No. Two causes are in the first four rows. **Skip:** ten points are 4.5 mm on their pixels and 9 mm on ours; read the
# first row against the second. **k:** their -0.062 was chosen for their opening, and a `k` fits one width of gap (lesson
# 04); read the second row against the fourth. Each alone brings the mean down, and both together come nearest. Outside the
# constant weighs more, inside both weigh about the same. With both mended the outer mean is below the paper's; the inner one is not, as a gap's
# inner ends are harder to find. The default's shorter `skip` and the fans bring the rest. The idea was good; the numbers
# were local.
#
# The reflection comes very near here, as this head is nearly symmetric: on such a head the paper's truth would do. On a
# real one it would not (lesson 08), and part of the paper's own mean may be the mirror's. The default, the thin plate and
# dnurbs are all a fraction of a voxel off: at this size the grid decides between them.
#
# </details>
#
# **Question.** You's mean is 3.09 in the paper and 2.54 here, on another head. Is that good agreement, or chance? Measure
# the height of the cap that the flat fill leaves out.

# %% tags=["nbval-check-output"]
from_truth = against_truth.side_distances(
    true, designs["You et al."]
)  # from the true nodes to the fill
height = from_truth["outer"].max()
mean = seen["You et al."].distances["outer"].mean()
print(f"cap {height:.2f} mm high, mean {mean:.2f} mm: ratio {mean / height:.2f}")
for whose, row in (
    ("here", seen["You et al."].table3["outer"]),
    ("paper", printed["You et al."]),
):
    print(f"{whose}, in voxels: mean / max = {row.mean / row.max:.2f}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# You shows its bias: mean about half the cap height, 0.55 of it here. A flat lid under a cap gives a half (exercise
# 8.2); a rim that is not plane lets the film sag a little more. The paper's mean is 0.51 of its largest distance: same
# method, same flaw, while 3.09 itself only says how high the authors' cap was.
#
# Voxels are no cubes, so the ratio needs mm. With the paper's grid (`"full"`), where a plane is as high as 5.6 pixels,
# the ratio in mm is 0.53, but mean / max in voxels only 0.28: the nearest place one plane further is "one voxel" away.
# The paper's 0.51 suggests that its "voxel units" are pixels, or its voxels nearer to cubes. It does not say.
#
# </details>
#
# ## Figure 4: the frame of a balloon
#
# The middle slice of the paper's preset in the chord frame: ends on the axis, the cubic of eq. (3) as the start, the
# tangents at both ends.

# %%
sliced = paper.working[0]
bridged = [s for s in sliced.slices if s.status == "balloon"]
middle = bridged[len(bridged) // 2]
frame = cn.curves.ChordFrame.of(middle.ends[0], bone.to_voxel(openings[0].head_centre)[1:])
ends = frame.end_angles(middle.ends[0])

# %% tags=["nbval-check-output"]
fig, (ax,) = pictures.axes(height=1.9, width=8.0)
for curve, line, name in ((middle.start[0], "--", "start"), (middle.curves[0], "-", "at rest")):
    ax.plot(*(px * frame.to_chord(curve)).T, line, color=pictures.BLUE, label=name)
for x, angle, along in zip((0, px * frame.length), ends, (9, -9), strict=True):
    ax.plot([x, x + along], [0, along * np.tan(angle)], color=pictures.GREEN, lw=2)
ax.set(xlabel="x (mm)", ylabel="out (mm)", aspect="equal")
fig.legend(loc="outside right center", fontsize=8)
alt = "An arch over the x axis from 0 to L; short straight lines are the tangents at its ends."
line = "L = {:.0f} mm, angles {:.0f} and {:.0f} degrees"
pictures.picture(fig, alt, line.format(px * frame.length, *np.degrees(ends)))

# %% [markdown]
# ## Figure 5: one slice, both ways
#
# First a plane of the scan with the paper's constant. Then the middle page of the default's first fan: another plane,
# so the two gaps are not of the same length. In both, blue belongs to the outer boundary and orange-red to the inner
# one: dots are the boundary, a dashed line is the start curve, a full line the balloon at rest. Rings are the ends of
# the gap, green arrows the tangents there; light blue is the patch.

# %% tags=["nbval-check-output"]
figure = figures.slice_figure(sliced, middle, bone, paper.patch, skeleton=True)
alt = "The paper's preset: both balloons cross the gap flatter than the skull; patch in blue."
pictures.picture(figure, alt, "steps " + ", ".join(str(n) for n in middle.inflation.n_iter))

# %% tags=["nbval-check-output"]
fan = ours.working[0]
middle = fan.slices[len(fan.slices) // 2]
figure = figures.slice_figure(fan, middle, bone, ours.patch)
alt = "The default: both curves go on as the bone does; the patch is as thick as the bone."
pictures.picture(figure, alt, "steps " + ", ".join(str(n) for n in middle.inflation.n_iter))

# %% [markdown]
# Look at the dashed lines of the first picture: the *start* continues the skull better than the balloon that the
# paper's constant makes of it. Over all slices with a balloon:

# %% tags=["nbval-check-output"]
for i, side in enumerate(("outer", "inner")):
    off = []
    for s in bridged:
        true = case.true_curves(s.plane + first)
        if true:
            pair = (s.start[i], s.curves[i])
            off.append([classroom.distance_to_curve(true[i], c).mean() * px for c in pair])
    if off:
        print(side, "start {:.1f} mm off, balloon {:.1f} mm".format(*np.mean(off, axis=0)))

# %% [markdown]
# And why "steps 1, 1" for the default? Its start is a spiral that follows from both ends, with the pressure that
# holds just this spiral. So the balloon starts at rest, and stops after one look.
#
# Figure 6, partial loss, stands in lesson 05, section 2.
#
# ## Figure 7: good slices and a bad one
#
# The paper shows two good patches, one whose thickness "is not suitable", and a zoom into it. We take the preset with `k`
# from the ends, so that only the ends are to blame, and order its slices by their Dice coefficient: the best, the middle
# one, the worst.

# %%
made, lost = designs["its k from ends"], case.truth.voxels
planes = [s.plane + first for s in made.working[0].slices if s.status == "balloon"]
pairs = [(made.patch.voxels[p], lost[p]) for p in planes]
dice = [2 * (a & b).sum() / (a.sum() + b.sum()) for a, b in pairs]
order = np.argsort(dice)
picks = order[[-1, len(order) // 2, 0, 0]]

# %% tags=["nbval-check-output"]
fig, panels = pictures.axes(4, height=3.4, width=10.0)
for ax, i, letter in zip(panels, picks, "abcd", strict=True):
    plane = planes[i]
    pictures.show_mask(ax, bone.voxels[plane], px=px)
    pictures.show_mask(ax, lost[plane], px=px, colour="missing")
    title = f"({letter}) slice {plane}"
    pictures.show_mask(ax, made.patch.voxels[plane], px=px, colour="patch", title=title)
    pictures.zoom(ax, [np.argwhere(lost[plane])], px=px, margin=6 if letter == "d" else 40)
alt = "Patches in blue over the missing bone in red: good, fair, and next to none, with a zoom."
pictures.picture(fig, alt, "Dice " + ", ".join(f"{dice[i]:.2f}" for i in picks[:3]))

# %% tags=["nbval-check-output"]
for one in made.record["slices"]:
    at = one["plane"] + first
    if abs(at - planes[picks[2]]) <= 2 and one["status"] == "balloon":
        outer, inner = one["theta1"]
        print(f"slice {at}: theta1 outer {outer:.0f}, inner {inner:.0f} degrees")

# %% [markdown]
# Of the third patch next to nothing is left: the outer curve has to arrive from inside the head, its theta1 being more
# than 180 degrees, and crosses the inner one. It is as the authors say: "we did not get the suitable boundary
# conditions".
#
# ## Figure 8: the skull before and after

# %% tags=["nbval-check-output"]
skull = (pictures.skull_surface(bone), pictures.SKULL)
towards = openings[0].direction
fig, panels = pictures.axes(4, height=2.8, width=10.0)
pictures.show_meshes(panels[0], [skull], towards, title="(a) defective")
for ax, (name, side) in zip(panels[1:], figures.views_of([towards]).items(), strict=True):
    parts = [skull, (paper.mesh, pictures.BLUE)]
    pictures.show_meshes(ax, parts, side, title=f"repaired, {name}")
alt = "A skull with a hole in its side, and closed by a blue patch, from three directions."
pictures.picture(fig, alt, f"prosthesis of {paper.mesh.volume / 1000:.1f} cm3")

# %% [markdown]
# ## Figure 9: maps of the distances
#
# All in one scale, in mm from the true bone. The paper has the first three.

# %%
shown = {
    "(a) preset, top": ("paper's preset", "outer"),
    "(b) preset, inner": ("paper's preset", "inner"),
    "(c) You, top": ("You et al.", "outer"),
    "default, top": ("default", "outer"),
}
scale = figures.colour_scale(5.0)

# %% tags=["nbval-check-output"]
fig, panels = pictures.axes(4, height=2.8, width=10.0)
for ax, (title, (name, side)) in zip(panels, shown.items(), strict=True):
    colours = scale.to_rgba(seen[name].distances[side])[:, :3]
    part = (designs[name].surface(against_truth.SIDES[side]), colours)
    view = towards if side == "outer" else -towards
    pictures.show_meshes(ax, [part], view, title=title, px=0.25, shaded=False)
fig.colorbar(scale, ax=panels, label="mm", shrink=0.7)
alt = "Four patches coloured by distance: You's is off most in the middle, the default nowhere."
means = [f"{seen[name].distances[side].mean():.2f}" for name, side in shown.values()]
pictures.picture(fig, alt, "means " + ", ".join(means) + " mm")

# %% [markdown]
# The paper finds its largest distances "in small places". With its preset here it is not so: the weak `k` lets the
# middle sink in over a wide area, a milder form of what You's flat fill does.
#
# ## Figure 10: You's solution beside ours
#
# You's closed skull; then both patches alone, from the side.

# %%
aside = np.cross(towards, [0, 0, 1.0])
patches = {"You et al.": "(a) its patch", "default": "(b) the default's"}

# %% tags=["nbval-check-output"]
fig, panels = pictures.axes(3, height=2.8, width=9.0)
closed = [skull, (designs["You et al."].mesh, pictures.BLUE)]
pictures.show_meshes(panels[0], closed, towards, title="(a) You et al.")
for ax, (name, title) in zip(panels[1:], patches.items(), strict=True):
    part = (designs[name].mesh, pictures.BLUE)
    pictures.show_meshes(ax, [part], aside, title=title, px=0.3)
alt = "You's skull closed; from the side its patch is flat, the default's bulges outwards."
volumes = [f"{designs[name].mesh.volume / 1000:.1f}" for name in patches]
pictures.picture(fig, alt, f"volumes {' and '.join(volumes)} cm3")

# %% [markdown]
# ## Your turn: the whole method under sliders
#
# Every parameter at once, measured against the truth each time. **Predict** before you move: which *single* change
# from the default costs most? Is there one that does better? (DSC is the Dice coefficient; border DSC is Dice over
# the voxels within 10 mm of bone only. `panel.parameters` is what `cranio-nb design --params` takes as JSON.)

# %% tags=["nbval-check-output"]
panel = widgets.tuner(classroom.synthetic("tiny").phantom)
panel

# %% tags=["nbval-check-output"]
start = dict(panel.values)
axial = {"slices": "axial, as in the paper"}
changes = [{"own": True}, {"tension": 2.0}, axial, {"skip_mm": 0}, {"reach_mm": 4}]
for change in ({}, *changes, {"n_snaxels": 11}, {"skip_mm": 5}):
    line = panel.set(**start | change).view.line
    print(f"{change or 'default'!s:38} {line[:9]}")
_ = panel.set(**start)

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# What breaks the balance of pressure and tension: k = 0.062 by hand in place of the pressure that follows from the ends.
# (Here it is far too *strong*: it is counted in mm, and what matters is k N^2, with N = 40 in place of 20.) Then come
# slicing along the scan's own planes and a tension of 2: `k` is worked out for a tension of 1, and twice of it pulls the
# balloon flat. Then fitting tangents right at the cut (`skip_mm` 0), and a `reach_mm` of 4, too short to carry a tangent.
# The number of snaxels hardly matters: 11 do as well as 41.
#
# A `skip_mm` of 5 does *better* than the default, on this one coarse head. But a value chosen on one head fits that head,
# as the paper's `k` did.
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
fig, (ax,) = pictures.axes(height=3.0)
chords = np.linspace(5, 100, 40)
curves = {f"R = {r} mm": [end_angle(c, r) for c in chords] for r in (70, 80, 90)}
pictures.plot_lines(ax, chords, curves, xlabel="gap (mm)", ylabel="theta0 (degrees)")
ax.axhspan(4, 22, color="#999999", alpha=0.2)
alt = "Three rising curves of angle against gap; a grey band from 4 to 22 degrees."
pictures.picture(fig, alt, f"80 mm: {end_angle(60, 80):.1f} degrees for a gap of 60 mm")

# %% [markdown]
# ## Summary
#
# - The method carries over, two of its numbers do not: a `skip` in points, and a constant `k`.
# - Minimum and maximum hide the middle; "mean" and "max" are easily confused, even in print.
#
# | paper | code |
# |---|---|
# | Tables 1, 2 | `paper_tables.balloon_ranges`, `paper_tables.PAPER_BALLOONS` |
# | Table 3 | `against_truth.table3`, `paper_tables.PAPER_DISTANCES` |
# | 23 slices, 3 by hull | `paper_tables.count_statuses` |
#
# | figure | what it shows | where |
# |---|---|---|
# | 1 (a), (b) | a slice of the skull; its bone | lesson 01, section 3; lesson 02, section 1 |
# | 2 | boundary and skeleton | lesson 03, section 1 |
# | 3 | inner and outer boundary, tangent lines | lesson 03, section 3 |
# | 4 | coordinates of a balloon | here; lesson 04, section 2 |
# | 5 (a), (b) | balloons at rest; the patch | here; lesson 05, section 1 |
# | 6 (a) to (d) | partial loss | lesson 05, section 2 |
# | 7 (a) to (d) | three slices, one of them bad | here |
# | 8 (a) to (d) | the skull, open and repaired | here; lesson 00 turns it |
# | 9 (a) to (c) | maps of the distances | here; lesson 07, section 1 |
# | 10 (a), (b) | You's solution and ours | here; lesson 08, section 3 |
#
# **Further reading.** Ioannidis, *Why most published research findings are false*, PLoS Medicine 2 (2005); then
# Sandve and others, *Ten simple rules for reproducible computational research*, PLoS Computational Biology 9 (2013).
