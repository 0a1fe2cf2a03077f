// The writer tracks the rounded position, so that its deltas are those that the controller computes.
#include "host_tools/geometry/toolpath/gcode_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>

#include "firmware/base/inch.hpp"
#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/toolpath/arc_geometry.hpp"
#include "host_tools/geometry/toolpath/drilled_holes.hpp"
#include "host_tools/geometry/toolpath/gcode_text.hpp"
#include "host_tools/geometry/toolpath/rounded_arc.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::toolpath {

using nurbs::Curve;

namespace {

// Arcs that leave their chord by less than this, in mm, are lines.
constexpr double kLeastSagitta = 1e-4;
// Arcs of posts with fewer decimals or a radius leave the planned one by at most this (post.hpp), in last
// decimals, and become lines below half a last decimal.
constexpr double kMostArcDeviation = 1.5;
constexpr double kLeastRoundedSagitta = 0.5;
constexpr double kMostSweepByRadius = kPi / 2 + 1e-6;  // there the middle moves by 0.42 of it
constexpr int kMostLineNumber = 99999;

using Place = std::array<std::int64_t, 3>;  // in units of the last decimal

class ProgramWriter {
public:
    ProgramWriter(std::ostream& out, const ProgramForm& form)
        : out_{out},
          form_{form},
          post_{form.post},
          unit_{form.inch ? kMillimetresPerInch : 1.0},
          decimals_{form.post.decimals(form.inch)},
          scale_{std::llround(elementary::power_of_ten(decimals_))},
          grain_{unit_ / static_cast<double>(scale_)},
          measures_arcs_{added_rounding(form.post, form.inch) > 0 ||
                         form.post.arcs == ArcForm::kRadius}
    {
    }

    void begin(const std::vector<PlannedOperation>& operations);
    void operation(const Toolpath& path);
    void end();

private:
    Place rounded(Vec3d p) const
    {
        return {std::llround(p.x / grain_), std::llround(p.y / grain_), std::llround(p.z / grain_)};
    }
    Vec3d millimetres(const Place& p) const
    {
        const auto mm = [&](std::size_t axis) {
            return static_cast<double>(p[axis]) * grain_;
        };
        return {mm(0), mm(1), mm(2)};
    }
    Vec3d place() const { return millimetres(at_.value_or(Place{})); }
    std::string coordinate(std::int64_t value) const
    {
        std::string text;
        add_scaled(text, value, scale_, post_.point);
        return text;
    }
    std::string clearance() const { return coordinate(rounded({0, 0, form_.clearance_z})[2]); }
    using Values = std::vector<std::pair<std::string, std::string>>;
    void put(std::string_view line);
    void put_comment(const std::string& text) { out_ << comment_lines(text, post_.comments); }
    void put_all(const std::vector<std::string>& lines, const Values& values);
    void retract();
    void spindle_and_coolant(const Toolpath& path);
    void end_coolant();
    void add_changed_axes(std::string& text, const Place& to) const;
    std::string feed_word(double feed);
    std::string rapid_word() { return post_.rapid_feed > 0 ? feed_word(post_.rapid_feed) : ""; }
    void rapid(Vec3d to);
    void change_tool(const Toolpath& path);
    void line(const char* word, Vec3d end, const std::string& feed);
    void arc(const ArcTo& to, const std::string& feed);
    void halves(const ArcTo& to, const ArcShape& shape, const std::string& feed);
    // In the arc's plane, in last decimals.
    static Vec2d in_plane(const ArcTo& to, const Place& p)
    {
        const auto axes = axes_of(to.plane);
        return {static_cast<double>(p[axes[0]]), static_cast<double>(p[axes[1]])};
    }
    std::array<std::int64_t, 2> written_centre(const ArcTo& to, const Place& end) const;
    bool leaves_arc(const ArcTo& to,
                    const Place& end,
                    std::array<std::int64_t, 2> centre,
                    std::int64_t radius) const;
    void nurbs(const Curve& curve, const std::string& feed);
    void move(const Toolpath& path, const ToolMove& move);
    void cycles(const Toolpath& path);

