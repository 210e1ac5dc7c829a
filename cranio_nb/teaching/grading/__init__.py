"""Notebooks that students hand in -> points, causes of mistakes, a page for each student and one on the class."""
