// Files that a scene names, by path, so that one used twice is read once.
#pragma once

#include <filesystem>
#include <map>
#include <new>
#include <string>

#include "host/core/error.hpp"
#include "host/core/json_cursor.hpp"

namespace stokes {

template <class Content, Content (*read_content)(const std::string& path)>
class InputFiles {
  public:
    // folder: of the scene; paths are relative to it unless absolute.
    explicit InputFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    const std::filesystem::path& folder() const { return folder_; }

    // The file named here, by the name as the system takes it: ".." after a symbolic link leaves the folder that the
    // link leads to. Throws InputError at this place of the scene, also where the memory does not suffice.
    const Content& read(const JsonCursor& file) {
        const std::string path = (folder_ / file.text()).string();
        const auto found = contents_.find(path);
        if (found != contents_.end()) return found->second;
        try {
            return contents_.emplace(path, read_content(path)).first->second;
        } catch (const InputError& error) {
            file.fail(error.what());
        } catch (const std::bad_alloc&) {
            file.fail(path + ": too large for the memory");
        }
    }

  private:
    std::filesystem::path folder_;
    std::map<std::string, Content> contents_;
};

}  // namespace stokes