    std::ostream& out_;
    const ProgramForm& form_;
    const Post& post_;
    double unit_;  // mm
    int decimals_;
    std::int64_t scale_;  // of the last decimal in a unit
    double grain_;        // mm of the last decimal
    bool measures_arcs_;
    std::optional<Place> at_;
    Vec3d planned_at_{};       // mm: the same before rounding
    bool knows_plan_place_{};  // x and y of at_
    ArcPlane plane_{ArcPlane::kXY};
    double feed_{};
    double rpm_{};
    Coolant coolant_{Coolant::kOff};
    int number_{};  // of the line
    int tool_{};    // none yet
    bool wrote_{};  // a line, by the move at hand
    std::string line_;
};

// Comments, tapes' ends and program numbers have no line number.
void ProgramWriter::put(std::string_view line)
{
    const bool numbered = post_.line_numbers > 0 && !line.empty() &&
                          std::string_view{"(;%O:"}.find(line[0]) == std::string_view::npos;
    if (numbered) {
        number_ += post_.line_numbers;
        number_ = number_ > kMostLineNumber ? post_.line_numbers : number_;
        const fmt::format_int digits{number_};
        out_ << 'N';
        out_.write(digits.data(), static_cast<std::streamsize>(digits.size())) << ' ';
    }
    out_.write(line.data(), static_cast<std::streamsize>(line.size())) << '\n';
}

void ProgramWriter::put_all(const std::vector<std::string>& lines, const Values& values)
{
    for (const std::string& line : lines) {
        std::string text = filled(line, values);
        text.erase(text.find_last_not_of(' ') + 1);  // of a comment that there is none of
        if (!text.empty()) {
            put(text);
        }
    }
}

void ProgramWriter::begin(const std::vector<PlannedOperation>& operations)
{
    put_all(post_.begin, {});
    put_comment(form_.title);
    for (const PlannedOperation& operation : operations) {
        for (const std::string& text : operation.path.comments) {
            put_comment(text);
        }
    }
    put_all(post_.modes, {{"units", form_.inch ? "G20" : "G21"},
                          {"offset", fmt::format("G{}", form_.work_offset)},
                          {"clearance", clearance()}});
    if (form_.blend_tolerance) {
        put_all(post_.blend,
                {{"tolerance", fixed_point(*form_.blend_tolerance / unit_, decimals_ + 1)}});
    } else {
        put_all(post_.exact_path, {});
    }
    put_all(post_.header, {});
}

void ProgramWriter::retract()
{
    const std::int64_t z = rounded({0, 0, form_.clearance_z})[2];
    if (at_ && (*at_)[2] < z) {
        put("G0 Z" + coordinate(z) + rapid_word());
        (*at_)[2] = z;
    }
}

void ProgramWriter::end_coolant()
{
    if (coolant_ != Coolant::kOff) {
        put_all(post_.coolant_off, {});
        coolant_ = Coolant::kOff;
    }
}

void ProgramWriter::end()
{
    retract();
    end_coolant();
    put_all(post_.footer, {});
    put_all(post_.end, {});
}

void ProgramWriter::add_changed_axes(std::string& text, const Place& to) const
{
    for (unsigned axis = 0; axis < 3; ++axis) {
        const bool known = at_ && (axis == 2 || knows_plan_place_);
        if (!known || (*at_)[axis] != to[axis]) {
            text += ' ';
            text += "XYZ"[axis];
            add_scaled(text, to[axis], scale_, post_.point);
        }
    }
}

std::string ProgramWriter::feed_word(double feed)
{
    if (feed == feed_) {
        return "";
    }
    feed_ = feed;
    return " F" + feed_text(feed / unit_, post_.point);
}

void ProgramWriter::rapid(Vec3d to)
{
    const double before = feed_;
    wrote_ = false;
    line("G0", to, rapid_word());
    feed_ = wrote_ ? feed_ : before;
    planned_at_ = to;
}

void ProgramWriter::spindle_and_coolant(const Toolpath& path)
{
    if (path.spindle > 0 && path.spindle != rpm_) {
        rpm_ = path.spindle;
        put_all(post_.spindle_on, {{"rpm", fixed_point(rpm_, 1)}});
    }
    if (path.tool.coolant != coolant_) {
        end_coolant();
        coolant_ = path.tool.coolant;
        if (coolant_ != Coolant::kOff) {
            put_all(coolant_ == Coolant::kMist ? post_.mist : post_.flood, {});
        }
    }
}

void ProgramWriter::change_tool(const Toolpath& path)
{
    if (path.tool.number == tool_) {
        spindle_and_coolant(path);
        return;
    }
    const bool first = tool_ == 0;
    tool_ = path.tool.number;
    if (!first) {
        retract();
        end_coolant();
        rpm_ = 0;  // the change stops the spindle
    }
    const bool named = !path.tool_name.empty();
    const char* unit = form_.inch ? "inch" : "mm";
    const std::string text = tool_text(path, unit_, unit);
    const bool fits = text.size() <= kCommentWidth;
    const std::string name = named ? path.tool_name : fits ? text : "tool " + std::to_string(tool_);
    const std::vector<std::string>& lines = first ? post_.first_tool : post_.next_tool;
    // within a line the comment is short and may lack the sizes
    if (std::count(lines.begin(), lines.end(), "{comment}") == 0 && (named || !fits)) {
        put_comment(tool_sizes(path.tool, unit_, unit));
    }
    for (const std::string& line : lines) {
        if (line == "{comment}") {
            put_comment(text);
        } else {
            put_all({line}, {{"tool", std::to_string(tool_)},
                             {"comment", comment_word(name, post_.comments)},
                             {"clearance", clearance()}});
        }
    }
    spindle_and_coolant(path);
    if (!post_.after_tool.empty()) {
        put_all(post_.after_tool, {{"tool", std::to_string(tool_)}, {"clearance", clearance()}});
        at_ = rounded({0, 0, form_.clearance_z});
        knows_plan_place_ = false;
    }
}

void ProgramWriter::line(const char* word, Vec3d end, const std::string& feed)
{
    const Place to = rounded(end);
    line_ = word;
    const std::size_t size = line_.size();
    add_changed_axes(line_, to);
    if (line_.size() == size) {
        return;
    }
    line_ += feed;
    put(line_);
    wrote_ = true;
    at_ = to;
    knows_plan_place_ = true;
}

void ProgramWriter::halves(const ArcTo& to, const ArcShape& shape, const std::string& feed)
{
    ArcTo first = to;
    first.end = point_on(shape, 0.5);
    arc(first, feed);
    planned_at_ = first.end;
    arc(to, wrote_ ? "" : feed);
}

std::array<std::int64_t, 2> ProgramWriter::written_centre(const ArcTo& to, const Place& end) const
{
    const auto axes = axes_of(to.plane);
    const Vec2d wanted{to.centre[axes[0]] / grain_, to.centre[axes[1]] / grain_};
    return fitted_centre(in_plane(to, *at_), in_plane(to, end), wanted);
}

bool ProgramWriter::leaves_arc(const ArcTo& to,
                               const Place& end,
                               std::array<std::int64_t, 2> centre,
                               std::int64_t radius) const
{
    const auto axes = axes_of(to.plane);
    Vec2d c{static_cast<double>(centre[0]), static_cast<double>(centre[1])};
    if (post_.arcs == ArcForm::kRadius) {
        c = centre_of_radius(in_plane(to, *at_), in_plane(to, end), static_cast<double>(radius),
                             to.clockwise);
    }
    ArcTo written = to;
    written.end = millimetres(end);
    written.centre[axes[0]] = c.x * grain_;
    written.centre[axes[1]] = c.y * grain_;
    return arc_deviation(arc_shape(place(), written), to) > kMostArcDeviation * grain_;
}

void ProgramWriter::arc(const ArcTo& to, const std::string& feed)
{
    const Place end = rounded(to.end);
    const auto axes = axes_of(to.plane);
    const ArcShape shape = arc_shape(place(), to);
    // Rounding may carry the start past the end: the planned sweep counts.
    const ArcShape planned = arc_shape(planned_at_, to);
    if (std::abs(planned.sweep) < kPi && std::abs(shape.sweep) > 1.5 * kPi) {
        line("G1", to.end, feed);
        return;
    }
    if (std::abs(planned.sweep) > 1.5 * kPi && std::abs(shape.sweep) < kPi / 2) {
        halves(to, planned, feed);
        return;
    }
    const bool same = (*at_)[axes[0]] == end[axes[0]] && (*at_)[axes[1]] == end[axes[1]];
    const double half_sweep = std::min(std::abs(shape.sweep), kPi) / 2;
    const double sagitta = shape.start_radius * (1 - elementary::cos(half_sweep));
    const double least =
        measures_arcs_ ? std::max(kLeastSagitta, kLeastRoundedSagitta * grain_) : kLeastSagitta;
    if ((same && std::abs(shape.sweep) < kPi) || sagitta < least) {
        line("G1", to.end, feed);
        return;
    }
    const bool by_radius = post_.arcs == ArcForm::kRadius;
    if (by_radius && (same || std::abs(shape.sweep) > kMostSweepByRadius)) {
        halves(to, planned, feed);
        return;
    }
    const std::int64_t radius = std::llround(shape.end_radius / grain_);
    const auto centre = written_centre(to, end);
    if (measures_arcs_ && leaves_arc(to, end, centre, radius)) {
        halves(to, planned, feed);
        return;
    }
    line_.clear();
    if (to.plane != plane_) {
        plane_ = to.plane;
        line_ = plane_ == ArcPlane::kXY ? "G17 " : plane_ == ArcPlane::kZX ? "G18 " : "G19 ";
    }
    line_ += to.clockwise ? "G2" : "G3";
    add_changed_axes(line_, end);
    if (by_radius) {
        line_ += " R" + coordinate(radius);
    }
    for (unsigned k = 0; k < 2 && !by_radius; ++k) {
        const std::int64_t offset = centre[k] - (*at_)[axes[k]];
        if (offset != 0) {
            line_ += ' ';
            line_ += "IJK"[axes[k]];
            add_scaled(line_, offset, scale_, post_.point);
        }
    }
    put(line_ + feed);
    wrote_ = true;
    at_ = end;
}

void ProgramWriter::nurbs(const Curve& given, const std::string& feed)
{
    const Curve curve = clamped(given);
    wrote_ = true;
    const double begin = curve.domain_begin();
    const auto spans = static_cast<double>(curve.points.size()) - curve.degree;
    const double scale = spans / (curve.domain_end() - begin);
    const auto knot = [&](std::size_t i) {
        return " K" + nine_digits((curve.knots[i] - begin) * scale);
    };
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        const Place p = rounded(curve.points[i]);
        std::string words = fmt::format("{} X{} Y{} Z{}", knot(i), coordinate(p[0]),
                                        coordinate(p[1]), coordinate(p[2]));
        words = i == 0 ? fmt::format("G6.2 P{}", curve.degree + 1) + words : words.substr(1);
        if (const double weight = curve.weights[i] / curve.weights[0]; weight != 1.0) {
            words += " R" + nine_digits(weight);
        }
        put(words + (i == 0 ? feed : ""));
        at_ = p;
    }
    for (std::size_t i = curve.points.size(); i < curve.knots.size(); ++i) {
        put(knot(i).substr(1));
    }
}

