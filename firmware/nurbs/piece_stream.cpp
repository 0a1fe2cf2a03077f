// Spans to Bezier pieces by blossoming (Ramshaw 1987): control point k of the span [a, b] is the
// polar form at (a, ..., a, b, ..., b) with k times b.
#include "firmware/nurbs/piece_stream.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/nurbs/arc_length_table.hpp"

namespace cusp::nurbs {

void PieceStream::open(KnotSource source, unsigned order, const ControlPoint& first) noexcept
{
    CUSP_ASSERT(order >= 2 && order <= path::kMaxOrder);
    *this = PieceStream{};
    source_ = source;
    order_ = order;
    is_open_ = true;
    position_ = first.position;
    next_span_ = order - 1;
    add_point(first);
}

void PieceStream::add_point(const ControlPoint& point) noexcept
{
    CUSP_ASSERT(accepts_points() && point.weight > 0);
    points_[points_count_ % kResident] = point;
    ++points_count_;
}

Status PieceStream::check_knot(double knot) noexcept
{
    const bool closing = knots_count_ >= points_count_;
    if (closing && points_count_ < order_) {
        return Error::kGcodeInvalidTarget;
    }
    if (knots_count_ == 0) {
        multiplicity_ = 1;
        return kDone;
    }
    const double last = knot_at(knots_count_ - 1);
    if (knot < last) {
        return Error::kGcodeInvalidTarget;
    }
    const bool repeated = knot == last;
    multiplicity_ = repeated ? multiplicity_ + 1 : 1;
    if (closing) {
        return repeated == (closing_knots_ > 0) ? Status{kDone}
                                                : Status{Error::kGcodeInvalidTarget};
    }
    if (knots_count_ < order_) {
        return repeated ? Status{kDone} : Status{Error::kGcodeInvalidTarget};
    }
    // The first `order` knots are equal. One more of that value is refused, and so are `order` equal
    // knots inside the curve, where order - 1 already make a corner.
    const bool like_first = repeated && multiplicity_ > order_;
    const bool inside = multiplicity_ == order_;
    return like_first || inside ? Status{Error::kGcodeInvalidTarget} : Status{kDone};
}

Status PieceStream::add_knot(double knot) noexcept
{
    CUSP_ASSERT(is_open_ && source_ == KnotSource::kExplicit);
    if (const Status status = check_knot(knot); !status) {
        abandon();
        return status;
    }
    if (knots_count_ >= points_count_) {
        ++closing_knots_;
    }
    knots_[knots_count_ % kResident] = knot;
    ++knots_count_;
    if (closing_knots_ == order_) {
        is_open_ = false;
        closed_ = true;
    }
    return kDone;
}

Status PieceStream::close() noexcept
{
    CUSP_ASSERT(is_open_ && source_ == KnotSource::kUniform);
    if (points_count_ < order_) {
        abandon();
        return Error::kGcodeInvalidTarget;
    }
    is_open_ = false;
    closed_ = true;
    return kDone;
}

void PieceStream::abandon() noexcept
{
    const Position here = position_;
    *this = PieceStream{};
    position_ = here;
}

double PieceStream::knot_at(std::uint32_t index) const noexcept
{
    if (source_ == KnotSource::kExplicit) {
        return knots_[index % kResident];
    }
    const std::uint32_t degree = order_ - 1;
    const std::uint32_t last = closed_ ? points_count_ : index;
    return index <= degree ? 0.0 : static_cast<double>(std::min(index, last) - degree);
}

// Spans below this have all their points and knots.
std::uint32_t PieceStream::ready_end() const noexcept
{
    const std::uint32_t degree = order_ - 1;
    if (closed_) {
        return points_count_;
    }
    // Span i is complete with knot i + degree. A uniform knot j is known after j points.
    const std::uint32_t known = source_ == KnotSource::kUniform ? points_count_ + 1 : knots_count_;
    return known > degree ? std::min(known - degree, points_count_) : 0;
}

bool PieceStream::begin_span() noexcept
{
    const std::uint32_t degree = order_ - 1;
    for (; next_span_ < ready_end(); ++next_span_) {
        const double begin = knot_at(next_span_);
        const double end = knot_at(next_span_ + 1);
        if (!(begin < end)) {
            continue;
        }
        span_origin_ = position_;
        const std::uint32_t first = next_span_ - degree;
        for (std::uint32_t k = 0; k < order_; ++k) {
            Net net{};
            for (std::uint32_t j = 0; j < order_; ++j) {
                const ControlPoint& point = points_[(first + j) % kResident];
                net[j] = {to_millimetres(point.position - span_origin_) * point.weight,
                          point.weight};
            }
            for (std::uint32_t r = 1; r < order_; ++r) {
                const double at = r <= degree - k ? begin : end;
                for (std::uint32_t j = degree; j >= r; --j) {
                    const double low = knot_at(first + j);
                    const double t = (at - low) / (knot_at(first + j + order_ - r) - low);
                    net[j].point = net[j - 1].point * (1 - t) + net[j].point * t;
                    net[j].weight = net[j - 1].weight * (1 - t) + net[j].weight * t;
                }
            }
            span_[k] = net[degree];
        }
        ++next_span_;
        in_span_ = true;
        done_ = 0;
        step_ = 1;
        return true;
    }
    return false;
}

// The control points of the span between two parameters of it, by the same polar form.
PieceStream::Net PieceStream::part_of_span(double from, double to) const noexcept
{
    const std::uint32_t degree = order_ - 1;
    Net part{};
    for (std::uint32_t k = 0; k < order_; ++k) {
        Net net = span_;
        for (std::uint32_t r = 1; r < order_; ++r) {
            const double t = r <= degree - k ? from : to;
            for (std::uint32_t j = 0; j + r < order_; ++j) {
                net[j].point = net[j].point * (1 - t) + net[j + 1].point * t;
                net[j].weight = net[j].weight * (1 - t) + net[j + 1].weight * t;
            }
        }
        part[k] = net[0];
    }
    return part;
}

namespace {

// |dP/du| at the nodes, mm.
float greatest_parametric_speed(const ArcLengthTable& table) noexcept
{
    float least = table.nodes[0].du;
    for (unsigned i = 1; i < table.size; ++i) {
        least = std::min(least, table.nodes[i].du);
    }
    return 1.0F / least;
}

// The straight line to the end, as a curve of the same order.
void straighten(path::BezierPiece& piece, AxisVecd end) noexcept
{
    for (unsigned i = 0; i < piece.order; ++i) {
        piece.points[i] = to_float(end * (static_cast<double>(i) / (piece.order - 1U)));
        piece.weights[i] = 1;
    }
}

}  // namespace

// False where the part from `from` to `to` is too long for one piece, or its speed varies too much.
bool PieceStream::try_piece(double from, double to, Piece& piece) noexcept
{
    const Net net = part_of_span(from, to);
    const AxisVecd start = to_millimetres(position_ - span_origin_);
    double heaviest = 0;
    for (std::uint32_t i = 0; i < order_; ++i) {
        heaviest = std::max(heaviest, net[i].weight);
    }
    piece.bezier = {};
    piece.bezier.order = static_cast<std::uint8_t>(order_);
    AxisVecd last{};
    double polygon = 0;  // a curve is no longer than its control polygon
    for (std::uint32_t i = 0; i < order_; ++i) {
        const AxisVecd at = i == 0 ? AxisVecd{} : net[i].point / net[i].weight - start;
        polygon += norm(at - last);
        piece.bezier.points[i] = to_float(at);
        piece.bezier.weights[i] = static_cast<float>(net[i].weight / heaviest);
        last = at;
    }
    piece.end = position_ + to_position(last);
    if (polygon > kMaxPieceLength) {
        return false;
    }
    const AxisVecd end = to_millimetres(piece.end - position_);
    piece.bezier.points[order_ - 1] = to_float(end);
    ArcLengthTable table;
    const bool made = make_arc_length_table(piece.bezier, table);
    if (made && greatest_parametric_speed(table) <= kMaxParametricSpeed) {
        return true;
    }
    if (made || polygon > kMaxChordLength) {
        return false;
    }
    straighten(piece.bezier, end);
    return true;
}

bool PieceStream::next_of_span(Piece& piece) noexcept
{
    // Each halving at least halves the polygon once the pieces are nearly straight; a span of
    // 100 m with a cusp comes below kMaxChordLength in less than 40.
    constexpr unsigned kMaxHalvings = 48;
    bool fits = try_piece(done_, done_ + step_, piece);
    for (unsigned i = 0; i < kMaxHalvings && !fits; ++i) {
        step_ *= 0.5;
        fits = try_piece(done_, done_ + step_, piece);
    }
    if (!fits) {
        straighten(piece.bezier, to_millimetres(piece.end - position_));
    }
    done_ += step_;
    const double doubled = done_ / (2 * step_);
    if (doubled == std::floor(doubled) && done_ + 2 * step_ <= 1) {
        step_ *= 2;
    }
    in_span_ = done_ < 1;
    // A part without length is left out.
    const bool moves = piece.end != position_ || norm(piece.bezier.points[order_ / 2]) > 0;
    position_ = piece.end;
    return moves;
}

bool PieceStream::next(Piece& piece) noexcept
{
    while (in_span_ || begin_span()) {
        if (next_of_span(piece)) {
            return true;
        }
    }
    return false;
}

}  // namespace cusp::nurbs
