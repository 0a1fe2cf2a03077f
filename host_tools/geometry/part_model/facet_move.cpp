// Boxes clip the move; facets are left to a search by tangents.
#include "host_tools/geometry/part_model/facet_move.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cusp::part_model {

namespace {

constexpr int kMostTangents = 40;

// A part of the move, in mm from its start.
struct Stretch {
    double from;
    double to;
};

class MovedCore {
public:
    MovedCore(const PartModel::State& state,
              const ToolCore& core,
              Vec3d way,
              double sufficient,
              double resolution)
        : state_{state},
          core_{core},
          length_{norm(way)},
          along_{length_ > 0 ? way / length_ : Vec3d{}},
          resolution_{resolution},
          bound_{sufficient}
    {
    }

    double least()
    {
        struct Waiting {
            int node;
            Stretch part;
        };
        std::array<Waiting, 128> stack;
        std::size_t count = 0;
        const auto add = [&](int node, Stretch part) {
            if (clip(state_.tree.nodes[static_cast<std::size_t>(node)], part)) {
                stack[count++] = {node, part};
            }
        };
        if (!state_.tree.nodes.empty()) {
            add(0, {0, length_});
        }
        while (count > 0 && bound_ > 0) {
            const Waiting next = stack[--count];
            const BoxTree::Node& node = state_.tree.nodes[static_cast<std::size_t>(next.node)];
            if (node.child[0] >= 0) {
                add(node.child[0], next.part);
                add(node.child[1], next.part);
                continue;
            }
            const std::size_t first = static_cast<std::size_t>(-node.child[0] - 1);
            for (std::size_t k = 0; k < static_cast<std::size_t>(node.child[1]); ++k) {
                look_at(state_.facets[first + k], next.part);
            }
        }
        return std::max(0.0, bound_);
    }

private:
    struct Place {
        double at;        // mm from the start
        double distance;  // mm
        double slope;     // of the distance, along the move
    };

    ToolCore at(double along) const
    {
        ToolCore out = core_;
        out.end = core_.end + along_ * along;
        return out;
    }

    // Limits a part of the move to where the core may be nearer to the box than the bound; false: it is
    // nowhere.
    bool clip(const BoxTree::Node& box, Stretch& part) const
    {
        const double around = core_.greatest_radius() + bound_;
        for (unsigned axis = 0; axis < 2; ++axis) {
            const double low = box.low[axis] - around - core_.end[axis];
            const double high = box.high[axis] + around - core_.end[axis];
            const double rate = along_[axis];
            if (rate == 0) {
                if (low > 0 || high < 0) {
                    return false;
                }
                continue;
            }
            part.from = std::max(part.from, std::min(low / rate, high / rate));
            part.to = std::min(part.to, std::max(low / rate, high / rate));
        }
        if (part.from > part.to) {
            return false;
        }
        const double lowest = core_.end.z + std::min(along_.z * part.from, along_.z * part.to);
        if (lowest - box.high.z >= bound_) {
            return false;
        }
        const double half = 0.5 * (part.to - part.from);
        return at(part.from + half).distance_to_box(box.low, box.high) - half < bound_;
    }

    // Without a slope where the distance reaches the limit.
    Place place(const Facet& facet, double along, double limit = kInfinite) const
    {
        const ToolCore core = at(along);
        Vec3d nearest;
        const double distance = facet_distance(core, facet, nearest, limit);
        if (distance >= limit) {
            return {along, distance, 0};
        }
        const Vec3d reach = core.reach(nearest);
        const double length = norm(reach);
        return {along, distance, length > 0 ? -dot(reach, along_) / length : 0};
    }

    void look_at(const Facet& facet, const Stretch& part)
    {
        const double far = bound_ + part.to - part.from;
        Place a = place(facet, part.from, far);
        if (a.distance >= far) {
            return;
        }
        Place b = part.to > part.from ? place(facet, part.to) : a;
        for (int k = 0; k < kMostTangents; ++k) {
            const double seen = std::min(a.distance, b.distance);
            double low = seen;
            double between = a.at;
            if (a.slope < 0 && b.slope > 0) {
                between = std::clamp((b.distance - a.distance + a.slope * a.at - b.slope * b.at) /
                                         (a.slope - b.slope),
                                     a.at, b.at);
                low = a.distance + a.slope * (between - a.at);
            }
            if (low >= bound_) {
                return;
            }
            if (seen - low <= resolution_ || seen <= 0 || k + 1 == kMostTangents) {
                bound_ = low;
                return;
            }
            const Place middle = place(facet, between);
            (middle.slope < 0 ? a : b) = middle;
            if (middle.slope == 0) {
                a = b = middle;
            }
        }
    }

    const PartModel::State& state_;
    const ToolCore& core_;
    double length_;
    Vec3d along_;
    double resolution_;
    double bound_;
};

}  // namespace

double least_facet_distance(const PartModel::State& state,
                            const ToolCore& core,
                            Vec3d way,
                            double sufficient,
                            double resolution)
{
    return MovedCore{state, core, way, sufficient, resolution}.least();
}

}  // namespace cusp::part_model
