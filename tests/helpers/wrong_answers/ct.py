"""Wrong answers to the exercises of lesson 01."""

# what students write, and words of the hint that they should get
WRONG = {
    "1.1": [
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
    ],
    "1.2": [
        ("return affine[:3, :3].dot(index)", "origin"),
        ("return (affine @ np.append(index[::-1], 1))[:3]", "turn it round"),
        ("return index @ affine[:3, :3] + affine[:3, 3]", "transposed"),
        ("return affine @ np.append(index, 1)", "Four numbers"),
        ("return (affine[:3,:3] @ index + affine[:3,3])[::-1]", "These are z, y, x: the matrix "),
        ("return affine[:3,:3] @ index + affine[3,:3]", "The origin is missing"),
        ("return affine[:3,:3] @ (index + affine[:3,3])", "First the steps"),
        ("return affine[:3,:3] * index + affine[:3,3]", "`*` multiplies number by number"),
        ("return np.linalg.inv(affine)[:3,:3] @ index + affine[:3,3]", None),
        ("return affine[:3, 3]", "This is the place of voxel (0"),
        ("return affine[:3,:3] @ index - affine[:3,3]", "The origin is added"),
        ("return affine[:3,:3] @ (index + 0.5) + affine[:3,3]", "Half a voxel off"),
        ("return index + affine[:3,3]", "These are still voxels"),
        ("return affine @ index", "stopped with ValueError"),
        ("return affine[:3,:3] @ index * affine[:3,3]", None),
        ("return np.diag(affine)[:3] * index + affine[:3,3]", None),
    ],
    "1.3": [
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
            "z is not the height of a tilted slice",
        ),
        ("return np.median(np.diff(positions, axis=0))", "The function does not use `normal`"),
        ("return np.mean(positions @ normal)", None),
        ("return np.median(np.diff(np.sort(positions @ normal))) / 2", "0.5 times the right"),
        ("return np.median(np.diff(np.sort(positions[:, 0])))", "The function does not use `normal`"),
    ],
}
