"""Natural opening or cut one: an opening and what surrounds it come in -> a verdict with its reason goes out.

A craniectomy is soft all through, lies in the vault, and has the vault's single wall around it. Orbits, sinuses, the
nose and the foramina lie at the base, between walls that stand one behind the other. Where the thin bone of a temple
or the top of a thick slice falls below the threshold, bone is still there.
"""

from __future__ import annotations

from dataclasses import dataclass

SURE = 0.5
"""Least confidence of an opening that is designed without being asked for."""
_TWO_WALLS = 0.5  # share of the rim with deep bone from which an opening is one between the walls of face or base
_BASE_SHARE, _VAULT_SHARE = (
    0.1,
    0.3,
)  # of an opening above the base: natural up to, cut from; more where the frame is unsure
_ACROSS_MM, _PLAIN_MM = 0.1, 0.8  # of bone in the middle of an opening: what was cut out left none; plainly bone
_BLURRED_MM = 15.0  # width of a hole into which thick slices blur its rim
_PAPER_MM, _SMALL_MM = 1.5, 30.0  # a small hole whose rim is as thin as paper was not cut


@dataclass(frozen=True)
class Signs:
    """What an opening and its surroundings show.

    Parameters
    ----------
    diameter_mm : float
        Of a disk of the same area.
    across_mm : float
        Thickness of the bone that lies across the middle of the opening, below the threshold.
    on_vault : float
        Share of the opening above the line between vault and base.
    two_walls : float
        Share of the rim behind which more bone stands, as at orbits and sinuses.
    rim_mm : float
        Median thickness of the rim.
    frame : float
        Confidence in how the head lies.
    """

    diameter_mm: float
    across_mm: float
    on_vault: float
    two_walls: float
    rim_mm: float
    frame: float


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
    def designed(self) -> bool:
        """Whether it is closed without being chosen."""
        return not self.natural and self.confidence >= SURE

    @property
    def doubtful(self) -> bool:
        """Whether it is listed and left to the user."""
        return self.confidence < SURE


def judge(signs: Signs) -> Verdict:
    """Judge one opening.

    Parameters
    ----------
    signs : Signs

    Returns
    -------
    Verdict

    Examples
    --------
    >>> judge(Signs(60.0, 0.0, on_vault=1.0, two_walls=0.0, rim_mm=6.0, frame=1.0)).designed
    True
    >>> judge(Signs(20.0, 1.0, on_vault=1.0, two_walls=0.0, rim_mm=2.0, frame=1.0)).reason
    'Bone lies across it, too thin for the threshold.'
    """
    if signs.across_mm >= _ACROSS_MM:
        if signs.diameter_mm < _BLURRED_MM and signs.across_mm < _PLAIN_MM:
            return Verdict(
                True, 0.4, "A trace of bone lies across it: thin bone, or a small hole blurred by the slices."
            )
        return Verdict(True, 0.9, "Bone lies across it, too thin for the threshold.")
    if signs.diameter_mm < _SMALL_MM and signs.rim_mm < _PAPER_MM:
        return Verdict(True, 0.7, f"Its rim is {signs.rim_mm:.1f} mm thin, as where bone wears away or is blurred.")
    if signs.on_vault < _BASE_SHARE:
        return Verdict(True, 0.5 + 0.5 * signs.frame, "It lies at the base of the skull, where natural openings are.")
    if signs.two_walls > _TWO_WALLS and signs.on_vault < 0.5:
        return Verdict(True, 0.8, "It lies between walls one behind the other, as orbits and sinuses do.")
    if signs.two_walls > _TWO_WALLS:
        return Verdict(
            False, 0.4, "It lies in the vault, but between walls one behind the other, as orbits and sinuses do."
        )
    if signs.on_vault < _VAULT_SHARE * (1.5 - 0.5 * signs.frame):
        return Verdict(False, 0.45, "Most of it lies at the base of the skull.")
    return Verdict(
        False,
        0.6 + 0.4 * min(signs.on_vault, signs.frame),
        "Soft all through, in the vault, with a single wall around it.",
    )
