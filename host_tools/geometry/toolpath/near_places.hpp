// The nearest of many places in plan that are not taken yet: a k-d tree.
//
//     NearPlaces near{places};
//     near.nearest({10, 20}, 8);  // indices of eight places, the nearest first
//     near.take(3);               // place 3 is found no more
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::toolpath {

class NearPlaces {
public:
    explicit NearPlaces(const std::vector<Vec2d>& places);

    // The `count` places nearest to `p`, or all if there are fewer, as indices; equally near ones by index.
    std::vector<std::size_t> nearest(Vec2d p, std::size_t count) const;

    // Precondition: it is not taken yet.
    void take(std::size_t place);

private:
    // Places of the tree from one to before another; the middle one divides them.
    struct Range {
        std::size_t from;
        std::size_t to;
        bool by_x;
        std::size_t middle() const { return (from + to) / 2; }
        Range half(bool low) const
        {
            return {low ? from : middle() + 1, low ? middle() : to, !by_x};
        }
    };
    using Found = std::vector<std::pair<double, std::size_t>>;  // mm, index: sorted

    void divide(Range range);
    void search(Range range, Vec2d p, std::size_t count, Found& found) const;

    std::vector<Vec2d> places_;
    std::vector<std::size_t> order_;
    std::vector<std::size_t> position_;  // in order_, of each place
    std::vector<std::size_t> left_;      // not taken, in the range with this middle
    std::vector<bool> taken_;
};

}  // namespace cusp::toolpath
