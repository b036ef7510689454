#pragma once

// The seal of a file with a saved state: its first 512 bytes say what it is, of which schema, how long, and a hash of
// all other bytes. So a file that is cut short or damaged is refused before anything tries to make sense of it.

#include <dem/core/error.hpp>
#include <dem/io/checkpoint/columns.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace dem::io {

/// The version of what is in such a file. It grows whenever a field comes, goes or changes its meaning.
inline constexpr std::uint64_t checkpoint_schema = 14;

namespace detail {

struct Seal {
  static constexpr std::size_t size = 512;
  static constexpr const char* mark = "dem saved state";
  unsigned long long schema = 0, bytes = 0, hash = 0;

  std::string text() const {
    char line[size] = {};
    std::snprintf(line, sizeof line, "%s, schema %llu, %llu bytes, hash %016llx\n", mark, schema, bytes, hash);
    return {line, size};
  }
  /// False if these are not the first bytes of such a file.
  bool read(const std::string& line) {
    return line.starts_with(mark) && std::sscanf(line.c_str() + std::strlen(mark),
                                                 ", schema %llu, %llu bytes, hash %llx", &schema, &bytes, &hash) == 3;
  }
};

/// An open file.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags) : number_(::open(path.c_str(), flags | O_CLOEXEC)) {
    if (number_ < 0) fail("cannot open '{}' ({})", path.string(), std::strerror(errno));
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }
  operator int() const { return number_; }  // NOLINT: it stands for it

 private:
  int number_;
};

/// Makes sure that a file or folder is on the disk.
inline void synchronise(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY);
  if (::fsync(file) != 0) fail("cannot synchronise '{}' with the disk ({})", path.string(), std::strerror(errno));
}

/// Of all bytes behind the seal.
inline Seal seal_of(const Descriptor& file, const std::filesystem::path& path) {
  Seal seal;
  seal.schema = checkpoint_schema;
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  std::vector<char> piece(std::size_t{1} << 20);
  std::size_t at = Seal::size;
  for (;;) {
    const ssize_t n = ::pread(file, piece.data(), piece.size(), static_cast<off_t>(at));
    if (n < 0) fail("cannot read '{}' ({})", path.string(), std::strerror(errno));
    if (n == 0) break;
    mix(hash, piece.data(), static_cast<std::size_t>(n));
    at += static_cast<std::size_t>(n);
  }
  seal.bytes = at;
  seal.hash = hash;
  return seal;
}

/// Seals a file whose first bytes were left free, and makes sure that it is on the disk.
inline void seal(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDWR);
  const std::string text = seal_of(file, path).text();
  if (::pwrite(file, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) || ::fsync(file) != 0) {
    fail("cannot write to '{}' ({})", path.string(), std::strerror(errno));
  }
}

/// Throws Error unless the file is as it was sealed, and of the schema that this version reads.
inline void check_seal(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail("cannot load '{}': it is a folder, not a file", path.string());
  if (!std::filesystem::is_regular_file(path, error)) fail("cannot load '{}': there is no such file", path.string());
  const Descriptor file(path, O_RDONLY);
  std::string line(Seal::size, '\0');
  Seal seal;
  if (::pread(file, line.data(), line.size(), 0) != static_cast<ssize_t>(line.size()) || !seal.read(line)) {
    fail("cannot load '{}': it is no saved state, or its beginning is missing or damaged", path.string());
  }
  if (seal.schema != checkpoint_schema) {
    fail("cannot load '{}': it is of schema {}, but this version of dem reads schema {}; use the version that saved it",
         path.string(), seal.schema, static_cast<unsigned long long>(checkpoint_schema));
  }
  const Seal now = seal_of(file, path);
  if (now.bytes < seal.bytes) {
    fail(
        "cannot load '{}': it is cut short, {} bytes are left of {}; copy it again, or load a state that was saved "
        "under another name",
        path.string(), now.bytes, seal.bytes);
  }
  if (now.bytes != seal.bytes || now.hash != seal.hash || now.text() != line) {
    fail(
        "cannot load '{}': it is damaged, as its bytes are not those that were saved; copy it again, or load a "
        "state that was saved under another name",
        path.string());
  }
}

}  // namespace detail
}  // namespace dem::io
