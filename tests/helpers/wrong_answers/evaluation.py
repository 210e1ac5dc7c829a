"""Wrong answers to the exercises of lesson 07."""

NEAREST = "there, back = spatial.cKDTree(b).query(a)[0], spatial.cKDTree(a).query(b)[0]"

# what students write, and words of the hint that they should get
WRONG = {
    "7.1": [
        ("return np.percentile(spatial.cKDTree(b).query(a)[0], 95)", "One way"),
        ("return max(spatial.cKDTree(b).query(a)[0].max(), spatial.cKDTree(a).query(b)[0].max())", "largest"),
        (
            "return np.concatenate([spatial.cKDTree(b).query(a)[0], spatial.cKDTree(a).query(b)[0]]).mean()",
            "mean distance",
        ),
        (f"{NEAREST}; return np.percentile(back, 95)", "what a has too much"),
        (f"{NEAREST}; return max(np.percentile(there, 95), np.percentile(back, 95))", "larger of two percentiles"),
        (f"{NEAREST}; return np.percentile(np.concatenate([there, back]), 0.95)", "not 0.95"),
        ("return np.percentile(np.linalg.norm(a - b[:len(a)], axis=1), 95) if len(a) <= len(b) else 0.0", None),
        (
            (f"{NEAREST}; return (np.percentile(there, 95) + np.percentile(back, 95)) / 2"),
            "This is the mean of two percentiles (some",
        ),
        ((f"{NEAREST}; return np.percentile(np.concatenate([there, back]), 5)"), "The worst 5 percent are left out"),
        ((f"{NEAREST}; return np.median(np.concatenate([there, back]))"), "This is the median"),
        ((f"{NEAREST}; return 0.95 * np.concatenate([there, back]).max()"), "95 percent of the largest distance"),
        ((f"{NEAREST}; return max(there.max(), back.max()) * 0.95"), "95 percent of the largest distance"),
        ((f"{NEAREST}; return np.concatenate([there, back])"), "These are all distances"),
        ("return np.percentile(spatial.distance.cdist(a, b).min(), 95)", None),
        ((f"{NEAREST}; return np.percentile(there + back, 95)"), "stopped with ValueError"),
        ((f"{NEAREST}; return np.percentile([there, back], 95)"), "stopped with ValueError"),
        ("return spatial.cKDTree(b).query(a)", "One number is wanted"),
        (
            "return np.percentile(np.concatenate([spatial.cKDTree(b).query(a), spatial.cKDTree(a).query(b)]), 95)",
            "[0] are distances",
        ),
        ("return spatial.distance.directed_hausdorff(a, b)[0]", "This is the largest distance"),
        (
            "i = spatial.cKDTree(b).query(a)[1]; return np.percentile(i, 95)",
            "query gives distances and numbers of points",
        ),
        (
            (f"{NEAREST}; return min(np.percentile(there, 95), np.percentile(back, 95))"),
            "This is the smaller of two percentiles",
        ),
        ((f"{NEAREST}; return np.percentile(np.concatenate([there, back])**2, 95)"), "These are squares of distances"),
        ("return np.percentile(spatial.cKDTree(a).query(a)[0], 95)", "each set is asked for its own points"),
        (
            "d = spatial.cKDTree(a).query(a)[0], spatial.cKDTree(b).query(b)[0]; "
            "return np.percentile(np.concatenate(d), 95)",
            "each set is asked for its own points",
        ),
        (
            "i = spatial.cKDTree(b).query(a)[1], spatial.cKDTree(a).query(b)[1]; "
            "return np.percentile(np.concatenate(i), 95)",
            "numbers of points",
        ),
        ("return np.percentile(spatial.cKDTree(a).query(b)[1], 95)", "numbers of points"),
        (
            "i = spatial.cKDTree(b).query(a)[1], spatial.cKDTree(a).query(b)[1]; "
            "return max(np.percentile(n, 95) for n in i)",
            "numbers of points",
        ),
        ("return np.percentile(spatial.cKDTree(b).query(a, k=2)[0], 95)", "k=2 takes the second nearest point too"),
        ("return spatial.cKDTree(b).query(a)[0].mean()", "This is the mean distance"),
        ("return np.linalg.norm(a.mean(0) - b.mean(0))", None),
    ],
    "7.2": [
        ("return np.array([points[i] - 2 * ((points[i] - origin) @ normal) * normal for i in range(3)])", "form"),
        (
            (
                "out = points.copy(); "
                "out[:, :2] -= 2 * ((points - origin)[:, :2] @ normal[:2])[:, None] * normal[:2]; "
                "return out"
            ),
            None,
        ),
        ("return points - np.outer((points - origin) @ normal, normal)", "twice as far"),
        ("return points - 2 * np.outer(points @ normal, normal)", "origin given"),
        ("return points * [-1, 1, 1]", "x = 0"),
        ("d = abs((points - origin) @ normal); return points - 2 * d[:, None] * normal", "without abs"),
        ("return np.flip(points, axis=0)", "order of the points"),
        ("return points[::-1, ::-1]", "no plane"),
        ("return points[:, ::-1]", "swaps x and z"),
        ("distance = (points - origin) @ normal; return points - 2 * distance * normal", "one number for each row"),
        ("return points + 2 * np.outer((points - origin) @ normal, normal)", "sign is wrong"),
        ("p = points - origin; return p - 2 * np.outer(p @ normal, normal)", "left there"),
        ("return -points", "This is a point reflection"),
        ("return points - (points @ normal)[:, None] * normal", "The points stop on a plane through 0"),
        ("return points - 2 * normal", "All points are moved by the same step"),
        ("return points - 2 * (points - origin) * normal", "The distance is a dot product"),
        ("return points - 2 * (points - origin) * normal * normal", "The distance is a dot product"),
        ("return 2 * origin - points", "This is a point reflection"),
        ("return origin - 2 * np.outer((points - origin) @ normal, normal)", "The steps are taken off the origin"),
        ("return -2 * np.outer((points - origin) @ normal, normal)", "These are the steps alone"),
        ("return (points - origin) @ normal", "These are the distances from the plane"),
        ("return points * (1 - 2 * normal)", "This turns single axes round"),
        ("return points", "This is `points`"),
        ("return points - 2 * np.outer((points + origin) @ normal, normal)", "Measure from the origin"),
        ("return points * -normal", "does not use `origin`"),
        ("return points @ np.diag([-1, 1, 1])", "This mirrors at x = 0"),
        ("return points + origin - 2 * np.outer(points @ normal, normal)", None),
        ("return points - 2 * ((points - origin) @ normal)", "keep it a column"),
        ("return points - 2 * origin", "The function does not use `normal`"),
        (
            "d = np.linalg.norm(points - origin, axis=1); return points - 2 * d[:, None] * normal",
            "This is the distance from the origin given",
        ),
        ("return 2 * origin - points - 2 * np.outer((points-origin) @ normal, normal)", None),
    ],
}
