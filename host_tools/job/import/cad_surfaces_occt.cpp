// Converts every face of a CAD model into a B-spline surface with trimming curves.
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/cad_face.hpp"
#include "host_tools/job/import/cad_face_repair.hpp"
#include "host_tools/job/import/cad_open_faces.hpp"
#include "host_tools/job/import/cad_shape.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"

#include "fmt/format.h"
#include "opencascade/BRepBuilderAPI_Sewing.hxx"
#include "opencascade/BRepBuilderAPI_Transform.hxx"
#include "opencascade/BRepLib.hxx"
#include "opencascade/BRep_Builder.hxx"
#include "opencascade/BRep_Tool.hxx"
#include "opencascade/Standard_Failure.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Face.hxx"
#include "opencascade/TopoDS_Solid.hxx"
#include "opencascade/gp_Trsf.hxx"

namespace cusp::import {

namespace {

constexpr double kSewing = 1e-3;  // mm

void add_faces(const TopoDS_Shape& shape, bool solid, std::vector<SolidFace>& faces)
{
    for (TopExp_Explorer at{shape, TopAbs_FACE, solid ? TopAbs_SHAPE : TopAbs_SOLID}; at.More();
         at.Next()) {
        faces.push_back({TopoDS::Face(at.Current()), solid});
    }
}

// Sews the faces outside solids. A closed shell becomes a solid whose faces are oriented outwards.
// Returns the number of closed shells.
std::size_t add_loose_faces(const TopoDS_Shape& shape, std::vector<SolidFace>& faces)
{
    BRepBuilderAPI_Sewing sewing{kSewing};
    bool any = false;
    for (TopExp_Explorer at{shape, TopAbs_FACE, TopAbs_SOLID}; at.More(); at.Next()) {
        sewing.Add(at.Current());
        any = true;
    }
    if (!any) {
        return 0;
    }
    std::size_t closed_shells = 0;
    sewing.Perform();
    const TopoDS_Shape sewn = sewing.SewedShape();
    const BRep_Builder builder;
    for (TopExp_Explorer at{sewn, TopAbs_SHELL}; at.More(); at.Next()) {
        TopoDS_Solid solid;
        builder.MakeSolid(solid);
        builder.Add(solid, at.Current());
        const bool closed = BRep_Tool::IsClosed(at.Current()) && BRepLib::OrientClosedSolid(solid);
        add_faces(closed ? TopoDS_Shape{solid} : at.Current(), closed, faces);
        closed_shells += closed ? 1 : 0;
    }
    for (TopExp_Explorer at{sewn, TopAbs_FACE, TopAbs_SHELL}; at.More(); at.Next()) {
        faces.push_back({TopoDS::Face(at.Current()), false});
    }
    return closed_shells;
}

TopoDS_Shape placed_shape(const TopoDS_Shape& shape, const Similarity& placed)
{
    if (placed.is_identity()) {
        return shape;
    }
    const auto& [x, y, z] = placed.axes;
    const Vec3d by = placed.shift;
    gp_Trsf move;
    move.SetValues(x.x, y.x, z.x, by.x, x.y, y.y, z.y, by.y, x.z, y.z, z.z, by.z);
    return BRepBuilderAPI_Transform{shape, move, true}.Shape();
}

CadModel model_of(const std::string& file,
                  Repairs repairs,
                  const Similarity& placed,
                  CadWanted wanted)
{
    ReadShape read = read_shape(file, repairs);
    read.shape = placed_shape(read.shape, placed);
    CadModel model;
    model.unit = read.unit;
    std::vector<SolidFace> faces;
    for (TopExp_Explorer at{read.shape, TopAbs_SOLID}; at.More(); at.Next()) {
        add_faces(at.Current(), true, faces);
        ++model.solids;
    }
    model.solids += add_loose_faces(read.shape, faces);
    if (faces.empty()) {
        throw InputError(file + ": the file holds no face");
    }
    if (wanted == CadWanted::kFacets) {
        model.triangles = triangles_of_faces(faces, kFacetsOff);
        return model;
    }
    const bool all_faces = wanted != CadWanted::kUpward;
    if (wanted == CadWanted::kEverything) {
        model.triangles = triangles_of_faces(faces, kFacetsOff);
    } else if (!all_faces) {
        model.triangles = triangles_of_open_faces(faces);
    }
    for (std::size_t i = 0; i < faces.size(); ++i) {
        add_face(faces[i], all_faces, fmt::format("{}: face {}", file, i + 1), model);
    }
    if (model.faces.empty()) {
        throw InputError(file + ": no face faces up: is z the tool's axis? (placing: up)");
    }
    return model;
}

// A file whose wires have to be reversed is read again with all repairs, unless these lose area.
CadModel model_with_fewest_repairs(const std::string& file,
                                   const Similarity& placed,
                                   CadWanted wanted)
{
    constexpr double kSamePart = 1e-3;
    try {
        return model_of(file, Repairs::kGentle, placed, wanted);
    } catch (const InputError&) {
        const double gentle = area_of(read_shape(file, Repairs::kGentle).shape);
        const double repaired = area_of(read_shape(file, Repairs::kAll).shape);
        if (repaired < (1 - kSamePart) * gentle) {
            throw;
        }
        try {
            return model_of(file, Repairs::kAll, placed, wanted);
        } catch (const InputError&) {
        }
        throw;  // the file as it is
    }
}

}  // namespace
}  // namespace cusp::import

extern "C" void cusp_read_cad_model(const std::string& file,
                                    const cusp::import::Similarity& placed,
                                    cusp::import::CadWanted wanted,
                                    cusp::import::CadModel& model)
{
    try {
        model = cusp::import::model_with_fewest_repairs(file, placed, wanted);
    } catch (const Standard_Failure& failure) {
        throw cusp::InputError(
            fmt::format("{}: Open CASCADE failed: {}", file, failure.GetMessageString()));
    }
}
