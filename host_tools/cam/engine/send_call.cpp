// cusp stream without its port: what goes to a controller for a program, from its beginning or from a line that the tool had reached.
#include <cmath>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/dialect/refusal.hpp"
#include "host_tools/controller/stream/approach.hpp"
#include "host_tools/controller/stream/controller_facts.hpp"
#include "host_tools/controller/stream/resume_point.hpp"

#include "fmt/format.h"

namespace cusp::engine {

using dialect::ProgramLine;
using dialect::ProgramLines;
using stream::ControllerFacts;

namespace {

ControllerFacts facts_of(const std::vector<std::string>& listing)
{
    ControllerFacts facts;
    for (const std::string& line : listing) {
        facts.take(line);
    }
    return facts;
}

// The argument as a place of the machine; the upper ends of the travel where it is absent.
Position place_of(const Call& call, const char* key)
{
    const std::vector<double> place = call.arguments.find_numbers(key);
    constexpr double kFarthest = 1e7;  // mm
    if (!place.empty() && place.size() != kLinearAxes && place.size() != kAxisCount) {
        throw InputError{fmt::format("send: {}: needs a number for each axis", key)};
    }
    AxisVecd at;
    for (unsigned axis = 0; axis < place.size(); ++axis) {
        if (!(std::abs(place[axis]) <= kFarthest)) {
            throw InputError{fmt::format("send: {}: is no place of a machine", key)};
        }
        at[axis] = place[axis];
    }
    return to_position(at);
}

class SentLines {
public:
    explicit SentLines(bool numbers) : numbers_{numbers} {}

    //   as   the number that the line carries
    void add(std::uint64_t line, std::uint64_t as, const std::string& text)
    {
        text_ += fmt::format("{}\t{}\n", line, numbers_ ? dialect::numbered_line(text, as) : text);
        ++count_;
    }
    // Throws where the controller would take a byte of the line for a command of the operator.
    void add(const std::string& program, const ProgramLine& line)
    {
        constexpr int kNoLetter = 1;
        if (dialect::realtime_byte(line.text)) {
            throw InputError{fmt::format("{}:{}: error:1: {}", program, line.number,
                                         dialect::refusal(kNoLetter, line.text).text)};
        }
        add(line.number, line.number, line.text);
    }
    std::uint64_t count() const { return count_; }
    std::string take() { return std::move(text_); }

private:
    bool numbers_;
    std::uint64_t count_{0};
    std::string text_;
};

stream::TransferRecord record_of(const Call& call, double line)
{
    const ControllerFacts start = facts_of(call.arguments.find_texts("start"));
    stream::TransferRecord record;
    record.start = start.start_at(place_of(call, "start_place"));
    record.executed_line = static_cast<std::uint64_t>(line);
    return record;
}

Json way_json(const stream::ResumePoint& point, const stream::Approach& way)
{
    Json json = {{"line", point.line},
                 {"tool", point.modal.tool},
                 {"point", {way.point.x, way.point.y, way.point.z}},
                 {"travel_z", way.safe_z},
                 {"plunges", way.plunges},
                 {"plunge_feed", way.plunge_feed}};
    json["spindle"] = point.modal.spindle == gcode::SpindleMode::kOff
                          ? 0.0
                          : static_cast<double>(point.modal.spindle_speed);
    return json;
}

}  // namespace

Json send_call(Call& call)
{
    constexpr double kMostLine = 1e9;
    const std::string program = call.arguments.text("program");
    const auto line = call.arguments.find_number("line");
    const auto safe_z = call.arguments.find_number("safe_z");
    SentLines lines{call.arguments.flag("numbers", true)};
    Json result = Json::object();
    std::uint64_t first = 0;
    if (line) {
        if (!(*line >= 1 && *line <= kMostLine)) {
            throw InputError{"send: line: is no line of a program"};
        }
        const stream::TransferRecord record = record_of(call, *line);
        const ControllerFacts now = facts_of(call.arguments.find_texts("now"));
        const Position machine = place_of(call, "place");
        call.arguments.check_all_read();
        const stream::ResumePoint point = find_resume_point(program, record);
        const stream::Approach way =
            make_approach(point, record.start.parameters, now.parameters(), machine, safe_z);
        for (const std::string& of_way : way.lines) {
            lines.add(0, point.line, of_way);
        }
        result["way"] = way_json(point, way);
        first = point.line;
    }
    call.arguments.check_all_read();
    ProgramLines source{program};
    while (const auto next = source.next()) {
        if (next->number >= first) {
            lines.add(program, *next);
        }
    }
    result["lines"] = lines.count();
    result["block"] = "lines";
    call.blocks.push_back({"lines", lines.take()});
    return result;
}

}  // namespace cusp::engine
