// Nodes far from the contour are decided in blocks: a distance changes no faster than the position.
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::waterline_slices {

using offset::Box2d;
using offset::Contour;
using offset::line_edge;
using offset::Region2d;
using part_model::PartModel;
using toolpath::Tool;

namespace {

constexpr double kMostSliceNodes = 4e6;
constexpr std::size_t kBlock = 16;  // nodes, each way: a power of two
constexpr std::size_t kGroup = 16;  // blocks that one core fills
// Share of a side: contours cross sides no nearer to their ends, so no edge is too short.
constexpr double kNearestEnd = 0.01;
// Amount by which distances may be too low: at a block's middle, in reaches of the block, and at a
// node, in `excess`.
constexpr double kBlockSlack = 0.05;
constexpr double kNodeSlack = 0.05;

double square(double x) { return x * x; }

// The pitch for which the contours keep at most `excess` more than `least`.
double pitch_for(double least, double excess)
{
    return std::sqrt(2.0 * (square(least + excess) - square(least)));
}

bool collinear(Vec2d a, Vec2d b, Vec2d c)
{
    return std::abs(cross(b - a, c - b)) < 1e-10 && dot(b - a, c - b) > 0;
}

Contour contour_of(const std::vector<Vec2d>& loop)
{
    std::vector<Vec2d> corners;
    const std::size_t n = loop.size();
    for (std::size_t k = 0; k < n; ++k) {
        const Vec2d before = corners.empty() ? loop[n - 1] : corners.back();
        if (!collinear(before, loop[k], loop[(k + 1) % n])) {
            corners.push_back(loop[k]);
        }
    }
    Contour out;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        out.push_back(line_edge(corners[k], corners[(k + 1) % corners.size()]));
    }
    return out;
}

}  // namespace

// Squared distances of the core at the nodes of one slice; never too high.
struct WaterlineSlices::Levels {
    double z;
    double least;                // squared distance on the contour
    double square_limit;         // larger ones may be inexact
    double deep;                 // distance: nodes nearer than this have no neighbour over `least`
    double far;                  // distance: nodes farther have none below `least`
    double corner;               // radius of the tool
    std::vector<double> square;  // node (i, j) at i * ny + j
};

// Nodes of the lattice, `size` each way.
struct WaterlineSlices::Block {
    std::size_t i, j, size;
};

WaterlineSlices::WaterlineSlices(const PartModel& model,
                                 const Tool& tool,
                                 const SliceSettings& settings)
    : model_{model}, tool_{tool}, settings_{settings}
{
    const Box2d& field = settings_.field;
    const double width = field.x1 - field.x0;
    const double height = field.y1 - field.y0;
    const double wanted =
        std::max(pitch_for(tool.corner_radius + settings.clearance, settings.excess),
                 std::max(settings.least_pitch, std::sqrt(width * height / kMostSliceNodes)));
    const auto count = [&](double length) {
        return std::max<std::size_t>(4, static_cast<std::size_t>(std::ceil(length / wanted)));
    };
    nx_ = count(width) + 1;
    ny_ = count(height) + 1;
    pitch_x_ = width / static_cast<double>(nx_ - 1);
    pitch_y_ = height / static_cast<double>(ny_ - 1);
}

double WaterlineSlices::max_excess() const { return kNodeSlack * settings_.excess; }

Vec2d WaterlineSlices::node(std::size_t i, std::size_t j) const
{
    return {settings_.field.x0 + pitch_x_ * static_cast<double>(i),
            settings_.field.y0 + pitch_y_ * static_cast<double>(j)};
}

// True if the core intersects the model everywhere within `reach` of the point: a core smaller by
// that lies in all of them, and intersects the model.
bool WaterlineSlices::buried(Vec2d middle, double reach, const Levels& levels) const
{
    Tool smaller = tool_;
    smaller.radius -= reach + elementary::hypot(pitch_x_, pitch_y_);
    constexpr double kCertain = 0.01;  // mm: smaller distances count as an intersection
    return smaller.radius >= tool_.corner_radius &&
           model_.distance_within(smaller, {middle.x, middle.y, levels.z},
                                  {-tool_.corner_radius, kCertain, kBlockSlack * kCertain}) <=
               -tool_.corner_radius;
}

