// Feeds a program to gcode::Interpreter line by line, and samples the resulting moves.
#include "host_tools/judge/verify/program_moves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "firmware/gcode/interpreter.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/dialect/refusal.hpp"
#include "host_tools/judge/verify/tool_comment.hpp"

#include "fmt/format.h"

namespace cusp::verify {

using dialect::refusal;
using toolpath::MoveCounts;
using toolpath::Tool;

namespace {

constexpr int kFirstOffset = 54;
constexpr int kOtherOffset = 60;
constexpr const char* kSuspend =
    "M600";  // Smoothieware's word for a change of the tool, which a comment names

Vec3d point_on(const path::Arc& arc, double t)
{
    const double angle = t * arc.sweep;
    const double radius = arc.radius + t * arc.radius_change;
    return xyz(arc.centre +
               radius * (elementary::cos(angle) * arc.u + elementary::sin(angle) * arc.v) +
               t * arc.axial);
}

// de Casteljau on homogeneous points.
Vec3d point_on(const path::BezierPiece& piece, double t)
{
    std::array<Vec3d, path::kMaxOrder> points;
    std::array<double, path::kMaxOrder> weights;
    for (unsigned i = 0; i < piece.order; ++i) {
        weights[i] = static_cast<double>(piece.weights[i]);
        points[i] = weights[i] * Vec3d{static_cast<double>(piece.points[i].x),
                                       static_cast<double>(piece.points[i].y),
                                       static_cast<double>(piece.points[i].z)};
    }
    for (unsigned level = piece.order; level-- > 1;) {
        for (unsigned i = 0; i < level; ++i) {
            points[i] = (1 - t) * points[i] + t * points[i + 1];
            weights[i] = (1 - t) * weights[i] + t * weights[i + 1];
        }
    }
    return points[0] / weights[0];
}

template <class Shape>
void append_sampled(
    const Shape& shape, double length, double spacing, Vec3d start, std::vector<Vec3d>& points)
{
    const int steps = std::max(1, static_cast<int>(std::ceil(length / spacing)));
    for (int i = 1; i < steps; ++i) {
        points.push_back(start + point_on(shape, static_cast<double>(i) / steps));
    }
}

void append_piece(const path::BezierPiece& piece,
                  double spacing,
                  Vec3d start,
                  std::vector<Vec3d>& points)
{
    // the parameter is not proportional to length: halve where neighbours are too far apart
    double length = 0;
    Vec3d last{};
    constexpr int kParts = 32;
    for (int i = 1; i <= kParts; ++i) {
        const double begin = static_cast<double>(i - 1) / kParts;
        const Vec3d p = point_on(piece, static_cast<double>(i) / kParts);
        length = norm(p - last);
        const int steps = std::max(1, static_cast<int>(std::ceil(1.2 * length / spacing)));
        for (int k = 1; k <= steps; ++k) {
            if (i < kParts || k < steps) {
                points.push_back(start +
                                 point_on(piece, begin + static_cast<double>(k) / steps / kParts));
            }
        }
        last = p;
    }
}

bool is_curve(gcode::Motion motion)
{
    return motion == gcode::Motion::kNurbs || motion == gcode::Motion::kUniformNurbs;
}

void count(const path::Move& move, MoveCounts& counts)
{
    if (move.kind == path::MoveKind::kRapid) {
        ++counts.rapids;
    } else if (std::holds_alternative<path::Line>(move.path)) {
        ++counts.lines;
    } else if (std::holds_alternative<path::Arc>(move.path)) {
        ++counts.arcs;
    }
}

// Posts without T words name the tool in a comment alone: "(tool 2 flat diameter 6 mm)".
std::optional<int> tool_in_comment(std::string_view line)
{
    for (const std::string_view begin : {"(tool ", "; tool "}) {
        if (line.substr(0, begin.size()) == begin) {
            const std::string digits{line.substr(begin.size(), 3)};
            const int number = std::atoi(digits.c_str());
            return number > 0 ? std::optional{number} : std::nullopt;
        }
    }
    return std::nullopt;
}

class ProgramReader {
public:
    ProgramReader(const std::string& file, double start_z) : file_{file}
    {
        interpreter_.set_position(to_position({0, 0, start_z}));
    }

