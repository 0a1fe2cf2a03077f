// Edges are counted by their faces: one that bounds a single face, once, is open.
#include "host_tools/job/import/cad_open_faces.hpp"

#include <utility>

#include "host_tools/job/import/cad_face_repair.hpp"

#include "opencascade/BRepMesh_IncrementalMesh.hxx"
#include "opencascade/BRep_Builder.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Poly_Triangulation.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopLoc_Location.hxx"
#include "opencascade/TopTools_DataMapOfShapeInteger.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Compound.hxx"
#include "opencascade/TopoDS_Edge.hxx"

namespace cusp::import {
namespace {

// A seam bounds its face twice.
bool has_open_edge(const std::vector<SolidFace>& faces)
{
    TopTools_DataMapOfShapeInteger sides;
    for (const SolidFace& found : faces) {
        for (TopExp_Explorer at{found.face, TopAbs_EDGE}; at.More(); at.Next()) {
            if (!BRep_Tool::Degenerated(TopoDS::Edge(at.Current()))) {
                int* const count = sides.ChangeSeek(at.Current().Oriented(TopAbs_FORWARD));
                if (count != nullptr) {
                    ++*count;
                } else {
                    sides.Bind(at.Current().Oriented(TopAbs_FORWARD), 1);
                }
            }
        }
    }
    for (TopTools_DataMapOfShapeInteger::Iterator at{sides}; at.More(); at.Next()) {
        if (at.Value() == 1) {
            return true;
        }
    }
    return false;
}

}  // namespace

std::vector<std::array<Vec3d, 3>> triangles_of_faces(const std::vector<SolidFace>& faces,
                                                     double off)
{
    constexpr double kTurn = 0.35;  // radians
    std::vector<std::array<Vec3d, 3>> triangles;
    const BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (const SolidFace& found : faces) {
        builder.Add(all, found.face);
    }
    const BRepMesh_IncrementalMesh mesh{all, off, false, kTurn};
    for (const SolidFace& found : faces) {
        TopLoc_Location place;
        const Handle(Poly_Triangulation) facets = BRep_Tool::Triangulation(found.face, place);
        for (int k = 1; !facets.IsNull() && k <= facets->NbTriangles(); ++k) {
            int a = 0;
            int b = 0;
            int c = 0;
            facets->Triangle(k).Get(a, b, c);
            if (found.face.Orientation() == TopAbs_REVERSED) {
                std::swap(b, c);
            }
            const auto corner = [&](int number) {
                return vec_of(facets->Node(number).Transformed(place.Transformation()));
            };
            triangles.push_back({corner(a), corner(b), corner(c)});
        }
    }
    return triangles;
}

std::vector<std::array<Vec3d, 3>> triangles_of_open_faces(const std::vector<SolidFace>& faces)
{
    constexpr double kOff = 0.05;  // mm
    return has_open_edge(faces) ? triangles_of_faces(faces, kOff)
                                : std::vector<std::array<Vec3d, 3>>{};
}

}  // namespace cusp::import
