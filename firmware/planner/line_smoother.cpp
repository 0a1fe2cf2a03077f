// Curves through the vertices of dense lines.
#include "firmware/planner/line_smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "firmware/base/assert.hpp"
#include "firmware/base/lane_vec.hpp"
#include "firmware/planner/quintic.hpp"

namespace cusp::planner {
namespace {

// A vertex that turns by more than this is a corner: 20 degrees.
constexpr float kCornerTurnSquared = 0.1206F;  // (2 sin 10 degrees)^2
// The vertices around a knot may leave its cubic by this part of the tolerance; fewer are taken
// where they do not.
constexpr float kKnotShare = 0.1F;
// Longer pieces, mm, gain nothing.
constexpr float kLongestPiece = 4.0F;
// The parameter is arc length within this, relative.
constexpr float kSpeedError = 5e-4F;

// For distances below 2 m: the target converts 32 bits in one instruction.
AxisVecf millimetres(Position p) noexcept
{
    constexpr float kScale = 1e-6F;
    const auto scaled = [](std::int64_t nm) {
        return static_cast<float>(static_cast<std::int32_t>(nm)) * kScale;
    };
    return mapped(p, scaled);
}

bool is_short(Position p) noexcept
{
    constexpr auto kLongest = static_cast<std::int64_t>(LineSmoother::kLongestLine * 1e6F);
    for (unsigned i = 0; i < kAxisCount; ++i) {
        if (p[i] > kLongest || p[i] < -kLongest) {
            return false;
        }
    }
    return true;
}

constexpr float kMillimetre = 1e-6F;  // of a nanometre

// mm, of nanometres.
AxisVecf scaled(AxisVec<std::int32_t> nm) noexcept { return to_float(nm) * kMillimetre; }

Position wide(const AxisVec<std::int32_t>& nm) noexcept
{
    return mapped(nm, [](std::int32_t part) { return std::int64_t{part}; });
}

// Direction and curvature, of the first two derivatives by a parameter.
void set_end(AxisVecf slope, AxisVecf bend, PathEnd& end) noexcept
{
    const float speed = norm(slope);
    end.tangent = slope / std::max(speed, 1e-6F);
    end.curvature = (bend - end.tangent * dot(bend, end.tangent)) / std::max(speed * speed, 1e-12F);
}

// Distance of a vertex from its fit, mm. An array of these is not cleared first.
union Leave {
    Leave() noexcept {}
    LaneVec value;
};

// nm: of the axis that travels farthest.
std::int32_t travel(const AxisVec<std::int32_t>& from, const AxisVec<std::int32_t>& to) noexcept
{
    std::int32_t most = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        most = std::max(most, std::abs(to[i] - from[i]));
    }
    return most;
}

AxisVecf unit(AxisVecf a) noexcept
{
    const float length = norm(a);
    return length > 0 ? a / length : a;
}

// The lean of a curve that begins or ends on a line's end.
path::PathLean lean_of(AxisVecf tangent, AxisVecf line) noexcept
{
    const float length = norm(line);
    return {norm(tangent - unit(line)), length};
}

}  // namespace

bool LineSmoother::accepts(const path::Move& move) noexcept
{
    if (move.kind == path::MoveKind::kRapid || move.tolerance <= 0 ||
        !std::holds_alternative<path::Line>(move.path) || move.start == move.end ||
        !is_short(move.end - move.start)) {
        return false;
    }
    const AxisVecf along = millimetres(move.end - move.start);
    return dot(along, along) <= kLongestLine * kLongestLine;
}

bool LineSmoother::continues(const path::Move& move) const noexcept
{
    const std::size_t count = vertices_.size();
    if (count < 2) {
        return true;
    }
    const AxisVec<std::int32_t>& last = vertices_[count - 1].at;
    const Position end = origin_ + wide(last);
    if (move.kind != kind_ || move.feed != feed_ || move.tolerance != tolerance_ ||
        move.power != power_ || end != move.start) {
        return false;
    }
    const AxisVecf before = unit(between(count - 2, count - 1));
    const AxisVecf turn = unit(millimetres(move.end - move.start)) - before;
    return dot(turn, turn) <= kCornerTurnSquared;
}

