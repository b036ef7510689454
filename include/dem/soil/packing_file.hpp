#pragma once

#include <dem/io/file.hpp>
#include <dem/io/text.hpp>
#include <dem/soil/packing.hpp>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <string>

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
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {} {}\n", g.position.x(), g.position.y(), g.position.z(),
                   q.w(), q.x(), q.y(), q.z());
  }
  io::write_file(path, text);
}

/// Reads a packing. Throws Error, with what is wrong and where, for a file that is not one, is cut short, or holds
/// numbers that make no sense.
inline Packing load_packing(const std::filesystem::path& path) {
  std::istringstream in(io::read_file(path));
  const auto wrong = [&](const std::string& why) {
    fail("'{}' is no packing that can be read: {}; make one with save_packing", path.string(), why);
  };
  const auto expect = [&](const char* word) {
    std::string found;
    if (!(in >> found) || found != word) wrong(fmt::format("'{}' is missing, '{}' stands there", word, found));
  };
  Packing p;
  int version = 0;
  std::size_t count = 0;
  expect("dem-packing");
  if (!(in >> version) || version != 1) wrong(fmt::format("its version is {}, known is 1", version));
  std::string word;
  if (in >> word && word == "shape") in >> p.shape >> word;
  if (word != "half_edge") wrong(fmt::format("'half_edge' is missing, '{}' stands there", word));
  in >> p.half_edge;
  expect("box");
  in >> p.length_x >> p.length_y;
  expect("note");
  std::getline(in, p.note);  // which may be empty
  p.note.erase(0, p.note.find_first_not_of(" \t"));
  if (p.note.ends_with('\r')) p.note.pop_back();
  expect("grains");
  if (!(in >> count) || count > 100'000'000) wrong("the number of grains is missing or above 100 million");
  if (!(p.half_edge > 0.0 && p.length_x > 0.0 && p.length_y > 0.0)) wrong("half_edge or box is not positive");
  p.grains.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Placement g;
    double w, x, y, z;
    if (!(in >> g.position.x() >> g.position.y() >> g.position.z() >> w >> x >> y >> z)) {
      wrong(fmt::format("it ends at grain {} of {}, or has something else than a number there", i, count));
    }
    const Quaternion q(w, x, y, z);
    if (!g.position.allFinite() || !(std::abs(q.norm() - 1.0) < 1e-6)) {
      wrong(fmt::format("grain {} has no finite position or no unit quaternion", i));
    }
    g.rotation = q.normalized().toRotationMatrix();
    p.grains.push_back(g);
  }
  return p;
}

}  // namespace dem::soil
