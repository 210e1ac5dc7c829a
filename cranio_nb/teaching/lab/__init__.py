"""JupyterLab, set up for the lessons."""
