"""Solids with flat faces as STEP files, written without a CAD kernel."""


def block_with_slope(size_x, size_y, bottom, low, high):
    """Faces of a block whose top rises from `low` at x = 0 to `high` at x = size_x."""
    a, b, c, d = (0, 0, bottom), (size_x, 0, bottom), (size_x, size_y, bottom), (0, size_y, bottom)
    e, f, g, h = (0, 0, low), (size_x, 0, high), (size_x, size_y, high), (0, size_y, low)
    return [[d, c, b, a], [e, f, g, h], [a, b, f, e], [b, c, g, f], [c, d, h, g], [d, a, e, h]]


def step_solid(faces):
    """The text of a STEP file in mm; each face a list of corners, counter-clockwise from outside."""
    lines = []

    def add(text):
        lines.append(text)
        return f"#{len(lines)}"

    def reals(values):
        return "(" + ",".join(repr(float(value)) for value in values) + ")"

    def unit_vector(values):
        length = sum(value * value for value in values) ** 0.5
        return [value / length for value in values]

    def minus(p, q):
        return [x - y for x, y in zip(p, q)]

    points, vertices, edges = {}, {}, {}
    for corner in {corner for face in faces for corner in face}:
        points[corner] = add(f"CARTESIAN_POINT('',{reals(corner)})")
        vertices[corner] = add(f"VERTEX_POINT('',{points[corner]})")

    def oriented_edge(p, q):
        if (q, p) in edges:
            return add(f"ORIENTED_EDGE('',*,*,{edges[q, p]},.F.)")
        way = add(f"DIRECTION('',{reals(unit_vector(minus(q, p)))})")
        vector = add(f"VECTOR('',{way},1.0)")
        line = add(f"LINE('',{points[p]},{vector})")
        edges[p, q] = add(f"EDGE_CURVE('',{vertices[p]},{vertices[q]},{line},.T.)")
        return add(f"ORIENTED_EDGE('',*,*,{edges[p, q]},.T.)")

    shell = []
    for face in faces:
        u, v = minus(face[1], face[0]), minus(face[2], face[1])
        normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        z = add(f"DIRECTION('',{reals(unit_vector(normal))})")
        x = add(f"DIRECTION('',{reals(unit_vector(u))})")
        place = add(f"AXIS2_PLACEMENT_3D('',{points[face[0]]},{z},{x})")
        plane = add(f"PLANE('',{place})")
        loop = [oriented_edge(p, q) for p, q in zip(face, face[1:] + face[:1])]
        loop = add(f"EDGE_LOOP('',({','.join(loop)}))")
        bound = add(f"FACE_OUTER_BOUND('',{loop},.T.)")
        shell.append(add(f"ADVANCED_FACE('',({bound}),{plane},.T.)"))
    shell = add(f"CLOSED_SHELL('',({','.join(shell)}))")
    solid = add(f"MANIFOLD_SOLID_BREP('',{shell})")
    units = [add("(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))"),
             add("(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))"),
             add("(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())")]
    accuracy = add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{units[0]},'','')")
    context = add("(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT("
                  f"({accuracy})) GLOBAL_UNIT_ASSIGNED_CONTEXT(({','.join(units)})) "
                  "REPRESENTATION_CONTEXT('',''))")
    shape = add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',({solid}),{context})")
    application = add("APPLICATION_CONTEXT('automotive design')")
    product = add(f"PRODUCT('part','part','',(#{len(lines) + 2}))")
    add(f"PRODUCT_CONTEXT('',{application},'mechanical')")
    formation = add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
    about = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')")
    definition = add(f"PRODUCT_DEFINITION('design','',{formation},{about})")
    whole = add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
    add(f"SHAPE_DEFINITION_REPRESENTATION({whole},{shape})")
    data = "".join(f"#{k}={line};\n" for k, line in enumerate(lines, 1))
    return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
            "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\n"
            f"DATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n")
