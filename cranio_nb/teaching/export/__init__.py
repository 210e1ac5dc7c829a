"""Executed lessons -> assignments for the course tools nbgrader and Otter-Grader, which then collect and grade.

Both are made from the cells and tags that the students' own copies are made from, and ask the same checks, so that all
give the same points. Neither tool is needed to write them.
"""
