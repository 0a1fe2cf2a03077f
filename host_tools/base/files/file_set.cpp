// One set is in force at most.
#include "host_tools/base/files/file_set.hpp"

#include <atomic>
#include <cstdlib>
#include <system_error>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/files/program_data.hpp"
#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::files {

namespace fs = std::filesystem;

namespace {

std::atomic<const FileSet*> in_force{nullptr};

std::string plain(const std::string& file)
{
    return fs::path{file}.lexically_normal().generic_string();
}

// True of the posts and libraries of tools that come with the program.
bool comes_with_program(const std::string& file)
{
    const fs::path path = plain(file);
    const std::string folder = path.parent_path().filename().string();
    const std::string name = path.filename().string();
    const auto found =
        folder == "posts" || folder == "tool_libraries" ? program_data(folder, name) : std::nullopt;
    return found && plain((*found / name).string()) == path;
}

const std::string* find(const FileSet& set, const std::string& file)
{
    if (const auto found = set.find(file); found != set.end()) {
        return &found->second;
    }
    const std::string path = plain(file);
    for (const auto& [name, text] : set) {
        if (plain(name) == path) {
            return &text;
        }
    }
    return nullptr;
}

[[noreturn]] void refuse(const std::string& file)
{
    throw InputError(file + ": is not among the files that were given", {file});
}

// A folder that is removed with what is in it.
class TemporaryFolder {
public:
    TemporaryFolder()
    {
        std::string name = (fs::temp_directory_path() / "cusp-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw InputError(name + ": no folder can be made there");
        }
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code failed;
        fs::remove_all(path_, failed);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

}  // namespace

InMemory::InMemory(const FileSet& set) { in_force = &set; }
InMemory::~InMemory() { in_force = nullptr; }

const std::string* find_in_memory(const std::string& file)
{
    const FileSet* set = in_force;
    if (set == nullptr) {
        return nullptr;
    }
    const std::string* text = find(*set, file);
    if (text == nullptr && !comes_with_program(file)) {
        refuse(file);
    }
    return text;
}

const std::string& text_in_memory(const std::string& file)
{
    const std::string* text = find_in_memory(file);
    if (text == nullptr) {
        refuse(file);
    }
    return *text;
}

bool is_file(const std::string& file)
{
    std::error_code failed;
    const FileSet* set = in_force;
    return set == nullptr ? fs::is_regular_file(file, failed) : find(*set, file) != nullptr;
}

void with_file_on_disk(const std::string& file,
                       const std::function<void(const std::string& path)>& read)
{
    const std::string* text = find_in_memory(file);
    if (text == nullptr) {
        read(file);
        return;
    }
    const TemporaryFolder folder;
    const std::string copy = (folder.path() / fs::path{file}.filename()).string();
    write_text(copy, *text);
    // what reads the copy finds it on the disk
    const FileSet* const set = in_force.exchange(nullptr);
    try {
        read(copy);
    } catch (const InputError& error) {
        in_force = set;
        throw InputError(replaced(error.what(), copy, file), {file});
    } catch (...) {
        in_force = set;
        throw;
    }
    in_force = set;
}

}  // namespace cusp::files
