// Patches are sampled as densely as their widest derivative asks for.
#include "host_tools/surface_passes/top_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace cusp::host {
namespace {

constexpr double kMostSquares = 4e6;
constexpr std::size_t kMostSamples = 1000;  // of a patch, each way
constexpr double kOpen = -std::numeric_limits<double>::infinity();

// Bound of the lengths of a patch along u and v, by its control points.
double longest_row(const Surface& s, bool along_u)
{
    double most = 0;
    const int rows = along_u ? s.size_v : s.size_u;
    const int count = along_u ? s.size_u : s.size_v;
    for (int row = 0; row < rows; ++row) {
        double sum = 0;
        for (int k = 1; k < count; ++k) {
            const auto point = [&](int at) {
                const int index = along_u ? at * s.size_v + row : row * s.size_v + at;
                return s.points[static_cast<std::size_t>(index)];
            };
            sum += norm(point(k) - point(k - 1));
        }
        most = std::max(most, sum);
    }
    return most;
}

}  // namespace

TopMap::TopMap(const std::vector<Surface>& surfaces, const SurfaceModel& model, double pitch)
    : x0_{model.box_low().x}, y0_{model.box_low().y}
{
    const Vec3d size = model.box_high() - model.box_low();
    pitch_ = std::max(pitch, std::sqrt(size.x * size.y / kMostSquares));
    nx_ = static_cast<std::size_t>(size.x / pitch_) + 1;
    ny_ = static_cast<std::size_t>(size.y / pitch_) + 1;
    top_.assign(nx_ * ny_, kOpen);
    for (std::size_t number = 0; number < surfaces.size(); ++number) {
        for (const BezierPatch& patch : bezier_patches(surfaces[number])) {
            const auto count = [&](bool along_u) {
                const double parts = 2.0 * longest_row(patch.surface, along_u) / pitch_;
                return std::min(kMostSamples, static_cast<std::size_t>(parts) + 2);
            };
            const std::size_t nu = count(true);
            const std::size_t nv = count(false);
            for (std::size_t i = 0; i <= nu; ++i) {
                for (std::size_t j = 0; j <= nv; ++j) {
                    const double s = static_cast<double>(i) / static_cast<double>(nu);
                    const double t = static_cast<double>(j) / static_cast<double>(nv);
                    const double u = patch.u_begin * (1 - s) + patch.u_end * s;
                    const double v = patch.v_begin * (1 - t) + patch.v_end * t;
                    const int surface = static_cast<int>(number);
                    if (!model.inside_trims(surface, u, v)) {
                        continue;
                    }
                    const Vec3d p = model.evaluate(surface, u, v).point;
                    const std::size_t x = std::min(
                        nx_ - 1, static_cast<std::size_t>(std::max(0.0, (p.x - x0_) / pitch_)));
                    const std::size_t y = std::min(
                        ny_ - 1, static_cast<std::size_t>(std::max(0.0, (p.y - y0_) / pitch_)));
                    top_[x * ny_ + y] = std::max(top_[x * ny_ + y], p.z);
                }
            }
        }
    }
}

double TopMap::least_around(double x, double y) const
{
    double least = std::numeric_limits<double>::infinity();
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) {
            const double at_x = std::floor((x - x0_) / pitch_) + i;
            const double at_y = std::floor((y - y0_) / pitch_) + j;
            if (at_x < 0 || at_y < 0 || at_x >= static_cast<double>(nx_) ||
                at_y >= static_cast<double>(ny_)) {
                return kOpen;
            }
            least = std::min(
                least, top_[static_cast<std::size_t>(at_x) * ny_ + static_cast<std::size_t>(at_y)]);
        }
    }
    return least;
}

double TopMap::drop(double x, double y, double radius) const
{
    const auto range = [&](double at, double first, std::size_t count) {
        const double low = std::floor((at - radius - first) / pitch_);
        const double high = std::floor((at + radius - first) / pitch_) + 1;
        const double most = static_cast<double>(count);
        return std::array<std::size_t, 2>{static_cast<std::size_t>(std::clamp(low, 0.0, most)),
                                          static_cast<std::size_t>(std::clamp(high, 0.0, most))};
    };
    const auto [i_begin, i_end] = range(x, x0_, nx_);
    const auto [j_begin, j_end] = range(y, y0_, ny_);
    double best = kOpen;
    for (std::size_t i = i_begin; i < i_end; ++i) {
        const double dx = x0_ + (static_cast<double>(i) + 0.5) * pitch_ - x;
        for (std::size_t j = j_begin; j < j_end; ++j) {
            const double dy = y0_ + (static_cast<double>(j) + 0.5) * pitch_ - y;
            const double square = radius * radius - dx * dx - dy * dy;
            if (square > 0) {
                best = std::max(best, top_[i * ny_ + j] - radius + std::sqrt(square));
            }
        }
    }
    return best;
}

}  // namespace cusp::host
