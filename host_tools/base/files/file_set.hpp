// Files in memory: what readers find in place of the disk while a set is in force.
//
//     const files::FileSet set{{"part.stl", bytes}};
//     {
//         const files::InMemory in_memory{set};
//         files::text_of_file("part.stl");    // of the set
//         files::text_of_file("/etc/hosts");  // InputError: a job from a page reads nothing of the disk
//     }
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace cusp::files {

using FileSet = std::map<std::string, std::string>;

// While it lives, the files of all readers are those of the set, and of the folders that come with the program
// (program_data.hpp). Paths are compared as they are spelt, but for "./" and "a/../". For one thread at a time; the set
// outlives it.
class InMemory {
public:
    explicit InMemory(const FileSet& set);
    ~InMemory();
    InMemory(const InMemory&) = delete;
    InMemory& operator=(const InMemory&) = delete;
};

// The bytes of a file of the set in force; null where no set is in force, or the file comes with the program.
// Throws InputError where the set lacks it.
const std::string* find_in_memory(const std::string& file);

// As above, of a set that is in force. Throws InputError, too, where none is.
const std::string& text_in_memory(const std::string& file);

// True if the file can be read: of the set in force, else on the disk.
bool is_file(const std::string& file);

// Calls `read` with the path of the file on the disk: its own, or that of a copy of the file of the set in force, for
// libraries that read nothing else. An InputError that names the copy is thrown with the name of the file.
void with_file_on_disk(const std::string& file,
                       const std::function<void(const std::string& path)>& read);

}  // namespace cusp::files