    // False once the program has ended.
    bool read_line(std::string_view line)
    {
        ++number_;
        commented_tool_ = tool_in_comment(line).value_or(commented_tool_);
        take_tool(line);
        const bool was_curve = is_curve(interpreter_.modal().motion);
        const std::string words = dialect::bare_line(line);
        if (words == kSuspend) {
            return true;
        }
        const Status status = interpreter_.execute(words, number_);
        if (!status) {
            const int code = static_cast<int>(status.error());
            throw InputError(
                fmt::format("{}:{}: error {}: {}", file_, number_, code, refusal(code, line).text),
                {file_, number_, "", std::string{line}});
        }
        gcode::Action action;
        while (interpreter_.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                const int tool = interpreter_.modal().tool;
                program_.moves.push_back({of_the_tip(*move), tool != 0 ? tool : commented_tool_});
                count(*move, program_.counts);
                program_.offsets.insert(
                    std::min(kFirstOffset + interpreter_.modal().coordinate_system, kOtherOffset));
            } else if (std::holds_alternative<gcode::ProgramEnd>(action)) {
                return false;
            }
        }
        const bool curve = is_curve(interpreter_.modal().motion);
        program_.counts.nurbs += curve && !was_curve ? 1 : 0;
        return true;
    }

    Program take()
    {
        if (is_curve(interpreter_.modal().motion)) {
            throw InputError(fmt::format("{}:{}: the program ends inside a NURBS", file_, number_));
        }
        if (program_.moves.empty()) {
            throw InputError(file_ + ": no move");
        }
        return std::move(program_);
    }

private:
    void take_tool(std::string_view line)
    {
        const std::optional<Tool> tool = comments_.tool_after(line);
        if (!tool) {
            return;
        }
        const auto [known, is_new] =
            program_.tools.try_emplace(tool->number, DescribedTool{*tool, number_});
        if (!is_new && !is_same_cutter(known->second.tool, *tool)) {
            throw InputError(fmt::format("{}:{}: tool {} is another one than in a comment before",
                                         file_, number_, tool->number),
                             {file_, number_});
        }
    }

    // The interpreter's moves are the spindle's: with a tool length in force the tip is that much lower.
    path::Move of_the_tip(path::Move move) const
    {
        const std::int64_t length = interpreter_.parameters().tool_length_offset_nm;
        move.start.z -= length;
        move.end.z -= length;
        return move;
    }

    std::string file_;
    gcode::Interpreter interpreter_;
    Program program_;
    std::uint32_t number_{0};
    int commented_tool_{0};
    ToolComments comments_;
};

}  // namespace

Program read_program(const job::Job& job, const std::string& name, double start_z)
{
    const auto held = job.programs.find(name);
    const std::string text = held == job.programs.end() ? files::text_of_file(name) : *held->second;
    ProgramReader reader{name, start_z};
    dialect::LineSource source = dialect::LineSource::of_text(name, text);
    dialect::EndLine end_line;
    while (const auto line = source.next()) {
        if (end_line.at(*line) || !reader.read_line(*line)) {
            break;
        }
    }
    return reader.take();
}

void append_points(const path::Move& move, double spacing, std::vector<Vec3d>& points)
{
    const Vec3d start = xyz(to_millimetres(move.start));
    const Vec3d end = xyz(to_millimetres(move.end));
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        append_sampled(*arc, path::length(move), spacing, start, points);
    } else if (const auto* piece = std::get_if<path::BezierPiece>(&move.path)) {
        append_piece(*piece, spacing, start, points);
    } else {
        const double length = norm(end - start);
        const int steps = std::max(1, static_cast<int>(std::ceil(length / spacing)));
        for (int i = 1; i < steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            points.push_back(start + share * (end - start));
        }
    }
    points.push_back(end);
}

}  // namespace cusp::verify
