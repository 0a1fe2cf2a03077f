// A plan on its way through the stages.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/plan/rest_of_job.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/path_engagement.hpp"

namespace cusp::plan {

// The paths of one entry of job.operations: roughing and finish, in order.
struct Planned {
    std::size_t place;  // in job.operations
    std::vector<toolpath::PlannedOperation> paths;
};

// Feeds that the engagement of a path asked for.
struct FeedRange {
    double low{kUnbounded};  // mm/min
    double high{};           // 0: the feeds are as planned
    int changes{};
    double before_s{};  // time with the feeds as planned
};

struct Planning {
    job::Job& job;
    const PlanOptions& options;
    Watcher& watcher;

    toolpath::MachineRates rates{};
    machine::Settings settings{};  // of the controller that times the program
    RestOfJob rest{};
    std::vector<Planned> planned{};  // until put_in_order() moves them to the program
    PlannedProgram program{};
    std::vector<std::size_t> begins{};  // of each operation in program.gcode, bytes
    bool is_written{false};             // program.gcode has the feeds of the operations
    bool is_timed{false};               // measures have the times of program.gcode
    // Of each operation, where the job asks for it.
    std::vector<std::optional<double>> limits{};
    std::vector<verify::PathEngagement> engagement{};
    std::vector<FeedRange> feeds{};
    std::vector<double> air{};  // of each operation, the share of its time at feed

    // Says what begins. Throws Cancelled.
    void begin(const std::string& work) const;
    // Tells the watcher the share that is done. `work` outlives it.
    std::function<void(double)> reports(const char* work) const;
};

// The path of each operation, in order; they live as long as the program.
std::vector<const toolpath::Toolpath*> paths_of(const PlannedProgram& program);

// "operation 2, pocket": in sentences.
std::string words_of(const toolpath::PlannedOperation& planned);

// The operation of the job that a path is planned for.
const job::Operation& operation_of(const job::Job& job, const toolpath::PlannedOperation& planned);

}  // namespace cusp::plan
