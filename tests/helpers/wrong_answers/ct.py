"""Wrong answers to the exercises of lesson 01."""

GREY = "g = (hu - (centre - width / 2)) / width * 255"
STEPS = "s = np.linalg.norm(affine[:3, :3], axis=0)"

# what students write, and words of the hint that they should get
WRONG = {
    "1.1": [
        ("low = centre - width // 2; return np.clip((hu - low) / width, 0, 1) * 255", "half of an odd width"),
        ("return np.clip((hu - centre + width / 2) / width * 256, 0, 255)", "by 256 white is reached"),
        ("return np.clip((hu - width + centre / 2) / centre, 0, 1) * 255", "exchanged"),
        ("return (np.clip((hu - centre + width / 2) / width, 0, 1) * 255).tolist()", "in a list"),
        ("return 255 * (hu - centre + width / 2) / width", "clip"),
        ("return np.clip((hu - centre) / width, 0, 1) * 255", "starts at"),
        ("return np.clip((hu - centre) / width + 0.5, 0, 1)", "0 to 1"),
        ("return ((hu - centre + width / 2) / width * 255).astype(int).astype(np.uint8)", "uint8"),
        ("return np.clip((hu - centre + width) / (2 * width), 0, 1) * 255", "twice too wide"),
        ("return np.clip(hu, centre - width / 2, centre + width / 2)", "These are still HU"),
        ("return (hu - hu.min()) / (hu.max() - hu.min()) * 255", "This stretches the whole range of the slice"),
        ("return np.clip((hu - centre) / width * 255, 0, 255)", "The window starts at centre - width / 2"),
        ("return (np.clip((hu - centre + width / 2) / width, 0, 1) * 255).astype(bool)", "This runs from 0 to 1"),
        (
            "low = centre - width; return np.clip((hu - low) / width, 0, 1) * 255",
            "The window starts at centre - width / 2",
        ),
        ("return np.clip((hu - (centre - width / 2)) / (width / 2), 0, 1) * 255", "The window is width wide"),
        ("return (hu > centre) * 255", "This is black and white only"),
        ("return np.clip((hu - centre + width / 2) * 255, 0, 255)", "Divide by width"),
        ("return np.clip((hu - width / 2) / width, 0, 1) * 255", "The function does not use `centre`"),
        ("return np.clip((hu - centre - width / 2) / width, 0, 1) * 255", "The window starts at centre - width / 2"),
        (f"{GREY}; g[g > 255] = g[g < 0] = 0; return g", "Above the window is white"),
        (f"{GREY}; return np.where((g > 0) & (g < 255), g, 255)", "Below the window is black"),
        (f"{GREY}; return np.where(g < 0, 255, np.where(g > 255, 0, g))", "Below the window is black"),
        (f"{GREY}; return np.minimum(g, 255)", "Only one end"),
        (f"{GREY}; return np.maximum(g, 0)", "Only one end"),
        ("return np.clip((hu - centre + width / 2) / width, 0, 1) * 256", "not by 256"),
        ("return (np.clip((hu - centre + width / 2) / width, 0, 1) * 256).astype(np.uint8)", "As uint8 256 becomes 0"),
        ("return np.clip((hu - centre + width / 2) / width, 0, 1) * 254", "0.9961 times the right"),
        ("return np.clip((hu - centre + width / 2) // width, 0, 1) * 255", "`//` cuts"),
        ("return np.round(np.clip((hu - centre + width / 2) / width, 0, 1)) * 255", "black and white only"),
        (
            "c = np.clip(hu, centre - width / 2, centre + width / 2); return (c - c.min()) / np.ptp(c) * 255",
            "stretches",
        ),
        ("low = centre - width / 2; return np.clip(hu - low / width, 0, 1) * 255", "in brackets"),
        ("low = (centre - width) / 2; return np.clip((hu - low) / width, 0, 1) * 255", "not (centre - width) / 2"),
        ("return np.clip(hu - (centre - width / 2), 0, 255)", "Divide by width"),
    ],
    "1.2": [
        ("p = affine[:3, :3] @ index + affine[:3, 3]; return p * [-1, -1, 1]", "signs turned"),
        (
            (
                "return [affine[0, 2] * index[2] + affine[0, 3], affine[1, 1] * index[1] + affine[1, 3], affine[2, "
                "0] * index[0] + affine[2, 3]]"
            ),
            "Spacings alone",
        ),
        ("return affine[:3, :3].dot(index)", "origin"),
        ("return (affine @ np.append(index[::-1], 1))[:3]", "turn it round"),
        ("return index @ affine[:3, :3] + affine[:3, 3]", "transposed"),
        ("return affine @ np.append(index, 1)", "Four numbers"),
        ("return (affine[:3,:3] @ index + affine[:3,3])[::-1]", "These are z, y, x: the matrix "),
        ("return affine[:3,:3] @ index + affine[3,:3]", "The origin is missing"),
        ("return affine[:3,:3] @ (index + affine[:3,3])", "First the steps"),
        ("return affine[:3,:3] * index + affine[:3,3]", "`*` multiplies number by number"),
        ("return np.linalg.inv(affine)[:3,:3] @ index + affine[:3,3]", "The inverse leads back"),
        ("return (np.linalg.inv(affine) @ np.append(index, 1))[:3]", "The inverse leads back"),
        (f"{STEPS}; return s * index + affine[:3, 3]", "Spacings alone"),
        (f"{STEPS}; return s[::-1] * index[::-1] + affine[:3, 3]", "Spacings alone"),
        (f"{STEPS}; return s.round(1) * index + affine[:3, 3]", "Spacings alone"),
        ("return np.linalg.norm(affine[:3, :3], axis=1) * index + affine[:3, 3]", "Spacings alone"),
        ("return affine[:3, :3].max(axis=0) * index + affine[:3, 3]", "Spacings alone"),
        ("return affine[:3, :3].sum(axis=0) * index + affine[:3, 3]", "Spacings alone"),
        ("return (affine @ np.append(1, index))[:3]", "The 1 stands behind"),
        ("return (np.append(index, 1) @ affine)[:3]", "transposed"),
        ("return (affine @ np.append(index, 0))[:3]", "origin is missing"),
        ("return affine[:3, 3]", "This is the place of voxel (0"),
        ("return affine[:3,:3] @ index - affine[:3,3]", "The origin is added"),
        ("return affine[:3,:3] @ (index + 0.5) + affine[:3,3]", "Half a voxel off"),
        ("return index + affine[:3,3]", "These are still voxels"),
        ("return affine @ index", "4 columns left and 3 rows"),
        ("return (affine[:3,:3] @ index + affine[:3,3]).round()", "rounded"),
        ("return affine[:3,:3] @ index * affine[:3,3]", "not multiplied"),
        ("return np.diag(affine)[:3] * index + affine[:3,3]", "Spacings alone"),
    ],
    "1.3": [
        (
            (
                "d = np.round(np.diff(np.sort(positions @ normal)), 3); "
                "v, n = np.unique(d, return_counts=True); return v[n.argmax()]"
            ),
            None,
        ),
        ("d = np.sort(np.diff(np.sort(positions @ normal))); return d[len(d) // 2]", "mean of the two in the middle"),
        ("return str(np.median(np.diff(np.sort(positions @ normal))))", "returns text"),
        ("return np.median(np.diff(np.sort(positions @ np.abs(normal))))", "drops signs of the normal"),
        ("return np.array([np.median(np.diff(np.sort(positions @ normal)))])", "stands in an array"),
        ("z = sorted(positions[:, 2]); return np.median(np.diff(z))", "tilted"),
        ("return np.median(np.diff(positions @ normal))", "any order"),
        ("return positions[1, 2] - positions[0, 2]", "any order"),
        ("return np.median(np.abs(np.diff(positions @ normal)))", "any order"),
        ("return np.diff(np.sort(positions @ normal)).mean()", "pulls the mean"),
        ("return np.diff(np.sort(positions @ normal)).min()", "This is the smallest step"),
        ("return np.diff(np.sort(positions @ normal)).max()", "This is the largest step"),
        ("return np.median(positions @ normal)", "This is the median height"),
        ("return np.diff(np.sort(positions @ normal))[0]", "This is the first step only"),
        ("return np.median(np.linalg.norm(np.diff(positions, axis=0), axis=1))", "Files come in any order"),
        ("return np.diff(np.sort(positions @ normal))", "These are all the steps"),
        ("h = np.sort(positions @ normal); return (h[-1] - h[0]) / len(h)", "n slices have n - 1 steps between them"),
        ("h = np.sort(positions @ normal); return (h[-1] - h[0]) / (len(h) - 1)", "A slice may be missing"),
        (
            (
                "p = positions[np.argsort(positions[:, 2])]; "
                "return np.median(np.linalg.norm(np.diff(p, axis=0), axis=1))"
            ),
            "all have one z",
        ),
        (
            "p = positions[np.argsort(positions @ normal)]; "
            "return np.median(np.linalg.norm(np.diff(p, axis=0), axis=1))",
            "the way from slice to slice",
        ),
        ("p = positions[np.argsort(positions[:, 2])]; return np.median(np.diff(p @ normal))", "all have one z"),
        ("p = positions[positions[:, 2].argsort()]; return np.median(abs(np.diff(p @ normal)))", "all have one z"),
        ("return np.median(np.diff(np.array(sorted(positions.tolist())) @ normal))", "sorts by x first"),
        ("return np.median(np.diff(positions, axis=0))", "The function does not use `normal`"),
        ("return np.mean(positions @ normal)", "This is the mean height"),
        ("return np.median(np.diff(np.sort(positions, axis=0) @ normal))", "each by itself"),
        (
            "p = np.sort(positions, axis=0); return np.median(np.linalg.norm(np.diff(p, axis=0), axis=1))",
            "the way from slice",
        ),
        ("return abs(np.median(np.diff(np.sort(positions[:, 2])) * normal[2]))", "z is not the height"),
        ("return np.median(np.diff(np.sort(positions[:, 2]))) / normal[2]", "z is not the height"),
        ("return np.median(np.diff(np.sort(positions @ normal))) / normal[2]", "along the normal already"),
        ("return np.median(np.diff(np.sort(np.abs(positions @ normal))))", "A height has a sign"),
        ("return np.median(np.diff(np.sort(positions * normal, axis=0)))", "`*` multiplies"),
        ("return np.median(np.diff(np.sort(positions * normal, axis=0), axis=0))", None),
        ("return np.median(np.diff(np.sort(positions @ normal))) / 2", "0.5 times the right"),
        ("return np.median(np.diff(np.sort(positions) @ normal))", "among themselves"),
        ("return round(np.median(np.diff(np.sort(positions @ normal))), 1)", "rounded"),
        ("return np.median(np.diff(np.sort(positions[:, 0])))", "The function does not use `normal`"),
    ],
}
