// The writer keeps the rounded position, so that what it writes is what the controller sums up.
#include "host_tools/toolpath/gcode_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "firmware/base/math.hpp"
#include "host_tools/nurbs/knot_insertion.hpp"
#include "host_tools/toolpath/arc_geometry.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::toolpath {

using nurbs::Curve;

namespace {

constexpr double kMillimetresPerInch = 25.4;
constexpr int kDecimalsInMillimetres = 4;
constexpr int kDecimalsInInches = 5;
constexpr int kFeedDecimals = 3;
constexpr int kKnotDigits = 9;
// Arcs that leave their chord by less than this, in mm, are lines.
constexpr double kLeastSagitta = 1e-4;
constexpr std::size_t kCommentWidth = 72;

using Place = std::array<std::int64_t, 3>;  // in units of the last decimal

std::string trimmed(std::string text)
{
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') {
            text.pop_back();
        }
    }
    return text == "-0" ? "0" : text;
}

// A knot or a weight: nine digits in all.
std::string nine_digits(double value)
{
    int before_point = 1;
    for (double limit = 10; std::abs(value) >= limit && before_point < kKnotDigits; limit *= 10) {
        ++before_point;
    }
    return fixed_point(value, kKnotDigits - before_point);
}

// What controllers take out of the stream as a command, or as the end of the comment, is none here.
char plain_character(char c)
{
    const bool printable = c >= ' ' && c <= '~';
    const bool command = c == '!' || c == '?' || c == '~' || c == '%';
    return c == '(' ? '[' : c == ')' ? ']' : printable && !command ? c : '_';
}

// As many comments as the text needs: a controller's line is short.
std::string comment_lines(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), plain_character);
    std::string lines;
    while (text.size() > kCommentWidth) {
        const std::size_t blank = text.rfind(' ', kCommentWidth);
        const bool between_words = blank != std::string::npos && blank > 0;
        const std::size_t end = between_words ? blank : kCommentWidth;
        lines += "(" + text.substr(0, end) + ")\n";
        text.erase(0, between_words ? end + 1 : end);
    }
    return lines + "(" + text + ")\n";
}

std::string tool_text(const Tool& tool, double unit, const char* name)
{
    std::string text = fmt::format("tool {} {} diameter {} {}", tool.number, name_of(tool.shape),
                                   fixed_point(2 * tool.radius / unit, 4), name);
    if (tool.shape == ToolShape::kBull) {
        text +=
            fmt::format(" corner radius {} {}", fixed_point(tool.corner_radius / unit, 4), name);
    }
    if (is_conical(tool)) {
        text += fmt::format(" tip angle {}", fixed_point(tool.tip_angle * 180 / kPi, 2));
    }
    return text;
}

class ProgramWriter {
public:
    ProgramWriter(std::ostream& out, const ProgramForm& form)
        : out_{out},
          form_{form},
          unit_{form.inch ? kMillimetresPerInch : 1.0},
          decimals_{form.inch ? kDecimalsInInches : kDecimalsInMillimetres},
          scale_{std::llround(std::pow(10.0, decimals_))},
          grain_{unit_ / static_cast<double>(scale_)}
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
    // Where the tool is, mm.
    Vec3d place() const
    {
        const Place at = at_.value_or(Place{});
        const auto mm = [&](std::size_t axis) {
            return static_cast<double>(at[axis]) * grain_;
        };
        return {mm(0), mm(1), mm(2)};
    }
    void add_coordinate(std::string& text, std::int64_t value) const;
    std::string coordinate(std::int64_t value) const
    {
        std::string text;
        add_coordinate(text, value);
        return text;
    }
    void add_changed_axes(std::string& text, const Place& to) const;
    std::string feed_word(double feed);
    void change_tool(const Toolpath& path);
    void line(const char* word, Vec3d end, const std::string& feed);
    void arc(const ArcTo& to, const std::string& feed);
    void nurbs(const Curve& curve, const std::string& feed);
    void move(const Toolpath& path, const ToolMove& move);

