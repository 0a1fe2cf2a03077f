// A turn of the spiral is the lower of two loops, raised by what is left of the way.
#include "host_tools/cam/steep_shallow/level_spiral.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::steep_shallow {

namespace {

bool is_whole(const LevelLoop& loop)
{
    return std::all_of(loop.places.begin(), loop.places.end(),
                       [](const LevelPlace& place) { return place.in_area; });
}

void add_whole(const LevelLoop& loop, LevelRun& out)
{
    for (const LevelPlace& place : loop.places) {
        out.push_back(place.tip);
    }
    out.push_back(loop.places.front().tip);
}

// Shares of the way round, of each place.
std::vector<double> shares_of(const LevelLoop& loop)
{
    std::vector<double> out{0};
    for (std::size_t k = 1; k <= loop.places.size(); ++k) {
        out.push_back(out.back() +
                      norm(loop.places[k % loop.places.size()].tip - loop.places[k - 1].tip));
    }
    for (double& share : out) {
        share /= out.back();
    }
    return out;
}

Vec3d point_at(const LevelLoop& loop, const std::vector<double>& shares, double share)
{
    const auto after = std::upper_bound(shares.begin() + 1, shares.end() - 1, share);
    const auto k = static_cast<std::size_t>(after - shares.begin());
    const Vec3d a = loop.places[k - 1].tip;
    const Vec3d b = loop.places[k % loop.places.size()].tip;
    const double width = shares[k] - shares[k - 1];
    return width > 0 ? a + (b - a) * ((share - shares[k - 1]) / width) : a;
}

// The way from one loop down to another, without its first tip; none where they are too far apart.
std::optional<LevelRun> way_down(const LevelLoop& from,
                                 const LevelLoop& to,
                                 const LevelCurves& curves,
                                 double near)
{
    const std::vector<double> shares = shares_of(from);
    const std::vector<double> shares_below = shares_of(to);
    LevelRun out;
    for (std::size_t k = 1; k <= to.places.size(); ++k) {
        const double share = shares_below[k];
        const Vec3d above = point_at(from, shares, share);
        const Vec3d below = to.places[k % to.places.size()].tip;
        if (elementary::hypot(above.x - below.x, above.y - below.y) > near) {
            return std::nullopt;
        }
        out.push_back(above + (below - above) * share);
    }
    for (Vec3d& tip : out) {
        tip = curves.touching(in_plan(tip), tip.z);
    }
    return out;
}

}  // namespace

std::vector<LevelRun> runs_of(const std::vector<LevelLoop>& loops)
{
    std::vector<LevelRun> out;
    for (const LevelLoop& loop : loops) {
        if (is_whole(loop)) {
            add_whole(loop, out.emplace_back());
            continue;
        }
        // Such a loop begins outside the area.
        LevelRun run;
        for (std::size_t k = 0; k <= loop.places.size(); ++k) {
            const LevelPlace& place = loop.places[k % loop.places.size()];
            if (place.in_area) {
                run.push_back(place.tip);
                continue;
            }
            if (run.size() > 1) {
                out.push_back(run);
            }
            run.clear();
        }
    }
    return out;
}

std::vector<LevelRun> spirals(const std::vector<LevelLoop>& loops,
                              const LevelCurves& curves,
                              double near)
{
    std::vector<LevelRun> out;
    std::vector<LevelLoop> parts;
    std::vector<char> done(loops.size(), 0);
    for (std::size_t first = 0; first < loops.size(); ++first) {
        if (done[first] != 0) {
            continue;
        }
        if (!is_whole(loops[first])) {
            parts.push_back(loops[first]);
            continue;
        }
        LevelRun run;
        add_whole(loops[first], run);
        std::size_t last = first;
        for (std::size_t k = first + 1; k < loops.size(); ++k) {
            if (done[k] != 0 || !is_whole(loops[k]) || !(loops[k].z() < loops[last].z())) {
                continue;
            }
            if (const auto way = way_down(loops[last], loops[k], curves, near)) {
                run.insert(run.end(), way->begin(), way->end());
                done[k] = 1;
                last = k;
            }
        }
        if (last != first) {
            add_whole(loops[last], run);
        }
        out.push_back(std::move(run));
    }
    for (LevelRun& run : runs_of(parts)) {
        out.push_back(std::move(run));
    }
    return out;
}

}  // namespace cusp::steep_shallow
