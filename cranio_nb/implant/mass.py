"""A closed mesh -> its volume and what it weighs in common materials.

Frame: world mm.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..mesh import Mesh

DENSITIES = {"PMMA": 1.19, "PEEK": 1.31, "Ti-6Al-4V": 4.43}
"""g/cm3 at room temperature, solid material: W. D. Callister, Materials Science and Engineering, appendix B.1
(PMMA is given as 1.17 to 1.20). Bone cement with air or a contrast agent in it differs by some percent."""


@dataclass(frozen=True)
class ImplantMass:
    """What an implant weighs.

    Parameters
    ----------
    volume_cm3 : float
        Volume of the mesh.
    mass_g : dict of str to float
        Mass if made solid of each of the `DENSITIES`.
    """

    volume_cm3: float
    mass_g: dict[str, float]


def weigh_implant(mesh: Mesh) -> ImplantMass:
    """Volume and mass of a closed mesh.

    Parameters
    ----------
    mesh : Mesh
        World mm, normals outward.

    Returns
    -------
    ImplantMass

    Examples
    --------
    >>> import numpy as np
    >>> tetrahedron = Mesh(np.array([[0.0, 0, 0], [60, 0, 0], [0, 60, 0], [0, 0, 60]]),
    ...                    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    >>> round(weigh_implant(tetrahedron).mass_g["PEEK"], 2)
    47.16
    """
    volume = mesh.volume / 1000
    return ImplantMass(volume, {material: volume * density for material, density in DENSITIES.items()})
