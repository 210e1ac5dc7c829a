"""The comparison that stand-ins have made."""

from stand_ins import blind, compared_case, compared_home, found  # noqa: F401  (fixtures)
