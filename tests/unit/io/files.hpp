#pragma once
// Help for tests that write files or streams.

#include "catch.hpp"

#include <dem/core/error.hpp>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

/// A new empty folder that is gone at the end.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / ("dem_io_" + std::string(6, 'X'))).string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    path_ = pattern;
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// A stream that is no terminal and remembers what is written to it.
class Captured {
 public:
  Captured() : file_(std::tmpfile(), &std::fclose) { REQUIRE(file_ != nullptr); }

  [[nodiscard]] std::FILE* file() const { return file_.get(); }

  /// Everything written since the last call.
  std::string take() {
    std::fflush(file_.get());
    std::fseek(file_.get(), taken_, SEEK_SET);
    std::string text;
    std::array<char, 1024> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), file_.get())) > 0;) {
      text.append(buffer.data(), n);
    }
    taken_ = std::ftell(file_.get());
    std::fseek(file_.get(), 0, SEEK_END);
    return text;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  long taken_ = 0;
};

/// The text of the dem::Error that `call` throws; a note when it throws none.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const dem::Error& error) {
    return error.what();
  }
  return "(no dem::Error was thrown)";
}
