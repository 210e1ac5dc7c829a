"""Checks of exercises: the shipped solution passes, the stub gets the teaching message, typical answers their hint."""

import ast
from pathlib import Path

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import cKDTree
from skimage.morphology import convex_hull_image

from cranio_nb.curves import cubic, spiral
from cranio_nb.stages.deformable_model import PAPER_PRESSURE, inflate, tangent_pressure
from cranio_nb.teaching import build, check
from cranio_nb.teaching.exercises import EXERCISES

SOURCES = sorted((Path(__file__).parents[2] / "notebooks" / "src").glob("*.py"))
LIBRARY = {
    "np": np,
    "ndimage": ndimage,
    "cKDTree": cKDTree,
    "convex_hull_image": convex_hull_image,
    "inflate": inflate,
    "cubic": cubic,
    "spiral": spiral,
    "tangent_pressure": tangent_pressure,
    "PAPER_PRESSURE": PAPER_PRESSURE,
}


def shipped(stub):
    """Exercise -> the function of its solution cell, or of its stub in the student's copy."""
    found = {}
    for source in SOURCES:
        cells = build.read(source).cells
        for cell in cells:
            if "solution" in build.tags(cell):
                number = build._next_number(cells, cell)
                text = build._stub(cell.source, number) if stub else cell.source
                found[number] = function(text)
    return found


def function(text):
    room = dict(LIBRARY)
    exec(text, room)  # the project's own lesson texts
    return room[ast.parse(text).body[-1].name]


SOLUTIONS, STUBS = shipped(False), shipped(True)

SLOPES = "slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)])"
REST = (
    "k = tangent_pressure(length, theta0, theta1, n); "
    "return inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"
)
FRAME = ("l[0]", "l[-1]", "l[:, 0]", "l[:, -1]")


def holes(*borders, structure="None", compare="<=", sizes="s", given="mask"):
    """A way to fill small holes, written as a student does."""
    return (
        f"l, n = ndimage.label(~mask, {structure}); s = np.bincount(l.ravel()); s = {sizes}; "
        f"out = {given}.copy(); border = {{*np.concatenate([{', '.join(borders)}])}}\n"
        f"    for i, size in enumerate(s):\n"
        f"        if i > 0 and size {compare} max_pixels and i not in border: out[l == i] = True\n"
        "    return out"
    )


REGIONS_4 = (
    "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel(), minlength=n + 1); s[0] = 0"
)
REGIONS_8 = REGIONS_4.replace("~bone)", "~bone, np.ones((3, 3)))")
TETRAHEDRA = "a, b, c = vertices[faces].swapaxes(0, 1); v = (a * np.cross(b, c)).sum(1)"
SPLINE = "D, W = np.diff(np.eye(len(f)), order, axis=0), np.diag(known.astype(float))"
BASIS = "B = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2])"
NEAREST = "there, back = cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]"

