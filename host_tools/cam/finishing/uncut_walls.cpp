// All walls are looked at at once; passes are cut one after the other.
#include "host_tools/cam/finishing/uncut_walls.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/finishing/finish_area.hpp"

namespace cusp::finishing {

using part_model::PartModel;

namespace {

constexpr int kWallRounds = 5;
constexpr std::size_t kWallShares = 64;  // of a search on several threads
constexpr double kJoined = 0.25;         // in stepovers: ends of passes along neighbouring facets
constexpr double kAreaStep = 0.125;  // the same: places along a wall, whether they are in the area

double bottom_of(const WallFacet& facet)
{
    double low = facet.corners.front().z;
    for (const Vec3d& corner : facet.corners) {
        low = std::min(low, corner.z);
    }
    return low;
}

// The part of a polygon over a height, or with sign -1 under it.
std::vector<Vec3d> part_over(const std::vector<Vec3d>& corners, double height, double sign)
{
    std::vector<Vec3d> out;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3d a = corners[k];
        const Vec3d b = corners[(k + 1) % corners.size()];
        const double over_a = sign * (a.z - height);
        const double over_b = sign * (b.z - height);
        if (over_a >= 0) {
            out.push_back(a);
        }
        if (over_a * over_b < 0) {
            out.push_back(a + (b - a) * (over_a / (over_a - over_b)));
        }
    }
    return out;
}

}  // namespace

std::vector<WallFacet> facets_in(const FinishArea& area, const std::vector<WallFacet>& facets)
{
    if (area.is_everything()) {
        return facets;
    }
    const job::GroundRange& range = area.range();
    std::vector<WallFacet> out;
    for (WallFacet facet : facets) {
        if (facet.normal.z < range.least_normal_z() || facet.normal.z > range.most_normal_z()) {
            continue;
        }
        if (range.low > -kInfinite) {
            facet.corners = part_over(facet.corners, range.low, 1);
        }
        if (range.high < kInfinite) {
            facet.corners = part_over(facet.corners, range.high, -1);
        }
        if (facet.corners.size() >= 3) {
            out.push_back(std::move(facet));
        }
    }
    return out;
}

// Cuts the passes of one round in order. Those along neighbouring facets, as of a curved face, become
// one pass.
class UncutWalls::Cutter {
public:
    // radius  mm, of the tool
    Cutter(double radius, double join, const std::function<void(const Points&)>& cut)
        : radius_{radius}, join_{join}, cut_{cut}
    {
    }

    // True if passes cut so far may have changed what is left beside the wall. All that is looked at
    // beside it lies within two radii.
    bool has_cut_near(const WallSide& side) const
    {
        const Box at = box_of(side.corners(), 2 * radius_);
        const auto overlaps = [&](const Box& box) {
            return box.low.x <= at.high.x && box.high.x >= at.low.x && box.low.y <= at.high.y &&
                   box.high.y >= at.low.y;
        };
        for (long band = band_at(at.low.x); band <= band_at(at.high.x); ++band) {
            const auto found = done_.find(band);
            if (found != done_.end() &&
                std::any_of(found->second.begin(), found->second.end(), overlaps)) {
                return true;
            }
        }
        return false;
    }

    void add(Points tips)
    {
        if (!open_.empty() && norm(tips.front() - open_.back()) > join_ &&
            norm(tips.back() - open_.back()) <= join_) {
            std::reverse(tips.begin(), tips.end());
        }
        if (!open_.empty() && norm(tips.front() - open_.back()) > join_) {
            finish();
        }
        // If two facets meet both have the tip between them.
        const bool again = !open_.empty() && norm(tips.front() - open_.back()) < kSameTip;
        open_.insert(open_.end(), tips.begin() + (again ? 1 : 0), tips.end());
    }

    // Cuts what is still open.
    void finish()
    {
        if (!open_.empty()) {
            const Box box = box_of(open_, 2 * radius_);
            for (long band = band_at(box.low.x); band <= band_at(box.high.x); ++band) {
                done_[band].push_back(box);
            }
            cut_(open_);
            open_.clear();
        }
    }

private:
    static constexpr double kSameTip = 1e-3;  // mm
    static constexpr double kBand = 8;        // radii

    long band_at(double x) const { return std::lround(std::floor(x / (kBand * radius_))); }

    static Box box_of(const std::vector<Vec3d>& points, double around)
    {
        Box out{{kInfinite, kInfinite}, {-kInfinite, -kInfinite}};
        for (const Vec3d& p : points) {
            out.low = {std::min(out.low.x, p.x - around), std::min(out.low.y, p.y - around)};
            out.high = {std::max(out.high.x, p.x + around), std::max(out.high.y, p.y + around)};
        }
        return out;
    }

    double radius_;
    double join_;
    const std::function<void(const Points&)>& cut_;
    Points open_;
    std::unordered_map<long, std::vector<Box>> done_;  // by bands of x
};

