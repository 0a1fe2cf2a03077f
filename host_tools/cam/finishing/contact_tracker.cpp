// Newton's method from the last contact, or from the contact of a drop.
#include "host_tools/cam/finishing/contact_tracker.hpp"

namespace cusp::finishing {

using part_model::CcPoint;
using part_model::PartModel;
using toolpath::Tool;

namespace {

constexpr double kSameContact = 1e-3;  // radii

}  // namespace

std::optional<ContactTracker::Position> ContactTracker::at(double x, double y)
{
    const PartModel& model = path_fitter_.model();
    const Tool& tool = path_fitter_.offset_tool();
    if (model.is_mesh()) {
        const auto on_mesh = model.drop_tool(tool, x, y);
        return on_mesh
                   ? std::optional{Position{on_mesh->tip + Vec3d{0, 0, path_fitter_.band().offset},
                                            {},
                                            dot(on_mesh->lean, on_mesh->normal),
                                            on_mesh->point,
                                            on_mesh->lean}}
                   : std::nullopt;
    }
    const auto leaning = [&](Vec3d centre, Vec3d point, Vec3d normal) {
        const Vec3d tip = centre - Vec3d{0, 0, path_fitter_.tool().radius};
        return Position{{x, y, tip.z},
                        {},
                        dot(centre - point, normal) / tool.radius,
                        point,
                        (centre - point) / norm(centre - point)};
    };
    if (const std::optional<Position> found = beside(x, y)) {
        return found;
    }
    const auto rest = model.drop_cutter(tool, x, y);
    if (!rest) {
        return std::nullopt;
    }
    last_ = {rest->place.surface, rest->place.u, rest->place.v};
    if (const std::optional<Position> found = beside(x, y)) {
        return found;
    }
    // A trimmed edge has no parameters.
    const Vec3d point = rest->place.point;
    const CcPoint under = model.cc_point(last_.surface, last_.u, last_.v, tool.radius);
    Position out = leaning({x, y, rest->tip + tool.radius}, point, under.normal);
    if (norm(under.point - point) > kSameContact * tool.radius) {
        out.facing = 0;
    }
    return out;
}

std::optional<ContactTracker::Position> ContactTracker::beside(double x, double y)
{
    if (last_.surface < 0) {
        return std::nullopt;
    }
    const double radius = path_fitter_.offset_tool().radius;
    const std::optional<CcPoint> contact =
        path_fitter_.model().cc_point_under(x, y, last_.surface, {last_.u, last_.v}, radius);
    if (!contact || !path_fitter_.model().inside_trims(contact->surface, contact->u, contact->v) ||
        !path_fitter_.is_clear_at_contact(*contact)) {
        return std::nullopt;
    }
    last_ = {contact->surface, contact->u, contact->v};
    return Position{{x, y, contact->centre().z - path_fitter_.tool().radius},
                    last_,
                    1,
                    contact->point,
                    contact->normal};
}

}  // namespace cusp::finishing
