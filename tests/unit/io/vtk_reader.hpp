#pragma once
// Reads the files for ParaView that dem writes, compressed or not, without zlib: a second opinion on them.

#include "catch.hpp"
#include "io/xml.hpp"
#include "report/inflate.hpp"

#include <dem/io/file.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

/// A VTK XML file read back: its tags, and the bytes of its arrays by name.
struct VtkContent {
  std::vector<XmlTag> tags;
  std::map<std::string, std::string> bytes;

  [[nodiscard]] const XmlTag& tag(const std::string& name) const {
    for (const auto& t : tags) {
      if (t.name == name) return t;
    }
    throw std::runtime_error("no tag " + name);
  }
  [[nodiscard]] const XmlTag& array(const std::string& name) const {
    for (const auto& t : tags) {
      if (t.name == "DataArray" && t.at("Name") == name) return t;
    }
    throw std::runtime_error("no array " + name);
  }
  template <class T>
  [[nodiscard]] std::vector<T> values(const std::string& name) const {
    const std::string& from = bytes.at(name);
    REQUIRE(from.size() % sizeof(T) == 0);
    std::vector<T> to(from.size() / sizeof(T));
    if (!to.empty()) std::memcpy(to.data(), from.data(), from.size());
    return to;
  }
};

/// The bytes of an array that begins at `at`, which is moved behind it: as they are, or in zlib's blocks.
inline std::string read_array(const std::string& data, std::size_t& at, bool is_compressed) {
  const auto number = [&] {
    std::uint64_t n = 0;
    REQUIRE(at + sizeof n <= data.size());
    std::memcpy(&n, data.data() + at, sizeof n);
    at += sizeof n;
    return n;
  };
  const auto bytes = [&](std::uint64_t size) {
    REQUIRE(at + size <= data.size());
    at += size;
    return data.substr(at - size, size);
  };
  if (!is_compressed) return bytes(number());
  const std::uint64_t blocks = number(), size = number(), last = number();
  std::vector<std::uint64_t> packed(blocks);
  for (auto& p : packed) p = number();
  std::string all;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    const std::string block = Inflate::all(bytes(packed[k]));
    CHECK(block.size() == (k + 1 == blocks && last > 0 ? last : size));
    all += block;
  }
  return all;
}

inline VtkContent read_vtk(const std::filesystem::path& path, const std::string& type = "PolyData") {
  const std::string file = dem::io::read_file(path);
  const std::string start = "<AppendedData encoding=\"raw\">\n_", end = "\n</AppendedData>\n</VTKFile>\n";
  const auto at = file.find(start);
  REQUIRE(at != std::string::npos);
  REQUIRE(file.size() >= end.size());
  REQUIRE(file.substr(file.size() - end.size()) == end);
  const std::string data = file.substr(at + start.size(), file.size() - at - start.size() - end.size());

  VtkContent content;
  content.tags = XmlReader::tags(file.substr(0, at) + "</VTKFile>");
  const auto& attributes = content.tag("VTKFile").attributes;
  const auto compressor = attributes.find("compressor");
  const bool is_compressed = compressor != attributes.end();
#if defined(DEM_WITH_ZLIB)
  REQUIRE(is_compressed);
  CHECK(compressor->second == "vtkZLibDataCompressor");
#else
  REQUIRE_FALSE(is_compressed);
#endif
  std::size_t next = 0;
  for (const auto& tag : content.tags) {
    if (tag.name != "DataArray" || tag.at("format") != "appended") continue;
    CHECK(tag.at("offset") == std::to_string(next));  // the blocks touch
    content.bytes[tag.at("Name")] = read_array(data, next, is_compressed);
  }
  CHECK(next == data.size());
  CHECK(content.tag("VTKFile").at("type") == type);
  CHECK(content.tag("VTKFile").at("header_type") == "UInt64");
  CHECK(content.tag("VTKFile").at("byte_order") == "LittleEndian");
  return content;
}
