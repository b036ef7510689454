#pragma once
// The bytes of an array in a VTK file: compressed by zlib in programs that link dem::zlib (VTK File Formats, "XML file
// formats", compressed data), else as they are.

#include <dem/core/error.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#if defined(DEM_WITH_ZLIB)
#include <dem/parallel/threads.hpp>

#include <vector>

#include <zlib.h>
#endif

namespace dem::io::detail {

#if defined(DEM_WITH_ZLIB)

/// Packs arrays block by block, on all threads that OpenMP offers.
class VtkPacker {
 public:
  static constexpr const char* attribute = " compressor=\"vtkZLibDataCompressor\"";  ///< of the file

  /// How many blocks there are, the bytes of each, of the last one if it is shorter, and of each when compressed; then
  /// these.
  std::string operator()(const void* data, std::size_t bytes) {
    const std::size_t blocks = (bytes + block_size - 1) / block_size;
    std::vector<std::string> packed(blocks);
    threads_.for_each(blocks, [&](std::size_t k) {
      packed[k] =
          compressed(static_cast<const char*>(data) + k * block_size, std::min(block_size, bytes - k * block_size));
    });
    std::string out;
    const auto put = [&](std::uint64_t number) { out.append(reinterpret_cast<const char*>(&number), sizeof number); };
    put(blocks), put(block_size), put(bytes % block_size);
    for (const std::string& p : packed) put(p.size());
    for (const std::string& p : packed) out += p;
    return out;
  }

 private:
  static constexpr std::size_t block_size = std::size_t{1} << 17;

  static std::string compressed(const char* data, std::size_t bytes) {
    constexpr int fastest = 1;  // numbers of a simulation gain next to nothing from better levels
    auto room = ::compressBound(static_cast<uLong>(bytes));
    std::string out(room, '\0');
    const int status = ::compress2(reinterpret_cast<Bytef*>(out.data()), &room, reinterpret_cast<const Bytef*>(data),
                                   static_cast<uLong>(bytes), fastest);
    if (status != Z_OK) fail("zlib cannot compress {} bytes for ParaView (its error {})", bytes, status);
    out.resize(room);
    return out;
  }

  exec::Threads threads_;
};

#else

class VtkPacker {
 public:
  static constexpr const char* attribute = "";

  /// The number of bytes, and the bytes.
  std::string operator()(const void* data, std::size_t bytes) const {
    const std::uint64_t size = bytes;
    std::string out(sizeof size + bytes, '\0');
    std::memcpy(out.data(), &size, sizeof size);
    if (bytes > 0) std::memcpy(out.data() + sizeof size, data, bytes);
    return out;
  }
};

#endif

}  // namespace dem::io::detail
