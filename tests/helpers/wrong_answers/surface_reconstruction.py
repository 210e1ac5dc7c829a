"""Wrong answers to the exercises of lesson 06."""

TETRAHEDRA = "a, b, c = vertices[faces].swapaxes(0, 1); v = (a * np.cross(b, c)).sum(1)"

# what students write, and words of the hint that they should get
WRONG = {
    "6.1": [
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(b, c)).sum() / 3", "Twice"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return abs((a * np.cross(b, c)).sum(1)).sum() / 6", "signs"),
        ("a, b, c = vertices[faces].swapaxes(0, 1); return (a * np.cross(c, b)).sum() / 6", "sign is wrong"),
        (f"{TETRAHEDRA}; return v.sum()", "Six times too big"),
        (f"{TETRAHEDRA}; return abs(v.sum()) / 6", "inside out"),
        (
            ("a, b, c = (vertices[faces[:, i]] for i in range(3)); return (a * np.cross(b, c)).sum(1) / 6"),
            "These are the single tetrahedra",
        ),
        (
            (
                "a, b, c = (vertices[faces[:, i]] for i in range(3)); "
                "return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2"
            ),
            "This is the area of the surface",
        ),
        ("return len(faces) / 6", "does not use `vertices`"),
        ("a, b, c = (vertices[faces[i]] for i in range(3)); return (a * np.cross(b, c)).sum() / 6", "first face"),
        (
            ("a, b, c = vertices[:, 0], vertices[:, 1], vertices[:, 2]; return np.dot(a, np.cross(b, c)) / 6"),
            "stopped with ValueError",
        ),
        (
            ("a, b, c = (vertices[faces[:, i]] for i in range(3)); return np.einsum('ij,ij->', a, np.cross(b, c)) / 2"),
            "Three times too much",
        ),
        (
            (
                "a, b, c = (vertices[faces[:, i]] for i in range(3)); "
                "return np.einsum('ij,ij->', a, np.cross(b, c)) / 6 / 1000"
            ),
            "Each of your numbers is 0.001 ",
        ),
        (
            ("a, b, c = (vertices[faces[i]] for i in range(3)); return np.einsum('ij,ij->', a, np.cross(b, c)) / 6"),
            None,
        ),
        (
            "a, b, c = (vertices[faces[:, i]] for i in range(3)); return (a * b * c).sum() / 6",
            "This multiplies number by number",
        ),
        (("from scipy.spatial import ConvexHull\n    return ConvexHull(vertices).volume"), "The volume of the hull"),
        (
            (
                "a, b, c = (vertices[faces[:, i]] for i in range(3)); "
                "return np.einsum('ij,ij->', a - vertices.mean(0), np.cross(b, c)) / 6"
            ),
            None,
        ),
        (
            (
                "a, b, c = (vertices[faces[:, i]] for i in range(3)); "
                "return np.einsum('ij,ij->', a, np.cross(b - a, c - a)) / 3"
            ),
            "Twice too much",
        ),
        (
            ("a, b, c = (vertices[faces[:, i]] for i in range(3)); return (a @ np.cross(b, c).T).sum() / 6"),
            "`@` takes every face with every other",
        ),
        (
            ("a, b, c = (vertices[faces[:, i]] for i in range(3)); return np.einsum('ij,ij->', b, np.cross(a, c)) / 6"),
            "The sign is wrong",
        ),
        ("return len(vertices)", "The function does not use `faces`"),
    ],
    "6.2": [
        ("return (index * spacing).astype(str)", "returns text"),
        ("return (index - index.min(axis=0)) * spacing", "count from the first position"),
        ("return index", "still voxels"),
        ("return index * spacing[::-1]", "turn it round"),
        ("return index / spacing", "Divided"),
        ("return index[:, ::-1] * spacing", "columns of the index"),
        ("return (index * spacing)[:, ::-1]", "their columns turned round"),
        ("return (index + 0.5) * spacing", "Half a voxel"),
        ("return index * spacing - spacing / 2", "Half a voxel"),
        ("return index + spacing", "A spacing is mm per voxel"),
        ("return index * spacing[:, None]", "The spacings go along the rows of the array"),
        ("return index * spacing[0]", "The first spacing is used for all axes"),
        ("return index @ spacing", "The three axes are added up"),
        ("return np.round(index) * spacing", "Rounded: vertices lie between "),
        ("return (index - 1) * spacing", "A voxel off: index 0 lies at 0"),
        ("return (index * spacing).T", "Rows and columns are exchanged"),
        ("return (index * spacing).sum(axis=1)", "The three axes are added up"),
        ("return index * np.prod(spacing)", "np.prod is the volume of a voxel"),
        ("return np.linalg.norm(index * spacing, axis=1)", "These are distances from 0"),
        ("return (index + 1) * spacing", "A voxel off: index 0 lies at 0"),
        ("return index * spacing ** 2", "The spacing comes in once"),
        ("return index * spacing.max()", "One spacing for all axes"),
        ("return index * spacing[2]", "One spacing for all axes"),
        ("return index * spacing[1]", "One spacing for all axes"),
        ("return index * spacing.min()", "One spacing for all axes"),
        ("return index * np.median(spacing)", "One spacing for all axes"),
        ("return index * np.prod(spacing) ** (1 / 3)", "One spacing for all axes"),
        ("return index * np.linalg.norm(spacing)", "the diagonal of a voxel"),
        ("return index * spacing[[0, 2, 1]]", "Spacings are exchanged"),
        ("return index * spacing[[1, 0, 2]]", "Spacings are exchanged"),
        ("return index * np.roll(spacing, 1)", "are exchanged"),
        ("return index + 0.5 * spacing", "A spacing is mm per voxel"),
        ("return spacing * index[0]", None),
    ],
}
