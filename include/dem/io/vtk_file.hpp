#pragma once
// The format below all VTK XML files: XML text that describes the arrays, then their bytes, appended as they are in
// memory (VTK File Formats, "XML file formats", appended raw data), or compressed (vtk_compress.hpp).

#include <dem/core/error.hpp>
#include <dem/io/escape.hpp>
#include <dem/io/file.hpp>
#include <dem/io/vtk_compress.hpp>
#include <dem/io/vtk_data.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dem::io::detail {

inline constexpr std::string_view kVtkByteOrder =
    std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";

template <class T>
constexpr std::string_view vtk_type() {
  if constexpr (std::same_as<T, double>) return "Float64";
  else if constexpr (std::same_as<T, float>) return "Float32";
  else if constexpr (std::same_as<T, std::int32_t>) return "Int32";
  else if constexpr (std::same_as<T, std::int64_t>) return "Int64";
  else if constexpr (std::same_as<T, std::uint8_t>) return "UInt8";
  else if constexpr (std::same_as<T, std::uint32_t>) return "UInt32";
  else if constexpr (std::same_as<T, std::uint64_t>) return "UInt64";
}

/// A number in single precision, rounded. What is not finite stays.
inline float single_of(double x, const Rounding& r) {
  const auto value = static_cast<float>(r.step > 0.0 ? std::nearbyint(x / r.step) * r.step : x);
  if (r.bits >= 23 || !std::isfinite(value)) return value;
  const auto dropped = static_cast<unsigned>(23 - r.bits);
  const std::uint32_t half = 1U << (dropped - 1);  // up into the exponent where the mantissa is full
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(value) + half) >> dropped << dropped);
}

/// Gathers the XML and the arrays of one file, and writes them in one go.
class VtkFile {
 public:
  /// `attributes` of the data's own tag, each with a space in front.
  VtkFile(std::string_view type, const VtkOptions& options, std::string_view attributes = {})
      : type_(type), options_(options) {
    xml_ = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"{1}\" header_type=\"UInt64\"{2}>\n<{0}{3}>\n",
        type_, kVtkByteOrder, VtkPacker::attribute, attributes);
    if (std::isfinite(options.time_s)) {
      xml_ += fmt::format(
          "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">{}"
          "</DataArray>\n</FieldData>\n",
          options.time_s);
    }
  }

  /// Adds XML text, e.g. an opening or closing tag.
  void xml(std::string_view text) { xml_ += text; }

  template <class T>
  void array(std::string_view name, int components, std::span<const T> values, const Rounding& rounding = {}) {
    if constexpr (std::same_as<T, double>) {
      if (options_.single_precision) {
        std::vector<float> floats(values.size());
        std::transform(values.begin(), values.end(), floats.begin(), [&](double x) { return single_of(x, rounding); });
        return array(name, components, std::span<const float>(floats));
      }
    }
    xml_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        vtk_type<T>(), escape_xml(name), components, offset_);
    blocks_.push_back(pack_(values.data(), values.size_bytes()));
    offset_ += blocks_.back().size();
  }
  template <class T>
  void array(std::string_view name, int components, const std::vector<T>& values) {
    array(name, components, std::span<const T>(values));
  }
  void array(const DataArray& data) {
    std::visit([&](const auto& values) { array(data.name, data.components, values, data.rounding); }, data.values);
  }

  /// Closes the XML, appends the arrays and writes the file, complete or not at all.
  void save(const std::filesystem::path& path) {
    xml_ += fmt::format("</{}>\n<AppendedData encoding=\"raw\">\n_", type_);
    AtomicFile file(path);
    file.write(xml_);
    for (const std::string& bytes : blocks_) file.write(bytes);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
  }

 private:
  std::string type_, xml_;
  VtkOptions options_;
  std::vector<std::string> blocks_;  // what is appended
  VtkPacker pack_;
  std::size_t offset_ = 0;
};

/// Throws dem::Error when an array has no or a repeated name, or not `tuples` tuples; `what` names a tuple ("points").
inline void check_arrays(const std::filesystem::path& path, const std::vector<DataArray>& arrays, std::size_t tuples,
                         std::string_view what) {
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const DataArray& a = arrays[i];
    if (a.name.empty()) fail("vtk file '{}': array {} has no name; give it one", path.string(), i);
    for (std::size_t k = 0; k < i; ++k) {
      if (arrays[k].name == a.name) fail("vtk file '{}': two arrays are named '{}'; rename one", path.string(), a.name);
    }
    if (a.components < 1) {
      fail("vtk file '{}': array '{}' has {} components; give 1 (scalar), 3 (vector) or more", path.string(), a.name,
           a.components);
    }
    if (a.size() != tuples * static_cast<std::size_t>(a.components)) {
      fail("vtk file '{}': array '{}' has {} values, but {} {} with {} components need {}", path.string(), a.name,
           a.size(), tuples, what, a.components, tuples * static_cast<std::size_t>(a.components));
    }
  }
}

/// Throws dem::Error when `count` indices would not fit into the files' 32-bit ones.
inline void check_index_count(const std::filesystem::path& path, std::size_t count) {
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  if (count > kMost) {
    fail("vtk file '{}': {} indices, but at most {} fit; write several parts", path.string(), count, kMost);
  }
}

}  // namespace dem::io::detail
