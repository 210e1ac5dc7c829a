# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3 (ipykernel)
#     language: python
#     name: python3
# ---

# %% [markdown]
# # 06 Surface reconstruction: from voxels to something that can be made
#
# A machine wants triangles, not voxels. Marching cubes makes them, but it makes stairs as well: the paper complains of
# its own "staircase defect". This lesson makes the surface, smooths it as far as the data allow, and asks whether the
# result can be built at all.
#
# **After this lesson you can**
# - explain what marching cubes does and where the stairs come from;
# - smooth a surface and say how far it moved, in mm;
# - check a mesh before it leaves the house, and compute its volume and mass.
#
# **Time:** 40 minutes (text 20, questions 5, exercises 15). **You need:** lesson 05; the cross product.
#
# **From the paper:** stage 5, Figure 8, and the staircase of section 4.

# %%
import numpy as np

import cranio_nb as cn
from cranio_nb.implant.mass import DENSITIES, weigh_implant
from cranio_nb.stages import surface_reconstruction
from cranio_nb.teaching import check, classroom, pictures, widgets

# %% [markdown]
# ## Parameters
#
# | name | meaning | unit | paper |
# |---|---|---|---|
# | `smooth` | let vertices leave the half-way points of marching cubes; yes if not given | yes or no | no |
# | `n_steps` | steps of smoothing (`steps` in the panel); 24 if not given | 1 | no |
#
# *The switch:* `classroom.load("full")` takes a head of the paper's size, `classroom.load(scan="path/to/your/scan")` a
# scan of your own.

# %% tags=["nbval-check-output"]
case = classroom.load("class")
bone = cn.segment(case.ct)
openings = cn.find_openings(bone)
made = cn.design(bone, openings)
patch = made.patch
print(f"{patch.voxels.sum()} voxels of {np.round(patch.spacing, 2)} mm")

# %% [markdown]
# ## 1. Marching cubes
#
# Take eight neighbouring voxels as the corners of a cube. Each is in or out, which makes 2 x 2 x ... x 2 = 256 cases. A
# table gives the triangles of each case, with corners half-way along the edges of the cube. March on to the next cube.
#
# **Predict.** Planes are 2.5 mm apart, pixels 0.9 mm. How high will the stairs be? Do they change the area, and the
# volume? (Below the picture a slope is compared with its stairs: once of the faces of cubes, once of marching cubes.)

# %% tags=["nbval-check-output"]
print(f"{2**8} cases")
raw = surface_reconstruction.extract_surface(patch, smooth=False)
smooth = surface_reconstruction.extract_surface(patch)
print(f"raw: {len(raw.faces)} faces, area {raw.areas.sum() / 100:.1f} cm2")
print(f"smooth: {len(smooth.faces)} faces, area {smooth.areas.sum() / 100:.1f} cm2")

# %% tags=["nbval-check-output"]
towards = openings[0].direction + [0, 0, 0.4]
fig, panels = pictures.axes(2, height=4.4)
for ax, (name, mesh) in zip(panels, {"raw": raw, "smooth": smooth}.items(), strict=True):
    pictures.show_meshes(ax, [(mesh, pictures.BLUE)], towards, title=name, px=0.14)
alt = "The prosthesis twice: raw with steps like the contour lines of a map; smoothed without."
pictures.picture(
    fig, alt, f"area {raw.areas.sum() / 100:.1f} and {smooth.areas.sum() / 100:.1f} cm2"
)

# %% tags=["nbval-check-output"]
for rise, run in ((1, 1), (1, 2)):
    slope = np.hypot(rise, run)
    cubes, marching = rise + run, run - rise + rise * np.sqrt(2)
    print(
        f"a slope of {rise} in {run} ({np.degrees(np.arctan2(rise, run)):.0f} degrees): "
        f"faces of cubes {cubes / slope - 1:+.0%} area, "
        f"marching cubes {marching / slope - 1:+.0%}"
    )
