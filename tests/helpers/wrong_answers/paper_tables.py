"""Wrong answers to the exercises of lesson 10."""

# what students write, and words of the hint that they should get
WRONG = {
    "10.1": [
        ("v = [s[key][side] for s in slices[:-1] if s['status'] == 'balloon']; return min(v), max(v)", "last slice"),
        (
            "v = [s[key][side] for s in slices if s['status'] == 'balloon']; return min([*v, 100]), max([*v, 0])",
            "starts from a number",
        ),
        (
            "v = [s[key][side] for s in slices if s['status'] == 'balloon']; return str(min(v)), str(max(v))",
            "returns text",
        ),
        ("v = [s[key][side] for s in slices]; return min(v), max(v)", "no balloon"),
        ("v = [s[key][side] for s in slices if s['status'] != 'hull']; return min(v), max(v)", "Carried and skipped"),
        (
            "v = [s[key][side] for s in slices if s['status'] in ('balloon', 'carried')]; return min(v), max(v)",
            "Carried and skipped",
        ),
        (
            "v = [s[key] for s in slices if s['status'] == 'balloon']; return min(v)[side], max(v)[side]",
            "before, not after",
        ),
        (
            "v = [s[key][side] for s in slices if s['status'] == 'balloon']; return round(min(v)), round(max(v))",
            "as they are",
        ),
        ("v = [int(s[key][side]) for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "as they are"),
        ("v = [s[key][side] for s in slices if s[key][side] > 0]; return min(v), max(v)", "An angle below 0"),
        ("v = [s[key][1 - side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "side 0"),
        ("v = [s[key][0] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "outer side whatever"),
        ("v = [s[key][1] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "inner side whatever"),
        (
            "v = [s['theta0'][side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)",
            "whatever `key`",
        ),
        (
            "v = [s['theta1'][side] for s in slices if s['status'] == 'balloon']; return min(v), max(v)",
            "whatever `key`",
        ),
        ("v = sum((s[key] for s in slices if s['status'] == 'balloon'), []); return min(v), max(v)", "Both sides"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return max(v), min(v)", "comes first"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return v[0], v[-1]", "in any order"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return (np.mean(v),) * 2", "the mean"),
        (
            ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return np.mean(v), np.std(v)"),
            "These are mean and spread",
        ),
        (
            ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return np.median(v), np.median(v)"),
            "This is the median",
        ),
        (
            "v = [s[key][side] for s in slices if s['status'] == 'hull']; return min(v), max(v)",
            "These are the slices without a balloon",
        ),
        (
            "v = [s[key][side] for s in slices if s['status'] == 'balloon']; return max(v) - min(v)",
            "This is how far they spread",
        ),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return sorted(v)", "All values in order"),
        ("v = [s[key] for s in slices if s['status'] == 'balloon']; return min(v), max(v)", "`side` is not used"),
        ("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return min(v)", "Only the smallest"),
        ("v = [s[key][side] for s in slices if s[key][side] > 0]; return min(v), max(v) + 1", None),
        (
            "v = [s['plane'] for s in slices if s['status'] == 'balloon']; return min(v), max(v)",
            "These are numbers of planes",
        ),
        ("s = slices[0]; return min(s[key]), max(s[key])", "does not use `side`"),
        (
            (
                "v = sorted(slices, key=lambda s: s['plane']); "
                "v = [s[key][side] for s in v if s['status'] == 'balloon']; return v[0], v[-1]"
            ),
            "These are the values of the lowest and the",
        ),
        (
            "v = [s[key] for s in slices if s['status'] == 'balloon']; return np.min(v), np.max(v)",
            "Both sides are thrown together",
        ),
        (("v = [s[key][side] for s in slices if s['status'] == 'balloon']; return [min(v), max(v), np.mean(v)]"), None),
        ("v = [s[key][side] for s in slices if s['plane'] > 21]; return min(v), max(v)", None),
    ],
    "10.2": [
        ("return np.degrees(np.arcsin(chord // 2 / radius))", None),
        ("return np.arcsin(chord / (2 * radius))", "radians"),
        ("return np.degrees(np.arctan(chord / 2 / radius))", "sine"),
        ("return np.degrees(np.arcsin(chord / radius))", "Half the chord"),
        ("return np.nan", "not a finite number"),
        ("return 2 * np.degrees(np.arcsin(chord / 2 / radius))", "centre"),
        ("return np.degrees(np.arccos(chord / 2 / radius))", "This is the angle to the radius"),
        ("return 90 - np.degrees(np.arcsin(chord / 2 / radius))", "This is the angle to the radius"),
        ("return np.arcsin(np.degrees(chord / 2 / radius))", "There is NaN or infinity in the answer"),
        ("return np.degrees(chord / 2 / radius)", "This takes the angle for its sine"),
        ("return np.degrees(chord / radius)", "This takes the chord for the arc"),
        ("return np.sin(chord / 2 / radius)", "(chord / 2) / radius is the sine"),
        ("return np.degrees(np.sin(chord / 2 / radius))", "(chord / 2) / radius is the sine"),
        ("return np.degrees(np.arcsin(2 * radius / chord))", "There is NaN or infinity in the answer"),
        ("return np.degrees(np.arcsin(chord / (2 * radius))) / 2", "Halved twice"),
        ("return np.degrees(np.arcsin(chord / 4 / radius))", "Halved twice"),
        ("return np.radians(np.arcsin(chord / 2 / radius))", "np.radians goes from degrees to radians"),
        ("return np.degrees(np.arctan2(chord, radius))", "Half the chord over the radius is a sine"),
        ("return np.arcsin(chord / 2 / radius) * 360 / np.pi", "This is the angle at the centre"),
        ("return 180 - np.degrees(np.arcsin(chord / 2 / radius))", "This is theta1"),
        ("return np.arctan(chord / 2 / radius)", "A sine, not a tangent; and in "),
        ("return np.degrees(2 * np.arctan(chord / 2 / radius))", "A sine, not a tangent; and the"),
        ("return np.degrees(np.arcsin(radius / chord))", "There is NaN or infinity in the answer"),
        ("return np.degrees(np.arccos(1 - chord**2 / 2 / radius**2))", "This is the angle at the centre"),
        ("return chord / 2 / radius", "This is the sine of the angle"),
        ("return np.arcsin(chord / radius)", "chord / 2; and in degrees"),
        ("return 2 * np.arcsin(chord / 2 / radius)", "at the centre, and in radians"),
    ],
}
