"""Arrays and meshes -> pictures.

`palette` has the colours, `figures` the printed pictures, `canvas` the fast ones, `shading` the surfaces, `scene3d` the
scenes to turn. Matplotlib is imported in `figures.axes` only, pyvista in `scene3d` only; nothing here knows a widget.
"""
