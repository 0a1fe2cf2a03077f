// The job of a plan without a job file.
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/engine/calls.hpp"
#include "host_tools/job/import/one_line_job.hpp"

namespace cusp::engine {

Json suggest_call(Call& call)
{
    const Arguments& given = call.arguments;
    import::OneLineRequest request;
    request.parts = given.texts("parts");
    request.tools = given.texts("tools");
    request.boundary = given.find_text("boundary");
    request.islands = given.find_texts("islands");
    request.inch = given.flag("inch", false);
    request.scallop = given.find_number("scallop");
    request.tolerance = given.find_number("tolerance");
    request.max_depth = given.find_number("max_depth");
    request.allowance = given.find_number("allowance");
    request.feed = given.find_number("feed");
    request.plunge_feed = given.find_number("plunge_feed");
    request.spindle = given.find_number("spindle");
    request.stock_top = given.find_number("stock_top");
    request.clearance = given.find_number("clearance");
    request.scale = given.find_number("scale");
    request.up = given.find_text("up").value_or("");
    request.rotate = given.find_numbers("rotate");
    request.origin = given.find_text("origin").value_or("");
    request.move = given.find_numbers("move");
    request.roughing = given.flag("roughing", true);
    request.strategy = given.find_text("strategy").value_or("");
    request.output = given.find_text("moves").value_or("lines");
    request.depth = given.find_number("depth");
    request.layers = given.find_texts("layers");
    request.tabs = given.find_text("tabs").value_or("");
    request.side = given.find_text("side").value_or("");
    request.join_gaps = given.find_number("join_gaps");
    request.post = given.find_text("post").value_or("");
    given.check_all_read();
    call.report(0, "reading " + request.parts.front());
    import::PartFiles parts;
    const import::OneLineJob job = import::one_line_job(request, strategies::all(), parts);
    return {{"job", job.toml}, {"said", job.said}};
}

}  // namespace cusp::engine
