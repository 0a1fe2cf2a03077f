// The figures of a run as JSON, for the page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "firmware/base/machine_limits.hpp"
#include "host_tools/controller/program_run/program_run.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/view/left_map.hpp"
#include "host_tools/judge/view/program_reading.hpp"

namespace cusp::view {

struct RunFacts {
    std::string program;
    const ProgramReading& reading;
    const program_run::RunResult& run;
    const MachineLimits& limits;
    std::uint64_t ticks;
    std::uint64_t start_us;
    std::int64_t farthest_nm;  // greatest distance of an axis from the start of the run
    const job::Job* job;
    const verify::Verification* verification;  // null: not verified
    std::string not_verified;                  // the reason
    std::vector<WorstPlace> worst;
};

// JSON that is safe inside a <script> of HTML, for any bytes in names and comments.
std::string facts_json(const RunFacts& facts);

}  // namespace cusp::view
