// The flash sectors of the simulated board in a file.
#include <filesystem>
#include <fstream>
#include <system_error>

#include "hal/sim/simulated_store.hpp"

namespace cusp::hal {
namespace {

using StoreSectors = std::array<std::vector<std::uint8_t>, 2>;

bool write_sectors(const std::string& file, const StoreSectors& sectors)
{
    const std::string fresh = file + ".new";
    {
        std::ofstream out{fresh, std::ios::binary | std::ios::trunc};
        for (const auto& sector : sectors) {
            // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): how iostreams take bytes.
            out.write(reinterpret_cast<const char*>(sector.data()),
                      static_cast<std::streamsize>(sector.size()));
        }
        out.flush();
        if (!out.good()) {
            return false;
        }
    }
    std::error_code failed;
    std::filesystem::rename(fresh, file, failed);
    return !failed;
}

}  // namespace

bool SimulatedStore::keep_in(const std::string& file)
{
    keep_ = [file](const StoreSectors& sectors) {
        return write_sectors(file, sectors);
    };
    std::error_code failed;
    if (!std::filesystem::exists(file, failed)) {
        return save();
    }
    if (std::filesystem::file_size(file, failed) != 2 * kSectorSize || failed) {
        return false;
    }
    std::ifstream in{file, std::ios::binary};
    for (auto& sector : sectors_) {
        // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): how iostreams take bytes.
        in.read(reinterpret_cast<char*>(sector.data()), kSectorSize);
    }
    return in.good();
}

}  // namespace cusp::hal
