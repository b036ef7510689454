#pragma once

#include <dem/io/file.hpp>
#include <dem/io/mesh_text.hpp>
#include <dem/io/text.hpp>
#include <dem/soil/packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

// Packings as text files, so that they can be read by any program:
//
//     dem-packing 1                 format and its version
//     shape cube8                   one word; may be left out
//     half_edge 0.0009              m
//     box 0.06 0.06                 m, inner length along x and y
//     note random, RD 0.7           to the end of the line
//     grains 14256
//     x y z qw qx qy qz             one line a grain: m, and the rotation as a unit quaternion

namespace dem::soil {

/// Writes a packing, complete or not at all. Numbers read back as the very same. Throws Error if it cannot be written.
inline void save_packing(const Packing& p, const std::filesystem::path& path) {
  if (p.shape.empty() || p.shape.find_first_of(" \t\r\n") != std::string::npos) {
    fail("the shape of a packing is '{}', but must be one word", p.shape);
  }
  std::string text = fmt::format("dem-packing 1\nshape {}\nhalf_edge {}\nbox {} {}\nnote {}\ngrains {}\n", p.shape,
                                 p.half_edge, p.length_x, p.length_y, io::one_line(p.note), p.grains.size());
  for (const Placement& g : p.grains) {
    const Quaternion q(g.rotation);
    text += fmt::format("{} {} {} {} {} {} {}\n", g.position.x(), g.position.y(), g.position.z(), q.w(), q.x(), q.y(),
                        q.z());
  }
  io::write_file(path, text);
}

/// Reads a packing, in every locale. Throws Error, with what is wrong and where, for a file that is not one, is cut
/// short, or holds numbers that make no sense.
inline Packing load_packing(const std::filesystem::path& path) {
  const std::string text = io::read_file(path);
  io::detail::Words words(text, path.string());
  const auto wrong = [&](const std::string& why) {
    fail("'{}' is no packing that can be read: {}; make one with save_packing", path.string(), why);
  };
  const auto expect = [&](std::string_view word) {
    const std::string_view found = words.next();
    if (found != word) wrong(fmt::format("'{}' is missing, '{}' stands there", word, io::detail::shown(found)));
  };
  const auto count_of = [&](std::string_view word) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
    return error == std::errc() && end == word.data() + word.size() && !word.empty() ? std::optional(count)
                                                                                     : std::nullopt;
  };
  Packing p;
  expect("dem-packing");
  const std::string_view version = words.next();
  if (count_of(version) != 1) wrong(fmt::format("its version is {}, known is 1", io::detail::shown(version)));
  if (words.peek() == "shape") {
    words.next();
    p.shape = words.next();
  }
  expect("half_edge");
  p.half_edge = words.number(words.next(), "half_edge");
  expect("box");
  p.length_x = words.number(words.next(), "the box's length");
  p.length_y = words.number(words.next(), "the box's length");
  expect("note");
  p.note = words.rest_of_line();  // which may be empty
  expect("grains");
  const std::optional<std::size_t> count = count_of(words.next());
  if (!count || *count > 100'000'000) wrong("the number of grains is missing or above 100 million");
  if (!(p.half_edge > 0.0 && p.length_x > 0.0 && p.length_y > 0.0)) wrong("half_edge or box is not positive");
  p.grains.reserve(std::min(*count, text.size() / 14));  // not more than the file can hold, whatever it says
  for (std::size_t i = 0; i < *count; ++i) {
    double numbers[7];
    for (double& number : numbers) {
      if (words.at_end()) wrong(fmt::format("it ends at grain {} of {}", i, *count));
      number = words.number(words.next(), "a number of a grain");
    }
    const auto& [x, y, z, qw, qx, qy, qz] = numbers;
    const Quaternion q(qw, qx, qy, qz);
    if (!(std::abs(q.norm() - 1.0) < 1e-6)) wrong(fmt::format("the rotation of grain {} is no unit quaternion", i));
    p.grains.push_back({{x, y, z}, q.normalized().toRotationMatrix()});
  }
  return p;
}

}  // namespace dem::soil
