// Finds the call, gives it its files, and makes errors part of the answer.
#include "host_tools/cam/engine/engine.hpp"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>

#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/judge/verify/program_setup.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::engine {
namespace {

struct NamedCall {
    const char* name;
    Json (*answer)(Call&);
};

constexpr std::array kCalls = {
    NamedCall{"keys", keys_call},       NamedCall{"describe", describe_call},
    NamedCall{"suggest", suggest_call}, NamedCall{"check", check_call},
    NamedCall{"plan", plan_call},       NamedCall{"verify", verify_call},
    NamedCall{"run", run_call},         NamedCall{"fit", fit_call},
    NamedCall{"send", send_call},
};

Json result_of(const std::string& name,
               const std::string& text,
               const files::FileSet& files,
               Listener& listener,
               std::vector<Block>& blocks)
{
    const auto found = std::find_if(kCalls.begin(), kCalls.end(),
                                    [&](const NamedCall& known) { return name == known.name; });
    if (found == kCalls.end()) {
        throw InputError{
            fmt::format("{}: there is no such call; there are {}", name, fmt::join(names(), ", "))};
    }
    const Arguments arguments{name, text};
    const files::InMemory in_memory{files};
    Call call{arguments, files, listener, blocks};
    return found->answer(call);
}

Json error_json(const char* kind, const std::string& text, const InputFault& fault = {})
{
    Json error = fault_json(text, fault);
    error["kind"] = kind;
    return {{"ok", false}, {"error", error}};
}

// The result, or the error as it is known.
Json answer_of(const std::string& name,
               const std::string& arguments,
               const files::FileSet& files,
               Listener& listener,
               std::vector<Block>& blocks)
{
    try {
        Json result = result_of(name, arguments, files, listener, blocks);
        return {{"ok", true}, {"result", std::move(result)}};
    } catch (const InputError& error) {
        return error_json("input", error.what(), error.fault());
    } catch (const Cancelled& error) {
        return error_json("cancelled", error.what());
    } catch (const plan::Cancelled& error) {
        return error_json("cancelled", error.what());
    } catch (const std::bad_alloc&) {
        return error_json("memory", "there is not enough memory");
    } catch (const std::exception& error) {
        return error_json("internal", error.what());
    }
}

}  // namespace

void Listener::progress(double, const std::string&) {}
bool Listener::cancelled() { return false; }

std::vector<std::string> names()
{
    std::vector<std::string> out;
    for (const NamedCall& known : kCalls) {
        out.emplace_back(known.name);
    }
    return out;
}

Answer call(const std::string& name,
            const std::string& arguments,
            const files::FileSet& files,
            Listener& listener)
{
    static std::mutex one_at_a_time;
    const std::lock_guard lock{one_at_a_time};
    Answer answer;
    const Json json = answer_of(name, arguments, files, listener, answer.blocks);
    if (!json["ok"].get<bool>()) {
        answer.blocks.clear();
    }
    answer.json = json_text::written(json);
    return answer;
}

std::string Call::add_block(const std::string& kind, std::string bytes) const
{
    const auto count = std::count_if(blocks.begin(), blocks.end(), [&](const Block& block) {
        return block.name.rfind(kind + "-", 0) == 0;
    });
    blocks.push_back({fmt::format("{}-{}", kind, count), std::move(bytes)});
    return blocks.back().name;
}

std::vector<job::Job> read_setups(const Arguments& arguments)
{
    const std::string name = arguments.find_text("name").value_or("job.toml");
    const std::string folder = std::filesystem::path{name}.parent_path().string();
    return import::read_setups({arguments.text("job"), name, folder}, strategies::all());
}

job::Job read_job_of_program(const Arguments& arguments)
{
    return verify::job_of_program(read_setups(arguments), arguments.text("program"),
                                  arguments.find_texts("after"));
}

Json fault_json(const std::string& text, const InputFault& fault)
{
    return {{"text", text},         {"file", fault.file}, {"line", fault.line},
            {"place", fault.place}, {"key", fault.key},   {"value", fault.value},
            {"limit", fault.limit}};
}

}  // namespace cusp::engine
