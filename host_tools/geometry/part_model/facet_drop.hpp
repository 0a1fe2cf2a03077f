// The drop of a tool on one triangle: on its plane, its sides and its corners.
#pragma once

#include <optional>

#include "host_tools/geometry/part_model/facet_distance.hpp"

namespace cusp::part_model {

// The lower side of a tool: an arc round a disc, a cone that touches it, a cylinder.
class ToolProfile {
public:
    explicit ToolProfile(const toolpath::Tool& tool);

    // Its end at 0.
    const ToolCore& core() const { return core_; }
    double corner() const { return corner_; }
    double radius() const { return core_.greatest_radius() + corner_; }

    // mm: of the lower side over the core's end, at a distance from the axis; kInfinite beyond the
    // radius.
    double height(double away) const;

    // The tool with its core's end at a height over (x, y).
    ToolCore core_at(double x, double y, double end) const
    {
        ToolCore out = core_;
        out.end = {x, y, end};
        return out;
    }

    // Cosine and sine of the angle between the lower side and the level.
    struct Slope {
        double along;
        double up;
    };
    Slope slope(double away) const;

private:
    ToolCore core_;
    double corner_;
    double lean_cosine_{1};  // of half the angle between the flanks
    double lean_sine_{0};
    double joined_;  // mm from the axis, where the arc goes over into the flank
    double top_;     // mm from the axis, where the flank ends
};

struct FacetContact {
    double centre;  // mm: height of the core's end; of a ball its centre
    Vec3d point;
};

// A tool dropped at (x, y) on one facet; none where it misses the facet, or where its core would end
// below `least`. Exact for a ball; for other ends too low by at most a nanometre, where sides are
// touched.
std::optional<FacetContact> drop_on_facet(
    const Facet& facet, const ToolProfile& tool, double x, double y, double least);

}  // namespace cusp::part_model
