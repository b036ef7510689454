#pragma once
// Files: whole-file reading, checked writing, and writing that never leaves half a file (POSIX).

#include <dem/core/error.hpp>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace dem::io {

/// Makes the folder that `file` lies in, with its parents. Throws dem::Error when that is not possible.
inline void make_folder_of(const std::filesystem::path& file) {
  const auto folder = file.parent_path();
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    fail("cannot make the folder '{}' ({}); choose a folder that you may write to", folder.string(), error.message());
  }
}

namespace detail {

/// Opens a file to be written, never under the number of a standard stream that is closed: what is printed to that
/// stream would end up in the file. Null, with errno, when it cannot be opened.
inline std::FILE* open_for_writing(const char* path) {
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr || ::fileno(file) > STDERR_FILENO) return file;
  const int moved = ::fcntl(::fileno(file), F_DUPFD, STDERR_FILENO + 1);
  const int error = errno;
  std::fclose(file);
  errno = error;
  return moved < 0 ? nullptr : ::fdopen(moved, "wb");
}

}  // namespace detail

/// A file that is written from its start; its folder is made when it is missing. Every method throws dem::Error,
/// with the path and the system's reason, when the file cannot be opened or written.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path) : path_(std::move(path)) {
    make_folder_of(path_);
    file_.reset(detail::open_for_writing(path_.c_str()));
    if (!file_) {
      fail("cannot open '{}' for writing ({}); choose a path that you may write to", path_.string(),
           std::strerror(errno));
    }
  }

  void write(const void* data, std::size_t bytes) {
    if (bytes != 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes) fail_to_write();
  }
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Hands buffered bytes to the system, so that they outlive this process.
  void flush() {
    if (std::fflush(file_.get()) != 0) fail_to_write();
  }

  /// Closes and reports what a destructor could not: a full disk is often noticed only here.
  void close() {
    if (std::fclose(file_.release()) != 0) fail_to_write();
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail_to_write() const {
    fail("cannot write to '{}' ({}); check that the disk is not full", path_.string(), std::strerror(errno));
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A file that appears under its name only when it is complete: bytes go to `<path>.tmp`, and commit() renames that.
/// Without commit() the temporary file is removed and an older file of this name stays. Throws as OutputFile does.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path) : path_(path), file_(std::filesystem::path(path) += ".tmp") {}
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() {
    if (committed_) return;
    std::error_code ignored;
    std::filesystem::remove(file_.path(), ignored);
  }

  void write(const void* data, std::size_t bytes) { file_.write(data, bytes); }
  void write(std::string_view text) { file_.write(text); }

  void commit() {
    file_.close();
    std::error_code error;
    std::filesystem::rename(file_.path(), path_, error);
    if (error) {
      fail("cannot rename '{}' to '{}' ({}); is there a folder of that name?", file_.path().string(), path_.string(),
           error.message());
    }
    committed_ = true;
  }

 private:
  std::filesystem::path path_;
  OutputFile file_;
  bool committed_ = false;
};

/// Writes `content` to `path`, complete or not at all. Throws dem::Error.
inline void write_file(const std::filesystem::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content);
  file.commit();
}

/// All bytes of the file at `path`. Throws dem::Error when it cannot be read.
[[nodiscard]] inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    fail("cannot read the file '{}'; check that it exists and may be read", path.string());
  }
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace dem::io
