// Compresses with zlib.
#include <stdexcept>
#include <zlib.h>

#include "host_tools/judge/view/byte_text.hpp"

namespace cusp::view {

std::string deflated(std::string_view bytes)
{
    constexpr int kLevel = 6;
    constexpr int kMemory = 9;
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, kMemory, Z_DEFAULT_STRATEGY) !=
        Z_OK) {
        throw std::runtime_error{"no memory to compress the page"};
    }
    std::string out(deflateBound(&stream, bytes.size()), '\0');
    std::string in{bytes};
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    const int state = deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    if (state != Z_STREAM_END) {
        throw std::runtime_error{"the page could not be compressed"};
    }
    return out;
}

}  // namespace cusp::view
