#include "catch.hpp"

#include <dem/core/error.hpp>
#include <dem/io/file.hpp>
#include <dem/rig/folder_lock.hpp>

#include <filesystem>
#include <optional>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace folder_lock_test {

using Catch::Matchers::ContainsSubstring;
using dem::rig::FolderLock;
namespace fs = std::filesystem;

namespace {

struct Folder {
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  fs::path path = fs::temp_directory_path() / ("dem_lock_test_" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("a folder is held by one run at a time, and the other is told by which") {
  const Folder folder;
  std::optional<FolderLock> first;
  first.emplace(folder.path.string(), "direct_shear");
  CHECK_THROWS_WITH(FolderLock(folder.path.string(), "blade"), ContainsSubstring(std::to_string(::getpid())) &&
                                                                   ContainsSubstring("(direct_shear)") &&
                                                                   ContainsSubstring("choose another --output"));
  CHECK(fs::exists(folder.path / FolderLock::file_name));
  first.reset();
  CHECK_FALSE(fs::exists(folder.path / FolderLock::file_name));
  CHECK_NOTHROW(FolderLock(folder.path.string(), "blade"));
}

TEST_CASE("a lock that moves stays held") {
  const Folder folder;
  FolderLock first(folder.path.string(), "one"), second;
  second = std::move(first);
  CHECK_THROWS_AS(FolderLock(folder.path.string(), "two"), dem::Error);
}

TEST_CASE("what a killed run leaves holds nothing") {
  const Folder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    const FolderLock lock(folder.path.string(), "killed");
    ::_exit(0);  // without a destructor
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(fs::exists(folder.path / FolderLock::file_name));
  CHECK_NOTHROW(FolderLock(folder.path.string(), "next"));
}

TEST_CASE("a folder that cannot be written to cannot be locked") {
  CHECK_THROWS_WITH(FolderLock("/no/such/folder", "blade"),
                    ContainsSubstring("cannot open '/no/such/folder/run.lock'"));
}

}  // namespace folder_lock_test
