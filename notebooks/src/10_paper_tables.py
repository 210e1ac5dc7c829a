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
# - tell what a table of angles says of an opening, and what it does not.
#
# **Time:** 45 minutes (text 20, questions 15, exercises 10). **You need:** lessons 04 and 07.
#
# **From the paper:** Tables 1, 2 and 3, and all ten figures. A map at the end says where each of them is explained.

# %%
import numpy as np

import cranio_nb as cn
from cranio_nb.evaluation import against_truth, mesh_distances, paper_tables
from cranio_nb.teaching import check, classroom, pictures, widgets

# %% [markdown]
# ## Parameters
#
# | name | the paper's preset | default |
# |---|---|---|
# | slices | planes of the scan | fans in 6 directions |
# | `skip` | 4.5 mm, the paper's ten points (lesson 03) | 1.5 mm |
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

# %% tags=["nbval-check-output"]
slicewise = cn.methods.slicewise.method
theirs, default = slicewise.paper_options(bone), slicewise.pieces.__kwdefaults__
for name in ("axial", "skip_mm", "pressure_mm", "n_snaxels"):
    print(f"{name:11} preset {theirs[name]!s:8.6} default {default[name]}")
print(f"the preset's k: {theirs['pressure_mm'] / px:.3f} px per index squared")

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
ranges = paper_tables.balloon_ranges(paper.record["slices"])
print("                 paper           here")
for side, rows in paper_tables.PAPER_BALLOONS.items():
    for key, (low, high) in rows.items():
        here = ranges[side][key]
        print(f"{side} {key:7} {low:6g} to {high:<6g} {here[0]:6.0f} to {here[1]:<6.0f}")

# %% tags=["nbval-check-output"]
balloons = [s for s in paper.record["slices"] if s["status"] == "balloon"]
for key in ("theta0", "theta1"):
    print(f"outer {key}, slice by slice:", *(f"{s[key][0]:.0f}" for s in balloons))
theta0, theta1 = np.mean([[s["theta0"][0], s["theta1"][0]] for s in balloons], axis=0)
print(f"on average outer theta0 {theta0:.0f}, 180 - theta1 {180 - theta1:.0f} degrees")
rounder = sum(180 - s["theta1"][0] > s["theta0"][0] for s in balloons)
print(f"the second end is the steeper one in {rounder} of {len(balloons)} slices")
ends = [one.ends[0].points for one in paper.working[0].slices if one.status == "balloon"]
print(f"and lies further back in {sum(second[0] > one[0] for one, second in ends)}")
for i, (side, rows) in enumerate(paper_tables.PAPER_BALLOONS.items()):
    above = sum(s["n_iter"][i] > rows["n_iter"][1] for s in balloons)
    print(f"{side}: {above} of {len(balloons)} slices take more steps than the paper's largest")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# In its first and last slices, where the gap is short. On a circle the angle follows from the gap (exercise 10.2): with
# a radius of 80 mm an angle of 22 degrees means a gap of 60 mm, and 4 degrees one of 11 mm. Ours has it in the first
# slices, at both ends. In the last ones it does not get as far: there the hull takes over while the gap is still wide,
# and the cut is slanted (see below).
#
# </details>
#
# May one read the authors' opening off their angles in this way? Let us try it on our head, whose gaps are known. L
# is the chord between the two ends of the balloon; these lie `skip` inside the bone, so the true gap is shorter.

# %%
centre = bone.to_voxel(openings[0].head_centre)[1:]
rows = []
for one in paper.working[0].slices:
    truth = case.true_curves(one.plane + first)
    if one.status == "balloon" and truth:
        chord = cn.curves.ChordFrame.of(one.ends[0], centre)
        start, end = chord.end_angles(one.ends[0])
        lean = (start + np.pi - end) / 2  # of both ends
        true_lean = (
            np.radians((case.true_angles(one.plane + first)[0] * [1, -1]).sum() + 180) / 2
        )
        gap = np.linalg.norm(truth[0][-1] - truth[0][0]) * px
        fits = chord.length * px / 2 / np.sin(lean), gap / 2 / np.sin(true_lean)
        rows.append((np.degrees(lean), 2 * 80 * np.sin(lean), chord.length * px, gap, *fits))

