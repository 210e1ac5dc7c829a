"""Wrong answers to the exercises of lesson 02."""

LABELS = "l, n = ndimage.label(mask); s = np.bincount(l.ravel()); s[0] = 0"

FRAME = ("l[0]", "l[-1]", "l[:, 0]", "l[:, -1]")


def loop(numbers, when, *, labelled="~mask"):
    """Small holes filled in a loop over the numbers of the parts, at the border or not."""
    return (
        f"l, n = ndimage.label({labelled}); out = mask.copy(); at = {{*l[0], *l[-1], *l[:, 0], *l[:, -1]}}\n"
        f"    for i in {numbers}:\n"
        f"        size = (l == i).sum()\n"
        f"        if {when}: out[l == i] = True\n"
        "    return out"
    )


def holes(*borders, structure="None", compare="<=", sizes="s", given="mask"):
    """A way to fill small holes, written as a student does."""
    return (
        f"l, n = ndimage.label(~mask, {structure}); s = np.bincount(l.ravel()); s = {sizes}; "
        f"out = {given}.copy(); border = {{*np.concatenate([{', '.join(borders)}])}}\n"
        f"    for i, size in enumerate(s):\n"
        f"        if i > 0 and size {compare} max_pixels and i not in border: out[l == i] = True\n"
        "    return out"
    )


