#include "host_tools/job/import/cad_face_patches.hpp"

#include <algorithm>

#include "host_tools/job/import/cad_face_repair.hpp"
#include "host_tools/job/import/revolved_patches.hpp"
#include "host_tools/job/import/sphere_patches.hpp"

#include "opencascade/BRepAdaptor_Surface.hxx"
#include "opencascade/gp_Ax3.hxx"
#include "opencascade/gp_Cone.hxx"
#include "opencascade/gp_Cylinder.hxx"
#include "opencascade/gp_Sphere.hxx"
#include "opencascade/gp_Torus.hxx"

namespace cusp::import {

namespace {

Vec3d direction_of(const gp_Dir& d) { return {d.X(), d.Y(), d.Z()}; }

// About the axis of a position, which may be left-handed: then heights are turned round.
Revolved about(const gp_Ax3& position, double radius, double tube, double slope)
{
    const Vec3d x = direction_of(position.XDirection());
    const Vec3d y = direction_of(position.YDirection());
    return {vec_of(position.Location()),
            {x, y, cross(x, y)},
            radius,
            tube,
            position.Direct() ? slope : -slope};
}

}  // namespace

std::optional<FacePatches> patches_of(const TopoDS_Face& face, const std::string& place)
{
    const BRepAdaptor_Surface adaptor{face};
    const GeomAbs_SurfaceType type = adaptor.GetType();
    gp_Ax3 position;
    Revolved revolved{};
    if (type == GeomAbs_Sphere) {
        position = adaptor.Sphere().Position();
    } else if (type == GeomAbs_Torus) {
        const gp_Torus ring = adaptor.Torus();
        position = ring.Position();
        revolved = about(position, ring.MajorRadius(), ring.MinorRadius(), 0);
    } else if (type == GeomAbs_Cone) {
        const gp_Cone cone = adaptor.Cone();
        position = cone.Position();
        revolved = about(position, cone.RefRadius(), 0, cone.SemiAngle());
    } else if (type == GeomAbs_Cylinder) {
        position = adaptor.Cylinder().Position();
        revolved = about(position, adaptor.Cylinder().Radius(), 0, 0);
    } else {
        return std::nullopt;
    }
    const bool mirrored = !position.Direct();
    const bool inwards = (face.Orientation() == TopAbs_REVERSED) != mirrored;
    const std::vector<FaceEdge> edges = edges_in_space(face, mirrored);
    const double gap = std::max(allowed_off(face), allowed_gap(face));
    return FacePatches{type == GeomAbs_Sphere ? sphere_patches({vec_of(position.Location()),
                                                                adaptor.Sphere().Radius()},
                                                               edges, gap, place)
                                              : revolved_patches(revolved, edges, gap, place),
                       inwards ? -1.0 : 1.0};
}

}  // namespace cusp::import