UncutWalls::UncutWalls(const GougeFreePathFitter& path_fitter, ScallopAtPoint& places)
    : path_fitter_{path_fitter}, places_{places}
{
}

void UncutWalls::share_out(std::size_t count,
                           const std::function<void(Search&, std::size_t)>& work) const
{
    const std::size_t shares = std::min(count, kWallShares);
    {
        const PartModel::SharedQueries shared{path_fitter_.model()};
        parallel::for_each(shares, [&](std::size_t share) {
            Search copy{places_, {}};
            const PartModel::SharedQueries::Part queries{path_fitter_.model()};
            for (std::size_t k = count * share / shares; k < count * (share + 1) / shares; ++k) {
                work(copy, k);
                queries.next();  // others may wait to release cells
            }
        });
    }
    path_fitter_.model().forget_queries();
}

// The places with stock left, on the part of the wall that is in the area.
std::vector<WallSide::Run> UncutWalls::missing_in_area(const WallSide& side,
                                                       const ScallopAtPoint& places,
                                                       WallSide::KnownReach& known) const
{
    const FinishArea& area = path_fitter_.area();
    std::vector<WallSide::Run> all = side.missing_runs(places, known);
    if (area.is_everything()) {
        return all;
    }
    Vec3d normal = side.out();
    normal.z = std::max(0.0, normal.z);
    std::vector<WallSide::Run> out;
    for (const WallSide::Run& run : all) {
        const int parts = std::max(
            1, static_cast<int>(std::ceil((run.to - run.from) / (kAreaStep * places.step()))));
        for (int k = 0; k < parts; ++k) {
            const double from = run.from + (run.to - run.from) * k / parts;
            const double to = run.from + (run.to - run.from) * (k + 1) / parts;
            if (!area.holds(side.place_at(0.5 * (from + to)), normal)) {
                continue;
            }
            if (!out.empty() && out.back().to == from && out.back().level == run.level) {
                out.back().to = to;
            } else {
                out.push_back({from, to, run.level});
            }
        }
    }
    return out;
}

void UncutWalls::find(const std::vector<WallFacet>& all)
{
    const std::vector<WallFacet> facets = facets_in(path_fitter_.area(), all);
    std::vector<std::size_t> order;
    std::vector<double> bottoms;
    for (std::size_t k = 0; k < facets.size(); ++k) {
        order.push_back(k);
        bottoms.push_back(bottom_of(facets[k]));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return bottoms[a] < bottoms[b]; });
    std::vector<std::vector<Wall>> found(order.size());
    share_out(order.size(), [&](Search& search, std::size_t k) {
        for (const WallSide& side : wall_sides_of(facets[order[k]], path_fitter_)) {
            std::vector<WallSide::Run> runs = missing_in_area(side, search.places, search.known);
            if (!runs.empty()) {
                found[k].push_back({side, std::move(runs)});
            }
        }
    });
    walls_.clear();
    for (const std::vector<Wall>& sides : found) {
        for (const Wall& side : sides) {
            walls_.push_back(side);
        }
    }
    moves_seen_ = places_.swept().moves();
}

void UncutWalls::look_again()
{
    if (moves_seen_ == places_.swept().moves()) {
        return;
    }
    moves_seen_ = places_.swept().moves();
    share_out(walls_.size(), [&](Search& search, std::size_t k) {
        walls_[k].runs = missing_in_area(walls_[k].side, search.places, search.known);
    });
    std::vector<Wall> kept;
    for (Wall& wall : walls_) {
        if (!wall.runs.empty()) {
            kept.push_back(wall);
        }
    }
    walls_ = std::move(kept);
}

void UncutWalls::add_missing(const std::function<void(const Points&)>& cut)
{
    for (int round = 0; round < kWallRounds && !walls_.empty(); ++round) {
        if (round == 0) {
            look_again();
        }
        Cutter cutter{path_fitter_.offset_tool().radius, kJoined * places_.step(), cut};
        for (Wall& wall : walls_) {
            path_fitter_.model().forget_many_cells();
            if (cutter.has_cut_near(wall.side)) {
                WallSide::KnownReach known;
                wall.runs = missing_in_area(wall.side, places_, known);
            }
            for (const WallSide::Run& run : wall.runs) {
                cutter.add(wall.side.pass_along(run));
            }
        }
        cutter.finish();
        look_again();
    }
}

double UncutWalls::measure_left()
{
    look_again();
    std::vector<double> left(walls_.size());
    share_out(walls_.size(), [&](Search& search, std::size_t k) {
        for (const WallSide::Run& run : walls_[k].runs) {
            left[k] = std::max(left[k], walls_[k].side.left_in(run, search.places));
        }
    });
    double most = 0;
    for (const double some : left) {
        most = std::max(most, some);
    }
    return most;
}

}  // namespace cusp::finishing