print(f"here: raw {raw.areas.sum() / smooth.areas.sum() - 1:+.0%} area against smooth")
voxels_cm3 = patch.voxels.sum() * np.prod(patch.spacing) / 1000
print(f"volume: voxels {voxels_cm3:.2f} cm3, raw {raw.volume / 1000:.2f} cm3")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# One plane high (2.5 mm) where the surface is nearly horizontal, one pixel deep (0.9 mm) where it is nearly vertical.
#
# Stairs also add area, however fine the voxels are: the faces of cubes add 41 % on a slope of 45 degrees. Marching
# cubes cuts the corners of the steps, so it adds nothing at 45 degrees and 8 % on a slope of 1 in 2. Here, where voxels
# are longer than wide, raw is 11 % more than smooth. Volume has no such flaw: the raw surface holds 16.89 of the
# voxels' 16.99 cm3.
#
# </details>
#
# ## 2. How far may it move?
#
# Between the last voxel inside and the first outside the true surface can be anywhere. So a vertex may move by half a
# voxel along each axis; further would contradict the data. (A triangle between such vertices can still pass on the
# wrong side of a voxel's centre here and there.) `surface_reconstruction.extract_surface` goes
# towards the smoothest surface within these bounds and keeps the volume.

# %% tags=["nbval-check-output"]
moved = surface_reconstruction.measure_deviation(raw, smooth)
bound = np.linalg.norm(patch.spacing) / 2
print(f"moved by {moved.mean_mm:.2f} mm on average, {moved.max_mm:.2f} at most")
print(f"allowed are {bound:.2f} mm")
print(f"volume {raw.volume / 1000:.2f} cm3 before, {smooth.volume / 1000:.2f} cm3 after")

# %% [markdown]
# **Predict, then move, then explain.** The smoother the surface, the smaller its area. How many steps of smoothing does
# it take until the area hardly falls any more? Can you leave the bound by taking all that the panel has? How far will
# those vertices have moved that are stopped by it? (The bars beside the mesh count vertices by the way they moved;
# their scale is logarithmic, so that a few can be seen beside many.) (No sliders? Use `panel.set(steps=48)` in a new
# cell.) The cell below the panel goes on to 200 steps.

# %% tags=["nbval-check-output"]
panel = widgets.surface(patch)
panel

# %% tags=["nbval-check-output"]
areas = {}
for steps in (0, 1, 5, 10, 24, 200):
    after = surface_reconstruction.extract_surface(patch, n_steps=steps)
    areas[steps] = after.areas.sum()
    moved = surface_reconstruction.measure_deviation(raw, after)
    print(
        f"{steps:3} steps: area {areas[steps] / 100:.2f} cm2, "
        f"moved {moved.mean_mm:.2f} mm, {moved.max_mm:.2f} at most"
    )
for steps in (10, 24):
    share = (areas[0] - areas[steps]) / (areas[0] - areas[200])
    print(f"{steps} steps take off {share:.0%} of the area that 200 take off")

# %% [markdown]
# <details>
# <summary>Answer</summary>
#
# About ten steps bring most of it: counted from 0 steps, they take off 83 % of the area that two hundred take off, and
# the default 24 take off 94 %. After that the vertices still creep (0.51 to 0.61 mm on average), and the area hardly
# falls. (0 steps already put each vertex where the distance to the patch's edge, taken negative inside and smoothed, is
# zero; the panel's 0 is marching cubes itself, with a larger area.) You cannot leave the bound: each vertex is clipped
# to its box of half a voxel in every step.
#
# What would go further stops at a wall of the box. Those that a wall half a plane away stops make the pile near
# 1.25 mm, and a little beyond it, as along the wall a vertex may still move. Those that a wall half a pixel away stops
# the bars do not show: many others have moved as far. Only a vertex that is stopped along all
# three axes sits in a corner of the box, at 1.40 mm.
#
# </details>
#
# ## 3. Can it be built?
#
# A solid has an inside. What the check counts:
#
# - *open edge*: an edge that does not join exactly two faces; the skin has a hole there;
# - *flipped edge*: its two faces disagree on which side is outside;
# - *pinch*: two parts of the skin touch in a single point;
# - *parts*: pieces that no edge connects; an implant should be one for each hole;
# - *crossings*: pairs of faces that cut through each other;
# - *manifold*: no open edges, no flipped ones, no pinches: around every point the skin is like one bent sheet of paper.

