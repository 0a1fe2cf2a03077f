// The tables of keys, by which pages make their fields.
#include <algorithm>
#include <thread>

#include "host_tools/cam/engine/calls.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/controller/dialect/answer.hpp"
#include "host_tools/job/import/job_schema.hpp"
#include "host_tools/job/import/one_line_keys.hpp"
#include "host_tools/job/import/post_reader.hpp"

namespace cusp::engine {

namespace {

// The texts of Grbl's codes by their numbers.
Json texts_of(std::string_view (*text_of)(int))
{
    constexpr int kMostCode = 99;
    Json texts = Json::object();
    for (int code = 1; code <= kMostCode; ++code) {
        const std::string text{text_of(code)};
        if (text != dialect::kUnknownCode) {
            texts[std::to_string(code)] = text;
        }
    }
    return texts;
}

// The arguments of a suggestion: how their values are written, what they are for.
Json suggestions()
{
    constexpr const char* kUses[]{"any", "surfaces", "drawings"};
    Json keys = Json::array();
    for (const import::OneLineKey& key : import::one_line_keys(strategies::all())) {
        constexpr const char* kKinds[]{"number", "text", "text", "numbers", "texts"};
        keys.push_back({{"name", key.name},
                        {"kind", kKinds[key.place.index()]},
                        {"type", key.type},
                        {"help", key.help},
                        {"choices", key.choices},
                        {"use", kUses[static_cast<int>(key.use)]}});
    }
    return keys;
}

}  // namespace

Json keys_call(Call& call)
{
    call.arguments.check_all_read();
    Json strategies = Json::array();
    for (const job::Strategy* const strategy : strategies::all()) {
        Json keys = Json::array();
        for (const job::Key& key : keys_of(*strategy)) {
            keys.push_back(key.name);
        }
        strategies.push_back({{"name", strategy->name},
                              {"help", strategy->help},
                              {"one_line", strategy->traits.one_line},
                              {"is_pocket", strategy->traits.pocket},
                              {"surfaces", !strategy->is_prismatic()},
                              {"keys", keys}});
    }
    return {{"version", CUSP_VERSION},
            {"threads", std::max(1U, std::thread::hardware_concurrency())},
            {"cad", CUSP_READS_CAD != 0},
            {"schema", Json::parse(import::job_schema(strategies::all()))},
            {"strategies", strategies},
            {"suggest", suggestions()},
            {"posts", import::post_names()},
            {"errors", texts_of(dialect::error_text)},
            {"alarms", texts_of(dialect::alarm_text)}};
}

}  // namespace cusp::engine
