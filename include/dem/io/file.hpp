#pragma once
// Files: whole-file reading, checked writing, and writing that never leaves half a file (POSIX).

#include <dem/core/error.hpp>
#include <dem/core/output.hpp>

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
  if (folder.empty() || !process_writes_files) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    fail("cannot make the folder '{}' ({}); choose a folder that you may write to", folder.string(), error.message());
  }
}

/// Where the writing of a file that is there begins.
enum class WriteFrom { start, end };

namespace detail {

/// A stream on a descriptor that never has the number of a standard stream that is closed: what is printed to that
/// stream would end up in the file. Null, with errno, if that is not possible.
inline std::FILE* stream_on(int descriptor) {
  if (descriptor >= 0 && descriptor <= STDERR_FILENO) {
    const int moved = ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    const int error = errno;
    ::close(descriptor);
    errno = error;
    descriptor = moved;
  }
  return descriptor < 0 ? nullptr : ::fdopen(descriptor, "wb");
}

inline std::FILE* open_for_writing(const std::filesystem::path& path, WriteFrom from = WriteFrom::start) {
  if (!process_writes_files) return stream_on(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  const int where = from == WriteFrom::start ? O_TRUNC : O_APPEND;
  return stream_on(::open(path.c_str(), O_WRONLY | O_CREAT | where | O_CLOEXEC, 0666));
}

/// A file in a folder that has no name yet, so that a process which is killed leaves nothing. Null where the system has
/// no such files.
inline std::FILE* open_unnamed([[maybe_unused]] const std::filesystem::path& folder) {
#if defined(O_TMPFILE)
  if (::access("/proc/self/fd", X_OK) != 0) return nullptr;  // by which it gets its name
  return stream_on(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
#else
  return nullptr;
#endif
}

/// Gives an unnamed file its name, in place of an older one. False, with errno, if that is not possible.
inline bool name_file(std::FILE* file, const std::filesystem::path& path) {
  const std::string unnamed = "/proc/self/fd/" + std::to_string(::fileno(file));
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return false;
  return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace detail

/// A file that is written from its start, or from its end; its folder is made when it is missing. Every method throws
/// dem::Error, with the path and the system's reason, when the file cannot be opened or written.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path, WriteFrom from = WriteFrom::start) : path_(std::move(path)) {
    make_folder_of(path_);
    file_.reset(detail::open_for_writing(path_, from));
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
  friend class AtomicFile;

  OutputFile(std::filesystem::path path, std::FILE* open) : path_(std::move(path)), file_(open) {}

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail_to_write() const {
    fail("cannot write to '{}' ({}); check that the disk is not full", path_.string(), std::strerror(errno));
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A file that appears under its name only when it is complete. Until commit() its bytes have no name, or where the
/// system knows no unnamed files that of `<path>.tmp`. Without commit() they are gone and an older file of this name
/// stays, also when the process is killed (but for `<path>.tmp`). Throws as OutputFile does.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path)
      : path_(path), temporary_(std::filesystem::path(path) += ".tmp"), file_(open()) {}
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() {
    std::error_code ignored;
    if (is_named_) std::filesystem::remove(temporary_, ignored);
  }

  void write(const void* data, std::size_t bytes) { file_.write(data, bytes); }
  void write(std::string_view text) { file_.write(text); }

  void commit() {
    if (!process_writes_files) return file_.close();
    if (!is_named_) {
      file_.flush();
      if (!detail::name_file(file_.file_.get(), temporary_)) file_.fail_to_write();
      is_named_ = true;
    }
    file_.close();
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) {
      fail("cannot rename '{}' to '{}' ({}); is there a folder of that name?", temporary_.string(), path_.string(),
           error.message());
    }
    is_named_ = false;
  }

 private:
  OutputFile open() {
    make_folder_of(path_);
    if (!process_writes_files) return OutputFile(temporary_);
    if (std::FILE* unnamed = detail::open_unnamed(path_.parent_path())) return {path_, unnamed};
    is_named_ = true;
    return OutputFile(temporary_);
  }

  std::filesystem::path path_, temporary_;
  bool is_named_ = false;  ///< whether there is a file `temporary_`
  OutputFile file_;
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
