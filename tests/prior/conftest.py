"""What the tests of the prior share."""

import numpy as np
import pytest

from cranio_nb.prior.vault_radii import vault_rays


@pytest.fixture(scope="session")
def hole() -> np.ndarray:
    """Rays through a round hole on the left."""
    towards = np.array([0.7, 0.3, 0.65])
    return vault_rays() @ towards > np.cos(0.4) * np.linalg.norm(towards)