# %% tags=["nbval-check-output"]
report = cn.check_mesh(smooth)
print(
    f"open edges {report.n_open_edges}, flipped {report.n_flipped_edges}, "
    f"pinches {report.n_pinches}"
)
print(f"parts {report.n_parts}, crossings {report.n_crossings}, sound: {report.sound}")
print(f"99 % of the wall is thicker than {report.wall_p1:.1f} mm")

# %% [markdown]
# **Can it?** Yes, if it is `sound` (manifold, of positive volume, without crossings), in one part for each hole, and
# nowhere thinner than your workshop's material and machine allow. The first two hold here; for the third ask the
# workshop what it makes of a wall of 4.1 mm, and mind that a hundredth of the surface has a thinner one. Whether it can
# also be put *in* is another question: a rim that widens inwards holds it back.
#
# What would it weigh? PMMA is acrylic glass, PEEK a hard plastic, Ti-6Al-4V the usual alloy of titanium, with aluminium
# and vanadium. Then we write the files.

# %% tags=["nbval-check-output"]
data = weigh_implant(smooth)
print(f"{data.volume_cm3:.1f} cm3")
for material, mass in data.mass_g.items():
    print(f"{material:10} {DENSITIES[material]:.2f} g/cm3  {mass:5.1f} g")

# %% tags=["nbval-check-output"]
folder = classroom.scratch_folder()
for path in cn.save(made, folder):
    print(path.name)
size = (folder / "prosthesis.stl").stat().st_size
assert size == 84 + 50 * len(made.mesh.faces)
print(f"prosthesis.stl: {size} bytes = 84 + 50 x {len(made.mesh.faces)} faces")

# %% [markdown]
# An STL file is a header of 84 bytes and then 50 bytes for each face: its normal and its corners, as plain numbers of 4
# bytes, and 2 bytes to spare. So it knows no unit. Everybody assumes mm; 3MF, a younger format, says so.
#
# ## A mistake to make once
#
# Give the workshop the outer side only. It looks fine on screen, but it is a skin without an inside:

# %% tags=["raises-exception"]
skin = made.surface(cn.mesh.OUTER)
cn.save(cn.Prosthesis(skin, made.sides, None, made.method), folder)

# %% [markdown]
# ## Exercises
#
# **Exercise 6.1.** The volume of a closed mesh. Each face and the origin make a tetrahedron of (signed) volume a . (b x
# c) / 6, with a, b, c the corners of the face in their order. Add them up and keep the sign: a mesh turned inside out
# has a negative volume.


# %% tags=["solution"]
def mesh_volume(vertices, faces):
    """Volume enclosed by triangles (F, 3) of vertices (V, 3)."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


# %% tags=["check", "nbval-check-output"]
check.exercise("6.1", mesh_volume)

# %% [markdown]
# **Exercise 6.2.** Forgotten spacing. Marching cubes on a plain array gives vertices in voxels. Turn them into mm.


# %% tags=["solution"]
def to_mm(index, spacing):
    """Positions in mm of indices (n, 3), along the same axes; spacing (3,) in mm."""
    return index * spacing


# %% tags=["check", "nbval-check-output"]
check.exercise("6.2", to_mm)

# %% [markdown]
# ## Summary
#
# - Marching cubes is exact about what is in and out, and blind between voxels: hence the stairs.
# - Smooth within half a voxel, and say how far.
# - A mesh that leaves must be closed, manifold and free of crossings.
#
# | paper | code | unit |
# |---|---|---|
# | marching cubes | `surface_reconstruction.extract_surface(smooth=False)` | mm |
# | staircase defect | `surface_reconstruction.extract_surface(smooth=True)` | mm |
# | digital model | `Prosthesis.mesh`, `cn.save` | mm |
# | top, inner surface | `Prosthesis.surface(OUTER)`, `(INNER)` | mm |
#
# **Further reading.** Lorensen and Cline, *Marching cubes*, SIGGRAPH 1987. Gibson, *Constrained elastic surface nets*
# (1998).
