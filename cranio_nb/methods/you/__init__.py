"""After You et al. 2009: the hole filled by a flat mesh between guiding points."""