# %% tags=["nbval-check-output"]
wide = np.array([row for row in rows if row[3] > 50])
names = (
    "mean angle (degrees)",
    "gap from it, R = 80 (mm)",
    "L (mm)",
    "true gap (mm)",
    "R that fits L (mm)",
    "R of the true bone (mm)",
)
print(f"{len(wide)} slices with a gap of more than 50 mm:")
for name, values in zip(names, wide.T, strict=True):
    print(f"{name:25} {values.mean():5.0f}, from {values.min():.0f} to {values.max():.0f}")

# %% [markdown]
# From the angles one would read gaps of 56 mm on average. The balloons' ends are L = 74 mm apart, as L has the two
# `skip` in it (counted along a skeleton that itself stops short of the cut), and bone is missing over 61 mm. The
# angles belong to the balloons' ends, so to L, and the R that fits both is 106 mm, not 80: the side of this head is
# flatter. It is flatter still, 122 mm by the true curves: the tangents are fitted a little further back and come out
# too steep (lesson 03, section 4). Gap and radius are two unknowns, and no single angle gives both. Of the authors'
# opening we may say that it was a wide one, and not much more.
#
# The second end, the one further back, is the steeper one in 20 of 22 slices: this skull is rounder towards the back.
# One exception is the first, by little; the other is the last bridged slice, whose outer theta1 is more than 180
# degrees: there the curve has to arrive from *inside* the head. The cutter had slanted the bone, and the line was
# fitted to the slant (lesson 05, section 3).
#
# The number of steps depends on `dt`, which the paper does not give. With dt = 1 most of our slices take more steps
# than the paper's largest; whether their time step was larger or their stop earlier, we cannot tell. Angles of the same
# kind, then, and not the same steps.
#
# ## Table 3: distances
#
# The paper's distances are in voxels against a *mirrored* skull; ours are against the bone that was really removed. So
# the reflection, the paper's truth, can be a row itself (as it is in the paper: not bent to the rim). The first four
# rows are the preset and its two causes of error (lesson 05): ten points counted on our pixels, which are 9 mm, or
# 4.5 mm; the constant `k`, or one from the tangents. Then comes the default, on axial slices and in fans.
# Lesson 08 has the reflection and You's fill in detail. `thin-plate` and `dnurbs` are not in the paper's table; the
# second is what its last paragraph wishes for. (Ten designs: up to half a minute.)

