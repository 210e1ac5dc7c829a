"""Wrong answers to the exercises of lesson 08."""

# what students write, and words of the hint that they should get
WRONG = {
    "8.1": [
        ("return a[0] - b[0], (a[0] + b[0]) / 2", "length 1"),
        ("return np.mean(a - b, axis=0), np.mean(a + b, axis=0) / 2", "length 1"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), a.mean(axis=0)", "half-way"),
        ("return np.array([1, 0, 0]), (a.mean(axis=0) + b.mean(axis=0)) / 2", "head leans"),
        ("n = b[0] - a[0]; return n / np.linalg.norm(n), np.zeros(3)", "0, 0, 0"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), (a[0] + b[0]) / 2", "first pair only"),
        ("n = a[0] - b[0]; return n / np.linalg.norm(n), (a + b).mean(axis=0) / 2", "normal rests on the first"),
        ("n = (a - b).sum(axis=0); return n / np.linalg.norm(n), (a[0] + b[0]) / 2", "point rests on the first"),
        (
            "n = (a - b).mean(axis=0); return n / np.linalg.norm(n), np.array([0, 0, 0])",
            "The plane need not pass through 0",
        ),
        ("n = (a - b).mean(axis=0); n /= np.linalg.norm(n); return n", "The point is missing"),
        ("n = (a - b).mean(axis=0); n /= np.linalg.norm(n); return (a + b).mean(axis=0) / 2, n", "Turned round"),
        (
            "n = (a + b).mean(axis=0); n /= np.linalg.norm(n); return n, (a + b).mean(axis=0) / 2",
            "The normal runs from a point to its partner",
        ),
        (
            ("n = np.linalg.svd((a + b) / 2 - ((a + b) / 2).mean(axis=0))[2][0]; return n, (a + b).mean(axis=0) / 2"),
            "This is the direction in which the middles",
        ),
        (
            "n = np.cross(a[0], b[0]); return n / np.linalg.norm(n), (a + b).mean(axis=0) / 2",
            "A cross product lies across both",
        ),
        (
            "n = (a - b).mean(axis=0); n /= np.linalg.norm(n); return n, (a - b).mean(axis=0) / 2",
            "The point is half of the way across",
        ),
        (
            "n = a - b; n = n / np.linalg.norm(n, axis=1, keepdims=True); return n, (a + b) / 2",
            "A normal and a point for each pair",
        ),
        ("n = (a - b).mean(); return n, (a + b).mean() / 2", None),
        ("n = (a - b).mean(axis=0); return n / n.sum(), (a + b).mean(axis=0) / 2", "Divided by the sum of its parts"),
        (
            "n = a.mean(axis=0) - b.mean(axis=0); n /= np.linalg.norm(n); return n, b.mean(axis=0)",
            "The plane passes through the points",
        ),
        (
            "n = (a[-1] - b[-1]); n /= np.linalg.norm(n); return n, (a[-1] + b[-1]) / 2",
            "This rests on the last pair only",
        ),
        (
            "n = (a - b).mean(axis=0); return n / np.linalg.norm(a - b), (a + b).mean(axis=0) / 2",
            "np.linalg.norm(a - b) is one number for all",
        ),
    ],
    "8.2": [
        ("return h", "the largest"),
        ("return h / 2", "exact volume"),
        ("return 2 / 3 * h", "in a slice"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6", "divide it"),
        ("return h * (3 * a**2 + h**2) / (6 * a)", "The area of the lid grows with a squared"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / (4 * np.pi * a**2)", "a is the radius of the hole"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / (np.pi * (2 * a)**2)", "a is the radius of the hole"),
        ("return h * (3 * a**2 + h**2) / 6", "The area of the lid"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / a**2", "pi is in the area too"),
        ("return h / 3", "This is the mean of a cone"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / (2 * np.pi * a)", "2 pi a is the rim of the lid"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / (np.pi * h**2)", "h is the height"),
        ("return h * (3 * a + h**2) / (6 * a**2)", "In the volume of the cap a is squared"),
        ("return np.pi * h * (3 * a**2 + h**2) / 6 / (np.pi * (a**2 + h**2))", "This is the area of the cap"),
        ("return a / 2", None),
        ("return np.pi * h * (3 * a**2 + h**2) / (6 * np.pi) * a**2", "Brackets: a^2 stands below the"),
    ],
    "8.3": [
        ("return convex_hull_image(bone) & ~bone", "brain's place"),
        ("return convex_hull_image(bone) ^ (convex_hull_image(inner) & convex_hull_image(bone))", "Bone is still"),
        ("return convex_hull_image(bone) & ~(bone | inner)", "its hull"),
        ("return convex_hull_image(bone)", "This is the whole hull of the bone"),
        ("return convex_hull_image(bone) & ~inner", "Only the inner edge was taken away"),
        ("return ~convex_hull_image(inner) & ~bone", "What lies outside the head is in it"),
        ("return convex_hull_image(bone & ~inner)", "This is the whole hull of the bone"),
        ("return convex_hull_image(bone) ^ convex_hull_image(inner)", "Bone is still in it"),
        ("return convex_hull_image(inner) & ~convex_hull_image(bone) & ~bone", "Turned round"),
        ("return convex_hull_image(bone) - convex_hull_image(inner) - bone", "stopped with TypeError"),
        (
            "return convex_hull_image(bone) & ~ndimage.binary_fill_holes(inner) & ~bone",
            "Only the inner edge was taken away",
        ),
        ("return convex_hull_image(bone) & convex_hull_image(inner) & ~bone", "This is the inside of the head"),
        ("return bone", "This is the bone that is there already"),
        ("return convex_hull_image(bone) & ~convex_hull_image(inner) | bone", "The bone is in it"),
    ],
}
