"""A design -> how good it is: against the truth, at its rim, in the paper's tables."""
