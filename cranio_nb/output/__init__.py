"""Designs and comparisons -> files and pages, all of them or none."""
