// A scaling, turn and shift of space: angles stay, all lengths change by one factor.
#pragma once

#include <array>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct Similarity {
    // Images of the unit vectors: as long as the factor, square to each other, right-handed.
    std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
    Vec3d shift{};  // mm, after the turn

    Vec3d turned(Vec3d p) const { return p.x * axes[0] + p.y * axes[1] + p.z * axes[2]; }
    Vec3d of(Vec3d p) const { return turned(p) + shift; }

    // This one first, then `next`.
    Similarity then(const Similarity& next) const
    {
        return {{next.turned(axes[0]), next.turned(axes[1]), next.turned(axes[2])}, next.of(shift)};
    }
    // Takes this one back. Accuracy: that of the axes' lengths, which are equal.
    Similarity inverse() const
    {
        const double square = dot(axes[0], axes[0]);
        Similarity back;
        back.axes = {Vec3d{axes[0].x, axes[1].x, axes[2].x} * (1 / square),
                     Vec3d{axes[0].y, axes[1].y, axes[2].y} * (1 / square),
                     Vec3d{axes[0].z, axes[1].z, axes[2].z} * (1 / square)};
        back.shift = -1.0 * back.turned(shift);
        return back;
    }
    bool is_identity() const
    {
        return axes[0] == Vec3d{1, 0, 0} && axes[1] == Vec3d{0, 1, 0} &&
               axes[2] == Vec3d{0, 0, 1} && shift == Vec3d{};
    }
};

}  // namespace cusp::import