void ProgramWriter::move(const Toolpath& path, const ToolMove& move)
{
    if (move.kind == MoveKind::kRapid) {
        rapid(end_of(move));
        return;
    }
    // a feed is spoken for only when a line is written, which a vanishing move is not
    const double before = feed_;
    const std::string feed = feed_word(feed_of(path, move, place()));
    wrote_ = false;
    if (const auto* to = std::get_if<LineTo>(&move.shape)) {
        line("G1", to->end, feed);
    } else if (const auto* round = std::get_if<ArcTo>(&move.shape)) {
        arc(*round, feed);
    } else {
        nurbs(std::get<NurbsTo>(move.shape).curve, feed);
    }
    feed_ = wrote_ ? feed_ : before;
    planned_at_ = end_of(move);
}

// G98: after each hole up to where the cycle began, which is the clearance.
void ProgramWriter::cycles(const Toolpath& path)
{
    const std::vector<DrilledHole> holes = drilled_holes(path);
    Place at = rounded({holes.front().bottom.x, holes.front().bottom.y, form_.clearance_z});
    const std::int64_t clearance = at[2];
    double r{};  // the R word that holds
    rapid(millimetres(at));
    const std::int64_t peck = rounded({0, 0, path.cycle->peck})[2];
    for (const DrilledHole& hole : holes) {
        const bool first = at[2] == clearance;
        const Place to = rounded(hole.bottom);
        std::string text = first ? peck > 0 ? "G98 G83 " : "G98 G81 " : "";
        text += "X" + coordinate(to[0]) + " Y" + coordinate(to[1]) +
                (to[2] != at[2] ? " Z" + coordinate(to[2]) : "");
        text += first || hole.above != r ? " R" + coordinate(rounded({0, 0, hole.above})[2]) : "";
        r = hole.above;
        put(text + (first && peck > 0 ? " Q" + coordinate(peck) : "") + feed_word(hole.feed));
        at = to;
    }
    put("G80");
    at_ = Place{at[0], at[1], clearance};
    planned_at_ = millimetres(*at_);
    knows_plan_place_ = true;
}

void ProgramWriter::operation(const Toolpath& path)
{
    change_tool(path);
    if (post_.drill_cycles && path.cycle && !path.moves.empty()) {
        cycles(path);
        return;
    }
    for (const ToolMove& m : path.moves) {
        move(path, m);
    }
}

}  // namespace

std::vector<std::size_t> write_program(std::ostream& out,
                                       const ProgramForm& form,
                                       const std::vector<PlannedOperation>& operations)
{
    const std::ostream::pos_type start = out.tellp();
    std::vector<std::size_t> begins;
    ProgramWriter writer{out, form};
    writer.begin(operations);
    for (const PlannedOperation& operation : operations) {
        begins.push_back(static_cast<std::size_t>(out.tellp() - start));
        if (!operation.path.moves.empty()) {
            writer.operation(operation.path);
        }
    }
    writer.end();
    return begins;
}

}  // namespace cusp::toolpath