    std::ostream& out_;
    const ProgramForm& form_;
    double unit_;  // mm
    int decimals_;
    std::int64_t scale_;  // of the last decimal in a unit
    double grain_;        // mm of the last decimal
    std::optional<Place> at_;
    ArcPlane plane_{ArcPlane::kXY};
    double feed_{};
    int tool_{};    // none yet
    bool wrote_{};  // a line, by the move at hand
    std::string line_;
};

void ProgramWriter::add_coordinate(std::string& text, std::int64_t value) const
{
    const std::int64_t size = std::abs(value);
    const fmt::format_int whole{size / scale_};
    if (value < 0) {
        text += '-';
    }
    text.append(whole.data(), whole.size());
    if (const std::int64_t below = size % scale_; below != 0) {
        // The leading one keeps the zeros of what is below one.
        const fmt::format_int digits{scale_ + below};
        std::size_t count = digits.size();
        while (digits.data()[count - 1] == '0') {
            --count;
        }
        text += '.';
        text.append(digits.data() + 1, count - 1);
    }
}

void ProgramWriter::begin(const std::vector<PlannedOperation>& operations)
{
    out_ << comment_lines(form_.title);
    for (const PlannedOperation& operation : operations) {
        for (const std::string& text : operation.path.comments) {
            out_ << comment_lines(text);
        }
    }
    out_ << (form_.inch ? "G17 G20 G40 G49 G54 G80 G90 G94\n"
                        : "G17 G21 G40 G49 G54 G80 G90 G94\n");
    out_ << "G0 Z" << coordinate(rounded({0, 0, form_.clearance_z})[2]) << '\n';
    if (form_.blend_tolerance) {
        out_ << "G64 P" << fixed_point(*form_.blend_tolerance / unit_, decimals_ + 1) << '\n';
    } else {
        out_ << "G61\n";
    }
}

void ProgramWriter::end()
{
    const std::int64_t z = rounded({0, 0, form_.clearance_z})[2];
    if (at_ && (*at_)[2] < z) {
        out_ << "G0 Z" << coordinate(z) << '\n';
    }
    out_ << "M5\nM30\n";
}

void ProgramWriter::add_changed_axes(std::string& text, const Place& to) const
{
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (!at_ || (*at_)[axis] != to[axis]) {
            text += ' ';
            text += "XYZ"[axis];
            add_coordinate(text, to[axis]);
        }
    }
}

std::string ProgramWriter::feed_word(double feed)
{
    if (feed == feed_) {
        return "";
    }
    feed_ = feed;
    return " F" + fixed_point(feed / unit_, kFeedDecimals);
}