# %%
ways = {
    "skip 9 mm": preset | {"skip_mm": 10 * px},
    "paper's preset": preset,
    "9 mm, k from ends": preset | {"skip_mm": 10 * px, "pressure_mm": None},
    "preset, k from ends": preset | {"pressure_mm": None},
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
    print(f"{name:19}", " |".join(cells))


# %% tags=["nbval-check-output"]
print("voxels               top: min   max  mean   std | inner: min   max  mean   std")
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
# No. Two causes are in the first four rows. **Skip:** ten points are 9 mm on our pixels, and 4.5 mm on theirs if
# these are what lesson 03 takes them for; read the first row against the second. **k:** their -0.062 was chosen for
# their opening, and a `k` fits one width of gap (lesson 04); read the first row against the third. Each alone brings
# the mean down, and both together, the fourth row, most. Outside the constant weighs more, inside both weigh
# about the same. With both mended the outer mean is below the paper's; the inner one is not. The default's shorter
# `skip` and the fans bring the rest. The idea was good; the numbers were local.
#
# The reflection comes very near here, as this head is nearly symmetric: on such a head the paper's truth would do. On a
# lopsided one it would not (lesson 08), and part of the paper's own mean may be the mirror's. The default, the thin
# plate and dnurbs are all a fraction of a voxel off: at this size the grid decides between them.
#
# </details>
#
# **Question.** The paper's headline is that its method beats You's, in the mean (1.10 against 3.09) and in the largest
# distance (2.89 against 6.06). Does that hold here, and on two more heads? (About 15
# seconds.)

# %% tags=["nbval-check-output"]
tried = (*list(ways)[:2], "You et al.")
headline = {"head 0": [seen[name].table3["outer"] for name in tried]}
theirs = {"head 0": ([designs[name] for name in tried[:2]], true, bone)}
for seed in (1, 2):
    other = classroom.load("class", seed=seed, needs_truth=True)
    its_bone = cn.segment(other.ct)
    its_holes = cn.find_openings(its_bone)
    its_truth = against_truth.true_prosthesis(other.truth, its_bone, its_holes[0].head_centre)
    made = [cn.design(its_bone, its_holes, **ways[name]) for name in tried]
    rows = [against_truth.table3(one, its_truth, its_bone)["outer"] for one in made]
    headline[f"head {seed}"], theirs[f"head {seed}"] = rows, (made[:2], its_truth, its_bone)
print("outer side, mean and max in voxels:  skip 9 mm   paper's preset      You et al.")
for name, rows in headline.items():
    print(f"{name:30}", *(f"{row.mean:9.2f} {row.max:5.2f}" for row in rows))


# %%
def in_voxels(one, bone):
    """The outer side of a prosthesis, counted in voxels."""
    side = one.surface(cn.mesh.OUTER)
    return cn.mesh.Mesh(bone.to_voxel(side.vertices), side.faces)


# %% tags=["nbval-check-output"]
print("largest distance in voxels, and without its slice and the two beside it")
for head, (both, its_truth, its_bone) in theirs.items():
    for name, one in zip(tried, both, strict=False):
        nodes = in_voxels(one, its_bone).vertices
        off = mesh_distances.surface_distance(nodes, in_voxels(its_truth, its_bone))
        plane = np.rint(nodes[:, 0])
        worst = plane[off.argmax()]
        rest = off[abs(plane - worst) > 1].max()
        print(f"{head}, {name:14}: {off.max():.2f} in slice {worst:.0f}, else {rest:.2f}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# In the mean it holds on all three heads: 1.24 to 1.49 voxels against 2.31 to 2.54, and with a skip of 9 mm still 1.96
# to 2.25. The factor is less than two, in the paper it is nearly three. In the largest distance it holds on two of the
# three heads (on head 1 the preset has 6.70, You 4.59), and on none with 9 mm. Can one bad end in one slice make that
# number? On head 1 it does: without that slice and its neighbours the preset has 3.29, less than You. On the other
# heads, and with 9 mm, other slices are nearly as bad.
#
# </details>
#
# **Question.** You's mean is 3.09 in the paper and 2.54 here, on another head. Is that good agreement, or chance?
# Measure the height of the cap that the flat fill leaves out.

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

# %% tags=["nbval-check-output"]
# the same two surfaces, counted in voxels of other shapes
film, bone_side = (one.surface(cn.mesh.OUTER) for one in (designs["You et al."], true))
for wide_mm, high_mm in ((0.45, 0.45), (0.9, 2.5), (0.45, 2.5)):
    size = np.array([wide_mm, wide_mm, high_mm])
    counted = cn.mesh.Mesh(bone_side.vertices / size, bone_side.faces)
    off = mesh_distances.surface_distance(film.vertices / size, counted)
    shape = f"{wide_mm} mm wide and {high_mm} mm high"
    print(f"voxels {shape}: mean / max = {off.mean() / off.max():.2f}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# You shows its bias: mean about half the cap height, 0.55 of it here. A flat lid under a cap gives a half (exercise
# 8.2), and the film of lesson 08, measured before it is made of voxels, comes to a half as well. The paper's mean is
# 0.51 of its largest distance: same method, same flaw, while 3.09 itself only says how high the authors' cap was.
#
# Voxels are no cubes, and their shape changes what "nearest" means. The last three lines count the same two surfaces in
# cubes, in our voxels, and in voxels such as the authors' may have been: 0.51 to 0.55. They
# differ little, as the film stands nearly upright and most of its distances lie within a slice, where pixels are
# square. So the paper's ratio is what such a fill gives; more cannot be read from two numbers.
#
# </details>
#
# ## The figures
#
# All ten, in the paper's order and with its letters (a), (b), ..., drawn by `paper_figures` from the designs above,
# with the paper's preset where the paper shows its own method. One colour has one meaning throughout: sand is bone,
# light blue the patch, dark blue the outer side and the finished prosthesis, orange-red the inner side, green the
# tangents, pink the truth. (A skull in space is ivory, and distances have a scale of their own.) What a frame holds
# is shown larger beside it or below.
#
# ## Figures 1 to 3: one slice
#
# The middle one of the slices that the preset bridges. The paper: "(a) Slice of the defective skull. (b) Bone
# segmentation." (Lessons 01 and 02.)

# %%
sliced = paper.working[0]
bridged = [s for s in sliced.slices if s.status == "balloon"]
middle = bridged[len(bridged) // 2]
plane = middle.plane + first

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_1(case.ct, bone, plane)
alt = "A slice of CT: a bright ring of bone, open at the patient's left; beside it the bone."
pictures.picture(fig, alt, f"slice {plane}: {bone.voxels[plane].sum()} pixels of bone")

# %% [markdown]
# "Bone boundary and skeleton." The path kept stops short of the end (lesson 03, section 2).

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_2(bone, plane)
alt = "The ring of bone with its boundary pixels and its skeleton; one end of it larger."
pictures.picture(fig, alt, f"slice {plane}")

# %% [markdown]
# "Inner and outer boundaries of the bone plus the tangent lines." The boundaries that the paper draws red and green are
# our orange-red and dark blue; green are our tangents. The balloons begin at the rings, `skip` inside the bone (lesson
# 03, section 3).

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_3(bone, plane, middle.ends)
alt = "Both boundaries in colour, with straight tangent lines at both ends of the gap, zoomed."
lengths = [np.linalg.norm(np.diff(one.points, axis=0)) * px for one in middle.ends]
pictures.picture(fig, alt, "L = {:.0f} mm outside, {:.0f} mm inside".format(*lengths))

# %% [markdown]
# ## Figure 4: the frame of a balloon
#
# "Coordinate system used to setup the outer balloon": both ends on the x axis, one in the origin, the other at x = L.
# theta1 is counted from the x axis as theta0 is, so it is obtuse. The dashed line is the cubic of eq. (3), the full one
# the balloon at rest.

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_4(sliced, middle, bone)
alt = "The gap lying flat: chord of length L on the x axis, an arch over it, its end angles."
angles = middle.inflation.theta0_deg[0], middle.inflation.theta1_deg[0]
line = "L = {:.0f} mm, angles {:.0f} and {:.0f} degrees"
pictures.picture(fig, alt, line.format(px * middle.inflation.length[0], *angles))

# %% [markdown]
# ## Figure 5: one slice, both ways
#
# "(a) Balloon results. (b) Prosthesis patch (in blue)." First the same plane with the paper's constant. Then the middle
# page of the default's first fan: another plane, so the two gaps are not of the same length.

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_5(sliced, middle, bone, paper.patch)
alt = "The paper's preset: both balloons cross the gap flatter than the skull; the patch."
pictures.picture(fig, alt, "steps " + ", ".join(str(n) for n in middle.inflation.n_iter))

# %% tags=["nbval-check-output"]
fan = ours.working[0]
page = fan.slices[len(fan.slices) // 2]
fig = pictures.paper_figures.figure_5(fan, page, bone, ours.patch)
alt = "The default: both curves go on as the bone does; the patch is as thick as the bone."
pictures.picture(fig, alt, "steps " + ", ".join(str(n) for n in page.inflation.n_iter))

# %% [markdown]
# The dashed lines of the first picture, the *start*, continue the skull better than the balloon that the paper's
# constant makes of them. How far each lies off the true bone, over all slices with a balloon:

# %% tags=["nbval-check-output"]
for i, side in enumerate(("outer", "inner")):
    off = []
    for s in bridged:
        arcs = case.true_curves(s.plane + first)
        if arcs:
            pair = (s.start[i], s.curves[i])
            off.append([classroom.distance_to_curve(arcs[i], c).mean() * px for c in pair])
    if off:
        print(side, "start {:.1f} mm off, balloon {:.1f} mm".format(*np.mean(off, axis=0)))

# %% [markdown]
# Outside it does; inside the two are nearly alike.
#
# And why "steps 1, 1" for the default? Its start is a spiral that follows from both ends, with the pressure that
# holds just this spiral. So the balloon starts at rest, and stops after one look.
#
# ## Figure 6: partial loss
#
# "(a) Original slice with defective region highlighted. (b) Segmented bone. (c) Difference between the convex hull and
# the bone region. (d) Prosthesis patch." Of the slices that the preset fills by the hull we show the one with the
# largest patch. Of hull minus bone the largest region is dropped, which is the inside of the head, and the islands
# around it; what is left is the patch (lesson 05, section 2).

# %% tags=["nbval-check-output"]
by_hull = [s.plane + first for s in sliced.slices if s.status == "hull"]
at = max(by_hull, key=lambda p: paper.patch.voxels[p].sum(), default=plane)
kept, lost = paper.patch.voxels[at], case.truth.voxels
fig = pictures.paper_figures.figure_6(case.ct, bone, at, kept)
alt = "One slice four times, each with a zoom on the dent: CT, bone, hull minus bone, patch."
pictures.picture(fig, alt, f"slice {at}: patch {kept.sum()} px, missing {lost[at].sum()} px")

# %% [markdown]
# ## Figure 7: good slices and a bad one
#
# "(a)-(c) Prosthesis patches obtained with our method. (d) Zoom in the patch of last figure." Two are good, of the
# third the thickness "is not suitable". We take the preset with
# `k` from the ends, so that only the ends are to blame, and order its slices by their Dice coefficient: the best, the
# middle one, the worst.

# %%
made = designs["preset, k from ends"]
results = [s for s in made.working[0].slices if s.status == "balloon"]
planes = [s.plane + first for s in results]
pairs = [(made.patch.voxels[p], lost[p]) for p in planes]
dice = [2 * (a & b).sum() / (a.sum() + b.sum()) for a, b in pairs]
order = np.argsort(dice)
picks = order[[-1, len(order) // 2, 0]]

# %% tags=["nbval-check-output"]
of_picks = [results[i] for i in picks], [planes[i] for i in picks]
fig = pictures.paper_figures.figure_7(*of_picks, bone, made.patch, case.truth)
alt = "Three patches, the missing bone outlined: good, fair, next to none; the last zoomed."
pictures.picture(fig, alt, "Dice " + ", ".join(f"{dice[i]:.2f}" for i in picks))

# %% tags=["nbval-check-output"]
for one in made.record["slices"]:
    at = one["plane"] + first
    if abs(at - planes[picks[2]]) <= 2 and one["status"] == "balloon":
        outer, inner = one["theta1"]
        print(f"slice {at}: theta1 outer {outer:.0f}, inner {inner:.0f} degrees")

# %% [markdown]
# Of the third patch next to nothing is left: the outer curve has to arrive from inside the head, its theta1 being more
# than 180 degrees, and comes down upon the inner one. It is as the authors say: "we did not get the suitable boundary
# conditions".
#
# ## Figure 8: the skull before and after
#
# "(a) Original defective skull. (b)-(d) Skull surface reconstructed", with the paper's preset. The slit near the upper
# rim of the patch is the slice of Figure 7 (c). The flat oval on the top of the head is the last slice with bone:
# of what lies between two slices a scan knows nothing. The faint rings are where the outline steps by one pixel.

# %% tags=["nbval-check-output"]
skull, towards = pictures.skull_surface(bone), openings[0].direction
fig = pictures.paper_figures.figure_8(skull, paper.mesh, towards)
alt = "A skull with a hole in its left side; closed by a blue patch, from three directions."
pictures.picture(fig, alt, f"prosthesis of {paper.mesh.volume / 1000:.1f} cm3")

# %% [markdown]
# ## Figure 9: maps of the distances
#
# "(a) Distance map plotted over the top surface obtained by our method. (b) Artificial inner surface and colored
# distance map. (c) Top surface and distance map for You et al. technique." All in one scale, in mm from the true bone;
# (d) is not in the paper. The inner side is seen from inside the head, so front and back change places. Grey is the
# edge, in thin slits also between two slices: distances are measured on the top and on the inner side only. The white
# slit is that of Figure 8. A circle is where the distance is largest. In (a), (b) and (d) that node itself is hidden,
# in the slit or at the edge: the colour under the circle is not its own.

# %%
shown = {
    "(a) preset, top": ("paper's preset", "outer"),
    "(b) preset, inner": ("paper's preset", "inner"),
    "(c) You et al., top": ("You et al.", "outer"),
    "(d) default, top": ("default", "outer"),
}
maps = []
for title, (name, side) in shown.items():
    one, view = designs[name], towards if side == "outer" else -towards
    on_side = one.surface(against_truth.SIDES[side]), seen[name].distances[side]
    maps.append(pictures.paper_figures.DistanceMap(title, one.mesh, *on_side, view))

# %% tags=["nbval-check-output"]
fig = pictures.paper_figures.figure_9(maps, top_mm=5.0)
alt = "Four patches coloured by distance: You's is off most in the middle, the default nowhere."
means = [f"{one.distances.mean():.2f}" for one in maps]
pictures.picture(fig, alt, "means " + ", ".join(means) + " mm")

# %% [markdown]
# The paper finds its largest distances "in small places". With its preset here that holds for the very largest: the
# circle of (a) lies at the slit. But it is not the whole story: the weak `k` lets the middle sink in over a wide area,
# a milder form of what You's flat fill does.
#
# ## Figure 10: You's solution beside the paper's
#
# "(a) Viewpoints of the solution obtained by the method described in (You et al., 2009). (b) A viewpoint of the
# prosthesis generated by our technique." Ours is the paper's own: its preset. Seen edge on, with the outline of the
# bone that is missing, the bias towards planar shapes shows: You's patch does not reach out to the outline.

# %% tags=["nbval-check-output"]
you, missing = designs["You et al."].mesh, true.mesh
fig = pictures.paper_figures.figure_10(skull, you, paper.mesh, missing, towards)
alt = "You's skull closed, from two sides; edge on its patch is flat, the paper's bulges more."
volumes = [f"{one.volume / 1000:.1f}" for one in (you, paper.mesh, missing)]
pictures.picture(fig, alt, "You's {}, the paper's {}, missing {} cm3".format(*volumes))

# %% [markdown]
# ## Your turn: the whole method under sliders
#
# Every parameter at once, measured against the truth each time. **Predict** before you move: which *single* change
# from the default costs most? Is there one that does better? (DSC is the Dice coefficient; border DSC counts
# only the voxels near bone. `panel.parameters` is what `cranio-nb design --params` takes as JSON.)

# %% tags=["nbval-check-output"]
small = classroom.synthetic("tiny")
panel = widgets.tuner(cn.Volume(small.phantom.bone, small.ct.affine), small.truth)
panel

# %% tags=["nbval-check-output"]
start = dict(panel.values)
axial = {"slices": "axial, as in the paper"}
changes = [{"own": True}, {"tension": 2.0}, axial, {"skip_mm": 0}, {"reach_mm": 4}]
for change in ({}, *changes, {"n_snaxels": 11}, {"skip_mm": 5}):
    line = panel.set(**start | change).view.line
    print(f"{change or 'default'!s:38} {line[:9]}")
_ = panel.set(**start)

# %% tags=["nbval-check-output"]
# what k can do: alone, without the tangents, it raises the middle by k N^2 / 8 (lesson 04)
by_hand = panel.values["pressure_mm"]
snaxels = {
    "paper, half px": (0.062 * px / 2, 20),
    "paper, our pixels": (0.062 * px, 20),
    "by hand": (by_hand, panel.values["n_snaxels"] - 1),
}
for name, (k, n) in snaxels.items():
    rise = f"k N^2 = {k * n**2:3.0f} mm, k N^2 / 8 = {k * n**2 / 8:4.1f} mm"
    print(f"{name:17} k {k:.3f} mm, N {n}: {rise}")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# What breaks the balance of pressure and tension: k = 0.062 mm per index squared, by hand (`own`), in place of the
# pressure that follows from the ends. The same figure as the paper's, and yet here far too *strong*, where section
# "Table 3" and lesson 04 find it too weak. Its unit is mm in place of px, and what matters is k N^2: 99 mm with N = 40,
# against 22 mm for the preset on our pixels (N = 20), and 11 mm on pixels of half the size. Then come slicing along the
# scan's own planes and a tension of 2: `k` is worked out for a tension of 1, and twice of it pulls the balloon flat.
# Then fitting tangents right at the cut (`skip_mm` 0), and a `reach_mm` of 4, too short to carry a tangent. The number
# of snaxels hardly matters here: 11 do as well as 41.
#
# A `skip_mm` of 5 has a slightly larger Dice than the default on this head, while other rows of the panel's table get a
# little worse: which is better depends on the number one looks at. And a value chosen on one head fits that head, as the
# paper's `k` did.
#
# </details>

# %% [markdown]
# ## A mistake to make once
#
# The text of the paper takes 135 and 147 for the *mean* number of steps; its tables list them as the largest. Which
# the authors meant, our steps cannot say; but one number cannot be both:

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
ax.axhspan(4, 22, color=pictures.MIDDLE_GREY, alpha=0.2, label="the paper's outer theta0")
pictures.plot_lines(ax, chords, curves, xlabel="gap (mm)", ylabel="theta0 (degrees)")
alt = "Three rising curves of angle against gap; a grey band from 4 to 22 degrees."
pictures.picture(fig, alt, f"80 mm: {end_angle(60, 80):.1f} degrees for a gap of 60 mm")

# %% [markdown]
# ## Summary
#
# - The method carries over, two of its numbers do not: a `skip` in points, and a constant `k`.
# - Its headline, nearer than You's, holds in the mean on three heads, and in the largest distance not always.
# - Minimum and maximum hide the middle; "mean" and "max" are easily confused, even in print.
#
# | paper | code |
# |---|---|
# | Tables 1, 2 | `paper_tables.balloon_ranges`, `paper_tables.PAPER_BALLOONS` |
# | Table 3 | `against_truth.table3`, `paper_tables.PAPER_DISTANCES` |
# | 23 slices, 3 by hull | `paper_tables.count_statuses` |
#
# | figure | what it shows | code (`paper_figures`) | explained in |
# |---|---|---|---|
# | 1 (a), (b) | a slice of the skull; its bone | `figure_1` | lesson 01, section 3; lesson 02, section 1 |
# | 2 | boundary and skeleton | `figure_2` | lesson 03, section 1 |
# | 3 | inner and outer boundary, tangent lines | `figure_3` | lesson 03, section 3 |
# | 4 | coordinates of a balloon | `figure_4` | lesson 04, section 1 |
# | 5 (a), (b) | balloons at rest; the patch | `figure_5` | lesson 05, section 1 |
# | 6 (a) to (d) | partial loss | `figure_6` | lesson 05, section 2 |
# | 7 (a) to (d) | three slices, one of them bad | `figure_7` | lesson 05, section 3 |
# | 8 (a) to (d) | the skull, open and repaired | `figure_8` | lesson 00 turns it |
# | 9 (a) to (c) | maps of the distances | `figure_9` | lesson 07, section 1 |
# | 10 (a), (b) | You's solution and the paper's | `figure_10` | lesson 08, section 3 |
#
# **Further reading.** Ioannidis, *Why most published research findings are false*, PLoS Medicine 2 (2005); then
# Sandve and others, *Ten simple rules for reproducible computational research*, PLoS Computational Biology 9 (2013).
