// Finds where the next steered pass starts: on an earlier path, with stock on the right.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/steered_pass.hpp"

namespace cusp::adaptive_clearing {

// Places the tool has been at, found by where stock is still beside them. Stock only goes: a
// place without it is dropped for good.
class PassStarts {
public:
    // target  what is to be swept; stock outside it does not count
    PassStarts(const offset::Box2d& box, const offset::Region2d& target, double radius);

    void add(Vec2d place);
    void add(const std::vector<offset::Edge>& path);

    // The pose nearest to `from` that has stock on its right and room to turn; if there is stock
    // behind it too, the one at the upstream end of that stock. None: nothing is left that a pass
    // in this space could start on.
    std::optional<Pose> next(Vec2d from, const SteeringSpace& space);

    // No pass starts at this place any more.
    void drop(Vec2d place);

private:
    struct Place {
        Vec2d at;
        bool dropped{};
    };
    std::optional<Pose> pose_at(Vec2d place, const SteeringSpace& space) const;
    bool is_stock(Vec2d point, const SweptArea& swept) const;
    Pose upstream(Pose pose, const SteeringSpace& space);
    std::vector<Place*> places_near(Vec2d point, double reach);
    std::size_t bucket(Vec2d point) const;

    double radius_;
    Vec2d corner_;
    double pitch_;  // of the target's cells
    int columns_;
    int rows_;
    std::vector<bool> target_;
    double size_;  // mm: of buckets
    int across_;
    int up_;
    std::vector<std::vector<Place>> buckets_;
};

}  // namespace cusp::adaptive_clearing
