"""The lessons: their case, panels, exercises, checks, and how notebooks are built and opened."""
