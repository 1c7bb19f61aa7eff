// A folder for the files of one test.
#pragma once

#include <filesystem>
#include <string>

#include "support/program.hpp"

namespace mbs::test {

/// An empty folder of its own, removed with everything in it.
class Folder {
 public:
  Folder() : path_(temporary_path("folder")) { std::filesystem::create_directory(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string file(const std::string& name) const { return path_ + "/" + name; }
  [[nodiscard]] bool is_empty() const { return std::filesystem::is_empty(path_); }

 private:
  std::string path_;
};

}  // namespace mbs::test
