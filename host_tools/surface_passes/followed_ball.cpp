// Newton's method from the last foot; after a drop from the place that it ended on.
#include "host_tools/surface_passes/followed_ball.hpp"

namespace cusp::host {

std::optional<FollowedBall::Stand> FollowedBall::at(double x, double y)
{
    const SurfaceModel& model = certified_.model();
    const Tool& tool = certified_.lifted_tool();
    const auto leaning = [&](Vec3d centre, Vec3d point, Vec3d normal) {
        const Vec3d tip = centre - Vec3d{0, 0, certified_.tool().radius};
        return Stand{{x, y, tip.z}, {}, dot(centre - point, normal) / tool.radius};
    };
    if (model.is_mesh()) {
        const auto on_mesh = model.rest_on_mesh(x, y, tool.radius);
        return on_mesh ? std::optional{leaning(on_mesh->centre, on_mesh->point, on_mesh->normal)}
                       : std::nullopt;
    }
    if (const std::optional<Stand> found = beside(x, y)) {
        return found;
    }
    const auto rest = model.rest(tool, x, y);
    if (!rest) {
        return std::nullopt;
    }
    last_ = {rest->place.surface, rest->place.u, rest->place.v};
    if (const std::optional<Stand> found = beside(x, y)) {
        return found;
    }
    const Contact under = model.contact(last_.surface, last_.u, last_.v, tool.radius);
    return leaning({x, y, rest->tip + tool.radius}, under.point, under.normal);
}

std::optional<FollowedBall::Stand> FollowedBall::beside(double x, double y)
{
    if (last_.surface < 0) {
        return std::nullopt;
    }
    const double radius = certified_.lifted_tool().radius;
    const std::optional<Contact> contact =
        certified_.model().contact_under(x, y, last_.surface, {last_.u, last_.v}, radius);
    if (!contact || !certified_.model().inside_trims(contact->surface, contact->u, contact->v) ||
        !certified_.touches_freely(*contact)) {
        return std::nullopt;
    }
    last_ = {contact->surface, contact->u, contact->v};
    return Stand{{x, y, contact->centre().z - certified_.tool().radius}, last_};
}

}  // namespace cusp::host
