// Splits text into lines.
#include "host_tools/controller/dialect/line_source.hpp"

#include <algorithm>
#include <utility>

namespace cusp::dialect {
namespace {

constexpr std::size_t kLongestLine = 1 << 16;
constexpr std::size_t kBlock = 1 << 13;
constexpr int kEnd = -1;

}  // namespace

LineSource::LineSource(std::string name, ByteReader reader, std::uint64_t size)
    : name_{std::move(name)}, reader_{std::move(reader)}, size_{size}, block_(kBlock)
{
}

LineSource LineSource::of_text(std::string name, std::string_view text)
{
    const ByteReader reader = [text](char* place, std::size_t room) mutable {
        const std::size_t count = std::min(room, text.size());
        std::copy_n(text.begin(), count, place);
        text.remove_prefix(count);
        return count;
    };
    return {std::move(name), reader, text.size()};
}

std::optional<std::string> LineSource::next()
{
    std::string line;
    int character = take();
    if (after_return_ && character == '\n') {
        character = take();
    }
    after_return_ = false;
    if (character == kEnd) {
        return std::nullopt;
    }
    while (character != kEnd && character != '\n' && character != '\r') {
        if (line.size() < kLongestLine) {
            line.push_back(static_cast<char>(character));
        }
        character = take();
    }
    after_return_ = character == '\r';
    ++line_number_;
    return line;
}

double LineSource::progress() const
{
    return size_ == 0 ? 0.0 : static_cast<double>(taken_) / static_cast<double>(size_);
}

int LineSource::take()
{
    if (next_ == end_) {
        next_ = 0;
        end_ = reader_(block_.data(), block_.size());
        if (end_ == 0) {
            return kEnd;
        }
    }
    ++taken_;
    return static_cast<unsigned char>(block_[next_++]);
}

}  // namespace cusp::dialect
