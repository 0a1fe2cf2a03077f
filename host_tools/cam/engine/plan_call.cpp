// cusp plan.
#include <algorithm>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/job/import/post_reader.hpp"

#include "fmt/format.h"

namespace cusp::engine {

using job::Job;
using plan::PlannedProgram;

namespace {

class PlanWatcher : public plan::Watcher {
public:
    explicit PlanWatcher(Call& call) : call_{call} {}

    void operation(std::size_t place, std::size_t count, const std::string& strategy) override
    {
        operation_ = fmt::format("operation {} of {}: {}", place, count, strategy);
        call_.report(0, operation_);
    }
    void begin(const std::string& work) override
    {
        work_ = work;
        call_.report(0, work_);
    }
    void progress(const char* /*work*/, double share) override { call_.report(share, work_); }
    bool cancelled() override { return call_.listener.cancelled(); }

private:
    Call& call_;
    std::string operation_;
    std::string work_;
};

// The operations of these numbers alone; all of them where there are none.
void choose_operations(std::vector<Job>& setups, const std::vector<double>& numbers)
{
    std::size_t left = 0;
    for (Job& job : setups) {
        auto& all = job.operations;
        const auto is_other = [&](const job::Operation& operation) {
            return !numbers.empty() &&
                   std::find(numbers.begin(), numbers.end(), operation.number) == numbers.end();
        };
        all.erase(std::remove_if(all.begin(), all.end(), is_other), all.end());
        left += all.size();
    }
    if (left == 0) {
        throw InputError{"plan: only: the job has none of these operations", {"", 0, "only"}};
    }
    setups.erase(std::remove_if(setups.begin(), setups.end(),
                                [](const Job& job) { return job.operations.empty(); }),
                 setups.end());
}

struct Request {
    std::string title;
    std::string program;
    std::optional<std::string> post;
    double blend;
    std::vector<double> only;
};

Request request_of(const Arguments& given)
{
    const std::string name = given.find_text("name").value_or("job.toml");
    Request request;
    request.title = given.find_text("title").value_or("job " + name);
    request.program = given.find_text("program").value_or("part.ngc");
    request.post = given.find_text("post");
    request.blend = given.find_number("blend").value_or(0);
    request.only = given.find_numbers("only");
    given.text("job");
    given.check_all_read();
    return request;
}

Json program_json(const Call& call,
                  const Job& job,
                  PlannedProgram& program,
                  const std::string& name)
{
    std::vector<std::string> warnings = job.notes;
    const std::vector<std::string> of_program = program.all_warnings();
    warnings.insert(warnings.end(), of_program.begin(), of_program.end());
    Json stats = Json::parse(statistics_json(job, program));
    const std::string summary = summary_text(program);
    return {{"name", name},
            {"setup", job.setup ? job.setup->name : ""},
            {"block", call.add_block("gcode", std::move(program.gcode))},
            {"summary", summary},
            {"warnings", warnings},
            {"stats", std::move(stats)}};
}

}  // namespace

Json plan_call(Call& call)
{
    const Request request = request_of(call.arguments);
    call.report(0, "reading the job");
    std::vector<Job> setups = read_setups(call.arguments);
    const bool several = setups.size() > 1;
    choose_operations(setups, request.only);
    if (request.post) {
        for (Job& job : setups) {
            job.post = import::read_post(*request.post, "");
        }
    }
    const auto name_of = [&](const Job& job) {
        return several ? file_of_setup(request.program, *job.setup) : request.program;
    };
    PlanWatcher watcher{call};
    Json programs = Json::array();
    plan_setups(
        setups, watcher,
        [&](const Job& job) {
            plan::PlanOptions options;
            options.title = request.title + (job.setup ? ", " + description_of(*job.setup) : "");
            options.name = name_of(job);
            options.blend = request.blend;
            return options;
        },
        [&](const Job& job, PlannedProgram program) {
            programs.push_back(program_json(call, job, program, name_of(job)));
        });
    return {{"programs", programs}};
}

}  // namespace cusp::engine