// A group at a time on each core: a level of many faces may take a million cells, 1 kB each.
void WaterlineSlices::fill(Levels& levels) const
{
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < nx_; i += kBlock) {
        for (std::size_t j = 0; j < ny_; j += kBlock) {
            blocks.push_back({i, j, kBlock});
        }
    }
    const PartModel::SharedQueries shared{model_};
    parallel::for_each((blocks.size() + kGroup - 1) / kGroup, [&](std::size_t group) {
        const PartModel::SharedQueries::Part queries{model_};
        const std::size_t end = std::min(blocks.size(), (group + 1) * kGroup);
        for (std::size_t k = group * kGroup; k < end; ++k) {
            fill_block(blocks[k], levels);
        }
    });
}

void WaterlineSlices::fill_block(const Block& whole, Levels& levels) const
{
    std::vector<Block> open{whole};
    while (!open.empty()) {
        const Block block = open.back();
        open.pop_back();
        if (block.i >= nx_ || block.j >= ny_) {
            continue;
        }
        const double half = 0.5 * static_cast<double>(block.size - 1);
        const Vec2d corner = node(block.i, block.j);
        const Vec2d middle{corner.x + half * pitch_x_, corner.y + half * pitch_y_};
        const double reach = half * elementary::hypot(pitch_x_, pitch_y_);
        const double low = std::max(kBlockSlack * reach, max_excess());
        // Below `deep` it only matters whether the tool intersects the model.
        const double within = std::max(0.0, levels.deep - reach - low - 1e-9);
        const double distance =
            levels.corner +
            model_.distance_within(
                tool_, {middle.x, middle.y, levels.z},
                {within - levels.corner, levels.far + reach - levels.corner + 1e-6, low});
        const bool settled = distance - reach >= levels.far ||
                             distance + low + reach < levels.deep ||
                             (block.size > 1 && distance <= 0.0 && buried(middle, reach, levels));
        if (!settled && block.size > 1) {
            const std::size_t part = block.size / 2;
            open.push_back({block.i, block.j, part});
            open.push_back({block.i + part, block.j, part});
            open.push_back({block.i, block.j + part, part});
            open.push_back({block.i + part, block.j + part, part});
            continue;
        }
        double value = square(std::max(0.0, distance));
        if (settled) {
            value = distance >= levels.far ? levels.square_limit : 0.0;
        }
        for (std::size_t i = block.i; i < std::min(nx_, block.i + block.size); ++i) {
            for (std::size_t j = block.j; j < std::min(ny_, block.j + block.size); ++j) {
                // The axis stays inside the field.
                const bool border = i == 0 || j == 0 || i + 1 == nx_ || j + 1 == ny_;
                levels.square[i * ny_ + j] = border ? 0.0 : std::min(value, levels.square_limit);
            }
        }
    }
}

namespace {

// Follows the contour from triangle to triangle, with the clear side on its left.
class ContourWalk {
public:
    ContourWalk(std::size_t nx, std::size_t ny, const std::vector<double>& square, double least)
        : nx_{nx}, ny_{ny}, square_{square}, least_{least}, seen_(3 * nx * ny, false)
    {
    }

    // A side of the lattice by its clear and its blocked node.
    struct Side {
        std::size_t free;
        std::size_t blocked;
    };

    bool free(std::size_t node) const { return square_[node] >= least_; }

    // Place where the contour crosses the side: from 0 at the clear node to 1.
    double share(const Side& side) const
    {
        const double over = square_[side.free] - least_;
        const double whole = square_[side.free] - square_[side.blocked];
        return std::clamp(over / whole, kNearestEnd, 1.0 - kNearestEnd);
    }

