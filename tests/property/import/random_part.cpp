// random_part SEED PART.step MESH.stl [swept]: a block with boxes, cylinders, cones, balls and rings, or with
// what is swept, lofted or free, added or cut away, some edges rounded or chamfered, sometimes turned; and
// Open CASCADE's own mesh of it. Prints the largest tolerance of its edges and vertices, mm: Open CASCADE may
// shrink a short side of a fillet to a vertex with a tolerance of half its length, and the mesh is no truer
// than that; and how far the mesh is beside the surfaces.
//
// Its least x and y are 0, its top z = 0, its longest side at most 40 mm.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tests/generators/draw.hpp"
#include "tests/generators/swept_bodies.hpp"

#include "opencascade/BRepAlgoAPI_Cut.hxx"
#include "opencascade/BRepAlgoAPI_Fuse.hxx"
#include "opencascade/BRepBndLib.hxx"
#include "opencascade/BRepBuilderAPI_Transform.hxx"
#include "opencascade/BRepCheck_Analyzer.hxx"
#include "opencascade/BRepFilletAPI_MakeChamfer.hxx"
#include "opencascade/BRepFilletAPI_MakeFillet.hxx"
#include "opencascade/BRepMesh_IncrementalMesh.hxx"
#include "opencascade/BRepPrimAPI_MakeBox.hxx"
#include "opencascade/BRepPrimAPI_MakeCone.hxx"
#include "opencascade/BRepPrimAPI_MakeCylinder.hxx"
#include "opencascade/BRepPrimAPI_MakeSphere.hxx"
#include "opencascade/BRepPrimAPI_MakeTorus.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Bnd_Box.hxx"
#include "opencascade/Geom_Surface.hxx"
#include "opencascade/Poly_Triangulation.hxx"
#include "opencascade/STEPControl_Writer.hxx"
#include "opencascade/Standard_Failure.hxx"
#include "opencascade/StlAPI_Writer.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopLoc_Location.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Edge.hxx"
#include "opencascade/TopoDS_Face.hxx"
#include "opencascade/gp_Ax1.hxx"
#include "opencascade/gp_Ax2.hxx"
#include "opencascade/gp_Trsf.hxx"
#include "opencascade/gp_Vec.hxx"
#include "opencascade/gp_XY.hxx"

using cusp::test::Draw;
using cusp::test::random_axis;