# what students write, and words of the hint that they should get
WRONG = {
    "2.1": [
        (
            "l, n = ndimage.label(mask); s = np.bincount(l.ravel()); s[0] = 0; return (l == s.argmax()).tolist()",
            "in a list",
        ),
        ("return np.ones(mask.shape, bool)", "Every place is True"),
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
        ("l, n = ndimage.label(mask); return l * (l == np.bincount(l.ravel())[1:].argmax() + 1)", "numbers"),
        ("return ndimage.label(mask)[0]", "These are the numbers of the parts"),
        ("return ndimage.label(mask)[0] > 0", "Nothing was dropped"),
        ("labels, n = ndimage.label(mask); return labels == n", "This is the part that is met last"),
        (
            ("labels, n = ndimage.label(mask); s = np.bincount(labels.ravel()); s[0] = 0; return s.argmax()"),
            "This is the number of the largest part",
        ),
        (
            ("labels, n = ndimage.label(mask); s = np.bincount(labels.ravel()); s[0] = 0; return labels == s.max()"),
            "max gives the count",
        ),
        (
            ("labels, n = ndimage.label(mask); s = np.bincount(labels.ravel()); s[0] = 0; return labels == s.argmin()"),
            "This is the background",
        ),
        (
            (
                "labels, n = ndimage.label(mask); s = np.bincount(labels.ravel())[1:]; "
                "return labels == np.argsort(s)[-2] + 1 if n > 1 else mask"
            ),
            "This is the second largest part",
        ),
        ("return ndimage.binary_fill_holes(mask)", "fills cavities and drops nothing"),
        ("labels, n = ndimage.label(mask); return np.where(labels == 1, 1, 0)", None),
        (
            (
                "from skimage.morphology import remove_small_objects\n"
                "    return ndimage.binary_opening(mask, iterations=2)"
            ),
            "Opening eats thin bone",
        ),
        (
            ("l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); s[0] = 0; return l == s.argmax()"),
            "You labelled ~mask",
        ),
        (
            "l, n = ndimage.label(mask); s = ndimage.sum(mask, l, range(n)); return l == np.argmax(s)",
            "The last part was not counted",
        ),
        ("return ndimage.label(mask)[0] == 2", "All that is too much lies in `mask`"),
        (
            "l, n = ndimage.label(mask); s = [(l == i).sum() for i in range(1, n)]; return l == np.argmax(s) + 1",
            "The last part was not counted",
        ),
        (f"{LABELS}; return mask & (l != s.argmax())", "drops the largest part"),
        (f"{LABELS}; return ndimage.binary_fill_holes(l == s.argmax())", "filling was not asked for"),
        (f"{LABELS}; return s == s.argmax()", None),
        (
            "l, n = ndimage.label(mask); s = np.bincount(l.ravel()); return l == np.argsort(s)[-2]",
            "need not be the largest count",
        ),
        ("l, n = ndimage.label(mask); s = np.bincount(l.ravel()); return l == 1 + s[1:].argmin()", "smallest part"),
        (
            "l, n = ndimage.label(mask); boxes = ndimage.find_objects(l); "
            "return l == 1 + np.argmax([np.prod([s.stop - s.start for s in box]) for box in boxes])",
            "largest box",
        ),
        ("return ndimage.label(mask) == 1", "one True or False"),
        (f"{LABELS}; return s.max()", "This is the size"),
        ("l, n = ndimage.label(mask); return l == np.bincount(l)[1:].argmax() + 1", "labels.ravel()"),
        (
            "l, n = ndimage.label(mask); return l == 1 + np.argmax([l[l == i].sum() for i in range(1, n + 1)])",
            "the size times the number",
        ),
        ("l = ndimage.label(mask); s = np.bincount(l.ravel()); s[0] = 0; return l == s.argmax()", "take them apart"),
        (
            "l, n = ndimage.label(mask); s = ndimage.sum(mask, l, range(1, n + 1)); return l == s.argmax()",
            "add 1",
        ),
    ],
    "2.2": [
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()) <= max_pixels + 1; s[0] = False; "
                "s[np.concatenate([l[0], l[-1], l[:, 0], l[:, -1]])] = False; return mask | s[l]"
            ),
            "a little larger",
        ),
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()) <= 2 * max_pixels; s[0] = False; "
                "s[np.concatenate([l[0], l[-1], l[:, 0], l[:, -1]])] = False; return mask | s[l]"
            ),
            "a little larger",
        ),
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()) * 0.81 <= max_pixels; "
                "s[0] = False; s[np.concatenate([l[0], l[-1], l[:, 0], l[:, -1]])] = False; "
                "return mask | s[l]"
            ),
            "a little larger",
        ),
        ("return ndimage.binary_fill_holes(mask)", "brain"),
        ("return mask.copy()", "No hole"),
        (loop("range(1, n)", "i not in at and size <= max_pixels"), "The last hole is missing"),
        (loop("range(1, n)", "i not in at and size < max_pixels"), "The last hole is missing"),
        (loop("range(2, n + 1)", "i not in at and size <= max_pixels"), "Part 1 is passed over"),
        (loop("range(1, n + 1)", "i not in at and size >= max_pixels"), "this fills the large holes"),
        (loop("range(1, n + 1)", "i not in at and size > max_pixels"), "this fills the large holes"),
        (loop("range(1, n + 1)", "i not in at or size <= max_pixels"), "join both by `and`"),
        (loop("range(1, n + 1)", "i in at and size <= max_pixels"), "fills what touches the border"),
        (loop("range(1, n + 1)", "i not in at"), "brain"),
        (loop("range(1, n + 1)", "i not in at and size <= max_pixels", labelled="mask"), "Was the bone labelled"),
        (
            "h = ndimage.binary_fill_holes(mask) & ~mask; return mask | h if h.sum() <= max_pixels else mask",
            "counted as one",
        ),
        (
            "h = ndimage.binary_fill_holes(mask) & ~mask; l, n = ndimage.label(h); s = np.bincount(l.ravel()); "
            "s[0] = 0; return mask | (s <= max_pixels)[l]",
            "was made small",
        ),
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
        (holes(*FRAME, given="(mask * 1)"), "numbers"),
        (
            ("l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); s[0] = 0; return mask | ((s <= max_pixels)[l])"),
            "What touches the border is outside",
        ),
        ("return ndimage.binary_closing(mask)", "Closing also fills bays of the outline"),
        (
            ("l, n = ndimage.label(mask); s = np.bincount(l.ravel()); return mask | ((s <= max_pixels)[l])"),
            "No hole was filled",
        ),
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); small = s <= max_pixels; "
                "small[0] = False; return small[l]"
            ),
            "These are the small parts of the background",
        ),
        ("return ndimage.binary_fill_holes(mask) & ~mask", "These are all holes"),
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); big = s > max_pixels; "
                "big[0] = False; return mask | big[l]"
            ),
            "This fills what is larger than max_pixels",
        ),
        ("return ~mask", "This is the background"),
        (
            (
                "l, n = ndimage.label(~mask); s = np.bincount(l.ravel(), minlength=n+1); "
                "small = s <= max_pixels; small[0] = False; small[l[0, 0]] = False; "
                "return mask | small[l]"
            ),
            "What touches the border is outside",
        ),
        (
            (
                "from skimage.morphology import remove_small_holes\n"
                "    return remove_small_holes(mask, max_size=max_pixels)"
            ),
            "What touches the border is outside",
        ),
        ("return mask | ndimage.binary_dilation(mask)", "The function does not use `max_pixels`"),
        (
            "l, n = ndimage.label(~mask); s = np.bincount(l.ravel()); return (s <= max_pixels)[l]",
            "These are the small parts of the background",
        ),
    ],
}