void LineSmoother::add(const path::Move& move, float departure) noexcept
{
    if (vertices_.empty()) {
        kind_ = move.kind;
        feed_ = move.feed;
        tolerance_ = move.tolerance;
        departure_ = departure;
        power_ = move.power;
        at_ = move.start;
        origin_ = move.start;
        has_start_ = false;
        lines_before_ = 1;
        (void)vertices_.try_push_back({{}, move.line, 0});
    }
    const Position from = move.end - origin_;
    const AxisVec<std::int32_t> at =
        mapped(from, [](std::int64_t nm) { return static_cast<std::int32_t>(nm); });
    const bool added = vertices_.try_push_back({at, move.line, travel(vertices_.back().at, at)});
    CUSP_ASSERT(added);
}

void LineSmoother::clear() noexcept
{
    vertices_.clear();
    has_start_ = false;
}

// mm
AxisVecf LineSmoother::between(std::size_t from, std::size_t to) const noexcept
{
    return scaled(vertices_[to].at - vertices_[from].at);
}

// Number of lines before a vertex, and after it, that a knot takes.
std::size_t LineSmoother::knot_lines_before(std::size_t index) const noexcept
{
    const std::size_t most = std::min(index, kBeyond);
    std::size_t lines = 0;
    const Vertex* vertex = vertices_.begin() + index;
    for (std::int32_t sum = 0; lines < most && sum < kKnotTravel; ++lines) {
        sum += vertex->travel;
        --vertex;
    }
    return lines;
}

std::size_t LineSmoother::knot_lines_after(std::size_t index) const noexcept
{
    const std::size_t most = std::min(vertices_.size() - 1 - index, kBeyond);
    std::size_t lines = 0;
    const Vertex* vertex = vertices_.begin() + index;
    for (std::int32_t sum = 0; lines < most && sum < kKnotTravel; ++lines) {
        ++vertex;
        sum += vertex->travel;
    }
    return lines;
}

// Fits a cubic over the lengths of the chords, or less where vertices are few. Returns by how much
// a vertex leaves it at most, mm.
// Over 60 lines: one recurrence over four arrays.
float LineSmoother::fit_knot(std::size_t index,
                             std::size_t from,
                             std::size_t to,
                             Knot& knot) const noexcept
{
    constexpr std::size_t kMost = 2 * kBeyond + 1;
    constexpr unsigned kTerms = 4;
    std::array<float, kMost> x;
    std::array<Leave, kMost> left;
    std::array<float, kMost> value;
    std::array<float, kMost> before;
    const std::size_t count = to - from + 1;
    const std::size_t here = index - from;
    const Vertex* const vertices = vertices_.begin() + from;
    for (std::size_t i = 0; i < count; ++i) {
        left[i].value = scaled_difference(vertices[i].at, vertices[here].at, kMillimetre);
    }
    x[here] = 0;
    for (std::size_t i = here; i-- > 0;) {
        x[i] = x[i + 1] - norm(left[i + 1].value - left[i].value);
    }
    for (std::size_t i = here + 1; i < count; ++i) {
        x[i] = x[i - 1] + norm(left[i].value - left[i - 1].value);
    }
    const bool one_sided = index == from || index == to;
    const std::size_t terms = std::min<std::size_t>(count, one_sided ? kTerms - 1 : kTerms);
    LaneVec place = all_lanes(0.0F);
    LaneVec slope = place;
    LaneVec bend = place;
    // Value, first and second derivative at the knot, of this polynomial and the one before.
    float now[3] = {1, 0, 0};
    float last[3] = {0, 0, 0};
    // Sums over the vertices: of the polynomial squared, of that times x, and of its products.
    float square = static_cast<float>(count);
    float moment = 0;
    LaneVec product = place;
    // The first polynomial is 1.
    for (std::size_t i = 0; i < count; ++i) {
        moment += x[i];
        product = product + left[i].value;
    }
    float square_before = 1;
    float worst = 0;
    // The vertices leave a polynomial and meet the next, which the first makes without the one before.
    const auto pass = [&](LaneVec part, float shift, float back, auto is_first) {
        square = 0;
        moment = 0;
        product = all_lanes(0.0F);
        for (std::size_t i = 0; i < count; ++i) {
            float next = x[i] - shift;
            LaneVec rest = left[i].value;
            if constexpr (is_first) {
                rest = rest - part;
                before[i] = 1.0F;
            } else {
                const float v = value[i];
                rest = rest - part * v;
                next = next * v - back * before[i];
                before[i] = v;
            }
            value[i] = next;
            left[i].value = rest;
            square += next * next;
            moment += x[i] * next * next;
            product = product + rest * next;
        }
    };
    for (std::size_t k = 0;; ++k) {
        const LaneVec part = product / square;
        place = place + part * now[0];
        slope = slope + part * now[1];
        bend = bend + part * now[2];
        if (k + 1 == terms) {
            for (std::size_t i = 0; i < count; ++i) {
                const LaneVec rest = left[i].value - (k == 0 ? part : part * value[i]);
                worst = std::max(worst, dot(rest, rest));
            }
            break;
        }
        const float shift = moment / square;
        const float back = k == 0 ? 0.0F : square / square_before;
        square_before = square;
        if (k == 0) {
            pass(part, shift, back, std::true_type{});
        } else {
            pass(part, shift, back, std::false_type{});
        }
        const float following[3] = {-shift * now[0] - back * last[0],
                                    now[0] - shift * now[1] - back * last[1],
                                    2.0F * now[1] - shift * now[2] - back * last[2]};
        for (unsigned n = 0; n < 3; ++n) {
            last[n] = now[n];
            now[n] = following[n];
        }
    }
    set_end(to_vec(slope), to_vec(bend), knot.end);
    const bool at_end = index == 0 || index + 1 == vertices_.size();
    knot.at = at_end ? AxisVecf{} : to_vec(place);
    return std::sqrt(worst);
}

