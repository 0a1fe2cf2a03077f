// A call gets arguments and files, and gives a result and blocks. Each of the calls reads its own arguments.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/engine/arguments.hpp"
#include "host_tools/cam/engine/engine.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::engine {

class Cancelled : public std::runtime_error {
public:
    Cancelled() : std::runtime_error{"the call was cancelled"} {}
};

struct Call {
    const Arguments& arguments;
    const files::FileSet& files;
    Listener& listener;
    std::vector<Block>& blocks;

    // Tells the listener the share that is done. Throws Cancelled where it asks for the end.
    void report(double share, const std::string& text) const
    {
        if (listener.cancelled()) {
            throw Cancelled{};
        }
        listener.progress(share, text);
    }
    // Adds a block. Returns its name: "gcode-0", "gcode-1" for those of one kind.
    std::string add_block(const std::string& kind, std::string bytes) const;
};

// The job of the arguments "job" and "name", one for each set-up.
std::vector<job::Job> read_setups(const Arguments& arguments);
// The job of the set-up that the program of the argument "program" is for, after those of "after".
job::Job read_job_of_program(const Arguments& arguments);

Json fault_json(const std::string& text, const InputFault& fault);

Json keys_call(Call& call);
Json describe_call(Call& call);
Json suggest_call(Call& call);
Json check_call(Call& call);
Json plan_call(Call& call);
Json verify_call(Call& call);
Json run_call(Call& call);
Json fit_call(Call& call);
Json send_call(Call& call);

}  // namespace cusp::engine
