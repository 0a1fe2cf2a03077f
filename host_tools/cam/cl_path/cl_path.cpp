// Drops the tool at stations along the path, fits the longest moves within the band, and raises
// moves that would gouge.
#include "host_tools/cam/cl_path/cl_path.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/cl_path/cl_path_proof.hpp"
#include "host_tools/cam/cl_path/equal_pieces.hpp"
#include "host_tools/cam/cl_path/nurbs_fit.hpp"
#include "host_tools/cam/cl_path/station_row.hpp"
#include "host_tools/cam/cl_path/tolerance_chain.hpp"

namespace cusp::cl_path {

using offset::arc_edge;
using offset::distance;
using offset::Edge;
using offset::line_edge;

namespace {

// A chain from corner to corner: a curve where one fits, else lines.
Chain curves_through(const std::vector<Station>& stations,
                     const std::vector<std::size_t>& corners,
                     const StationBand& band)
{
    Chain chain;
    const auto tip = [&](const Station& s) {
        return Vec3d{s.at.x, s.at.y, s.height + band.middle()};
    };
    chain.start = tip(stations.front());
    for (std::size_t c = 1; c < corners.size(); ++c) {
        std::vector<Station> run(stations.begin() + static_cast<std::ptrdiff_t>(corners[c - 1]),
                                 stations.begin() + static_cast<std::ptrdiff_t>(corners[c] + 1));
        if (auto curve = fit_cubic(run, band)) {
            for (Vec3d& p : curve->points) {
                p = written(p);
            }
            chain.moves.push_back({tip(run.back()), {}, 0, std::move(*curve)});
            continue;
        }
        run.back().exact = true;  // the next run starts there
        const Chain lines = chain_through(run, band, false, false);
        chain.moves.insert(chain.moves.end(), lines.moves.begin(), lines.moves.end());
    }
    return chain;
}

// Between stations the floor may bend a little more than at them, and an arc by an eighth.
constexpr double kUsed = 0.95;
constexpr double kUsedInPlan = 0.86;

}  // namespace

double repeated_plan_tolerance(double plan_tolerance)
{
    return std::min(1e-3, 0.2 * plan_tolerance);
}

std::vector<Edge> flattened(const std::vector<Edge>& plan,
                            double plan_tolerance,
                            double spacing,
                            bool arcs)
{
    const double tolerance = plan_tolerance - 3.0 * repeated_plan_tolerance(plan_tolerance);
    const StationRow row = stations_along(plan, nullptr, {spacing, tolerance, 1.0, false});
    const bool closed = distance(row.stations.front().at, row.stations.back().at) < 1e-9;
    const Chain chain =
        chain_through(row.stations, {kUsedInPlan * tolerance, -1.0, 1.0}, arcs, closed);
    std::vector<Edge> edges;
    Vec2d from{chain.start.x, chain.start.y};
    for (const ClMove& move : chain.moves) {
        const Vec2d to{move.end.x, move.end.y};
        edges.push_back(move.turn == 0 ? line_edge(from, to)
                                       : arc_edge(from, to, move.centre, move.turn));
        from = to;
    }
    return edges;
}

namespace {

// Heights above the allowance and `min_z`.
void raise_to_limits(std::vector<Station>& stations, const ClPathSettings& settings)
{
    for (Station& s : stations) {
        s.height += settings.allowance;
        if (s.height < settings.min_z) {
            s.height = settings.min_z;
            s.gradient = {};
        }
    }
    if (settings.level_at_min_z) {
        const auto at_limit = [&](std::size_t i) {
            return stations[std::min(i, stations.size() - 1)].height == settings.min_z;
        };
        for (std::size_t i = 0; i < stations.size(); ++i) {
            stations[i].level = at_limit(i > 0 ? i - 1 : i) && at_limit(i) && at_limit(i + 1);
        }
    }
}

// Returns how far (mm) a move was raised to clear the floor between its stations.
double path_over_stations(const std::vector<Edge>& plan,
                          const PathFloor& floor,
                          const ClPathSettings& settings,
                          bool sparse,
                          ClPath& path)
{
    StationRow row = stations_along(plan, &floor,
                                    {settings.spacing, settings.plan_tolerance,
                                     settings.height_tolerance, sparse, settings.lookup_spacing});
    if (row.missing) {
        path.over_floor = false;
        path.missing = *row.missing;
        return 0.0;
    }
    raise_to_limits(row.stations, settings);
    std::vector<Station>& stations = row.stations;
    const bool closed = distance(stations.front().at, stations.back().at) < 1e-9;
    const double tolerance = kUsed * settings.height_tolerance;
    const StationBand band{kUsedInPlan * settings.plan_tolerance,
                           settings.one_sided ? settings.clearance_reserve : -tolerance, tolerance};
    if (settings.start_z) {
        stations.front().height = *settings.start_z - band.middle();
        stations.front().level = false;
    }
    const Chain chain = settings.even
                            ? equal_pieces_chain(plan, floor,
                                                 {band, settings.allowance, settings.min_z,
                                                  settings.spacing, settings.arcs})
                        : settings.nurbs ? curves_through(stations, row.corners, band)
                                         : chain_through(stations, band, settings.arcs, closed);
    path.start = written(chain.start);
    path.moves = chain.moves;
    for (ClMove& move : path.moves) {
        move.end = written(move.end);
    }
    if (closed && !path.moves.empty()) {
        path.moves.back().end = path.start;
    }
    if (settings.nurbs) {
        return certify_curves(path, floor, settings, closed);
    }
    return certify(path, floor, settings, closed);
}

}  // namespace

ClPath drop_path(const std::vector<Edge>& plan,
                 const PathFloor& floor,
                 const ClPathSettings& settings)
{
    // If lookups are too far apart to show a ridge, whole moves would be raised over it.
    constexpr double kRaised = 0.25;
    ClPath path;
    if (path_over_stations(plan, floor, settings, true, path) >
        kRaised * settings.height_tolerance) {
        path = {};
        const double raised = path_over_stations(plan, floor, settings, false, path);
        if (settings.nurbs && raised > settings.height_tolerance) {
            ClPathSettings lines = settings;
            lines.nurbs = false;
            return drop_path(plan, floor, lines);
        }
    }
    return path;
}

}  // namespace cusp::cl_path
