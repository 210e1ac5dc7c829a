"""Designs -> files and pages, all of them or none."""
