"""Natural opening or cut one: an opening and what surrounds it come in -> a verdict with its reason goes out.

A craniectomy is soft all through, lies in the vault, and has the vault's single wall around it. Orbits, sinuses, the
nose and the foramina lie at the base, between walls that stand one behind the other. Where the thin bone of a temple
or the top of a thick slice falls below the threshold, bone is still there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

SURE = 0.5
"""Least confidence of an opening that is designed without being asked for."""
_TWO_WALLS = 0.5  # share of the rim with deep bone from which an opening is one between the walls of face or base
_BASE_SHARE, _VAULT_SHARE = 0.1, 0.3  # of an opening above the base: natural up to, cut from
_ACROSS_MM, _PLAIN_MM = 0.1, 0.8  # of bone in the middle of an opening: what was cut out left none; plainly bone
_BLURRED_MM = 15.0  # width of a hole into which coarse voxels blur its rim
_BLUR_SHARE = 0.5  # of its rim, which a blurred hole leaves less than: its width is that at half height
_FULL_MM, _ALL = 4.0, 0.9  # a rim as thick as a vault, where no bone wears away; share across which a film of bone lies
_PAPER_MM, _SMALL_MM = 1.5, 30.0  # a small hole whose rim is as thin as paper was not cut
_HALF = 0.5  # of an opening above the base: from there on walls behind its rim leave a doubt only


@dataclass(frozen=True)
class Signs:
    """What an opening and its surroundings show.

    Parameters
    ----------
    diameter_mm : float
        Of a disk of the same area.
    across_mm : float
        Thickness of the bone, below the threshold, that lies across most of the opening away from its rim.
    on_vault : float
        Share of the opening above the line between vault and base.
    two_walls : float
        Share of the rim behind which more bone stands, as at orbits and sinuses.
    rim_mm : float
        Median thickness of the rim.
    frame : float
        Confidence in how the head lies.
    plain : bool
        Whether it is wide enough for these slices and reaches into the vault; else there is no more than a hint of it.
    covered : float
        Share of the opening, away from its rim, across which bone lies.
    with_hu : bool
        Whether `across_mm` was measured in HU; a mask shows no bone below the threshold.
    """

    diameter_mm: float
    across_mm: float
    on_vault: float
    two_walls: float
    rim_mm: float
    frame: float
    plain: bool = True
    covered: float = 1.0
    with_hu: bool = True


@dataclass(frozen=True)
class Verdict:
    """Whether an opening was cut.

    Parameters
    ----------
    natural : bool
        Whether the body made it, or it is none.
    confidence : float
        0 to 1, in `natural`.
    reason : str
        One sentence.
    """

    natural: bool
    confidence: float
    reason: str

    @property
    def kind(self) -> str:
        """What follows from it.

        Returns
        -------
        {"cut", "doubtful", "natural"}
            "cut" is closed without being chosen; "doubtful" is listed as a warning and left to the user; "natural" is
            listed.
        """
        if self.confidence < SURE:
            return "doubtful"
        return "natural" if self.natural else "cut"


@dataclass(frozen=True)
class Rule:
    """One line of the rule by which openings are judged.

    Parameters
    ----------
    when : str
        What an opening shows, in words.
    holds : callable
        Whether its signs show that.
    judge : callable
        The verdict then.
    """

    when: str
    holds: Callable[[Signs], bool]
    judge: Callable[[Signs], Verdict]


RULES = (
    Rule(
        f"{_ACROSS_MM:g} mm of bone or more lie across its middle, but less than {_PLAIN_MM:g} mm or than"
        f" {100 * _BLUR_SHARE:g} % of its rim's thickness (the larger counts),"
        f" and it is narrower than {_BLURRED_MM:g} mm",
        lambda s: _ACROSS_MM <= s.across_mm < max(_PLAIN_MM, _BLUR_SHARE * s.rim_mm) and s.diameter_mm < _BLURRED_MM,
        lambda s: Verdict(True, 0.4, "Some bone lies across it: thin bone, or a small hole blurred by the slices."),
    ),
    Rule(
        f"{_ACROSS_MM:g} mm of bone or more lie across half of it, but across less than {100 * _ALL:g} %; its rim is"
        f" {_FULL_MM:g} mm thick or more, and {100 * _BASE_SHARE:g} % of it or more lie above the base",
        lambda s: s.across_mm >= _ACROSS_MM and s.covered < _ALL and s.rim_mm >= _FULL_MM and s.on_vault >= _BASE_SHARE,
        lambda s: Verdict(False, 0.4, "Something dense lies across a part of it, as a drain does; its rim is thick."),
    ),
    Rule(
        f"{_ACROSS_MM:g} mm of bone or more lie across its middle",
        lambda s: s.across_mm >= _ACROSS_MM,
        lambda s: Verdict(True, 0.9, "Bone lies across it, too thin for the threshold."),
    ),
    Rule(
        f"it is narrower than {_SMALL_MM:g} mm, and its rim thinner than {_PAPER_MM:g} mm",
        lambda s: s.diameter_mm < _SMALL_MM and s.rim_mm < _PAPER_MM,
        lambda s: Verdict(True, 0.7, f"Its rim is {s.rim_mm:.1f} mm thin, as where bone wears away or is blurred."),
    ),
    Rule(
        "the slices hardly show it: it is narrow for ones so thick, or one of them cuts it flat; or it begins just"
        " below the vault",
        lambda s: not s.plain,
        lambda s: Verdict(
            False, 0.4, "Hardly shown: small for these slices, cut flat by one, or just below the vault."
        ),
    ),
    Rule(
        f"less than {100 * _BASE_SHARE:g} % of it lies above the base of the skull",
        lambda s: s.on_vault < _BASE_SHARE,
        lambda s: Verdict(True, 0.5 + 0.5 * s.frame, "It lies at the base of the skull, where natural openings are."),
    ),
    Rule(
        f"behind more than {100 * _TWO_WALLS:g} % of its rim stands another wall, and less than {100 * _HALF:g} % of it"
        " lies above the base",
        lambda s: s.two_walls > _TWO_WALLS and s.on_vault < _HALF,
        lambda s: Verdict(True, 0.8, "It lies between walls one behind the other, as orbits and sinuses do."),
    ),
    Rule(
        f"behind more than {100 * _TWO_WALLS:g} % of its rim stands another wall",
        lambda s: s.two_walls > _TWO_WALLS,
        lambda s: Verdict(
            False, 0.4, "It lies in the vault, but between walls one behind the other, as orbits and sinuses do."
        ),
    ),
    Rule(
        f"less than {100 * _VAULT_SHARE:g} % of it lies above the base"
        f" ({150 * _VAULT_SHARE:g} % where nothing shows how the head lies)",
        lambda s: s.on_vault < _VAULT_SHARE * (1.5 - 0.5 * s.frame),
        lambda s: Verdict(False, 0.45, "Most of it lies at the base of the skull."),
    ),
    Rule(
        "none of these: it is soft all through, in the vault, and has a single wall around it",
        lambda s: True,
        lambda s: Verdict(
            False,
            0.6 + 0.4 * min(s.on_vault, s.frame),
            "Soft all through, in the vault, with a single wall around it."
            if s.with_hu
            else "In the vault, with a single wall around it; whether it is soft all through only HU can tell.",
        ),
    ),
)
"""The rule: the first line that holds decides."""


def judge(signs: Signs) -> Verdict:
    """Judge one opening by the first of the `RULES` that holds.

    Parameters
    ----------
    signs : Signs

    Returns
    -------
    Verdict

    Examples
    --------
    >>> judge(Signs(60.0, 0.0, on_vault=1.0, two_walls=0.0, rim_mm=6.0, frame=1.0)).kind
    'cut'
    >>> judge(Signs(20.0, 1.0, on_vault=1.0, two_walls=0.0, rim_mm=2.0, frame=1.0)).reason
    'Bone lies across it, too thin for the threshold.'
    """
    return next(rule for rule in RULES if rule.holds(signs)).judge(signs)


def rule_rows() -> list[tuple[str, str, str]]:
    """The rule as a table.

    Returns
    -------
    list of tuple of str
        For each of the `RULES`: when it holds, the kind of opening that follows, and the confidence, which is a range
        where it grows with the share above the base and with how surely it is known how the head lies.
    """
    rows = []
    for rule in RULES:
        low, high = (rule.judge(Signs(x, x, on_vault=x, two_walls=x, rim_mm=x, frame=x)) for x in (0.0, 1.0))
        ends = dict.fromkeys(f"{verdict.confidence:.2f}" for verdict in (low, high))
        rows.append((rule.when, high.kind, " to ".join(ends)))
    return rows
