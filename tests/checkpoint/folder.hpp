#pragma once

#include "catch.hpp"

#include <dem/io/checkpoint/world_columns.hpp>

#include <filesystem>
#include <string>

/// A new empty folder that is gone at the end.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "dem_state_").string() + std::string(6, 'X');
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// The columns in which two worlds differ, as one text.
template <class World>
std::string difference(const World& a, const World& b) {
  std::string names;
  for (const std::string& name : dem::io::differences(dem::io::columns_of(a), dem::io::columns_of(b))) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}
