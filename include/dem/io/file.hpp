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
#include <sys/stat.h>
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

/// The open descriptor of this process that a path names (/dev/stdout, /dev/fd/3), or -1. What it is open on may be a
/// file, which is written on where it is and not anew.
inline int descriptor_of(const std::filesystem::path& path) {
  const std::string text = path.string();
  if (text == "/dev/stdout") return STDOUT_FILENO;
  if (text == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!text.starts_with(folder) || text.size() == folder.size() || text.size() > folder.size() + 6) continue;
    const auto digits = text.substr(folder.size());
    if (digits.find_first_not_of("0123456789") == std::string::npos) return std::stoi(digits);
  }
  return -1;
}

inline std::FILE* open_for_writing(const std::filesystem::path& path, WriteFrom from = WriteFrom::start) {
  if (!process_writes_files) return stream_on(::open("/dev/null", O_WRONLY | O_CLOEXEC));
  if (const int open = descriptor_of(path); open >= 0) {
    std::fflush(nullptr);  // what was printed before stays before
    return stream_on(::fcntl(open, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  }
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

/// Whether there is something that is neither a file nor a folder, or an open descriptor of this process.
inline bool is_device(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_other(std::filesystem::status(path, ignored)) || descriptor_of(path) >= 0;
}

/// What a symbolic link leads to, whether that is there or not; else the path itself. Throws Error for links in a
/// circle.
inline std::filesystem::path behind_links(std::filesystem::path path) {
  const std::filesystem::path given = path;
  std::error_code error;
  for (int links = 0; std::filesystem::is_symlink(path, error); ++links) {
    if (links == 40) fail("'{}' is a symbolic link that leads back to itself; choose another path", given.string());
    const auto target = std::filesystem::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / target;  // an absolute target stays as it is
  }
  return path;
}

/// Gives an open file the permissions of the one that it is to take the place of, if there is one and they can be
/// given.
inline void take_permissions_of(const std::filesystem::path& older, std::FILE* file) {
  struct stat status;
  if (::stat(older.c_str(), &status) != 0) return;
  [[maybe_unused]] const int ignored = ::fchmod(::fileno(file), status.st_mode & 0777);
}

/// Gives an unnamed file its name, in place of an older one. False, with errno, if that is not possible.
inline bool name_file(std::FILE* file, const std::filesystem::path& path) {
  const std::string unnamed = "/proc/self/fd/" + std::to_string(::fileno(file));
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) return false;
  return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
}

}  // namespace detail

/// A file that is written from its start, or from its end; its folder is made when it is missing. Every method throws
/// dem::Error, with the path and the system's reason, when the file cannot be opened or written. A destructor cannot:
/// it tells on stderr that the last bytes could not be written, unless that was thrown already. close() throws.
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
  OutputFile(OutputFile&&) = default;
  OutputFile& operator=(OutputFile&& other) noexcept {
    std::swap(path_, other.path_), std::swap(file_, other.file_), std::swap(has_failed_, other.has_failed_);
    return *this;
  }
  ~OutputFile() {
    if (!file_ || std::fclose(file_.release()) == 0 || has_failed_) return;
    std::fprintf(stderr, "warning: the end of '%s' is lost (%s); check that the disk is not full\n", path_.c_str(),
                 std::strerror(errno));
  }

  void write(const void* data, std::size_t bytes) {
    if (!file_) fail("cannot write to '{}': it was closed; write before", path_.string());
    if (bytes != 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes) fail_to_write();
  }
  void write(std::string_view text) { write(text.data(), text.size()); }

  /// Hands buffered bytes to the system, so that they outlive this process.
  void flush() {
    if (file_ && std::fflush(file_.get()) != 0) fail_to_write();
  }

  /// Closes it and throws where a destructor could not: a full disk is often noticed only here.
  void close() {
    if (file_ && std::fclose(file_.release()) != 0) fail_to_write();
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  friend class AtomicFile;

  OutputFile(std::filesystem::path path, std::FILE* open) : path_(std::move(path)), file_(open) {}

  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail_to_write() {
    has_failed_ = true;
    fail("cannot write to '{}' ({}); check that the disk is not full", path_.string(), std::strerror(errno));
  }

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
  bool has_failed_ = false;  ///< which was thrown
};

/// A file that appears under its name only when it is complete. Until commit() its bytes have no name, or where the
/// system knows no unnamed files that of `<path>.tmp`. Without commit() they are gone and an older file of this name
/// stays, also when the process is killed (but for `<path>.tmp`). A symbolic link stays: the file that it leads to is
/// written, in a folder where files can be made. Permissions stay. What is there and is no file, as a device, a pipe or
/// /dev/stdout, is written as it is. Throws as OutputFile does.
class AtomicFile {
 public:
  explicit AtomicFile(const std::filesystem::path& path)
      : is_direct_(detail::is_device(path)),
        path_(is_direct_ ? path : detail::behind_links(path)),
        temporary_(std::filesystem::path(path_) += ".tmp"),
        file_(open()) {}
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile() {
    file_.file_.reset();  // what was not committed may be lost
    std::error_code ignored;
    if (is_named_) std::filesystem::remove(temporary_, ignored);
  }

  void write(const void* data, std::size_t bytes) { file_.write(data, bytes); }
  void write(std::string_view text) { file_.write(text); }

  void commit() {
    if (!process_writes_files || is_direct_) return file_.close();
    detail::take_permissions_of(path_, file_.file_.get());
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
    if (is_direct_) return OutputFile(path_);
    if (std::FILE* unnamed = detail::open_unnamed(path_.parent_path())) return {path_, unnamed};
    is_named_ = true;
    return OutputFile(temporary_);
  }

  bool is_direct_;
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