# what students write, and a word of the hint that they should get
WRONG = {
    "0.1": [
        ("return mask.sum()", "counts voxels"),
        ("return mask.sum() * spacing[0] * spacing[1] * spacing[2]", "1000 mm3"),
        ("return np.count_nonzero(mask) * spacing[1] * spacing[2] / 1000", "area"),
        ("return mask.size * np.prod(spacing) / 1000", "mask.sum()"),
        ("return mask.sum() * np.prod(spacing) / 10", "10 x 10 x 10"),
        ("return mask.sum() * spacing[0] * spacing[1] ** 2 / 1000", "not equal"),
        ("return mask.sum() * spacing[1] ** 3 / 1000", "not equal"),
    ],
    "0.2": [
        ("return np.sum(a & b) / np.sum(a | b)", "Jaccard"),
        ("return np.logical_and(a, b).sum() / (a.sum() + b.sum())", "factor 2"),
        ("return np.mean(a == b)", "air"),
        ("return 2 * np.sum(a & b) / np.sum(a + b)", "a + b means"),
    ],
    "1.1": [
        ("return 255 * (hu - centre + width / 2) / width", "clip"),
        ("return np.clip((hu - centre) / width, 0, 1) * 255", "starts at"),
        ("return np.clip((hu - centre) / width + 0.5, 0, 1)", "0 to 1"),
        ("return ((hu - centre + width / 2) / width * 255).astype(int).astype(np.uint8)", "uint8"),
        ("return np.clip((hu - centre + width) / (2 * width), 0, 1) * 255", "twice too wide"),
    ],
    "1.2": [
        ("return affine[:3, :3].dot(index)", "origin"),
        ("return (affine @ np.append(index[::-1], 1))[:3]", "turn it round"),
        ("return index @ affine[:3, :3] + affine[:3, 3]", "transposed"),
    ],
    "1.3": [
        ("z = sorted(positions[:, 2]); return np.median(np.diff(z))", "tilted"),
        ("return np.median(np.diff(positions @ normal))", "any order"),
        ("return positions[1, 2] - positions[0, 2]", "any order"),
        ("return np.median(np.abs(np.diff(positions @ normal)))", "any order"),
        ("return np.diff(np.sort(positions @ normal)).mean()", "pulls the mean"),
    ],
    "2.1": [
        ("labels, n = ndimage.label(mask); return labels == 1", "met first"),
        ("l, n = ndimage.label(mask); return l == np.bincount(l.ravel()).argmax()", "background"),
        ("return mask", "Nothing was dropped"),
        ("l, n = ndimage.label(mask); return l == np.bincount(l.ravel())[1:].argmax()", "add 1"),
        (
            "l = [ndimage.label(s)[0] for s in mask]; "
            "return np.array([(s == np.append(0, np.bincount(s.ravel())[1:]).argmax()) & (s > 0) for s in l])",
            "whole mask once",
        ),
        (
            "l, n = ndimage.label(mask, np.ones((3, 3, 3))); return l == np.bincount(l.ravel())[1:].argmax() + 1",
            "not connected",
        ),
        ("l, n = ndimage.label(mask); return l * (l == np.bincount(l.ravel())[1:].argmax() + 1)", "a bool mask"),
    ],
    "2.2": [
        ("return ndimage.binary_fill_holes(mask)", "brain"),
        ("return mask.copy()", "No hole"),
        (
            "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); return mask | ((s[l] <= max_pixels) & (l > 0))",
            "border",
        ),
        (holes("l[0]", "l[-1]"), "four borders"),
        (holes("l[:, 0]", "l[:, -1]"), "four borders"),
        (holes("l[0]", "l[-1]", "l[:, 0]"), "four borders"),
        (holes(*FRAME, structure="np.ones((3, 3))"), "4 neighbours"),
        (holes(*FRAME, compare="<"), "at most"),
        (holes(*FRAME, sizes="s[1:]"), "label before"),
        (holes(*FRAME, given="np.zeros_like(mask)"), "holes alone"),
        (holes(*FRAME, given="(mask * 1)"), "a bool mask"),
    ],
    "3.1": [
        ("return ndimage.binary_dilation(bone) & ~bone", "outside the bone"),
        ("return ndimage.binary_dilation(bone) & ~ndimage.binary_erosion(bone)", "two pixels"),
        ("return bone & ~ndimage.binary_erosion(bone, np.ones((3, 3)))", "cross"),
        (
            "r = np.roll; return bone & ~(r(bone, 1, 0) & r(bone, -1, 0) & r(bone, 1, 1) & r(bone, -1, 1))",
            "opposite border",
        ),
    ],
    "3.2": [
        ("a, b = np.polyfit(points[:, 0], points[:, 1], 1); return np.array([1, a])", "along a row"),
        ("a, b = np.polyfit(points[:, 1], points[:, 0], 1); return np.array([a, 1])", "along a column"),
        ("d = points[-1] - points[0]; return d / np.linalg.norm(d)", "to the last"),
        ("return np.linalg.svd(points)[2][0]", "centred"),
        ("return np.linalg.svd(points - points.mean(0))[2][-1]", "normal"),
    ],
    "3.3": [
        ("return np.arange(len(points))", "counts points"),
        ("return np.hypot(*(points - points[0]).T)", "straight"),
        ("return np.cumsum(np.hypot(*np.diff(points, axis=0).T))", "first point is missing"),
    ],
    "4.1": [
        ("return k * n ** 2 / 8", "N = n - 1"),
        ("return k * (n - 1) ** 2 / 2", "Four times"),
        ("return k * (n - 1) ** 2", "factor"),
    ],
    "4.2": [
        ("return length * (np.tan(theta0) - np.tan(theta1)) / n ** 2", "N = n - 1"),
        ("return length * (np.tan(theta0) + np.tan(theta1)) / (n - 1) ** 2", "negative"),
        ("r = np.radians; return length * (np.tan(r(theta0)) - np.tan(r(theta1))) / (n - 1) ** 2", "radians"),
        ("return length * (np.tan(theta1) - np.tan(theta0)) / (n - 1) ** 2", "sign"),
        ("return length * (theta0 - theta1) / (n - 1) ** 2", "These are angles;"),
        ("return length * (theta0 + np.pi - theta1) / (n - 1) ** 2", "above the chord"),
    ],
    "4.3": [
        ("k = PAPER_PRESSURE", "paper's k"),
        ("k = -tangent_pressure(length, theta0, theta1, n)", "into the head"),
        ("k = 0", "flat"),
        ("return np.linspace([0, 0], [length, 0], n)", "chord"),
        ("return cubic(length, theta0, theta1, n)", "start curve"),
        ("return spiral(length, theta0, theta1, n)[0]", "spiral"),
        ("k = length * (np.tan(theta0) - np.tan(theta1)) / n**2", "too flat"),
        (f"{SLOPES} / n; {REST}", "n - 1 steps"),
        (f"{SLOPES}; {REST}", "divide by n - 1"),
    ],
    "5.1": [
        ("return np.vstack([outer, inner])", "bow tie"),
        ("return outer", "inner curve is missing"),
        ("return inner", "outer curve is missing"),
    ],
    "5.2": [
        ("return region", "Bone is still"),
        ("return region != bone", "rest of the skull"),
        ("return region & bone", "must go"),
    ],
    "5.3": [
        ("return convex_hull_image(bone) & ~bone", "whole difference"),
        ("return ndimage.binary_fill_holes(bone) & ~bone", "convex hull"),
        (
            "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); s[0] = 0; "
            "return (s >= min_pixels)[l]",
            "brain's place",
        ),
        (f"{REGIONS_4}; k = s >= min_pixels; k[s.argmax()] = False; return k[l]", "touch at a corner"),
        (f"{REGIONS_8}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", ">=, not >"),
        (f"{REGIONS_4}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", "(>=), and"),
        (f"{REGIONS_8}; return (s >= min_pixels)[l]", "brain's place"),
    ],
    "6.1": [
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(b, c)).sum() / 3", "Twice"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return abs((a * np.cross(b, c)).sum(1)).sum() / 6", "signs"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(c, b)).sum() / 6", "sign is wrong"),
        (f"{TETRAHEDRA}; return v.sum()", "Six times too big"),
        (f"{TETRAHEDRA}; return abs(v.sum()) / 6", "inside out"),
    ],
    "6.2": [
        ("return index", "still voxels"),
        ("return index * spacing[::-1]", "turn it round"),
        ("return index / spacing", "Divided"),
        ("return index[:, ::-1] * spacing", "columns of the index"),
        ("return (index * spacing)[:, ::-1]", "their columns turned round"),
        ("return (index + 0.5) * spacing", "Half a voxel"),
        ("return index * spacing - spacing / 2", "Half a voxel"),
    ],
    "7.1": [
        ("return np.percentile(cKDTree(b).query(a)[0], 95)", "One way"),
        ("return max(cKDTree(b).query(a)[0].max(), cKDTree(a).query(b)[0].max())", "largest"),
        ("return np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]]).mean()", "mean distance"),
        (f"{NEAREST}; return np.percentile(back, 95)", "what a has too much"),
        (f"{NEAREST}; return max(np.percentile(there, 95), np.percentile(back, 95))", "larger of two percentiles"),
        (f"{NEAREST}; return np.percentile(np.concatenate([there, back]), 0.95)", "not 0.95"),
    ],
    "7.2": [
        ("return points - np.outer((points - origin) @ normal, normal)", "twice as far"),
        ("return points - 2 * np.outer(points @ normal, normal)", "origin given"),
        ("return points * [-1, 1, 1]", "x = 0"),
        ("distance = (points - origin) @ normal; return points - 2 * distance * normal", "distance[:, None]"),
        ("return points + 2 * np.outer((points - origin) @ normal, normal)", "sign is wrong"),
        ("p = points - origin; return p - 2 * np.outer(p @ normal, normal)", "left there"),
    ],
    "8.1": [
        ("return a[0] - b[0], (a[0] + b[0]) / 2", "length 1"),
        ("return np.mean(a - b, axis=0), np.mean(a + b, axis=0) / 2", "length 1"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), a.mean(axis=0)", "half-way"),
        ("return np.array([1, 0, 0]), (a.mean(axis=0) + b.mean(axis=0)) / 2", "head leans"),
        ("n = b[0] - a[0]; return n / np.linalg.norm(n), np.zeros(3)", "0, 0, 0"),
    ],
    "8.2": [
        ("return h", "the largest"),
        ("return h / 2", "exact volume"),
        ("return 2 / 3 * h", "in a slice"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6", "divide it"),
    ],
    "8.3": [
        ("return convex_hull_image(bone) & ~bone", "brain's place"),
        ("return convex_hull_image(bone) ^ (convex_hull_image(inner) & convex_hull_image(bone))", "Bone is still"),
        ("return convex_hull_image(bone) & ~(bone | inner)", "its hull"),
    ],
    "9.1": [
        ("return np.diff(np.eye(n), n=order)", "exchanged"),
        ("d = np.eye(n)[1:] - np.eye(n)[:-1]; return d**order", "difference of differences"),
        ("return np.eye(n)[1:] - np.eye(n)[:-1]", "first difference"),
        ("d = np.eye(n); return d[2:] - 2 * d[1:-1] + d[:-2]", "second difference"),
        ("return np.diff(np.eye(n), order - 1, axis=0)", "too low"),
    ],
    "9.2": [
        (
            f"{SPLINE}; I = np.eye(len(f)); return np.linalg.solve(I + strength * D.T @ D, f)",
            "as if it were bone",
        ),
        (f"{SPLINE}; return np.linalg.solve(W + strength * D.T @ D, f)", "still pulls"),
        (f"{SPLINE}; return np.linalg.solve(np.eye(len(f)) + strength * D.T @ D, W @ f)", "held to 0"),
        (f"{SPLINE}; return np.linalg.solve(W + D.T @ D, W @ f)", "not used"),
        (
            f"{SPLINE}; D = np.diff(np.eye(len(f)), 2, axis=0); return np.linalg.solve(W + strength * D.T @ D, W @ f)",
            "Always the second",
        ),
        (f"{SPLINE}; return np.linalg.solve(W + strength**2 * D.T @ D, W @ f)", "square"),
    ],
    "9.3": [
        (f"{BASIS}; return B @ points", "parabola"),
        (f"{BASIS}; return (B * weights) @ points", "Divide by"),
        (f"{BASIS}; return (B * weights) @ points / weights.sum()", "changes along"),
        (f"{BASIS}; return B @ points / (B @ weights)[:, None]", "above the line"),
        (
            "B = np.column_stack([(1 - t) ** 2, t * (1 - t), t**2]) * weights; "
            "return B @ points / B.sum(axis=1, keepdims=True)",
            "2 t (1 - t)",
        ),
    ],
    "10.1": [
        ("v = [s[key][side] for s in slices]; return min(v), max(v)", "no balloon"),
        ("v = [s[key][1 - side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "side 0"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return max(v), min(v)", "comes first"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return v[0], v[-1]", "in any order"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return (np.mean(v),) * 2", "the mean"),
    ],
    "10.2": [
        ("return np.arcsin(chord / (2 * radius))", "radians"),
        ("return np.degrees(np.arctan(chord / 2 / radius))", "sine"),
        ("return 2 * np.degrees(np.arcsin(chord / 2 / radius))", "centre"),
    ],
}
BALLOON_END = f"{SLOPES} / (n - 1); return inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"


