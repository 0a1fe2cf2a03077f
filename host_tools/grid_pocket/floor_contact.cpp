// A ball's next height is first looked for on the line through the last two.
#include "host_tools/grid_pocket/floor_contact.hpp"

#include <utility>

#include "host_tools/offset/contour.hpp"

namespace cusp::host {

FloorContact::FloorContact(const std::vector<Surface>& surfaces,
                           std::shared_ptr<const SurfaceModel> model,
                           const Tool& tool,
                           double accuracy)
    : model_{std::move(model)}, tool_{tool}, accuracy_{accuracy}
{
    // Distances tell nothing of how deep a flat end cuts, and its disc makes them slow to find.
    if (tool.corner_radius < tool.radius) {
        flat_ = std::make_shared<const FlatContact>(surfaces, tool, accuracy);
    }
}

std::optional<double> FloorContact::height(Vec2d at) const
{
    if (flat_) {
        return flat_->height(at);
    }
    const std::optional<double> z = model_->drop(tool_, at.x, at.y, guess(at));
    if (!z) {
        last_.reset();
    }
    before_ = last_;
    if (z) {
        last_ = Known{at, *z};
    }
    return z;
}

std::optional<double> FloorContact::guess(Vec2d at) const
{
    if (!last_ || distance(at, last_->at) > tool_.radius) {
        return std::nullopt;
    }
    double z = last_->height;
    if (before_) {
        const Vec2d way = last_->at - before_->at;
        const double square = dot(way, way);
        if (square > 1e-18 && square < tool_.radius * tool_.radius) {
            z += (last_->height - before_->height) * dot(at - last_->at, way) / square;
        }
    }
    return z;
}

double FloorContact::clearance(Vec3d a, Vec3d b, double enough) const
{
    return flat_ ? flat_->room(a, b) : model_->clearance_along(tool_, a, b, enough, 1e-6);
}

}  // namespace cusp::host
