#pragma once
// Time series for ParaView (.pvd).

#include <dem/core/error.hpp>
#include <dem/io/escape.hpp>
#include <dem/io/file.hpp>
#include <dem/io/vtk_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace dem::io {

/// A ParaView collection: which file shows which part (grains, bodies, ...) at which time. The .pvd file is rewritten,
/// complete or not at all, at every add(), so that an interrupted run leaves a series that opens.
///
///     VtkSeries series("out/shear.pvd");                  // files go to out/shear/
///     const auto file = series.next_path("grains");       // out/shear/grains_000000.vtp
///     write_vtk_points(file, positions, {{"radius", 1, radii}});
///     series.add(t, file, "grains");
class VtkSeries {
 public:
  /// Writes an empty collection, in place of an older one of that name. Throws dem::Error when it cannot be written or
  /// the name does not end in ".pvd".
  explicit VtkSeries(std::filesystem::path pvd) : pvd_(std::move(pvd)) {
    if (pvd_.extension() != ".pvd") {
      fail("vtk series '{}': ParaView knows a collection by its ending; name it '{}.pvd'", pvd_.string(),
           pvd_.stem().string());
    }
    save();
  }

  /// Where the next file of `part` may be written: a folder beside the collection, with the collection's name, and
  /// files numbered from 0 for each part. Throws dem::Error for a part name with anything but letters, digits, _ and -.
  [[nodiscard]] std::filesystem::path next_path(std::string_view part) const {
    const auto allowed = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    if (part.empty() || !std::all_of(part.begin(), part.end(), allowed)) {
      fail("vtk series '{}': '{}' cannot name files; use letters, digits, _ and -", pvd_.string(), part);
    }
    const auto known = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.name == part; });
    const std::size_t count = known == parts_.end() ? 0 : known->files;
    return pvd_.parent_path() / pvd_.stem() / fmt::format("{}_{:06}.vtp", part, count);
  }

  /// Adds a file (which should be complete) that shows `part` at the time `time_s` [s]. The same time may be given for
  /// several parts; times of a part need not be equally spaced. Throws dem::Error when the time is not finite or the
  /// collection cannot be written.
  void add(double time_s, const std::filesystem::path& file, std::string_view part = "") {
    if (!std::isfinite(time_s)) {
      fail("vtk series '{}': the time of '{}' is {}; give a finite time", pvd_.string(), file.string(), time_s);
    }
    auto known = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return p.name == part; });
    if (known == parts_.end()) known = parts_.insert(parts_.end(), Part{std::string(part), 0});
    known->files += 1;
    // Relative to the collection, so that the whole folder can be moved.
    const auto relative = file.lexically_proximate(pvd_.parent_path());
    entries_ += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time_s,
                            known - parts_.begin(), escape_xml(part), escape_xml(relative.generic_string()));
    save();
  }

  [[nodiscard]] const std::filesystem::path& path() const { return pvd_; }

  /// What is in the collection, to be kept and restored: a run that goes on adds to it.
  template <class V>
  void fields(V& v) {
    v("entries", entries_), v("parts", parts_);
    if (v.task() == V::Task::restore) save();
  }

 private:
  struct Part {
    std::string name;
    std::size_t files;
    template <class V>
    void fields(V& v) {
      v("name", name), v("files", files);
    }
  };

  void save() const {
    write_file(pvd_, fmt::format("<?xml version=\"1.0\"?>\n"
                                 "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"{}\">\n"
                                 "<Collection>\n{}</Collection>\n</VTKFile>\n",
                                 detail::kVtkByteOrder, entries_));
  }

  std::filesystem::path pvd_;
  std::vector<Part> parts_;  // in order of their first file; the position is ParaView's part number
  std::string entries_;
};

}  // namespace dem::io
