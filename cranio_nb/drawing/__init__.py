"""Arrays and meshes -> pictures. Matplotlib and pyvista are imported here only."""
