"""Wrong answers to the exercises of lesson 00."""

# what students write, and words of the hint that they should get
WRONG = {
    "0.1": [
        ("return mask.sum()", "counts voxels"),
        ("return mask.sum() * spacing[0] * spacing[1] * spacing[2]", "1000 mm3"),
        ("return np.count_nonzero(mask) * spacing[1] * spacing[2] / 1000", "area"),
        ("return mask.size * np.prod(spacing) / 1000", "mask.sum()"),
        ("return mask.sum() * np.prod(spacing) / 10", "10 x 10 x 10"),
        ("return mask.sum() * spacing[0] * spacing[1] ** 2 / 1000", "not equal"),
        ("return mask.sum() * spacing[1] ** 3 / 1000", "not equal"),
        ("return mask.sum() * np.sum(spacing) / 1000", "The three spacings are multiplied"),
        ("return mask.sum() * np.prod(spacing) / 1e6", "Each of your numbers is 0.001 "),
        ("return np.prod(spacing) / 1000", "This is the volume of one voxel"),
        ("return int(mask.sum() * np.prod(spacing) / 1000)", "The number was cut to a whole one"),
        ("return mask * np.prod(spacing) / 1000", "One number is wanted"),
        ("return mask.sum() / np.prod(spacing)", "Divided where it should multiply"),
        ("return len(mask) * np.prod(spacing) / 1000", "len counts the planes"),
        ("return mask.sum() * np.mean(spacing)**3 / 1000", "The three spacings are not equal"),
    ],
    "0.2": [
        ("return np.sum(a & b) / np.sum(a | b)", "Jaccard"),
        ("return np.logical_and(a, b).sum() / (a.sum() + b.sum())", "factor 2"),
        ("return np.mean(a == b)", "air"),
        ("return 2 * np.sum(a & b) / np.sum(a + b)", "a + b means"),
        ("return (a & b).sum() / a.sum()", "This is the part of a that b shares"),
        ("return 2 * (a | b).sum() / (a.sum() + b.sum())", "What is shared is a & b"),
        ("return 2 * (a * b).sum() / (a.size + b.size)", "size counts all voxels of the box"),
        ("return 200 * (a & b).sum() / (a.sum() + b.sum())", "100 times the right"),
        ("return 1 - 2 * (a & b).sum() / (a.sum() + b.sum())", "This is 1 - Dice"),
        ("return 2 * (a & b).sum() / (a | b).sum()", "For bool masks a + b means a | b"),
        ("return (a & b).sum()", "This counts what is shared"),
        ("return round(2 * (a & b).sum() / (a.sum() + b.sum()), 2)", None),
        ("return (a & b).sum() / max(a.sum(), b.sum())", None),
    ],
}
