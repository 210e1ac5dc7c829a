"""What is learned from synthetic heads, and what is not learned from."""

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.prior.learning import check_intact, learn_prior
from cranio_nb.prior.vault_radii import mirror_radii, vault_rays


def test_learned_heads_are_symmetric_and_of_mean_size(learned):
    assert learned.radii.shape == (4, 2, len(vault_rays()))
    assert np.isfinite(learned.radii).all() and (learned.radii[:, 0] > learned.radii[:, 1]).all()
    middle = learned.samples.mean(axis=0)
    np.testing.assert_allclose(mirror_radii(middle), middle, atol=1e-4)
    assert 60 < middle[0].mean() < 110


def test_an_open_skull_is_not_learned_from(skull, intact):
    check_intact(intact(0))
    with pytest.raises(InputRefused, match="not intact") as refused:
        check_intact(skull("large", 0))
    assert refused.value.code == "NotIntact"


def test_half_a_head_is_not_learned_from(intact):
    whole = intact(0)
    with pytest.raises(InputRefused, match="outside the image") as refused:
        check_intact(whole.crop((slice(whole.shape[0] // 2, None), slice(None), slice(None))))
    assert refused.value.code == "VaultLeavesImage"


def test_one_skull_is_too_few(intact):
    with pytest.raises(InputRefused, match="needs 2 intact skulls"):
        learn_prior([intact(0)])
