"""Wrong answers to the exercises of lesson 03."""

ROUND = "p = np.pad(bone, 1); a, b, c, d = p[:-2, 1:-1], p[2:, 1:-1], p[1:-1, :-2], p[1:-1, 2:]"
STEPS = "s = np.linalg.norm(np.diff(points, axis=0), axis=1)"
PARTS = "h = len(points)"

# what students write, and words of the hint that they should get
WRONG = {
    "3.1": [
        ("return bone & ~ndimage.binary_erosion(ndimage.binary_fill_holes(bone))", "inner boundary is missing"),
        ("one = ndimage.label(bone)[0] == 1; return one & ~ndimage.binary_erosion(one)", "one piece of bone"),
        ("return (bone & ~ndimage.binary_erosion(bone)).astype(int)", "as numbers"),
        ("return ndimage.binary_dilation(bone) & ~bone", "outside the bone"),
        ("return ndimage.binary_dilation(bone) & ~ndimage.binary_erosion(bone)", "two pixels"),
        ("return bone & ~ndimage.binary_erosion(bone, np.ones((3, 3)))", "cross"),
        (
            "r = np.roll; return bone & ~(r(bone, 1, 0) & r(bone, -1, 0) & r(bone, 1, 1) & r(bone, -1, 1))",
            "opposite border",
        ),
        ("return ndimage.binary_dilation(bone) & bone", "A dilation grows"),
        ("return bone ^ ndimage.binary_dilation(bone)", "These pixels lie outside the bone"),
        ("return np.argwhere(bone & ~ndimage.binary_erosion(bone))", "These are places"),
        ("return ndimage.binary_erosion(bone) ^ bone | ~bone", "All the background is in it"),
        ("return ~ndimage.binary_erosion(bone)", "All the background is in it"),
        ("return bone & ~ndimage.binary_erosion(bone, iterations=2)", "This band is two pixels wide"),
        ("return np.abs(np.diff(bone.astype(int), axis=0, prepend=0)) > 0", "One axis only"),
        ("return np.gradient(bone.astype(float))[0] != 0", "One axis only"),
        ("return bone & ndimage.binary_erosion(bone)", "This is the inside"),
        (
            (
                "r = np.zeros_like(bone)\n"
                "    for i in range(1, bone.shape[0] - 1):\n"
                "        for j in range(1, bone.shape[1] - 1):\n"
                "            r[i, j] = bone[i, j] and not (bone[i-1, j] & bone[i+1, j] & bone[i, j-1] & bone[i, j+1])\n"
                "    return r"
            ),
            "The outermost rows and columns are left out",
        ),
        ("return bone - ndimage.binary_erosion(bone)", "Masks cannot be subtracted"),
        ("return bone & ~ndimage.binary_opening(bone)", "grows again"),
        (f"{ROUND}; return bone & ~(a | b | c | d)", "one neighbour that is not bone is enough"),
        (f"{ROUND}; return bone & ~(a & b)", "Neighbours are left out"),
        (f"{ROUND}; return bone & ~(c & d)", "Neighbours are left out"),
        (f"{ROUND}; return bone & ~(a & c)", "Neighbours are left out"),
        (f"{ROUND}; return bone & ~(a & b & c)", "Neighbours are left out"),
        (f"{ROUND}; return ~bone & (a | b | c | d)", "outside the bone"),
        ("return bone & (ndimage.uniform_filter(bone.astype(float), 3) < 0.99)", "cross of 4"),
        ("return ndimage.binary_closing(bone) & ~bone", "Closing fills bays"),
        ("return ndimage.sobel(bone.astype(float)) != 0", None),
        ("return bone & ndimage.binary_dilation(~bone)", "At the edge of the image there is boundary"),
    ],
    "3.2": [
        ("p = points - points.mean(axis=0); return np.abs(np.linalg.svd(p)[2][0])", "signs are lost"),
        ("return np.linalg.eig(np.cov(points.T))[1][:, 0]", "does not sort"),
        ("a, b = np.polyfit(points[:, 0], points[:, 1], 1); return np.array([1, a])", "along a row"),
        ("a, b = np.polyfit(points[:, 1], points[:, 0], 1); return np.array([a, 1])", "along a column"),
        ("d = points[-1] - points[0]; return d / np.linalg.norm(d)", "to the last"),
        ("return np.linalg.svd(points)[2][0]", "centred"),
        ("return np.linalg.svd(points - points.mean(0))[2][-1]", "normal"),
        ("return np.linalg.svd(points - points.mean(0))[1]", "how far the points spread"),
        (
            (
                "a = np.polyfit(points[:,0], points[:,1], 1, full=True); "
                "b = np.polyfit(points[:,1], points[:,0], 1, full=True); "
                "return np.array([1, a[0][0]]) if a[1][0] < b[1][0] else np.array([b[0][0], 1])"
            ),
            "The better of two np.polyfit measures along",
        ),
        ("return points.mean(axis=0)", "The points are not centred"),
        ("return np.linalg.svd(points - points.mean(axis=0))[0][0]", "The first array has a row for each point"),
        ("return np.linalg.svd(points - points.mean())[2][0]", "p.mean() is one number for rows and columns"),
        ("return np.diff(points, axis=0).mean(axis=0)", "From the first point to the last"),
        (
            "u, s, v = np.linalg.svd(points - points.mean(axis=0)); return v[:, 0]",
            "Directions are the rows of the third array",
        ),
        ("return np.linalg.svd(points - points.mean(axis=0))[2]", "These are both directions"),
        ("return np.diff(points, axis=0)[0]", "Two pixels are too few"),
        ("w, v = np.linalg.eigh(np.cov(points.T)); return v[:, 0]", "This is the normal"),
        (
            "return np.linalg.svd(points - points.mean(axis=1, keepdims=True))[2][0]",
            "This centres each point by itself",
        ),
        ("return np.ptp(points, axis=0)", "Height and width of the cloud have no sign"),
        ("d = np.diff(points, axis=0); return np.median(d, axis=0)", "From point to point the noise is as long as"),
        ("d = points - points.mean(axis=0); return d.std(axis=0)", "The spreads of rows and columns have no sign"),
        (
            "d = points - points.mean(axis=0); return d[np.linalg.norm(d, axis=1).argmax()]",
            "From the first point to the last",
        ),
        ("d = points[len(points)//2:].mean(0) - points[0]; return d", "One end is a single point"),
        (f"{PARTS} // 2; return points[h:].mean(axis=0) - points[:h].mean(axis=0)", "Two means joined"),
        (f"{PARTS} // 2; return points[-h:].mean(axis=0) - points[:h].mean(axis=0)", "Two means joined"),
        (f"{PARTS} // 3; return points[-h:].mean(axis=0) - points[:h].mean(axis=0)", "Two means joined"),
        ("return np.linalg.svd(points - points[0])[2][0]", "One point was taken for the centre"),
        ("return np.linalg.svd(points - points[-1])[2][0]", "One point was taken for the centre"),
        (
            "d = points - points.mean(axis=0); return np.linalg.svd(d / points.std(axis=0))[2][0]",
            "another shape",
        ),
        ("return np.linalg.eig(points.T @ points)[1][:, 0]", None),
    ],
    "3.3": [
        (
            "p = points[::-1]; return np.r_[0, np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))]",
            "from the last point",
        ),
        (
            "d = np.diff(points, axis=0); return np.sqrt(np.r_[0, np.cumsum((d**2).sum(axis=1))])",
            "root of the sum of all squares",
        ),
        ("return np.arange(len(points))", "counts points"),
        ("return np.hypot(*(points - points[0]).T)", "straight"),
        ("return np.cumsum(np.hypot(*np.diff(points, axis=0).T))", "first point is missing"),
        ("return np.linalg.norm(np.diff(points, axis=0), axis=1)", "These are the lengths of the steps"),
        (
            "return np.concatenate([[0], np.linalg.norm(np.diff(points, axis=0), axis=1)])",
            "These are the lengths of the steps",
        ),
        ("return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()", "This is the whole length"),
        ("return np.concatenate([[0.0], np.cumsum((np.diff(points, axis=0)**2).sum(axis=1))])", "The root is missing"),
        (
            ("s = np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)); return np.concatenate([s, [s[-1]]])"),
            "The 0 belongs in front",
        ),
        ("return np.cumsum(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1))", "np.roll adds"),
        ("return np.cumsum(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))", "np.roll adds"),
        (f"{STEPS}; return np.linspace(0, s.sum(), len(points))", "Not all steps"),
        ("return np.cumsum(np.linalg.norm(points, axis=1))", "These are distances from 0"),
        ("return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points), axis=1))])", "Which axis"),
        ("return np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=0)))", "Which axis"),
        ("return np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0))))", "Which axis"),
        (f"{STEPS}; return np.concatenate([[1.0], np.cumsum(s)])", "lies at length 0"),
        (f"{STEPS}; return np.append(np.cumsum(s), 0)", "The 0 stands in front"),
        (f"{STEPS}; return np.concatenate([[0], np.cumsum(s)[:-1], [0]])", "The last length is lost"),
        (
            "return np.cumsum(np.linalg.norm(np.diff(points, axis=0, prepend=0), axis=1))",
            "as a step",
        ),
        ("return np.append(0, np.cumsum(np.diff(points, axis=0).sum(axis=1)))", "with their signs"),
        ("return np.cumsum(np.linalg.norm(np.gradient(points, axis=0), axis=1))", "np.gradient takes"),
        (
            (
                "s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]); "
                "return s / s[-1]"
            ),
            "This is the part of the whole way",
        ),
        ("return np.linalg.norm(points - points[0])", "One number for all"),
        ("return np.cumsum(np.abs(np.diff(points, axis=0)).max(axis=1))", "This takes the longer side of each step"),
        ("return np.arange(len(points)) * np.sqrt(2)", "Not every step is a diagonal"),
        (
            ("d = np.linalg.norm(np.diff(points, axis=0), axis=1); return np.concatenate([[0], np.cumsum(d)])[::-1]"),
            "These are the right values in turned order",
        ),
    ],
}