    std::vector<std::vector<Side>> loops()
    {
        std::vector<std::vector<Side>> out;
        for (std::size_t i = 0; i + 1 < nx_; ++i) {
            for (std::size_t j = 0; j + 1 < ny_; ++j) {
                const std::size_t a = i * ny_ + j;
                for (const std::size_t b : {a + ny_, a + 1, a + ny_ + 1}) {
                    if (free(a) != free(b) && !seen(a, b)) {
                        out.push_back(walk({free(a) ? a : b, free(a) ? b : a}));
                    }
                }
            }
        }
        return out;
    }

private:
    std::size_t slot(std::size_t a, std::size_t b) const
    {
        const std::size_t low = std::min(a, b);
        const std::size_t step = std::max(a, b) - low;
        return 3 * low + (step == 1 ? 0 : step == ny_ ? 1 : 2);
    }
    bool seen(std::size_t a, std::size_t b) const { return seen_[slot(a, b)]; }

    // The third node of the triangle to the left of the side from a to b. Every square is divided
    // along the diagonal from its node (i, j) to (i + 1, j + 1).
    std::size_t left_of(std::size_t a, std::size_t b) const
    {
        const auto from = std::pair{a / ny_, a % ny_};
        const auto to = std::pair{b / ny_, b % ny_};
        const int dx = static_cast<int>(to.first) - static_cast<int>(from.first);
        const int dy = static_cast<int>(to.second) - static_cast<int>(from.second);
        // Turned left by 45 degrees if that is a side, else by 90, the third node is next to a or
        // b.
        const std::array<std::array<int, 4>, 6> turns{{{1, 0, 1, 1},
                                                       {1, 1, 0, 1},
                                                       {0, 1, -1, 0},
                                                       {-1, 0, -1, -1},
                                                       {-1, -1, 0, -1},
                                                       {0, -1, 1, 0}}};
        for (const auto& [x, y, third_x, third_y] : turns) {
            if (x == dx && y == dy) {
                const int i = static_cast<int>(from.first) + third_x;
                const int j = static_cast<int>(from.second) + third_y;
                return static_cast<std::size_t>(i) * ny_ + static_cast<std::size_t>(j);
            }
        }
        return a;
    }

    std::vector<Side> walk(Side side)
    {
        std::vector<Side> out;
        while (!seen(side.free, side.blocked)) {
            seen_[slot(side.free, side.blocked)] = true;
            out.push_back(side);
            const std::size_t third = left_of(side.free, side.blocked);
            side = free(third) ? Side{third, side.blocked} : Side{side.free, third};
        }
        return out;
    }

    std::size_t nx_;
    std::size_t ny_;
    const std::vector<double>& square_;
    double least_;
    std::vector<bool> seen_;
};

}  // namespace

Region2d WaterlineSlices::at(double z, double extra) const
{
    const double side = elementary::hypot(pitch_x_, pitch_y_);
    const double keep = tool_.corner_radius + settings_.clearance + extra + kNearestEnd * side;
    Levels levels{};
    levels.z = z;
    levels.corner = tool_.corner_radius;
    levels.least = square(keep) + square(side) / 4.0;
    levels.deep = keep - side;
    levels.far = std::sqrt(levels.least) + side;
    levels.square_limit = square(levels.far);
    levels.square.assign(nx_ * ny_, 0.0);
    fill(levels);
    ContourWalk walk{nx_, ny_, levels.square, levels.least};
    Region2d out;
    for (const auto& loop : walk.loops()) {
        std::vector<Vec2d> corners;
        for (const ContourWalk::Side& crossed : loop) {
            const Vec2d from = node(crossed.free / ny_, crossed.free % ny_);
            const Vec2d to = node(crossed.blocked / ny_, crossed.blocked % ny_);
            corners.push_back(from + (to - from) * walk.share(crossed));
        }
        Contour contour = contour_of(corners);
        if (contour.size() >= 3) {
            out.contours.push_back(std::move(contour));
        }
    }
    return out;
}

}  // namespace cusp::waterline_slices