void ProgramWriter::change_tool(const Toolpath& path)
{
    if (path.tool.number == tool_) {
        return;
    }
    const bool first = tool_ == 0;
    tool_ = path.tool.number;
    if (!first) {
        const std::int64_t z = rounded({0, 0, form_.clearance_z})[2];
        if (at_ && (*at_)[2] < z) {
            out_ << "G0 Z" << coordinate(z) << '\n';
            (*at_)[2] = z;
        }
        out_ << "M5\n";
    }
    out_ << comment_lines(tool_text(path.tool, unit_, form_.inch ? "inch" : "mm"));
    out_ << "T" << tool_ << '\n';
    if (!first) {
        out_ << "M0\n";
    }
    if (path.spindle > 0) {
        out_ << "M3 S" << fixed_point(path.spindle, 1) << '\n';
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
    line_ += '\n';
    out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
    wrote_ = true;
    at_ = to;
}

// The centre that suits the rounded ends: on their bisector, then rounded to the grain point with
// the least difference of radii.
std::array<std::int64_t, 2> fitted_centre(Vec2d start, Vec2d end, Vec2d wanted)
{
    const Vec2d chord = end - start;
    const double squared = dot(chord, chord);
    if (squared > 0) {
        wanted = wanted + (dot(0.5 * (start + end) - wanted, chord) / squared) * chord;
    }
    std::array<std::int64_t, 2> best{};
    double least = kUnbounded;
    for (std::int64_t i = -1; i <= 1; ++i) {
        for (std::int64_t j = -1; j <= 1; ++j) {
            const std::array<std::int64_t, 2> candidate{std::llround(wanted.x) + i,
                                                        std::llround(wanted.y) + j};
            const Vec2d c{static_cast<double>(candidate[0]), static_cast<double>(candidate[1])};
            // the distance from the wanted centre breaks ties
            constexpr double kTie = 0.01;
            const double mismatch =
                std::abs(norm(start - c) - norm(end - c)) + kTie * norm(c - wanted);
            if (mismatch < least) {
                least = mismatch;
                best = candidate;
            }
        }
    }
    return best;
}

void ProgramWriter::arc(const ArcTo& to, const std::string& feed)
{
    const Place end = rounded(to.end);
    const auto axes = axes_of(to.plane);
    const ArcShape shape = arc_shape(place(), to);
    const bool same = (*at_)[axes[0]] == end[axes[0]] && (*at_)[axes[1]] == end[axes[1]];
    const double sagitta =
        shape.start_radius * (1 - std::cos(std::min(std::abs(shape.sweep), kPi) / 2));
    if ((same && std::abs(shape.sweep) < kPi) || sagitta < kLeastSagitta) {
        line("G1", to.end, feed);
        return;
    }
    const auto in_grains = [&](const Place& p) {
        return Vec2d{static_cast<double>(p[axes[0]]), static_cast<double>(p[axes[1]])};
    };
    const Vec2d wanted{to.centre[axes[0]] / grain_, to.centre[axes[1]] / grain_};
    const auto centre = fitted_centre(in_grains(*at_), in_grains(end), wanted);
    if (to.plane != plane_) {
        plane_ = to.plane;
        out_ << (plane_ == ArcPlane::kXY ? "G17 " : plane_ == ArcPlane::kZX ? "G18 " : "G19 ");
    }
    line_ = to.clockwise ? "G2" : "G3";
    add_changed_axes(line_, end);
    for (unsigned k = 0; k < 2; ++k) {
        const std::int64_t offset = centre[k] - (*at_)[axes[k]];
        if (offset != 0) {
            line_ += ' ';
            line_ += "IJK"[axes[k]];
            add_coordinate(line_, offset);
        }
    }
    out_ << line_ << feed << '\n';
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
        if (i == 0) {
            out_ << "G6.2 P" << curve.degree + 1;
        }
        const std::string words = fmt::format("{} X{} Y{} Z{}", knot(i), coordinate(p[0]),
                                              coordinate(p[1]), coordinate(p[2]));
        out_ << (i == 0 ? words : words.substr(1));
        if (const double weight = curve.weights[i] / curve.weights[0]; weight != 1.0) {
            out_ << " R" << nine_digits(weight);
        }
        out_ << (i == 0 ? feed : "") << '\n';
        at_ = p;
    }
    for (std::size_t i = curve.points.size(); i < curve.knots.size(); ++i) {
        out_ << knot(i).substr(1) << '\n';
    }
}

void ProgramWriter::move(const Toolpath& path, const ToolMove& move)
{
    if (move.kind == MoveKind::kRapid) {
        line("G0", end_of(move), "");
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
    if (!wrote_) {
        feed_ = before;
    }
}

void ProgramWriter::operation(const Toolpath& path)
{
    change_tool(path);
    for (const ToolMove& m : path.moves) {
        move(path, m);
    }
}

}  // namespace

std::string fixed_point(double value, int decimals)
{
    return trimmed(fmt::format("{:.{}f}", value, decimals));
}

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
        writer.operation(operation.path);
    }
    writer.end();
    return begins;
}

}  // namespace cusp::toolpath
