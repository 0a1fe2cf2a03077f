// The job of a plan without a job file.
#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/one_line_keys.hpp"

namespace cusp::engine {

Json suggest_call(Call& call)
{
    const Arguments& given = call.arguments;
    import::OneLineRequest request;
    request.parts = given.texts("parts");
    request.inch = given.flag("inch", false);
    request.roughing = given.flag("roughing", true);
    for (const import::OneLineKey& key : import::one_line_keys(strategies::all())) {
        std::visit([&](const auto place) { given.read(key.name, request.*place); }, key.place);
    }
    request.post = given.find_text("post").value_or("");
    given.check_all_read();
    call.report(0, "reading " + request.parts.front());
    import::PartFiles parts;
    const import::OneLineJob job = import::one_line_job(request, strategies::all(), parts);
    return {{"job", job.toml}, {"said", job.said}};
}

}  // namespace cusp::engine