namespace {

constexpr double kDeflection = 0.004;  // mm, of the mesh
constexpr double kTurn = 0.1;          // radians, the same

gp_Pnt random_point(Draw& draw, double low, double high)
{
    const double x = draw.uniform(-5, 60);
    const double y = draw.uniform(-5, 40);
    return {x, y, draw.uniform(low, high)};
}

TopoDS_Shape random_body(Draw& draw)
{
    const gp_Ax2 at{random_point(draw, 2, 24), random_axis(draw)};
    const double a = draw.uniform(0, 1);
    const double b = draw.uniform(0, 1);
    switch (draw.whole(0, 4)) {
        case 0:
            return BRepPrimAPI_MakeBox(at, 4 + 21 * a, 4 + 21 * b, draw.uniform(4, 25)).Shape();
        case 1:
            return BRepPrimAPI_MakeCylinder(at, 3 + 9 * a, 4 + 21 * b).Shape();
        case 2:
            return BRepPrimAPI_MakeCone(at, 6 + 6 * a, 5 * b, draw.uniform(4, 20)).Shape();
        case 3:
            return BRepPrimAPI_MakeSphere(at, 4 + 10 * a).Shape();
        default:
            return BRepPrimAPI_MakeTorus(at, 7 + 7 * a, 2 + 3 * b).Shape();
    }
}

// The changed shape where Open CASCADE makes a good one, or else the shape.
template <class Change>
TopoDS_Shape changed(const TopoDS_Shape& shape, Change change)
{
    try {
        const TopoDS_Shape next = change();
        const bool good = !next.IsNull() && BRepCheck_Analyzer(next).IsValid() &&
                          TopExp_Explorer(next, TopAbs_FACE).More();
        return good ? next : shape;
    } catch (const Standard_Failure&) {
        return shape;
    }
}

template <class Maker>
TopoDS_Shape with_edge(const TopoDS_Shape& shape, double size, const TopoDS_Edge& edge)
{
    Maker maker{shape};
    maker.Add(size, edge);
    maker.Build();
    return maker.IsDone() ? maker.Shape() : shape;
}

TopoDS_Shape with_a_blend(Draw& draw, const TopoDS_Shape& shape)
{
    std::vector<TopoDS_Edge> edges;
    for (TopExp_Explorer at{shape, TopAbs_EDGE}; at.More(); at.Next()) {
        edges.push_back(TopoDS::Edge(at.Current()));
    }
    const int last = static_cast<int>(edges.size()) - 1;
    const TopoDS_Edge edge = edges[static_cast<std::size_t>(draw.whole(0, last))];
    const bool rounded = draw.whole(0, 2) > 0;
    const double size = draw.uniform(0.5, rounded ? 4 : 3);
    return changed(shape, [&] {
        return rounded ? with_edge<BRepFilletAPI_MakeFillet>(shape, size, edge)
                       : with_edge<BRepFilletAPI_MakeChamfer>(shape, size, edge);
    });
}

TopoDS_Shape random_part(Draw& draw, bool swept)
{
    TopoDS_Shape part = BRepPrimAPI_MakeBox(60, 40, 20).Shape();
    for (int k = draw.whole(2, 6); k > 0; --k) {
        const bool added = draw.whole(0, 1) > 0;
        part = changed(part, [&] {
            const TopoDS_Shape body = swept ? cusp::test::swept_body(draw) : random_body(draw);
            return added ? BRepAlgoAPI_Fuse(part, body).Shape()
                         : BRepAlgoAPI_Cut(part, body).Shape();
        });
    }
    for (int k = draw.whole(0, 6); k > 0; --k) {
        part = with_a_blend(draw, part);
    }
    if (draw.whole(0, 1) > 0) {
        gp_Trsf turn;
        turn.SetRotation(gp_Ax1(gp_Pnt(30, 20, 0), random_axis(draw)), draw.uniform(0, 0.3));
        part = BRepBuilderAPI_Transform(part, turn, true).Shape();
    }
    return swept ? changed(part, [&] { return cusp::test::stretched(draw, part); }) : part;
}

// mm: how far the surfaces lie beside the middles of their triangles at most. Open CASCADE may miss the
// deflection by far on a face that is swept.
double mesh_off(const TopoDS_Shape& part)
{
    double most = 0;
    for (TopExp_Explorer at{part, TopAbs_FACE}; at.More(); at.Next()) {
        const TopoDS_Face& face = TopoDS::Face(at.Current());
        TopLoc_Location place;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
        const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
        for (int i = 1; !mesh.IsNull() && i <= mesh->NbTriangles(); ++i) {
            std::array<int, 3> corner{};
            mesh->Triangle(i).Get(corner[0], corner[1], corner[2]);
            const gp_Pnt a = mesh->Node(corner[0]).Transformed(place);
            const gp_Vec to_b{a, mesh->Node(corner[1]).Transformed(place)};
            const gp_Vec to_c{a, mesh->Node(corner[2]).Transformed(place)};
            const gp_XY uv = (mesh->UVNode(corner[0]).XY() + mesh->UVNode(corner[1]).XY() +
                              mesh->UVNode(corner[2]).XY()) /
                             3;
            const gp_Vec normal = to_b.Crossed(to_c);
            if (normal.Magnitude() > 1e-12) {
                const gp_Vec apart{a, surface->Value(uv.X(), uv.Y())};
                most = std::max(most, std::abs(normal.Dot(apart)) / normal.Magnitude());
            }
        }
    }
    return most;
}

TopoDS_Shape placed(const TopoDS_Shape& part)
{
    constexpr double kLongest = 40;  // mm
    Bnd_Box box;
    BRepBndLib::AddOptimal(part, box, false, false);
    const gp_Pnt low = box.CornerMin();
    const gp_Pnt high = box.CornerMax();
    gp_Trsf move;
    move.SetTranslation(gp_Vec(-low.X(), -low.Y(), -high.Z()));
    gp_Trsf scale;
    scale.SetScale(gp_Pnt(0, 0, 0), kLongest / std::max(high.X() - low.X(), high.Y() - low.Y()));
    return BRepBuilderAPI_Transform(part, scale * move, true).Shape();
}

}  // namespace

int main(int count, char** words)
{
    const bool swept = count == 5 && std::strcmp(words[4], "swept") == 0;
    if (count != 4 && !swept) {
        std::fputs("usage: random_part SEED PART.step MESH.stl [swept]\n", stderr);
        return 2;
    }
    Draw draw{std::mt19937{static_cast<unsigned>(std::strtoul(words[1], nullptr, 10))}};
    const TopoDS_Shape part = placed(random_part(draw, swept));
    STEPControl_Writer step;
    step.Transfer(part, STEPControl_AsIs);
    const bool written = step.Write(words[2]) == IFSelect_RetDone;
    const BRepMesh_IncrementalMesh mesh{part, kDeflection, false, kTurn};
    StlAPI_Writer stl;
    stl.ASCIIMode() = false;
    std::printf("tolerance %.6f mm, mesh off %.6f mm\n",
                std::max(BRep_Tool::MaxTolerance(part, TopAbs_EDGE),
                         BRep_Tool::MaxTolerance(part, TopAbs_VERTEX)),
                mesh_off(part));
    return written && stl.Write(part, words[3]) ? 0 : 1;
}
