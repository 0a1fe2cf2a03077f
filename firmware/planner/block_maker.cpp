// Moves into blocks of at most 64 mm and, for arcs, a quarter turn.
#include "firmware/planner/block_maker.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

namespace cusp::planner {
namespace {

// Arcs are evaluated in float: over 4 mm they stay within half a nanometre.
constexpr double kMaxArcLength = 4.0;
constexpr double kMaxArcAngle = kPi / 2;

PathOffset path_offset(Position from, Position to) noexcept
{
    return mapped(to - from, [](std::int64_t nm) {
        return static_cast<std::int32_t>(nm * kPathUnitsPerNanometre);
    });
}

std::uint32_t units(double mm) noexcept
{
    return static_cast<std::uint32_t>(mm * static_cast<double>(kPathUnitsPerMillimetre) + 0.5);
}

std::uint32_t pieces(double whole, double most) noexcept
{
    return 1U + static_cast<std::uint32_t>(whole / most);
}

// The point of an arc at parameter t, exact start and end excepted.
AxisVecd arc_point(const path::Arc& arc, double t) noexcept
{
    const auto [sine, cosine] = sin_cos(t * arc.sweep);
    const double radius = arc.radius + t * arc.radius_change;
    return arc.centre + arc.u * (radius * cosine) + arc.v * (radius * sine) + arc.axial * t;
}

}  // namespace

void BlockMaker::start(const path::Move& move, AxisFilter filter) noexcept
{
    filter_ = filter;
    next_ = 0;
    count_ = 0;
    at_ = move.start;
    length_ = path::length(move);
    if (length_ <= 0) {
        return;
    }
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        count_ = std::max(pieces(length_, kMaxArcLength), pieces(arc->sweep, kMaxArcAngle));
    } else {
        count_ = pieces(length_, kMaxBlockLength);
    }
}

bool BlockMaker::make(const path::Move& move, PathQueue& queue, Block& block) noexcept
{
    ++next_;
    const double t = static_cast<double>(next_) / count_;
    const auto* arc = std::get_if<path::Arc>(&move.path);
    const auto* piece = std::get_if<path::BezierPiece>(&move.path);
    const auto* quintic = std::get_if<path::Quintic>(&move.path);
    const Position from = at_;
    Position to = move.end;
    if (next_ != count_) {
        const AxisVecd whole = to_millimetres(move.end) - to_millimetres(move.start);
        to = move.start + to_position(arc != nullptr ? arc_point(*arc, t) : whole * t);
    }
    if (from == to && arc == nullptr && piece == nullptr) {
        return false;
    }
    at_ = to;
    block = Block{};
    block.displacement = path_offset(from, to);
    block.kind = move.kind;
    block.filter = filter_;
    block.line = move.line;
    block.power = move.power;
    if (arc != nullptr) {
        make_arc(*arc, block);
        return true;
    }
    if (piece != nullptr && make_curve(*piece, queue, block)) {
        return true;
    }
    if (from == to) {
        return false;
    }
    if (quintic != nullptr) {
        block.shape = BlockShape::kQuintic;
        block.quintic = QuinticBlock{quintic->bulge};
        set_length(block, std::max(units(length_), std::uint32_t{1}));
        return true;
    }
    const AxisVecd along = to_millimetres(to - from);
    set_length(block, std::max(units(norm(along)), std::uint32_t{1}));
    return true;
}

void BlockMaker::make_arc(const path::Arc& arc, Block& block) const noexcept
{
    const double before = static_cast<double>(next_ - 1) / count_;
    const auto [sine, cosine] = sin_cos(before * arc.sweep);
    block.shape = BlockShape::kArc;
    set_length(block, std::max(units(length_ / count_), std::uint32_t{1}));
    block.arc.tangent = to_float(arc.v * cosine - arc.u * sine);
    block.arc.normal = to_float(-(arc.u * cosine) - arc.v * sine);
    block.arc.axial = to_float(arc.axial / arc.sweep);
    block.arc.radius = static_cast<float>(arc.radius + before * arc.radius_change);
    block.arc.spread = static_cast<float>(arc.radius_change / arc.sweep);
    block.arc.angle_per_unit =
        static_cast<float>(arc.sweep / count_ / static_cast<double>(block.length));
}

// False where the piece is too short to be anything but a line.
bool BlockMaker::make_curve(const path::BezierPiece& piece,
                            PathQueue& queue,
                            Block& block) const noexcept
{
    constexpr float kShortestCurve = 1e-5F;  // mm
    nurbs::ArcLengthTable table;
    if (!nurbs::make_arc_length_table(piece, table) || table.length() < kShortestCurve) {
        return false;
    }
    CurveBlock& curve = queue.new_curve();
    curve.piece = piece;
    curve.table = table;
    block.shape = BlockShape::kCurve;
    block.curve = &curve;
    set_length(block, units(static_cast<double>(table.length())));
    return true;
}

}  // namespace cusp::planner
