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
#include <zlib.h>
#endif

namespace dem::io::detail {

#if defined(DEM_WITH_ZLIB)

inline constexpr const char* vtk_compressor = " compressor=\"vtkZLibDataCompressor\"";

/// Numbers of blocks, bytes of a block, bytes of the last one if it is shorter, and of each compressed one; then these.
inline std::string vtk_bytes(const void* data, std::size_t bytes) {
  constexpr std::size_t block = std::size_t{1} << 17;
  constexpr int fastest = 1;  // numbers of a simulation gain next to nothing from better levels
  const std::size_t blocks = (bytes + block - 1) / block;
  std::string out((3 + blocks) * sizeof(std::uint64_t), '\0');
  const auto put = [&](std::size_t k, std::uint64_t number) {
    std::memcpy(out.data() + k * sizeof number, &number, sizeof number);
  };
  put(0, blocks), put(1, block), put(2, bytes % block);
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t size = std::min(block, bytes - k * block), start = out.size();
    auto room = ::compressBound(static_cast<uLong>(size));
    out.resize(start + room);
    const auto* from = static_cast<const Bytef*>(data) + k * block;
    const int status = ::compress2(reinterpret_cast<Bytef*>(out.data() + start), &room, from, size, fastest);
    if (status != Z_OK) fail("zlib cannot compress {} bytes for ParaView (its error {})", size, status);
    out.resize(start + room);
    put(3 + k, room);
  }
  return out;
}

#else

inline constexpr const char* vtk_compressor = "";

/// The number of bytes, and the bytes.
inline std::string vtk_bytes(const void* data, std::size_t bytes) {
  const std::uint64_t size = bytes;
  std::string out(sizeof size + bytes, '\0');
  std::memcpy(out.data(), &size, sizeof size);
  if (bytes > 0) std::memcpy(out.data() + sizeof size, data, bytes);
  return out;
}

#endif

}  // namespace dem::io::detail
