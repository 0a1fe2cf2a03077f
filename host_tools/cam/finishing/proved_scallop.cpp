// Tries increasing bounds; only cells for which one fails are checked with the next.
#include "host_tools/cam/finishing/proved_scallop.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/finishing/scallop_check.hpp"

namespace cusp::finishing {

using nurbs::Surface;

namespace {

constexpr std::size_t kMostMeasured = 4000;  // uncovered cells
constexpr double kProvedMore = 1.04;         // room above the ridges for the proof by cells
constexpr double kBetweenPlaces = 1.25;      // allowance for points between those measured
constexpr double kMoreExpected = 1.06;       // first growth of a bound that fails

std::vector<ScallopCheck::Part> whole_domains(const std::vector<Surface>& surfaces)
{
    std::vector<ScallopCheck::Part> parts;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const Surface& s = surfaces[k];
        parts.push_back({static_cast<int>(k), {s.u_begin(), s.v_begin()}, {s.u_end(), s.v_end()}});
    }
    return parts;
}

double first_bound(const ScallopGuess& guess)
{
    if (guess.scallop_height > 0 && std::isfinite(guess.scallop_height)) {
        return kProvedMore * guess.scallop_height;
    }
    const double half = 0.5 * std::min(guess.spacing, guess.radius);
    return guess.outward + guess.radius - std::sqrt(guess.radius * guess.radius - half * half);
}

}  // namespace

ProvedScallop proved_scallop(const std::vector<Surface>& surfaces,
                             const GougeFreePathFitter& path_fitter,
                             double path_off,
                             const std::vector<Points>& cut,
                             const ScallopGuess& guess)
{
    double bound = first_bound(guess);
    double blocked = 0;
    double beside_edges = 0;
    double more = kMoreExpected;
    std::vector<ScallopCheck::Part> parts = whole_domains(surfaces);
    while (bound < guess.radius) {
        ScallopCheck cells{surfaces, path_fitter, bound, path_off, kMostMeasured};
        for (const Points& pass : cut) {
            cells.add(pass);
        }
        for (const ScallopCheck::Part& part : parts) {
            cells.check(part.surface, part.low, part.high);
        }
        if (cells.overflowed()) {
            // More stock is left than expected, perhaps far more.
            bound *= more;
            more *= more;
            continue;
        }
        const ScallopCheck::Unproved unproved = cells.unproved();
        blocked = std::max(blocked, unproved.blocked_left);
        beside_edges = std::max(beside_edges, cells.left_beside_edges());
        double left = unproved.left;
        if (unproved.parts.empty()) {
            left = cells.left_beside_walls();
            if (left == 0) {
                return {std::min(guess.radius, std::max(bound, kBetweenPlaces * blocked)),
                        beside_edges, cells.over_nothing()};
            }
        }
        parts = unproved.parts;
        bound = kProvedMore * std::max(bound, left);
    }
    return {guess.radius, beside_edges, 0};
}

MeshLeft proved_mesh_scallop(const std::vector<Corners>& mesh,
                             const GougeFreePathFitter& path_fitter,
                             double path_off,
                             const std::vector<Points>& cut,
                             const ScallopGuess& guess)
{
    double bound = first_bound(guess);
    double more = kMoreExpected;
    while (bound < guess.radius) {
        const std::unique_ptr<MeshCheck> cells = mesh_check(mesh, path_fitter, bound, path_off);
        for (const Points& pass : cut) {
            cells->add(pass);
        }
        cells->check();
        MeshLeft left = cells->left();
        if (left.overflowed) {
            bound *= more;
            more *= more;
            continue;
        }
        cells->measure_left();
        left = cells->left();
        if (left.uncovered == 0) {
            left.most_left = bound;
            return left;
        }
        bound = kProvedMore * std::max(bound, left.most_left);
    }
    MeshLeft all;
    all.most_left = guess.radius;
    return all;
}

}  // namespace cusp::finishing
