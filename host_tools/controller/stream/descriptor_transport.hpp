// DescriptorTransport: a controller behind a pseudo-terminal or a socket.
#pragma once

#include "hal/posix/descriptor.hpp"
#include "host_tools/controller/stream/transport.hpp"

namespace cusp::stream {

class DescriptorTransport : public Transport {
public:
    explicit DescriptorTransport(hal::Descriptor descriptor);

    std::size_t write(std::string_view bytes) override;
    std::string read(std::chrono::milliseconds timeout) override;

private:
    hal::Descriptor descriptor_;
};

}  // namespace cusp::stream
