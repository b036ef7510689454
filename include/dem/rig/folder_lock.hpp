#pragma once
// One run at a time in an output folder (POSIX).

#include <dem/core/error.hpp>

#include <cerrno>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace dem::rig {

/// Holds a folder for this process, by a lock on the file `run.lock` in it. The system gives the lock back when the
/// process ends, however it ends; the file that a killed process leaves holds nothing. On a file system without locks
/// it holds nothing either.
class FolderLock {
 public:
  static constexpr const char* file_name = "run.lock";

  FolderLock() = default;
  /// Locks a folder that exists. `program` is told to others who ask for the folder meanwhile. Throws Error, with the
  /// number and the program of the process, if another one holds it, and if the file cannot be made.
  FolderLock(const std::string& folder, std::string_view program)
      : path_((folder.empty() ? "." : folder) + "/" + file_name) {
    while (!try_lock(folder)) {
    }
    const std::string line = text("process {} ({})\n", ::getpid(), program);
    if (file_ >= 0 && ::ftruncate(file_, 0) == 0) {
      [[maybe_unused]] const auto written = ::write(file_, line.data(), line.size());
    }
  }
  FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)), path_(std::move(other.path_)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(path_, other.path_);
    return *this;
  }
  ~FolderLock() {
    if (file_ < 0) return;
    ::unlink(path_.c_str());  // before the lock goes: whoever waits for it sees that the file is another one
    ::close(file_);
  }

 private:
  /// Returns false if the file was taken away meanwhile: try again.
  bool try_lock(const std::string& folder) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) {
      fail("cannot open '{}' for writing ({}); choose a folder that you may write to", path_, std::strerror(errno));
    }
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
      const bool is_held = errno == EWOULDBLOCK;
      const std::string holder = is_held ? read_all() : "";
      ::close(std::exchange(file_, -1));
      if (!is_held) return true;  // no locks here
      fail("the folder '{}' is in use by {}; wait for its end, or choose another --output", folder,
           holder.empty() ? "another run" : holder);
    }
    struct stat mine {
    }, there{};
    if (::fstat(file_, &mine) == 0 && ::stat(path_.c_str(), &there) == 0 && mine.st_ino == there.st_ino) return true;
    ::close(std::exchange(file_, -1));
    return false;
  }

  std::string read_all() const {
    char text[256];
    const auto size = ::read(file_, text, sizeof text);
    std::string_view line(text, size > 0 ? static_cast<std::size_t>(size) : 0);
    return std::string(line.substr(0, line.find('\n')));
  }

  int file_ = -1;
  std::string path_;
};

}  // namespace dem::rig
