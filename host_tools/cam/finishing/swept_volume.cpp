// Moves are sorted into squares in plan, squares into blocks, each with the lowest of its moves.
#include "host_tools/cam/finishing/swept_volume.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/part_model/grid_square.hpp"

namespace cusp::finishing {

using part_model::square_key;

namespace {

constexpr double kUprightWay = 1e-9;  // mm, seen from above
// In squares: a move may cross the corner of one between the points at which it was sorted.
constexpr double kCutCorner = 0.13;
constexpr int kBlockBits = 3;

double square_to_move(Vec3d p, const SweptVolume::Move& move)
{
    const Vec3d d = move.to - move.from;
    const double square = dot(d, d);
    const Vec3d off = p - move.from;
    const double t = square > 0 ? std::clamp(dot(off, d) / square, 0.0, 1.0) : 0;
    const Vec3d rest = off - d * t;
    return dot(rest, rest);
}

// True if the point lies within the radius of the move or straight above such a point.
bool lies_within(double square_radius, Vec3d p, const SweptVolume::Move& move)
{
    if (square_to_move(p, move) <= square_radius) {
        return true;
    }
    if (p.z <= std::min(move.from.z, move.to.z)) {
        return false;
    }
    const Vec3d d = move.to - move.from;
    const Vec3d off = p - move.from;
    const double plan_square = d.x * d.x + d.y * d.y;
    const double t =
        plan_square > 0 ? std::clamp((off.x * d.x + off.y * d.y) / plan_square, 0.0, 1.0) : 0;
    const double low = plan_square > 0 ? move.from.z + d.z * t : std::min(move.from.z, move.to.z);
    const double x = off.x - d.x * t;
    const double y = off.y - d.y * t;
    return p.z >= low && x * x + y * y <= square_radius;
}

}  // namespace

SweptVolume::SweptVolume(double radius, double reach) : radius_{radius}, pitch_{reach}
{
    static_assert(kBlock == 1 << kBlockBits);
}

std::int64_t SweptVolume::cell(double at) const
{
    return static_cast<std::int64_t>(std::floor(at / pitch_));
}

std::size_t SweptVolume::number_in_block(std::int64_t i, std::int64_t j)
{
    return static_cast<std::size_t>((i & (kBlock - 1)) * kBlock + (j & (kBlock - 1)));
}

void SweptVolume::add(const std::vector<Vec3d>& tips)
{
    const Vec3d up{0, 0, radius_};
    for (std::size_t k = 1; k < tips.size(); ++k) {
        const Vec3d from = tips[k - 1] + up;
        const Vec3d to = tips[k] + up;
        const double length = elementary::hypot(to.x - from.x, to.y - from.y);
        const Move move{from, to, length};
        const std::uint32_t number = static_cast<std::uint32_t>(moves_.size());
        moves_.push_back(move);
        const double low = std::min(move.from.z, move.to.z);
        const int parts = std::max(1, static_cast<int>(std::ceil(4 * length / pitch_)));
        for (int part = 0; part <= parts; ++part) {
            const Vec3d at =
                move.from + (move.to - move.from) * (static_cast<double>(part) / parts);
            const std::int64_t i = cell(at.x);
            const std::int64_t j = cell(at.y);
            Block& block = blocks_[square_key(i >> kBlockBits, j >> kBlockBits)];
            Square& here = block.squares[number_in_block(i, j)];
            if (here.moves.empty() || here.moves.back() != number) {
                here.moves.push_back(number);
                here.low = std::min(here.low, low);
                block.low = std::min(block.low, low);
            }
        }
    }
}

template <class Visit>
void SweptVolume::visit_around(Vec3d centre, const Visit& visit) const
{
    const double reach = (1 + kCutCorner) * pitch_;
    const std::int64_t j_end = cell(centre.y + reach);
    for (std::int64_t i = cell(centre.x - reach); i <= cell(centre.x + reach); ++i) {
        for (std::int64_t j = cell(centre.y - reach); j <= j_end; ++j) {
            const auto block = blocks_.find(square_key(i >> kBlockBits, j >> kBlockBits));
            if (block == blocks_.end()) {
                continue;
            }
            for (const std::uint32_t number : block->second.squares[number_in_block(i, j)].moves) {
                visit(number);
            }
        }
    }
}

namespace {

// Beside a valley thousands of moves are near a point: looking each up in the list took as its square.
void keep_each_once(std::vector<std::uint32_t>& numbers)
{
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

void SweptVolume::near(Vec3d centre, std::vector<std::uint32_t>& out) const
{
    out.clear();
    visit_around(centre, [&](std::uint32_t number) {
        const Move& move = moves_[number];
        const double low = std::min(move.from.z, move.to.z) - pitch_;
        const double high = std::max(move.from.z, move.to.z) + pitch_;
        if (centre.z >= low && centre.z <= high) {
            out.push_back(number);
        }
    });
    keep_each_once(out);
}

void SweptVolume::near_or_below(Vec3d centre, std::vector<std::uint32_t>& out) const
{
    out.clear();
    visit_around(centre, [&](std::uint32_t number) {
        const Move& move = moves_[number];
        if (centre.z >= std::min(move.from.z, move.to.z) - pitch_) {
            out.push_back(number);
        }
    });
    keep_each_once(out);
}

bool SweptVolume::removes(std::uint32_t move, Vec3d point, double shrink) const
{
    const double radius = radius_ - shrink;
    return radius > 0 && lies_within(radius * radius, point, moves_[move]);
}

bool SweptVolume::passes_near(std::uint32_t move, Vec3d point) const
{
    return square_to_move(point, moves_[move]) <= radius_ * radius_;
}

// The lower side of a ball swept along a line is that of a tilted cylinder with ends. In the
// vertical plane through the move it is z0 + m s - sqrt(r^2 - (s - s0)^2), least where its slope is
// zero.
std::optional<double> SweptVolume::lowest_share(const Move& move, double x, double y) const
{
    const Vec3d way = move.to - move.from;
    const double length = move.length;
    const double off_x = x - move.from.x;
    const double off_y = y - move.from.y;
    const double away = off_x * off_x + off_y * off_y;
    if (length <= kUprightWay) {
        return away <= radius_ * radius_ ? std::optional{way.z < 0 ? 1.0 : 0.0} : std::nullopt;
    }
    const double beside = (way.x * off_y - way.y * off_x) / length;
    const double square = radius_ * radius_ - beside * beside;
    if (square < 0) {
        return std::nullopt;
    }
    const double along = (way.x * off_x + way.y * off_y) / length;
    const double reach = std::sqrt(square);
    const double slope = way.z / length;
    const double at = std::clamp(along - slope * reach / std::sqrt(1 + slope * slope), 0.0, length);
    return std::abs(at - along) <= reach ? std::optional{at / length} : std::nullopt;
}

void SweptVolume::try_move(std::uint32_t number, double x, double y, Lowest& best) const
{
    const Move& move = moves_[number];
    if (std::min(move.from.z, move.to.z) - radius_ > best.height) {
        return;
    }
    if (const std::optional<double> share = lowest_share(move, x, y)) {
        const Vec3d c = move.from + (move.to - move.from) * *share;
        const double square = radius_ * radius_ - (c.x - x) * (c.x - x) - (c.y - y) * (c.y - y);
        const double height = c.z - std::sqrt(std::max(0.0, square));
        if (height < best.height || (height == best.height && number < best.move)) {
            best = {height, c, number};
        }
    }
}

SweptVolume::Lowest SweptVolume::cut_by(std::uint32_t move, double x, double y) const
{
    Lowest best{kInfinite, {}, move};
    try_move(move, x, y, best);
    return best;
}

// True if a ball with its centre over a square, not below `low`, may cut as low as `than` at `at`.
bool SweptVolume::may_be_lower(double low, Vec2d corner, double side, Vec2d at, double than) const
{
    const double max_error = kCutCorner * pitch_;
    const auto beside = [&](double begin, double place) {
        return std::max(0.0,
                        std::max(begin - max_error - place, place - (begin + side + max_error)));
    };
    const double x = beside(corner.x, at.x);
    const double y = beside(corner.y, at.y);
    const double square = radius_ * radius_ - x * x - y * y;
    return square >= 0 && low < kInfinite && low - std::sqrt(square) <= than;
}

SweptVolume::Lowest SweptVolume::lowest(double x, double y) const
{
    Lowest best{kInfinite, {}, 0};
    if (moves_.empty()) {
        return best;
    }
    try_move(last_, x, y, best);
    const auto may = [&](double low, std::int64_t i, std::int64_t j, double squares) {
        const Vec2d corner{static_cast<double>(i) * pitch_, static_cast<double>(j) * pitch_};
        return may_be_lower(low, corner, squares * pitch_, {x, y}, best.height);
    };
    const auto look_into = [&](const Block& block, std::int64_t i0, std::int64_t j0) {
        for (std::int64_t i = i0; i < i0 + kBlock; ++i) {
            for (std::int64_t j = j0; j < j0 + kBlock; ++j) {
                const Square& square = block.squares[number_in_block(i, j)];
                if (may(square.low, i, j, 1)) {
                    for (const std::uint32_t number : square.moves) {
                        try_move(number, x, y, best);
                    }
                }
            }
        }
    };
    const double reach = radius_ + kCutCorner * pitch_;
    const std::int64_t i_end = cell(x + reach) >> kBlockBits;
    const std::int64_t j_end = cell(y + reach) >> kBlockBits;
    for (std::int64_t i = cell(x - reach) >> kBlockBits; i <= i_end; ++i) {
        for (std::int64_t j = cell(y - reach) >> kBlockBits; j <= j_end; ++j) {
            const auto block = blocks_.find(square_key(i, j));
            if (block != blocks_.end() &&
                may(block->second.low, i * kBlock, j * kBlock, static_cast<double>(kBlock))) {
                look_into(block->second, i * kBlock, j * kBlock);
            }
        }
    }
    if (std::isfinite(best.height)) {
        last_ = best.move;
    }
    return best;
}

}  // namespace cusp::finishing
