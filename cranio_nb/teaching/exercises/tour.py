"""Exercises of lesson 00: the whole way: volumes and overlap."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise, small_head


def _patches():
    head = small_head()
    return [(head.implant, (3.0, 1.75, 1.75)), (head.implant[:22], (3.0, 1.75, 1.5)), (head.implant, (1.0, 0.5, 0.8))]


def _pairs():
    patch = small_head().implant
    lower = patch & (np.arange(44) < 20)[:, None, None]
    return [(lower, np.roll(patch, 1, 2)), (patch, patch), (patch, lower)]


_CUBES = "The three spacings are not equal: use each of them once."


EXERCISES: dict[str, Exercise] = {
    "0.1": Exercise(
        cases=_patches,
        right=lambda mask, spacing: mask.sum() * np.prod(spacing) / 1000,
        answer=Answer("one number", unit="cm3", tolerance=0.01),
        mistakes=(
            (lambda m, s: m.sum(), "This counts voxels. Each voxel has a volume: the product of its three spacings."),
            (lambda m, s: m.sum() * np.prod(s), "This is in mm3; 1 cm3 is 1000 mm3."),
            (lambda m, s: m.sum() * s[1] * s[2] / 1000, "This is an area: the distance between slices is left out."),
            (lambda m, s: m.size * np.prod(s) / 1000, "This counts all voxels; mask.sum() counts those that are True."),
            *(
                (lambda m, s, to=to: m.sum() * np.prod(s) / to, "1 cm is 10 mm, so 1 cm3 is 10 x 10 x 10 = 1000 mm3.")
                for to in (10, 100)
            ),
            *(
                (lambda m, s, three=three: m.sum() * np.prod(np.take(s, three)) / 1000, _CUBES)
                for three in ((0, 0, 0), (1, 1, 1), (2, 2, 2), (0, 1, 1), (0, 2, 2), (0, 0, 1))
            ),
            (lambda m, s: m.sum() * np.sum(s) / 1000, "The three spacings are multiplied, not added: np.prod."),
            (lambda m, s: np.prod(s) / 1000, "This is the volume of one voxel: how many are there?"),
            (lambda m, s: len(m) * np.prod(s) / 1000, "len counts the planes; mask.sum() counts the voxels."),
            (lambda m, s: m.sum() * np.mean(s) ** 3 / 1000, _CUBES),
            *(
                (
                    lambda m, s, to=to: m.sum() / np.prod(s) / to,
                    "Divided where it should multiply: voxels times mm3 per voxel.",
                )
                for to in (1, 1000)
            ),
            (
                lambda m, s: int(m.sum() * np.prod(s) / 1000),
                "The number was cut to a whole one: a hundredth of a cm3 counts here.",
            ),
            *(
                (
                    lambda m, s, digits=digits: round(m.sum() * np.prod(s) / 1000, digits),
                    "The number was rounded: a hundredth of a cm3 counts here.",
                )
                for digits in (0, 1)
            ),
            (lambda m, s: m.sum() * s[0] / 1000, "The distance between slices alone: rows and columns are left out."),
            (lambda m, s: m.mean() * np.prod(s) / 1000, "mean is a share of the box; mask.sum() counts the voxels."),
            *(
                (
                    lambda m, s, two=two: m.sum() * np.prod(np.take(s, two)) / 1000,
                    "One of the three spacings is left out.",
                )
                for two in ((0, 1), (0, 2))
            ),
        ),
        hints=(
            "Count the voxels first.",
            "Multiply by the volume of one voxel, in mm3.",
            "np.prod multiplies three numbers; 1 cm3 is 1000 mm3.",
        ),
        praise="voxels became cubic centimetres.",
    ),
    "0.2": Exercise(
        cases=_pairs,
        right=lambda a, b: 2 * (a & b).sum() / (a.sum() + b.sum()),
        answer=Answer("one number from 0 to 1", unit="", tolerance=1e-6),
        mistakes=(
            (lambda a, b: (a & b).sum() / (a | b).sum(), "This is Jaccard's index: it divides by the union."),
            (
                lambda a, b: 2 * (a & b).sum() / (a + b).sum(),
                "For bool masks a + b means a | b, so what is shared counts once: use a.sum() + b.sum().",
            ),
            (lambda a, b: (a & b).sum() / (a.sum() + b.sum()), "The factor 2 is missing: two equal masks must give 1."),
            (lambda a, b: (a & b).sum() / b.sum(), "This is the part of b that is found; Dice divides by both sizes."),
            (lambda a, b: (a == b).mean(), "This counts the air as agreement; use only voxels of the masks."),
            *(
                (
                    lambda a, b, n=n, sizes=sizes: n * (a == b).sum() / sizes(a, b),
                    "a == b is true in the air as well, where both are False: what is shared is a & b.",
                )
                for n in (1, 2)
                for sizes in (lambda a, b: a.sum() + b.sum(), lambda a, b: (a | b).sum(), lambda a, b: 1)
            ),
            *(
                (
                    lambda a, b, size=size: (a & b).sum() / size(a.sum(), b.sum()),
                    "This divides by the larger size, the smaller, or the root of their product: Dice takes their sum.",
                )
                for size in (max, min, lambda m, n: np.sqrt(float(m) * n))
            ),
            (lambda a, b: 2 * (a & b).sum() / (a.sum() * b.sum()), "The sizes are added, not multiplied."),
            (
                lambda a, b: 2 * (a & b).sum() / a.sum() + b.sum(),
                "`/` goes before `+`: put the sum of the sizes in brackets.",
            ),
            (
                lambda a, b: 2 * (a & b).sum() // (a.sum() + b.sum()),
                "`//` cuts to a whole number: divide by `/`.",
            ),
            *(
                (
                    lambda a, b, shared=shared: 2 * shared(a & b) / (len(a) + len(b)),
                    "len counts the planes of the box; a.sum() counts the voxels of the mask.",
                )
                for shared in (np.sum, len)
            ),
            (lambda a, b: (a & b).sum() / a.sum(), "This is the part of a that b shares; Dice divides by both sizes."),
            (
                lambda a, b: (a & b).sum(),
                "This counts what is shared; divide it by the sizes, so that it runs from 0 to 1.",
            ),
            (
                lambda a, b: 2 * (a | b).sum() / (a.sum() + b.sum()),
                "What is shared is a & b; a | b holds what either has.",
            ),
            *(
                (
                    lambda a, b, differ=differ: 2 * differ(a, b).sum() / (a.sum() + b.sum()),
                    "This counts voxels that only one of the masks has; what is shared is a & b.",
                )
                for differ in (np.logical_xor, np.greater, np.less)
            ),
            (
                lambda a, b: 1 - 2 * (a & b).sum() / (a.sum() + b.sum()),
                "This is 1 - Dice, a distance: 0 for equal masks.",
            ),
            (
                lambda a, b: 2 * (a & b).sum() / (a.size + b.size),
                "size counts all voxels of the box; a.sum() counts those of the mask.",
            ),
        ),
        hints=(
            "What is shared: a & b.",
            "Divide by the sum of both sizes.",
            "Count with .sum(), and mind the factor that makes two equal masks give 1.",
        ),
        praise="two equal masks give 1, two strangers 0.",
    ),
}
"""The exercises of lesson 00, by number."""
