"""Plates of square columns as STL: any heights, with walls between them, any tops left out."""

PITCH = 4  # mm


def plate(heights, left_out=()):
    """Facets of a solid from z = 0; heights[i][j] of the square i along x and j along y."""
    wide, deep = len(heights), len(heights[0])
    facets = []

    def quad(a, b, c, d):
        facets.extend([(a, b, c), (a, c, d)])

    def height(i, j):
        return heights[i][j] if 0 <= i < wide and 0 <= j < deep else 0

    for i in range(wide):
        for j in range(deep):
            x, y, z = PITCH * i, PITCH * j, heights[i][j]
            far_x, far_y = x + PITCH, y + PITCH
            if (i, j) not in left_out:
                quad((x, y, z), (far_x, y, z), (far_x, far_y, z), (x, far_y, z))
            quad((x, y, 0), (x, far_y, 0), (far_x, far_y, 0), (far_x, y, 0))
            for low, a, b in ((height(i, j - 1), (x, y), (far_x, y)),
                              (height(i + 1, j), (far_x, y), (far_x, far_y)),
                              (height(i, j + 1), (far_x, far_y), (x, far_y)),
                              (height(i - 1, j), (x, far_y), (x, y))):
                if low < z:
                    quad((*a, low), (*b, low), (*b, z), (*a, z))
    return facets


def stl(facets):
    text = "solid plate\n"
    for facet in facets:
        text += "facet normal 0 0 0\nouter loop\n"
        text += "".join("vertex %.9g %.9g %.9g\n" % corner for corner in facet)
        text += "endloop\nendfacet\n"
    return text + "endsolid plate\n"