def written(name, body):
    """The shipped function's head with another body."""
    head = SOLUTIONS[name].__code__
    arguments = ", ".join(head.co_varnames[: head.co_argcount])
    if name == "4.3" and "return" not in body:
        body = f"{body}; {BALLOON_END}"
    return function(f"def answer({arguments}):\n    {body}")


def test_every_exercise_has_a_solution_and_three_wrong_answers():
    assert list(SOLUTIONS) == list(EXERCISES) == list(WRONG)
    assert all(len(answers) >= 3 for answers in WRONG.values())


@pytest.mark.parametrize("name", EXERCISES)
def test_the_solution_passes(name):
    verdict = check.exercise(name, SOLUTIONS[name])
    assert verdict.passed and verdict.points == verdict.out_of == 3
    assert str(verdict) == f"Exercise {name}: 3 of 3 points. {verdict.message}"


@pytest.mark.parametrize("name", EXERCISES)
def test_the_stub_is_told_what_to_do(name):
    verdict = check.exercise(name, STUBS[name])
    assert verdict.points == 0 and "Nothing here yet" in str(verdict)


@pytest.mark.parametrize(("name", "body", "hint"), [(n, *w) for n, wrong in WRONG.items() for w in wrong])
def test_a_typical_wrong_answer_gets_its_hint(name, body, hint):
    verdict = check.exercise(name, written(name, body))
    assert not verdict.passed and hint in verdict.message