// By as many vertices on either side as one cubic passes.
LineSmoother::Knot LineSmoother::knot_at(std::size_t index) const noexcept
{
    const float allowed = kKnotShare * tolerance_;
    const std::size_t before = knot_lines_before(index);
    const std::size_t after = knot_lines_after(index);
    Knot knot;
    std::size_t reach = std::max(before, after);
    while (fit_knot(index, index - std::min(reach, before), index + std::min(reach, after), knot) >
               allowed &&
           reach > 1) {
        reach /= 2;
    }
    return knot;
}

bool LineSmoother::within_tolerance(const Fit& fit, std::size_t last) const noexcept
{
    const float square = departure_ * departure_;
    float whole = 0;
    const Vertex* const vertices = vertices_.begin();
    for (std::size_t i = 0; i < last; ++i) {
        whole += norm(scaled_difference(vertices[i + 1].at, vertices[i].at, kMillimetre));
    }
    const LaneQuintic piece = lane_quintic(fit.piece.bulge, fit.chord);
    const LaneVec start = to_lanes(start_.at);
    // True if a place of the lines, by their length up to it, is near the piece.
    const auto is_near = [&](LaneVec place, float along) {
        const float x = along / whole;
        const LaneVec off = place - point_at(piece, x);
        const float distance = dot(off, off);
        if (distance <= square) {
            return true;  // whichever way the curve goes
        }
        const LaneVec slope = slope_at(piece, x);
        const float ahead = dot(off, slope);
        const bool is_off = distance - ahead * ahead / dot(slope, slope) > square;
        return !is_off;
    };
    float along = 0;
    LaneVec before = to_lanes(-start_.at);
    for (std::size_t i = 1; i <= last; ++i) {
        const LaneVec here = scaled_difference(vertices[i].at, vertices[0].at, kMillimetre) - start;
        const LaneVec line = here - before;
        const float length = norm(line);
        // before + line is not here itself, for rounding.
        if (!is_near(before + line * 0.5F, along + length * 0.5F) ||
            !is_near(before + line, along + length)) {
            return false;
        }
        along += length;
        before = here;
    }
    return true;
}

bool LineSmoother::fit(std::size_t last, Fit& fit) const noexcept
{
    const Knot& start = start_;
    const AxisVecf whole = between(0, last);
    if (last > 1 && dot(whole, whole) > kLongestPiece * kLongestPiece) {
        return false;
    }
    fit.end = knot_at(last);
    fit.chord = whole + fit.end.at - start.at;
    return make_quintic(fit.chord, start.end, fit.end.end, kSpeedError, fit.piece) &&
           within_tolerance(fit, last);
}

