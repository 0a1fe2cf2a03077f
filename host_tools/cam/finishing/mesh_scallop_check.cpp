// Triangles are halved across their longest side until one move covers each half, or none can.
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/scallop_at_point.hpp"
#include "host_tools/cam/finishing/walls_over_nothing.hpp"
#include "host_tools/geometry/part_model/facet_distance.hpp"

namespace cusp::finishing {

using part_model::Facet;
using part_model::PartModel;

namespace {

// Sizes of cells, in widths of what one move leaves low enough.
constexpr double kLargestTriangle = 3;
constexpr double kHiddenCell = 1;
constexpr double kTouchCell = 1;            // whether the tool may touch is asked from here on
constexpr double kUntouchedCell = 1.0 / 3;  // of ground that is kept as one that it can't touch
constexpr double kSmallestTriangle = 1.0 / 64;
constexpr int kTriangleHalvings = 60;
constexpr std::size_t kMostOpen = 300000;
constexpr std::size_t kFacetsAtOnce = 64;
constexpr double kSharedTriangle = 64;  // larger facets are divided before they are shared
constexpr double kUprightFacet = 1e-9;

struct LongSide {
    double length;
    std::size_t side;
};

LongSide longest_side(const std::array<Vec3d, 3>& corners)
{
    LongSide out{0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
        const double length = norm(corners[(k + 1) % 3] - corners[k]);
        if (k == 0 || length > out.length) {
            out = {length, k};
        }
    }
    return out;
}

std::array<std::array<Vec3d, 3>, 2> halves_of(const std::array<Vec3d, 3>& at, std::size_t side)
{
    const Vec3d half = (at[side] + at[(side + 1) % 3]) * 0.5;
    const Vec3d across = at[(side + 2) % 3];
    return {{{at[side], half, across}, {half, at[(side + 1) % 3], across}}};
}

}  // namespace

double MeshScallopCheck::Cell::area() const
{
    return 0.5 * norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
}

// The cells of one side of a facet.
class MeshScallopCheck::CellSearch {
public:
    CellSearch(const MeshGround& ground, Findings& found) : ground_{ground}, found_{found} {}

    void look_at(const Cell& cell)
    {
        side_ = ground_.side(cell.normal);
        last_ = 0;
        look_at(cell.corners, kTriangleHalvings);
    }

private:
    void look_at(const std::array<Vec3d, 3>& corners, int depth)
    {
        if (found_.open.size() >= kMostOpen) {
            found_.overflowed = true;
            return;
        }
        const LongSide longest = longest_side(corners);
        const double size = longest.length / side_.fine;
        const Cell cell{corners, side_.normal};
        if (ground_.path_fitter().area().is_beyond(cell.middle(), longest.length, side_.normal,
                                                   0) ||
            (size <= kLargestTriangle && ground_.is_covered(side_, corners, last_)) ||
            (size <= kHiddenCell && is_hidden(cell))) {
            return;
        }
        if (size > kTouchCell || (depth > 0 && !settles(cell, size))) {
            for (const std::array<Vec3d, 3>& half : halves_of(corners, longest.side)) {
                look_at(half, depth - 1);
            }
        }
    }

    // True if the cell needs no halves: it is kept, or its middle is covered.
    bool settles(const Cell& cell, double size)
    {
        const bool smallest = size <= kSmallestTriangle;
        switch (ground_.blocked(side_, cell.corners)) {
            case PartModel::Blocked::kFree:
                if (!ground_.is_covered(side_, cell.middle(), kPlaceShare)) {
                    keep_open(cell);
                    return true;
                }
                return smallest;
            case PartModel::Blocked::kByOneFacet:
                if (smallest || size <= kUntouchedCell) {
                    found_.blocked.push_back(cell);
                    return true;
                }
                return false;
            case PartModel::Blocked::kHere:
                if (smallest && !ground_.is_covered(side_, cell.middle(), kPlaceShare)) {
                    found_.blocked.push_back(cell);
                }
                return smallest;
        }
        return true;
    }