@pytest.mark.parametrize("name", EXERCISES)
def test_own_catalogue_says_what_it_should(name):
    for mistake, sentence in EXERCISES[name].mistakes:
        verdict = check.exercise(name, mistake)
        assert not verdict.passed and verdict.message == sentence


@pytest.mark.parametrize("name", EXERCISES)
@pytest.mark.parametrize(
    ("answer", "said"),
    [
        (None, "A function is wanted"),
        (3.0, "A function is wanted"),
        (lambda *a: None, "returns nothing"),
        (lambda *a: 1 / 0, "ZeroDivisionError"),
        (lambda: 1, "TypeError"),
        (lambda *a: "text", "right form"),
        (lambda *a: np.full(7, np.nan), "right form"),
        (lambda *a: {"a": object()}, "right form"),
    ],
    ids=["none", "number", "nothing", "fails", "arguments", "text", "nan", "object"],
)
def test_never_raises_and_says_one_line(name, answer, said):
    line = str(check.exercise(name, answer))
    assert said in line and "\n" not in line
    assert line == str(check.exercise(name, answer))


@pytest.mark.parametrize("name", EXERCISES)
def test_hints_come_in_stages(name):
    lines = [str(check.exercise(name, STUBS[name], hint=stage)) for stage in range(5)]
    assert "hint=1" in lines[0] and "Hint 1 of 3" in lines[1] and "Hint 3 of 3" in lines[3] == lines[4][:0] + lines[3]
    assert lines[3] == lines[4] and len({*lines}) == 4


def test_gives_points_for_part_of_the_cases():
    upright_only = written("1.3", "return np.median(np.diff(np.sort(positions[:, 2])))")
    assert check.exercise("1.3", upright_only).points == 2


def test_says_how_far_off_an_unknown_answer_is_in_its_unit():
    verdict = check.exercise("4.3", lambda length, a, b, n: cubic(length, a, b, n) + np.array([0, 5.0]))
    assert "mm, where 0.1 mm is allowed" in verdict.message


def test_sees_a_changed_input():
    def greedy(mask, max_pixels):
        mask[:] = False
        return mask

    assert "work on a copy" in check.exercise("2.2", greedy).message


def test_names_the_exercises_when_there_is_no_such():
    verdict = check.exercise("9.9", len)
    assert not verdict.passed and "4.2" in str(verdict)
