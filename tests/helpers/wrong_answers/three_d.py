"""Wrong answers to the exercises of lesson 09."""

SPLINE = "D, W = np.diff(np.eye(len(f)), order, axis=0), np.diag(known.astype(float))"

BASIS = "B = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2])"

# what students write, and words of the hint that they should get
WRONG = {
    "9.1": [
        (
            (
                "return {1: np.diff(np.eye(n), 1, axis=0), 2: np.diff(np.eye(n), 2, axis=0), 3: np.diff(np.eye(n), "
                "3, axis=0)}[order]"
            ),
            "KeyError",
        ),
        ("return np.diff(np.eye(n), n=order)", "exchanged"),
        ("d = np.eye(n)[1:] - np.eye(n)[:-1]; return d**order", "difference of differences"),
        ("d = np.eye(n - order, n, k=1) - np.eye(n - order, n); return d**order", "difference of differences"),
        ("return np.eye(n)[1:] - np.eye(n)[:-1]", "first difference"),
        ("d = np.eye(n); return d[2:] - 2 * d[1:-1] + d[:-2]", "second difference"),
        ("return np.diff(np.eye(n), order - 1, axis=0)", "too low"),
        ("return np.diff(np.eye(order), n, axis=0)", "n and order are exchanged"),
        ("return np.diff(np.eye(n), order, axis=0).T", "Rows and columns are exchanged"),
        ("return np.diff(np.arange(n), order)", "These are differences of 0"),
        (
            "d = np.diff(np.eye(n), axis=0); return np.linalg.matrix_power(d[:, :-1], order)",
            "A power of a square piece of D",
        ),
        ("return np.eye(n)[order:] - np.eye(n)[:-order]", "This is the difference of values `order`"),
        ("return np.diff(np.eye(n), order, axis=0) / 2", "0.5 times the right"),
        ("return np.abs(np.diff(np.eye(n), order, axis=0))", "The signs are lost"),
        ("return np.diff(np.eye(n), order + 1, axis=0)", "One order too high"),
        ("return np.eye(n) - np.eye(n, k=1)", "This has n rows"),
        (
            (
                "D = np.zeros((n - order, n))\n"
                "    for i in range(n - order):\n"
                "        D[i, i] = -1; D[i, i + 1] = 1\n"
                "    return D"
            ),
            "These are first differences in the right",
        ),
        ("return np.gradient(np.eye(n), axis=0)", "np.gradient takes neighbours on both sides"),
        ("d = np.diff(np.eye(n), order, axis=0); return d.T @ d", "This is D^T D"),
        ("return np.eye(n, k=1) - np.eye(n)", "This has n rows"),
        ("d = np.diff(np.eye(n), axis=0); return d @ d.T", "The function does not use `order`"),
        ("return np.diff(np.eye(n - order), order, axis=0)", None),
        ("return np.diff(np.diff(np.eye(n), axis=0), axis=0)", "This is the second difference"),
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
        (f"{SPLINE}; return np.linalg.solve(W - strength * D.T @ D, W @ f)", "sign of the smoothing"),
        (f"{SPLINE}; return np.linalg.solve(strength * D.T @ D - W, W @ f)", "sign of W"),
        (f"{SPLINE}; return np.linalg.solve(W + strength * D.T @ D, -W @ f)", "sign is turned"),
        ((f"{SPLINE}; return np.linalg.solve(W + strength * D @ D.T, W @ f)"), "A @ A.T for A.T @ A"),
        ((f"{SPLINE}; return np.linalg.lstsq(W + strength * D.T @ D, f)[0]"), "What stands in the gap still pulls"),
        (
            (f"{SPLINE}; return np.where(known, f, np.linalg.solve(W + strength * D.T @ D, W @ f))"),
            "The data are put back unsmoothed",
        ),
        ((f"{SPLINE}; return np.linalg.solve(strength * W + D.T @ D, W @ f)"), "The strength stands at W"),
        (
            (f"{SPLINE}; W = np.diag((~known).astype(float)); return np.linalg.solve(W + strength * D.T @ D, W @ f)"),
            "W has its ones in the gap",
        ),
        ("g = f.copy(); g[~known] = f[known].mean(); return g", "A step to the mean"),
        (
            "x = np.arange(len(f)); return np.polyval(np.polyfit(x[known], f[known], order), x)",
            "One polynomial through everything",
        ),
        ((f"{SPLINE}; return np.linalg.inv(W + strength * D.T @ D) @ f * known"), None),
        ((f"{SPLINE}; return np.linalg.solve(W + strength * D.T @ D, W @ f)[~known]"), "This is the gap alone"),
        (
            (f"{SPLINE}; return np.linalg.solve(W + order * strength * D.T @ D, W @ f)"),
            "The strength is already the whole factor of",
        ),
        (
            (
                f"{SPLINE}; "
                "D = np.diff(np.eye(len(f)), 1, axis=0); "
                "return np.linalg.solve(W + strength * D.T @ D, W @ f)"
            ),
            "Always the first order",
        ),
        (
            (f"{SPLINE}; return np.linalg.solve(W + np.sqrt(strength) * D.T @ D, W @ f)"),
            "The strength is already the whole factor of",
        ),
        ("x = np.arange(len(f)); return np.interp(x, x[known], f[known])", "A straight bridge"),
        ((f"{SPLINE}; return np.where(known, f, 0)"), "These are the data alone"),
    ],
    "9.3": [
        (
            (
                "B = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2]) * np.sqrt(weights); "
                "return B @ points / B.sum(axis=1, keepdims=True)"
            ),
            "no root",
        ),
        (f"{BASIS}; return B @ points", "parabola"),
        (f"{BASIS}; return (B * weights) @ points", "Divide by"),
        (f"{BASIS}; return (B * weights) @ points / weights.sum()", "changes along"),
        (f"{BASIS}; return B @ points / (B @ weights)[:, None]", "above the line"),
        (
            "B = np.column_stack([(1 - t) ** 2, t * (1 - t), t**2]) * weights; "
            "return B @ points / B.sum(axis=1, keepdims=True)",
            "2 t (1 - t)",
        ),
        ((f"{BASIS}; return B * weights @ points / B.sum(axis=1, keepdims=True)"), "Divide by the sum of w_i B_i(t)"),
        ((f"{BASIS}; s = B * weights; return s @ points / s.sum()"), "This divides by the sum over all t"),
        ((f"{BASIS}; s = B * weights; return s @ points / s.sum(axis=0)[:2]"), "Summed the wrong way"),
        (f"{BASIS}; s = B * weights; return s @ points / s.sum(axis=0)", "along the wrong axis"),
        (f"{BASIS}; s = B * weights; return s @ points / s.sum(axis=0, keepdims=True)", "along the wrong axis"),
        (
            (f"{BASIS}; s = B * weights; return (s @ points / s.sum(axis=1, keepdims=True)).T"),
            "Rows and columns are exchanged",
        ),
        ((f"{BASIS}; s = B * weights; return s @ points / s.sum(axis=1)"), "stopped with ValueError"),
        (
            (
                "B = np.column_stack([t**2, 2 * t * (1 - t), (1 - t)**2]); s = B * weights; "
                "return s @ points / s.sum(axis=1, keepdims=True)"
            ),
            "The curve runs backwards",
        ),
        (
            (
                "B = np.column_stack([1 - t, 2 * t * (1 - t), t]); s = B * weights; "
                "return s @ points / s.sum(axis=1, keepdims=True)"
            ),
            "The outer functions are squares",
        ),
        ((f"{BASIS}; w = weights / weights.sum(); return (B * w) @ points"), "The divisor changes along the curve"),
        (
            (f"{BASIS}; s = B * weights**2; return s @ points / s.sum(axis=1, keepdims=True)"),
            "The weights come in once",
        ),
        ((f"{BASIS}; s = B / weights; return s @ points / s.sum(axis=1, keepdims=True)"), "Multiply by the weights"),
        ("return points[0] + t[:, None] * (points[2] - points[0])", "A straight line from end to end"),
        ((f"{BASIS}; return B @ (points * weights[:, None])"), "Divide by the sum of w_i B_i(t)"),
        (
            (
                f"{BASIS}; "
                "s = B * weights; p = s @ points / s.sum(axis=1, keepdims=True); "
                "return p / np.linalg.norm(p, axis=1, keepdims=True)"
            ),
            "Every point is put on a circle of radius 1",
        ),
        (
            (
                "B = np.column_stack([(1 - t) ** 2, 2 * (1 - t), t**2]); s = B * weights; "
                "return s @ points / s.sum(axis=1, keepdims=True)"
            ),
            None,
        ),
        (
            (
                "B = np.column_stack([(1 - t) ** 2, 2 * t * (1 - t), t**2]); "
                "return B @ (weights[:, None] * points) / weights.sum()"
            ),
            "The divisor changes along the curve",
        ),
        ("B = np.column_stack([(1 - t) ** 2, t * (1 - t), t**2]); return B @ points", "The weights are not used"),
        (
            (
                "B = np.column_stack([(1 - t) ** 3, 3 * t * (1 - t), t**3]); s = B * weights; "
                "return s @ points / s.sum(axis=1, keepdims=True)"
            ),
            None,
        ),
    ],
}
