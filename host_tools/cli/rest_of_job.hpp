// Rest machining of the operations of a job, in the order in which they are planned.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host_tools/cam/rest_machining/rest_machining.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"

namespace cusp::cli {

class RestOfJob {
public:
    // Lowers the scallop of each operation that is rest machined by what rest machining may leave,
    // so that the two together are what the job asks for. Not where the job has a rest_tolerance.
    //
    // Errors: InputError where a program can't be read or its tool is not known.
    explicit RestOfJob(job::Job& job);

    // Leaves in the results of an operation what is still stock after its programs and after the
    // operations of the job before it. Does nothing in a job without earlier programs.
    void keep(const job::Job& job,
              const job::Operation& operation,
              std::vector<toolpath::PlannedOperation>& results);

private:
    std::vector<std::string> programs_before(const job::Job& job,
                                             const job::Operation& operation) const;

    std::map<std::string, std::vector<verify::EarlierCut>> cuts_;  // by program
    std::map<int, rest_machining::RestTolerance> tolerances_;      // by the number of the operation
    std::vector<toolpath::Toolpath> paths_;                        // of the job so far
};

}  // namespace cusp::cli
