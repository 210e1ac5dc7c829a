"""What is soft in a head, as lists of simple solids: the shape of face and neck, the airways, and what has its own HU.

Frame: head mm.
"""

from __future__ import annotations

from .bones import AIR, FAT, GLOBE, GLOBE_BALL, NERVE, Hollow
from .solids import Box, Cone, Ellipsoid, Solid, both, chain

CSF, MUSCLE = 8.0, 60.0


def body_solids() -> tuple[Solid, ...]:
    """Shape of face, ears and neck under the skin, scalp apart.

    Returns
    -------
    tuple of Solid
        They overlap; together they are the body.
    """
    nose = chain(((0.0, -92.0, -6.0), (0.0, -102.0, -26.0), (0.0, -108.0, -46.0)), (6.0, 7.0, 8.0))
    lips = chain(((0.0, -91.0, -72.0), (0.0, -92.0, -90.0)), (11.0, 11.0))
    chin = Cone((0.0, -84.0, -108.0), (0.0, -83.0, -114.0), 13.0, 14.0)
    cheeks = both(
        Cone((40.0, -60.0, -38.0), (34.0, -62.0, -72.0), 20.0, 20.0),
        Cone((56.0, -30.0, -30.0), (46.0, -24.0, -84.0), 18.0, 16.0),
        Cone((46.0, -22.0, -90.0), (16.0, -76.0, -106.0), 16.0, 16.0),
        Ellipsoid((8.0, -104.0, -50.0), (8.0, 8.0, 6.0)),  # wings of the nose
        Ellipsoid((76.0, 8.0, -28.0), (4.5, 14.0, 27.0)),  # ears
        Cone((40.0, -73.0, 1.0), (50.0, -58.0, -6.0), 10.0, 11.0),  # brows
        Cone((62.0, 3.0, -30.0), (76.0, 4.0, -30.0), 10.0, 5.0),
        Cone((60.0, -14.0, -4.0), (60.0, -30.0, -24.0), 12.0, 10.0),  # temples
        Cone((33.0, -74.0, -17.0), (33.0, -76.0, -18.0), 15.0, 14.5),  # lids
    )
    middle = Ellipsoid((0.0, -44.0, -48.0), (60.0, 56.0, 62.0))
    floor = Cone((0.0, -40.0, -92.0), (0.0, -66.0, -100.0), 38.0, 26.0)
    neck = Cone((0.0, 8.0, -60.0), (0.0, 14.0, -230.0), 56.0, 58.0)
    return (*nose, *lips, chin, *cheeks, middle, floor, neck)


def airways() -> tuple[Hollow, ...]:
    """Air within the soft parts, from nostrils to windpipe.

    Returns
    -------
    tuple of Hollow
        Without walls.
    """
    throat = chain(((0.0, -30.0, -40.0), (0.0, -24.0, -70.0), (0.0, -24.0, -120.0), (0.0, -22.0, -230.0)),
                   (8.0, 8.0, 6.5, 8.5))  # fmt: skip
    nostrils = both(*chain(((6.0, -103.0, -57.0), (6.0, -94.0, -50.0), (6.0, -84.0, -48.0)), (3.2, 4.2, 4.2)))
    mouth = Box((0.0, -58.0, -77.0), (16.0, 20.0, 1.5), 1.0)
    ears = both(Cone((60.0, 1.6, -29.6), (80.0, 3.0, -30.0), 3.2, 4.0))
    return tuple(Hollow(solid, AIR) for solid in (*throat, *nostrils, mouth, *ears))


def fillings() -> tuple[Hollow, ...]:
    """Parts with HU of their own, within the spaces of the bone.

    Returns
    -------
    tuple of Hollow
        Ventricles, eyes with their nerves and muscles, shells of the nose.
    """
    ventricles = both(Ellipsoid((9.0, -8.0, 30.0), (5.0, 26.0, 9.0)), Ellipsoid((17.0, 28.0, 22.0), (6.0, 16.0, 9.0)))
    eyes = both(GLOBE_BALL)
    muscles = both(
        Cone((33.0, -64.0, -18.0), (19.0, -42.0, -14.0), 2.0, 1.8),
        Cone((45.0, -68.0, -18.0), (20.0, -42.0, -15.0), 2.2, 1.8),
        Cone((23.0, -70.0, -18.0), (17.5, -43.0, -15.0), 2.2, 1.8),
        Cone((33.0, -70.0, -8.0), (19.0, -43.0, -12.0), 2.2, 1.8),
        Cone((33.0, -70.0, -29.0), (19.0, -43.0, -18.0), 2.2, 1.8),
    )
    shells = both(
        Cone((8.0, -80.0, -52.0), (8.0, -44.0, -52.0), 3.8, 3.2),
        Cone((8.0, -74.0, -40.0), (8.0, -46.0, -40.0), 3.0, 2.6),
    )
    return (
        *(Hollow(solid, CSF) for solid in ventricles),
        *(Hollow(solid, GLOBE) for solid in eyes),
        *(Hollow(solid, NERVE) for solid in muscles),
        *(Hollow(solid, MUSCLE) for solid in shells),
    )


__all__ = ["CSF", "FAT", "MUSCLE", "airways", "body_solids", "fillings"]
