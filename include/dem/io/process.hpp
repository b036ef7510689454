#pragma once
// Running another program without a shell (POSIX).

#include <dem/core/error.hpp>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;  // NOLINT: the system's own name

namespace dem::io {

/// The absolute path of the program `name` found along the variable PATH; nothing when it is not there.
[[nodiscard]] inline std::optional<std::filesystem::path> find_program(std::string_view name) {
  const char* variable = std::getenv("PATH");
  std::string_view folders = variable != nullptr ? variable : "";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(folder.size() == folders.size() ? folder.size() : folder.size() + 1);
    if (folder.empty()) continue;  // would mean the current folder, where no tool should be picked up from
    std::error_code error;
    const auto program = std::filesystem::absolute(std::filesystem::path(folder) / name, error);
    if (!error && std::filesystem::is_regular_file(program, error) && ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  return std::nullopt;
}

/// How a program ended.
struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string errors;  ///< all that it wrote to stderr
};

namespace detail {

/// A pipe whose ends the child does not inherit (but for what is duplicated into it).
class Pipe {
 public:
  Pipe() {
    if (::pipe(ends_) != 0) fail("cannot make a pipe ({}); are too many files open?", std::strerror(errno));
    for (const int end : ends_) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_writing();
    ::close(ends_[0]);
  }

  [[nodiscard]] int writing() const { return ends_[1]; }
  void close_writing() {
    const int end = std::exchange(ends_[1], -1);
    if (end >= 0) ::close(end);
  }

  /// Everything until the last writer has closed its end.
  [[nodiscard]] std::string read_all() const {
    std::string text;
    char buffer[4096];
    for (;;) {
      const auto bytes = ::read(ends_[0], buffer, sizeof buffer);
      if (bytes > 0) text.append(buffer, static_cast<std::size_t>(bytes));
      if (bytes == 0 || (bytes < 0 && errno != EINTR)) return text;
    }
  }

 private:
  int ends_[2] = {-1, -1};
};

}  // namespace detail

/// Runs `program` (a path) with `arguments` in the folder `folder` and waits for its end. No shell sees the
/// arguments. Its stdin is empty, and its stdout is dropped. Throws dem::Error when it cannot be started.
[[nodiscard]] inline ProgramResult run_program(const std::filesystem::path& program, std::vector<std::string> arguments,
                                               const std::filesystem::path& folder) {
  std::string name = program.string();
  std::vector<char*> argv{name.data()};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);

  detail::Pipe errors;
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addchdir_np(&actions, folder.empty() ? "." : folder.c_str());
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, errors.writing(), STDERR_FILENO);
  pid_t child = -1;
  const int error = ::posix_spawn(&child, name.c_str(), &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    fail("cannot start '{}' in the folder '{}' ({})", name, folder.string(), std::strerror(error));
  }

  errors.close_writing();
  ProgramResult result;
  result.errors = errors.read_all();
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.exit_code = 128 + WTERMSIG(status);
  return result;
}

}  // namespace dem::io
