#pragma once

// A picture of a world, drawn by gnuplot: grains as balls, the farthest first, and lines of what holds them.

#include <dem/core/ids.hpp>
#include <dem/io/file.hpp>
#include <dem/io/process.hpp>
#include <dem/math/vector.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

/// Seen from far away along right x up: `right` and `up` are the axes of the sheet.
class Picture {
 public:
  Picture(const dem::Vec3& right, const dem::Vec3& up)
      : right_(right.normalized()), up_(up.normalized()), to_us_(right_.cross(up_)) {}

  void grain(const dem::Vec3& x, double radius, std::uint32_t rgb) { balls_.push_back({x, radius, rgb}); }
  /// All grains of a world, coloured by `color(grain)`.
  template <class World, class Color>
  void grains(const World& world, Color&& color) {
    for (const dem::GrainId p : world.grains()) {
      grain(world.position(p), world.species(world.species_of(p)).shape.bounding_radius(), color(p));
    }
  }
  void line(const std::vector<dem::Vec3>& points, std::uint32_t rgb = 0x404040, double width = 2.0) {
    lines_ += fmt::format("$line{} << EOD\n", count_);
    for (const dem::Vec3& x : points) lines_ += fmt::format("{:.6g} {:.6g}\n", x.dot(right_), x.dot(up_));
    lines_ += "EOD\n";
    plots_ += fmt::format(", $line{} with lines lw {} lc rgb 0x{:06x} notitle", count_++, width, rgb);
  }

  /// Writes <base>.gp and, where gnuplot is installed, draws <base>.png.
  void save(const std::filesystem::path& base, const std::string& title, int width = 900, int height = 900) {
    // A stable sort: equal depths, as of grains of a plane, keep their order on every machine.
    std::stable_sort(balls_.begin(), balls_.end(),
                     [&](const Ball& a, const Ball& b) { return a.x.dot(to_us_) < b.x.dot(to_us_); });
    std::string data = "$grains << EOD\n";
    for (const Ball& b : balls_) {  // a rim, the ball, and a light on it
      const double x = b.x.dot(right_), y = b.x.dot(up_), r = b.radius;
      data += fmt::format("{:.6g} {:.6g} {:.6g} {}\n", x, y, r, shade(b.rgb, 0.45));
      data += fmt::format("{:.6g} {:.6g} {:.6g} {}\n", x, y, 0.9 * r, b.rgb);
      data += fmt::format("{:.6g} {:.6g} {:.6g} {}\n", x - 0.25 * r, y + 0.3 * r, 0.4 * r, shade(b.rgb, 1.25));
    }
    const std::string name = base.filename().string();
    dem::io::write_file(base.string() + ".gp",
                        fmt::format("set terminal pngcairo size {},{} font ',12'\nset output '{}.png'\nset title '{}'\n"
                                    "set size ratio -1\nset offsets graph 0.03, graph 0.03, graph 0.03, graph "
                                    "0.03\nunset border\nunset tics\nset style fill solid noborder\n{}EOD\n{}"
                                    "plot $grains using 1:2:3:4 with circles lc rgb variable notitle{}\n",
                                    width, height, name, title, data, lines_, plots_));
    if (const auto gnuplot = dem::io::find_program("gnuplot")) {
      const auto run = dem::io::run_program(*gnuplot, {"--default-settings", name + ".gp"}, base.parent_path());
      if (run.exit_code != 0) fmt::print("gnuplot could not draw {}: {}\n", name, run.errors);
    }
  }

  /// From blue by white to red for a share from 0 to 1.
  static std::uint32_t heat(double share) {
    const double s = std::clamp(share, 0.0, 1.0), red = std::min(1.0, 0.25 + 1.5 * s),
                 blue = std::min(1.0, 1.75 - 1.5 * s);
    return rgb(red, 0.3 + 0.55 * (1.0 - std::abs(2.0 * s - 1.0)), blue);
  }

 private:
  struct Ball {
    dem::Vec3 x;
    double radius;
    std::uint32_t rgb;
  };
  static std::uint32_t rgb(double r, double g, double b) {
    const auto byte = [](double x) { return static_cast<std::uint32_t>(std::clamp(255.0 * x, 0.0, 255.0)); };
    return byte(r) << 16 | byte(g) << 8 | byte(b);
  }
  static std::uint32_t shade(std::uint32_t c, double f) {
    const auto part = [&](int shift) { return f * (c >> shift & 0xff) / 255.0; };
    return rgb(part(16), part(8), part(0));
  }

  dem::Vec3 right_, up_, to_us_;
  std::vector<Ball> balls_;
  std::string lines_, plots_;
  int count_ = 0;
};
