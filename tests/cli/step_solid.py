"""Solids of flat faces and round holes as STEP files, written without a CAD kernel."""
import collections
import math

# A level face of circles, of which the first bounds it and the others are holes; or of corners and holes.
Level = collections.namedtuple("Level", "corners circles z up")
# The wall of a vertical hole: a cylinder, or a cone where the radii differ; a radius of 0 below is its tip.
HoleWall = collections.namedtuple("HoleWall", "x y low low_radius high high_radius")


def block_with_slope(size_x, size_y, bottom, low, high):
    """Faces of a block whose top rises from `low` at x = 0 to `high` at x = size_x."""
    a, b, c, d = (0, 0, bottom), (size_x, 0, bottom), (size_x, size_y, bottom), (0, size_y, bottom)
    e, f, g, h = (0, 0, low), (size_x, 0, high), (size_x, size_y, high), (0, size_y, low)
    return [[d, c, b, a], [e, f, g, h], [a, b, f, e], [b, c, g, f], [c, d, h, g], [d, a, e, h]]


def unit_vector(values):
    length = sum(value * value for value in values) ** 0.5
    return [value / length for value in values]


def minus(p, q):
    return [x - y for x, y in zip(p, q)]


class StepShell:
    """Entities of a file, by their order; edges that two faces have in common are written once."""
    def __init__(self):
        self.lines, self.points, self.vertices, self.edges = [], {}, {}, {}

    def add(self, text):
        self.lines.append(text)
        return f"#{len(self.lines)}"

    @staticmethod
    def reals(values):
        return "(" + ",".join(repr(float(value)) for value in values) + ")"

    def direction(self, values):
        return self.add(f"DIRECTION('',{self.reals(unit_vector(values))})")

    def vertex(self, corner):
        corner = tuple(map(float, corner))
        if corner not in self.points:
            self.points[corner] = self.add(f"CARTESIAN_POINT('',{self.reals(corner)})")
            self.vertices[corner] = self.add(f"VERTEX_POINT('',{self.points[corner]})")
        return self.points[corner], self.vertices[corner]

    def placement(self, at, z, x):
        return self.add(f"AXIS2_PLACEMENT_3D('',{self.vertex(at)[0]},{self.direction(z)},{self.direction(x)})")

    def line(self, p, q):
        p, q = tuple(map(float, p)), tuple(map(float, q))
        if (q, p) in self.edges:
            return self.add(f"ORIENTED_EDGE('',*,*,{self.edges[q, p]},.F.)")
        if (p, q) not in self.edges:
            (start, begin), (_, end) = self.vertex(p), self.vertex(q)
            vector = self.add(f"VECTOR('',{self.direction(minus(q, p))},1.0)")
            line = self.add(f"LINE('',{start},{vector})")
            self.edges[p, q] = self.add(f"EDGE_CURVE('',{begin},{end},{line},.T.)")
        return self.add(f"ORIENTED_EDGE('',*,*,{self.edges[p, q]},.T.)")

    def circle(self, x, y, z, radius, counter_clockwise):
        key = tuple(map(float, (x, y, z, radius)))
        if key not in self.edges:
            vertex = self.vertex((x + radius, y, z))[1]
            circle = self.add(f"CIRCLE('',{self.placement((x, y, z), (0, 0, 1), (1, 0, 0))},{float(radius)!r})")
            self.edges[key] = self.add(f"EDGE_CURVE('',{vertex},{vertex},{circle},.T.)")
        return self.add(f"ORIENTED_EDGE('',*,*,{self.edges[key]},{'.T.' if counter_clockwise else '.F.'})")

    def bound(self, kind, edges):
        return self.add(f"{kind}('',{self.add(f'''EDGE_LOOP('',({','.join(edges)}))''')},.T.)")

    def face(self, bounds, surface, same="T"):
        return self.add(f"ADVANCED_FACE('',({','.join(bounds)}),{surface},.{same}.)")

    def polygon(self, corners):
        u, v = minus(corners[1], corners[0]), minus(corners[2], corners[1])
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        edges = [self.line(p, q) for p, q in zip(corners, corners[1:] + corners[:1])]
        plane = self.add(f"PLANE('',{self.placement(corners[0], normal, u)})")
        return self.face([self.bound("FACE_OUTER_BOUND", edges)], plane)

    def level(self, face):
        bounds, circles = [], list(face.circles)
        if face.corners:
            corners = [(x, y, face.z) for x, y in (face.corners if face.up else face.corners[::-1])]
            bounds.append(self.bound("FACE_OUTER_BOUND",
                                     [self.line(p, q) for p, q in zip(corners, corners[1:] + corners[:1])]))
        else:
            x, y, radius = circles.pop(0)
            bounds.append(self.bound("FACE_OUTER_BOUND", [self.circle(x, y, face.z, radius, face.up)]))
        bounds += [self.bound("FACE_BOUND", [self.circle(x, y, face.z, r, not face.up)]) for x, y, r in circles]
        plane = self.add(f"PLANE('',{self.placement((0, 0, face.z), (0, 0, 1 if face.up else -1), (1, 0, 0))})")
        return self.face(bounds, plane)

    def hole_wall(self, wall):
        x, y, low, a, high, b = wall
        upper, lower = (x + b, y, high), (x + a, y, low)
        edges = [self.circle(x, y, high, b, True), self.line(upper, lower), self.line(lower, upper)]
        if a > 0:
            edges.insert(2, self.circle(x, y, low, a, False))
        place = self.placement((x, y, low), (0, 0, 1), (1, 0, 0))
        surface = (f"CYLINDRICAL_SURFACE('',{place},{float(a)!r})" if a == b else
                   f"CONICAL_SURFACE('',{place},{float(a)!r},{math.atan2(b - a, high - low)!r})")
        return self.face([self.bound("FACE_OUTER_BOUND", edges)], self.add(surface), "F")


def step_solid(faces):
    """The text of a STEP file in mm; a face is a Level, a HoleWall or a list of corners, counter-clockwise from outside."""
    shell = StepShell()
    add = shell.add
    written = [shell.level(face) if isinstance(face, Level) else shell.hole_wall(face) if isinstance(face, HoleWall)
               else shell.polygon(face) for face in faces]
    closed = add(f"CLOSED_SHELL('',({','.join(written)}))")
    solid = add(f"MANIFOLD_SOLID_BREP('',{closed})")
    units = [add("(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))"),
             add("(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))"),
             add("(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())")]
    accuracy = add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{units[0]},'','')")
    context = add("(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT("
                  f"({accuracy})) GLOBAL_UNIT_ASSIGNED_CONTEXT(({','.join(units)})) "
                  "REPRESENTATION_CONTEXT('',''))")
    shape = add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({solid}),{context})")
    application = add("APPLICATION_CONTEXT('automotive design')")
    product = add(f"PRODUCT('part','part','',(#{len(shell.lines) + 2}))")
    add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
    formation = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    about = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
    definition = add(f"PRODUCT_DEFINITION('design','',{formation},{about})")
    whole = add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    add(f"SHAPE_DEFINITION_REPRESENTATION({whole},{shape})")
    data = "".join(f"#{k}={line};\n" for k, line in enumerate(shell.lines, 1))
    return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
            "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\n"
            f"DATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n")
