// Requests are parsed, answers are written.
#include "host_tools/cli/studio/call.hpp"

#include <array>
#include <chrono>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/json_text/json_text.hpp"

#include "nlohmann/json.hpp"

namespace cusp::studio {

using engine::Answer;
using engine::Block;
using json_text::written;

namespace {

using Json = nlohmann::ordered_json;

void write_at_once(std::FILE* out, const std::string& bytes)
{
    std::fwrite(bytes.data(), 1, bytes.size(), out);
    std::fflush(out);
}

std::string rest_of(std::FILE* in)
{
    constexpr std::size_t kPiece = 1U << 16U;
    std::array<char, kPiece> piece{};
    std::string all;
    for (std::size_t got = 1; got > 0;) {
        got = std::fread(piece.data(), 1, piece.size(), in);
        all.append(piece.data(), got);
    }
    return all;
}

// Writes what the engine tells, as often as a person can read it.
class ProgressLines : public engine::Listener {
public:
    explicit ProgressLines(std::FILE* out) : out_{out} {}

    void progress(double share, const std::string& text) override
    {
        constexpr std::chrono::milliseconds kBetween{50};
        const auto now = std::chrono::steady_clock::now();
        if (text == text_ && now - told_ < kBetween) {
            return;
        }
        told_ = now;
        text_ = text;
        write_at_once(out_, written(Json{{"progress", {{"share", share}, {"text", text}}}}) + "\n");
    }

private:
    std::FILE* out_;
    std::string text_;
    std::chrono::steady_clock::time_point told_{};
};

}  // namespace

Call read_call(std::string_view request)
{
    const std::size_t end = request.find('\n');
    if (end == std::string_view::npos) {
        throw InputError{"a call: its first line has no end"};
    }
    Call call;
    try {
        const Json head = Json::parse(request.substr(0, end));
        call.arguments = written(head.value("arguments", Json::object()));
        std::string_view bytes = request.substr(end + 1);
        for (const Json& file : head.value("files", Json::array())) {
            const auto size = file.at("size").get<std::size_t>();
            if (size > bytes.size()) {
                throw InputError{"a call: the bytes of its files are not complete"};
            }
            call.files[file.at("name").get<std::string>()] = bytes.substr(0, size);
            bytes.remove_prefix(size);
        }
    } catch (const Json::exception&) {
        throw InputError{"a call: its first line is not the JSON of a call"};
    }
    return call;
}

std::string answer_bytes(const Answer& answer)
{
    Json blocks = Json::array();
    for (const Block& block : answer.blocks) {
        blocks.push_back({{"name", block.name}, {"size", block.bytes.size()}});
    }
    std::string bytes = "{\"answer\":" + answer.json + ",\"blocks\":" + written(blocks) + "}\n";
    for (const Block& block : answer.blocks) {
        bytes += block.bytes;
    }
    return bytes;
}

std::string failure_bytes(const std::string& text)
{
    const Json answer{{"ok", false}, {"error", {{"kind", "internal"}, {"text", text}}}};
    return answer_bytes({written(answer), {}});
}

void answer_call(const std::string& name, std::FILE* in, std::FILE* out)
{
    try {
        const Call call = read_call(rest_of(in));
        ProgressLines lines{out};
        write_at_once(out, answer_bytes(engine::call(name, call.arguments, call.files, lines)));
    } catch (const std::exception& fault) {
        write_at_once(out, failure_bytes(fault.what()));
    }
}

}  // namespace cusp::studio
