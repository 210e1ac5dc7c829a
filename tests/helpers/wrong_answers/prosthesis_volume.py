"""Wrong answers to the exercises of lesson 05."""

REGIONS_4 = (
    "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel(), minlength=n + 1); s[0] = 0"
)

REGIONS_8 = REGIONS_4.replace("~bone)", "~bone, np.ones((3, 3)))")

# what students write, and words of the hint that they should get
WRONG = {
    "5.1": [
        ("return np.vstack([outer, inner])", "bow tie"),
        ("return outer", "inner curve is missing"),
        ("return inner", "outer curve is missing"),
        ("return np.concatenate([outer[::-1], inner[::-1]])", "The outline crosses itself like a bow tie"),
        ("return np.concatenate([outer, inner], axis=1)", "Joined side by side"),
        ("return np.concatenate([outer, inner[:, ::-1]])", "This swaps row and col of the inner curve"),
        ("return outer + inner[::-1]", "This adds the coordinates"),
        ("return (outer + inner) / 2", "This is the middle between the curves"),
        ("return [outer, inner[::-1]]", "two curves in one array"),
        ("return np.stack([outer, inner])", "two curves in one array"),
        ("return np.append(outer, inner[::-1])", "axis=0"),
        ("return np.concatenate([outer, np.flip(inner)])", "np.flip without axis"),
        ("return np.concatenate([np.flip(outer), inner])", "np.flip without axis"),
        ("return np.flip(np.concatenate([outer, inner[::-1]]))", "(col, row), not"),
        ("return np.concatenate([outer, inner[::-1]])[:, ::-1]", "(col, row), not"),
        ("return np.concatenate([outer, np.fliplr(inner)])", "This swaps row and col of the inner curve"),
        ("return np.concatenate([outer, np.sort(inner, axis=0)[::-1]])", "np.sort orders"),
        ("return np.concatenate([outer, inner[1:-1][::-1]])", "A point at an end is lost"),
        ("return np.concatenate([outer[:-1], inner[::-1][:-1]])", "A point at an end is lost"),
        ("return np.concatenate([outer, inner[::-1], outer])", "walked twice"),
        ("return np.concatenate([outer, -inner])", "A minus mirrors"),
        ("return np.concatenate([outer, inner[::-1]]).T", "Rows and columns are exchanged"),
        ("return outer - inner", "This is the step from curve to curve"),
        ("return np.hstack([outer, inner[::-1]])", "Joined side by side"),
        ("return np.concatenate([outer[:1], inner[::-1]])", None),
        ("return np.concatenate([inner, outer])", "The outline crosses itself like a bow tie"),
        ("return np.concatenate([outer, outer[::-1]])", "The function does not use `inner`"),
        ("return np.concatenate([outer, inner[::2]])", None),
        ("return np.unique(np.concatenate([outer, inner]), axis=0)", None),
    ],
    "5.2": [
        (
            (
                "p = region & ~bone; l, n = measure.label(p, return_num=True); "
                "return l == 1 + np.bincount(l.ravel())[1:].argmax()"
            ),
            None,
        ),
        ("return region", "Bone is still"),
        ("return region != bone", "rest of the skull"),
        ("return region & bone", "must go"),
        ("return bone & ~region", "Turned round"),
        ("return region and not bone", "join masks by &"),
        ("return region - bone", "Masks cannot be subtracted"),
        ("return ~(region & bone)", "This is nearly the whole picture"),
        ("return ~bone", "This is everything that is not bone"),
        ("return region.astype(int) - bone.astype(int)", "Numbers with -1 among them"),
        ("return region & ~ndimage.binary_dilation(bone)", "A pixel is left free all round the bone"),
        ("return region & ~ndimage.binary_erosion(bone)", "The edge of the bone is still in it"),
        ("return bone", "This is the bone that is there already"),
        ("return ~region", "This is everything outside the region"),
        ("return np.logical_not(bone)", "This is everything that is not bone"),
        ("return region | ~bone", "join by `&`"),
        ("return region >= bone", "join by `&`"),
        ("return ~region & ~bone", "neither in the region nor bone"),
        ("return ndimage.binary_erosion(region) & ~bone", "no erosion"),
        ("return ndimage.binary_dilation(region) & ~bone", "no dilation"),
        ("return region & ~region", "The function does not use `bone`"),
        ("return (region & ~bone).astype(int)", "as numbers: a bool mask is wanted"),
        ("return np.where(bone, region, False)", "This is just the part that must go"),
    ],
    "5.3": [
        *(
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); s[0] = 0; "
                f"k = s >= {n_pixels}; k[s.argmax()] = False; return k[l]",
                "A fixed number",
            )
            for n_pixels in (5, 20, 40)
        ),
        ("return convex_hull_image(bone) & ~bone", "whole difference"),
        ("return ndimage.binary_fill_holes(bone) & ~bone", "convex hull"),
        (
            f"{REGIONS_8.replace('convex_hull_image', 'ndimage.binary_fill_holes')}; "
            "k = s >= min_pixels; k[s.argmax()] = False; return k[l]",
            "convex hull",
        ),
        (
            "l, n = ndimage.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); s[0] = 0; "
            "return (s >= min_pixels)[l]",
            "brain's place",
        ),
        (f"{REGIONS_4}; k = s >= min_pixels; k[s.argmax()] = False; return k[l]", "touch at a corner"),
        (f"{REGIONS_8}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", ">=, not >"),
        (f"{REGIONS_4}; k = s > min_pixels; k[s.argmax()] = False; return k[l]", "(>=), and"),
        (f"{REGIONS_8}; return (s >= min_pixels)[l]", "brain's place"),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "s[0] = 0; return l == np.argsort(s)[-2]"
            ),
            "This is the second biggest region alone",
        ),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "s[0] = 0; return l == s.argmax()"
            ),
            "This is the biggest region",
        ),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "k = s >= min_pixels; k[s.argmax()] = False; return k[l]"
            ),
            "The brain's place is in it",
        ),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "s[0] = 0; k = s < min_pixels; return k[l]"
            ),
            "Turned round, and label 0",
        ),
        (
            (
                "l = measure.label(~bone); s = np.bincount(l.ravel()); s[0] = 0; k = s >= min_pixels; "
                "k[s.argmax()] = False; return k[l]"
            ),
            "Filling holes finds the cavity",
        ),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "s[0] = 0; k = s >= min_pixels; k[s.argmax()] = False; return k"
            ),
            None,
        ),
        ("return convex_hull_image(bone)", "This is the whole hull"),
        (
            "l = measure.label(convex_hull_image(bone)); s = np.bincount(l.ravel()); s[0] = 0; "
            "k = s >= min_pixels; k[s.argmax()] = False; return k[l]",
            "before labelling",
        ),
        (
            "l = measure.label(bone); s = np.bincount(l.ravel()); s[0] = 0; k = s >= min_pixels; "
            "k[s.argmax()] = False; return k[l]",
            "before labelling",
        ),
        (
            "l = measure.label(convex_hull_image(bone)); s = np.bincount(l.ravel()); s[0] = 0; "
            "return (s >= min_pixels)[l] & ~bone",
            "whole difference",
        ),
        (
            "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel())[1:]; "
            "k = s >= min_pixels; k[s.argmax()] = False; return np.isin(l, np.flatnonzero(k))",
            "begins with region 1",
        ),
        (
            (
                "l = measure.label(convex_hull_image(bone) & ~bone); s = np.bincount(l.ravel()); "
                "s[0] = 0; k = s >= min_pixels; k[s.argmax()] = False; return k[l] | bone"
            ),
            "This is the mended ring",
        ),
        (
            "return morphology.remove_small_objects(convex_hull_image(bone) & ~bone, max_size=min_pixels - 1)",
            "The brain's place is in it",
        ),
    ],
}
