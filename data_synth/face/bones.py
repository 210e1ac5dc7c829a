"""The bones of the face, the jaw, the ears and the neck, and what is hollow in them, as lists of simple solids.

Frame: head mm (x left, y back, z top, from the centre of the braincase). The numbers are those of an adult skull:
vertex at z = 87, ear canals at z = -30, foramen magnum at z = -50, chin at z = -118.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .solids import Box, Cells, Cone, Ellipsoid, Ring, Solid, both, chain

AIR, FAT, GLOBE, NERVE, MARROW = -1000.0, -85.0, 15.0, 40.0, 45.0


@dataclass(frozen=True)
class Hollow:
    """A space within bone.

    Parameters
    ----------
    solid : Solid
        Its shape.
    hu : float
        What fills it; NaN if only bone is taken away.
    wall : float
        Thickness in mm of the bone laid around it; 0 for none.
    """

    solid: Solid
    hu: float
    wall: float = 0.0


_ORBIT_WALL = Cone((19.0, -42.0, -15.0), (30.6, -71.0, -18.1), 4.5, 15.2)
ORBIT = Cone((19.0, -42.0, -15.0), (34.0, -80.0, -19.0), 4.5, 18.5)
GLOBE_BALL = Cone((33.0, -75.0, -18.0), (33.0, -75.0, -18.0), 12.0, 12.0)
EAR_CANAL = Cone((38.0, 1.0, -29.0), (60.0, 1.6, -29.6), 3.2, 3.6)
MASTOID = Cone((53.0, 12.0, -34.0), (51.0, 11.0, -58.0), 12.0, 6.0)
CHIN = (0.0, -84.0, -116.0)
_CONDYLE, _ANGLE = (50.0, -13.0, -35.0), (47.0, -20.0, -90.0)


def _upper_face() -> tuple[Solid, ...]:
    rim = chain(
        ((3.0, -87.0, 0.0), (20.0, -86.0, 3.0), (38.0, -77.0, 3.0), (48.0, -66.0, -6.0), (48.0, -62.0, -24.0),
         (43.0, -64.0, -36.0), (30.0, -73.0, -40.0), (16.0, -80.0, -36.0), (9.0, -86.0, -18.0), (4.0, -88.0, -4.0)),
        (5.5, 5.5, 5.0, 5.0, 4.5, 6.0, 4.0, 4.0, 3.0, 4.5),
    )  # fmt: skip
    arch = chain(
        ((46.0, -60.0, -34.0), (58.0, -46.0, -35.0), (64.0, -28.0, -33.0), (63.0, -12.0, -30.0), (56.0, -2.0, -28.0)),
        (6.0, 4.0, 2.8, 3.0, 5.0),
    )
    strut = chain(((44.0, -62.0, -40.0), (36.0, -60.0, -58.0), (27.0, -56.0, -66.0)), (6.0, 4.0, 4.0))
    wing = chain(((49.0, -58.0, -8.0), (52.0, -42.0, -10.0), (54.0, -30.0, -16.0)), (2.5, 3.0, 3.0))
    wing += chain(((48.0, -58.0, -20.0), (48.0, -40.0, -22.0), (30.0, -36.0, -27.0)), (2.5, 2.8, 3.0))
    cheek = Ellipsoid((22.0, -64.0, -52.0), (17.0, 17.0, 19.0))
    nose = chain(((3.0, -90.0, -4.0), (3.6, -99.0, -24.0)), (2.4, 1.5))
    return both(*rim, *arch, *strut, *wing, cheek, *nose)


def _middle() -> tuple[Solid, ...]:
    body = chain(((0.0, -27.0, -20.0), (0.0, -12.0, -32.0), (0.0, -2.0, -47.0)), (13.0, 10.0, 6.0))
    plates = chain(((15.0, -30.0, -32.0), (17.0, -29.0, -62.0)), (2.6, 1.8))
    pyramid = chain(((14.0, -3.0, -31.0), (32.0, 4.0, -29.0), (50.0, 10.0, -30.0)), (6.0, 9.0, 13.0))
    joint = Cone((50.0, -22.0, -27.0), (58.0, -6.0, -28.0), 4.0, 5.0)
    spike = Cone((34.0, 4.0, -40.0), (30.0, -8.0, -68.0), 2.4, 1.0)
    condyle = Ellipsoid((19.0, 3.0, -55.0), (6.0, 10.0, 5.0))
    septum = Box((0.0, -62.0, -40.0), (0.8, 24.0, 22.0))
    palate = Box((0.0, -62.0, -63.5), (22.0, 24.0, 1.8))
    gum = Ring((0.0, -57.0, -70.0), 24.0, 6.0, 8.0, 1.25, -40.0)
    spine = Cone((0.0, -86.0, -62.0), (0.0, -92.0, -61.0), 3.5, 1.2)
    return (*body, *both(*plates, *pyramid, joint, spike, condyle, MASTOID), septum, palate, gum, spine)


def _jaw() -> tuple[Solid, ...]:
    ramus = chain((_CONDYLE, (50.0, -15.0, -52.0), _ANGLE), (5.0, 3.5, 4.5))
    front = chain(((48.0, -37.0, -42.0), (47.0, -36.0, -62.0), (46.0, -32.0, -88.0)), (2.0, 3.2, 4.5))
    blade = (Ellipsoid((48.0, -26.0, -68.0), (4.2, 13.0, 26.0)),)
    body = chain((_ANGLE, (38.0, -48.0, -100.0), (22.0, -74.0, -110.0), (6.0, -84.0, -113.0)), (4.5, 6.5, 6.5, 7.5))
    upper = chain(((44.0, -36.0, -86.0), (33.0, -54.0, -94.0), (18.0, -76.0, -99.0), (0.0, -85.0, -100.0)),
                  (4.5, 5.5, 5.5, 5.0))  # fmt: skip
    return (*both(*ramus, *front, *blade, *body, *upper), Cone((7.0, *CHIN[1:]), (-7.0, *CHIN[1:]), 6.0, 6.0))


def _neck() -> tuple[Solid, ...]:
    atlas = Ring((0.0, 17.0, -67.0), 20.0, 5.0, 5.0)
    masses = both(
        Ellipsoid((20.0, 6.0, -67.0), (9.0, 9.0, 7.5)), Cone((28.0, 8.0, -68.0), (39.0, 10.0, -68.0), 4.0, 3.5)
    )
    dens = Cone((0.0, 4.0, -60.0), (0.0, 4.0, -80.0), 5.0, 6.5)
    parts: list[Solid] = [atlas, *masses, dens]
    for level in range(5):
        z, y = -84.0 - 17.0 * level, 5.0 + 1.5 * level
        parts += [Box((0.0, y, z), (10.5, 8.0, 6.5), 3.0), Ring((0.0, y + 18.0, z), 14.0, 3.0, 4.5)]
        parts += [Cone((0.0, y + 32.0, z), (0.0, y + 45.0, z - 8.0), 3.0, 3.5)]
        parts += both(Box((17.0, y + 8.0, z), (5.5, 7.0, 7.0), 3.0))
    return tuple(parts)


def skull_solids() -> tuple[Solid, ...]:
    """What is grown to the braincase and its floor.

    Returns
    -------
    tuple of Solid
        Face, ear bones and middle of the base; not yet hollowed.
    """
    return (*_upper_face(), *_middle())


def loose_solids() -> tuple[Solid, ...]:
    """What a joint parts from the skull.

    Returns
    -------
    tuple of Solid
        Lower jaw, its joint heads 2 mm below the skull, and five bones of the neck.
    """
    return (*_jaw(), *_neck())


def tooth_solids() -> tuple[Solid, ...]:
    """Both rows of teeth.

    Returns
    -------
    tuple of Solid
        Sixteen teeth in each row.
    """
    places = ((4.0, -87.0), (12.0, -84.5), (18.0, -79.0), (22.0, -72.0), (24.0, -64.5), (25.5, -56.0), (27.0, -46.5))
    rows = []
    for x, y in places:
        size = 3.2 if y < -75 else 4.0
        rows += [
            Cone((x, y, -74.0), (x, y, -82.0), size * 0.7, size),
            Cone((x, y, -88.0), (x, y, -98.0), size, size * 0.7),
        ]
    return both(*rows)


def _canals() -> tuple[Solid, ...]:
    return both(
        Cone((22.0, -42.0, -16.0), (17.0, -27.0, -20.0), 3.0, 3.0),  # fissure behind the orbit
        Cone((24.0, -43.0, -13.0), (27.0, -27.0, -13.0), 2.4, 2.0),
        Cone((17.0, -42.0, -11.0), (10.0, -27.0, -7.0), 2.2, 2.2),  # optic nerve
        Cone((21.0, -14.0, -20.0), (23.0, -13.0, -50.0), 3.0, 3.0),  # oval foramen
        Cone((24.0, 6.0, -24.0), (24.0, 6.0, -60.0), 4.5, 4.5),  # jugular foramen
        Cone((9.0, 4.0, -44.0), (22.0, -6.0, -58.0), 2.5, 2.5),  # nerve of the tongue
        Cone((10.0, 6.0, -26.0), (27.0, 6.0, -26.0), 2.6, 2.2),  # nerve of the ear
    )


def hollows() -> tuple[Hollow, ...]:
    """Orbits, nose, sinuses, air cells, ear canals and the openings of the base.

    Returns
    -------
    tuple of Hollow
        In an order in which each may be filled over the ones before.
    """
    nose = (*both(Box((5.8, -62.0, -42.0), (5.1, 25.0, 20.5), 4.0)),)
    front = (
        Cone((0.0, -84.0, -50.0), (0.0, -98.0, -50.0), 11.5, 10.5),
        Cone((0.0, -89.0, -36.0), (0.0, -99.0, -34.0), 5.5, 5.5),
    )
    air = both(
        Ellipsoid((25.0, -59.0, -48.0), (12.5, 18.0, 15.5)),  # maxillary sinus
        Ellipsoid((9.0, -85.0, 7.0), (9.0, 4.2, 9.0)),  # frontal sinus
        Ellipsoid((6.5, -28.0, -23.0), (6.0, 8.5, 8.0)),  # sphenoid sinus
        Cells(Box((7.5, -58.0, -20.5), (7.0, 19.0, 9.0), 3.0), 7.0, 0.7),
        Cells(Cone((53.0, 12.0, -34.0), (51.0, 11.0, -55.0), 9.5, 4.0), 5.5, 0.9),
        EAR_CANAL,
        Cone((38.0, 1.0, -29.0), (37.0, -1.0, -25.0), 4.0, 3.5),  # middle ear
    )
    orbits = both(ORBIT, Cone((34.0, -80.0, -19.0), (38.0, -100.0, -20.0), 18.5, 19.0))
    return (
        *(Hollow(solid, AIR, 1.1) for solid in nose),
        *(Hollow(solid, AIR, 0.8) for solid in air),
        *(Hollow(solid, MARROW) for solid in _canals()),
        *(Hollow(solid, math.nan) for solid in front),
        *(Hollow(solid, FAT, 0.4) for solid in both(_ORBIT_WALL)),
        *(Hollow(solid, FAT) for solid in orbits),
    )  # fmt: skip