// Number of lines of the longest piece that fits; 0 if none fits. Neighbours are about as long:
// away from the length of the one before by doubling the step, then by halving it.
std::size_t LineSmoother::longest_fit(std::size_t most, Fit& best) const noexcept
{
    std::size_t good = 0;
    std::size_t bad = most + 1;
    std::size_t step = 1;
    for (std::size_t tried = std::min<std::size_t>(lines_before_, most); bad - good > 1;) {
        Fit fitted;
        if (fit(tried, fitted)) {
            good = tried;
            best = fitted;
        } else {
            bad = tried;
        }
        const bool found_both = good > 0 && bad <= most;
        if (found_both) {
            tried = good + (bad - good) / 2;
        } else {
            tried = good > 0 ? std::min(good + step, most) : bad - std::min(step, bad - 1);
            step *= 2;
        }
    }
    return good;
}

// From the first vertex to the one of a number, where the line piece ends.
void LineSmoother::make_curve(const Fit& fit,
                              bool begins,
                              std::size_t passed,
                              path::Move& piece) const noexcept
{
    if (begins) {
        piece.start_lean = lean_of(start_.end.tangent, between(0, 1));
    }
    if (passed + 1 == vertices_.size()) {
        piece.end_lean = lean_of(fit.end.end.tangent, between(passed - 1, passed));
    }
    piece.end = piece.end + to_position(to_double(fit.end.at));
    // The chord of whole nanometres.
    piece.path =
        hermite(millimetres(piece.end - piece.start), start_.end, fit.end.end, fit.piece.length);
}

bool LineSmoother::next(Patience patience, path::Move& piece) noexcept
{
    const bool ending = patience == Patience::kNone;
    const std::size_t lines = vertices_.empty() ? 0 : vertices_.size() - 1;
    if (ending && lines == 0) {
        vertices_.clear();
    }
    if (lines == 0 || (patience == Patience::kFull && !vertices_.full())) {
        return false;
    }
    // The lines that knots at the last vertices may need.
    const std::size_t beyond = ending ? 0 : knot_lines_before(lines);
    if (lines <= beyond) {
        return false;
    }
    const bool begins = !has_start_;
    if (begins) {
        start_ = knot_at(0);
        has_start_ = true;
    }
    const std::size_t most = std::min(lines - beyond, kMostLines);
    Fit best{};
    const std::size_t good = longest_fit(most, best);
    // The number of the first line: a reported line is never ahead of the tool.
    piece.line = vertices_[1].line;
    piece.kind = kind_;
    piece.feed = feed_;
    piece.tolerance = tolerance_;
    piece.power = power_;
    piece.departure = departure_;
    piece.start_lean = {};
    piece.end_lean = {};
    piece.start = at_;
    const std::size_t passed = std::max<std::size_t>(good, 1);
    lines_before_ = static_cast<std::uint8_t>(passed);
    const AxisVec<std::int32_t> vertex = vertices_[passed].at;
    piece.end = origin_ + wide(vertex);
    piece.path = path::Line{};
    // If not even one line can be rounded it stays, and its ends are corners.
    has_start_ = good != 0;
    if (good == 0) {
        piece.departure = begins ? 0.0F : departure_;
        piece.end_lean = lean_of(unit(millimetres(piece.end - piece.start)), between(0, 1));
    } else {
        make_curve(best, begins, passed, piece);
        start_ = best.end;
    }
    at_ = piece.end;
    drop(passed);
    return true;
}

void LineSmoother::drop(std::size_t count) noexcept
{
    std::copy(vertices_.begin() + count, vertices_.end(), vertices_.begin());
    vertices_.shrink(vertices_.size() - count);
    const AxisVec<std::int32_t> first = vertices_[0].at;
    if (travel({}, first) <= kFarthest) {
        return;
    }
    origin_ = origin_ + wide(first);
    for (Vertex& vertex : vertices_) {
        vertex.at = vertex.at - first;
    }
}

}  // namespace cusp::planner