    void keep_open(const Cell& cell)
    {
        if (side_.upright) {
            const std::optional<Vec3d> tip = ground_.touching_tip(side_, cell.middle());
            if (!tip || !ground_.rests(*tip)) {
                return;
            }
        }
        found_.open.push_back(cell);
    }

    bool is_hidden(const Cell& cell) const
    {
        return ground_.is_hidden(cell.place()) &&
               std::all_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                   return ground_.is_hidden({corner, cell.normal});
               });
    }

    const MeshGround& ground_;
    Findings& found_;
    MeshGround::Side side_{};
    std::uint32_t last_{};
};

MeshScallopCheck::MeshScallopCheck(const std::vector<std::array<Vec3d, 3>>& triangles,
                                   const GougeFreePathFitter& path_fitter,
                                   double scallop,
                                   double path_off)
    : triangles_{triangles}, ground_{path_fitter, scallop, path_off}
{
}

// The sides of facets that a tool may touch from above, in parts that several threads may share.
std::vector<MeshScallopCheck::Cell> MeshScallopCheck::sides() const
{
    std::vector<Cell> out;
    std::vector<std::array<Vec3d, 3>> open;
    for (const std::array<Vec3d, 3>& corners : triangles_) {
        const Vec3d normal = Facet{corners}.normal;
        open.assign(1, corners);
        while (!open.empty()) {
            const std::array<Vec3d, 3> part = open.back();
            open.pop_back();
            const LongSide longest = longest_side(part);
            if (longest.length > kSharedTriangle * ground_.step()) {
                for (const std::array<Vec3d, 3>& half : halves_of(part, longest.side)) {
                    open.push_back(half);
                }
                continue;
            }
            out.push_back({part, normal});
            if (normal.z < kUprightFacet) {
                out.push_back({part, -normal});
            }
        }
    }
    return out;
}

MeshScallopCheck::Findings MeshScallopCheck::look_at(const std::vector<Cell>& cells) const
{
    const std::size_t shares = (cells.size() + kFacetsAtOnce - 1) / kFacetsAtOnce;
    std::vector<Findings> found(shares);
    const PartModel& model = ground_.path_fitter().model();
    parallel::for_each(shares, [&](std::size_t share) {
        model.forget_queries();
        CellSearch search{ground_, found[share]};
        const std::size_t end = std::min(cells.size(), (share + 1) * kFacetsAtOnce);
        for (std::size_t k = share * kFacetsAtOnce; k < end; ++k) {
            search.look_at(cells[k]);
        }
    });
    model.forget_queries();
    Findings out;
    for (Findings& some : found) {
        out.overflowed =
            out.overflowed || some.overflowed || out.open.size() + some.open.size() > kMostOpen;
        if (!out.overflowed) {
            out.open.insert(out.open.end(), some.open.begin(), some.open.end());
        }
        out.blocked.insert(out.blocked.end(), some.blocked.begin(), some.blocked.end());
        some = {};
    }
    return out;
}

void MeshScallopCheck::check()
{
    Findings found = look_at(sides());
    open_ = std::move(found.open);
    blocked_ = std::move(found.blocked);
    overflowed_ = found.overflowed;
    std::vector<WallFacet> walls;
    for (const std::array<Vec3d, 3>& corners : triangles_) {
        const Facet facet{corners};
        if (ground_.side(facet.normal).upright) {
            walls.push_back({{corners.begin(), corners.end()}, facet.normal});
        }
    }
    over_nothing_ = walls_over_nothing(walls, ground_.path_fitter());
}

double MeshScallopCheck::blocked_area() const
{
    double sum = 0;
    for (const Cell& cell : blocked_) {
        sum += cell.area();
    }
    return sum;
}

void MeshScallopCheck::measure_left()
{
    std::vector<double> left(open_.size());
    parallel::for_each(open_.size(), [&](std::size_t k) {
        left[k] = ground_.missing_tip(open_[k].place()) ? ground_.left(open_[k].middle()) : -1;
    });
    std::vector<Cell> kept;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k] >= 0) {
            kept.push_back(open_[k]);
            most_left_ = std::max(most_left_, left[k]);
        }
    }
    open_ = std::move(kept);
}

}  // namespace cusp::finishing
